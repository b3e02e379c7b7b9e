// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: moment of fluid with any number of parts: the binary tree of
// straight cuts with the least Σ fraction · distance² of centroids.
//
// A polygon is cut in two for every way to share its parts out to the two
// sides; each cut is the best one for the two groups. A group's distance² is at
// most that of its parts (the mean of squares is no less than the square of the
// mean), so it bounds what can come of a cut, and few need following. All trees
// are tried up to `all_trees` parts in a polygon; beyond, the two cuts with the
// least errors are followed.
//
// Two parts that one cut cannot bring near their centroids are a filament, or a
// corner: then the smaller one may be a strip with the other on both sides.
// Three parts may meet in a point, in cells of up to `all_trees` parts.
#pragma once

#include "remap/interfaces/filament.h"
#include "remap/interfaces/junction.h"
#include "remap/interfaces/sort.h"
#include "remap/interfaces/turning.h"
#include "remap/materials/materials.h"

#include <limits>
#include <tuple>

namespace remap
{
/// Parts of one polygon up to which all trees are tried.
inline constexpr int all_trees = 4;

/// Put a tree behind the cuts of another.
/// @return number of its root there, or ~part if it has no cut
inline int append(const Partition& tree, int leaf, Partition& to)
{
  if (tree.count == 0)
    return ~leaf;
  const int first = to.count;
  for (int i = 0; i < tree.count; ++i)
  {
    Cut cut = tree.cuts[i];
    if (cut.in >= 0)
      cut.in = static_cast<std::int8_t>(cut.in + first);
    if (cut.out >= 0)
      cut.out = static_cast<std::int8_t>(cut.out + first);
    to.add(cut);
  }
  return first;
}

/// What became of the parts of a cell.
struct Tally
{
  double error = 0;   ///< Σ fraction · distance² of the centroids [m^2]
  int filaments = 0;  ///< strips with the same part on both sides
  int unresolved = 0; ///< pairs of parts that neither a cut nor a strip fits
};

/// The trees of one cell.
template <Geometry G>
class Trees
{
public:
  /// @param[in] cell     counter-clockwise
  /// @param[in] parts    as they shall be
  /// @param[in] filament from how far off, in half-widths of the cell, two
  /// parts
  ///                     are taken for a filament
  Trees(const Triangle& cell, std::span<const Part> parts, double filament)
      : _filament(filament), _origin(1.0 / 3 * (cell[0] + cell[1] + cell[2])),
        _count(static_cast<int>(parts.size()))
  {
    for (int i = 0; i < _count; ++i)
      _names[i] = i;
    // By what they are, not by their names: ties then end the same way.
    sort_few(_names.data(), _count,
             [parts](int a, int b)
             {
               const Part &p = parts[a], &q = parts[b];
               return std::tie(p.fraction, p.centroid.x, p.centroid.y)
                      < std::tie(q.fraction, q.centroid.x, q.centroid.y);
             });
    for (int i = 0; i < _count; ++i)
    {
      const Part& part = parts[_names[i]];
      _parts[i] = {part.fraction, part.centroid - _origin};
    }
    for (const Point& v : cell)
      _cell.push(v - _origin);
  }

  /// The best tree.
  Tally solve(Partition& out)
  {
    Found found;
    divide(_cell, (1u << _count) - 1, found);
    out.count = 0;
    for (int i = 0; i < found.tree.count; ++i)
    {
      out.add(found.tree.cuts[i]);
      out.cuts[i].plane.at = out.cuts[i].plane.at + _origin;
    }
    return found;
  }

private:
  static constexpr double none = std::numeric_limits<double>::infinity();

  struct Found : Tally ///< while there is none the error is an upper bound
  {
    bool is = false;
    int leaf = 0; ///< the part, without a cut
    Partition tree;
    Found() : Tally{.error = none} {}
  };
  struct Way
  {
    double error;
    unsigned in;
    HalfPlane plane;
  };

  [[nodiscard]] double radius() const
  {
    return G == Geometry::plane ? 0 : _origin.x;
  }
  [[nodiscard]] Moments moments(const Piece& p) const
  {
    return polygon::fan<G>(p.x.data(), p.y.data(), p.size, radius());
  }

  /// Fraction and centroid of some parts together.
  [[nodiscard]] Target group(unsigned parts) const
  {
    Target out;
    for (; parts != 0; parts &= parts - 1)
    {
      const Target& t = _parts[std::countr_zero(parts)];
      out.fraction += t.fraction;
      out.centroid = out.centroid + t.fraction * t.centroid;
    }
    out.centroid = 1 / out.fraction * out.centroid;
    return out;
  }

  /// Best cut of a polygon for two groups.
  [[nodiscard]] Straight cut(const Piece& p, const Moments& whole, Target in,
                             Target out) const
  {
    const double all = in.fraction + out.fraction;
    in.fraction /= all;
    out.fraction /= all;
    Straight found = [&]
    {
      if constexpr (G == Geometry::plane)
        if (p.size == 3)
          return best_cut(Triangle{p[0], p[1], p[2]}, in, out);
      return best_cut<G>(p, whole, in, out, radius());
    }();
    found.error *= all;
    return found;
  }

  /// The tree of a polygon with these parts, if its error is below the bound
  /// that `best` brings; otherwise `best` is left as it is.
  void divide(const Piece& p, unsigned parts, Found& best) const
  {
    const Moments whole = moments(p);
    if (std::popcount(parts) == 1 or not(whole.v > 0))
    {
      // A polygon lost to round-off is any part's.
      const int part = std::countr_zero(parts);
      const Point off =
          whole.v > 0 ? whole.centroid() - _parts[part].centroid : Point{};
      const double error = _parts[part].fraction * dot(off, off);
      if (error < best.error)
      {
        static_cast<Tally&>(best) = {.error = error};
        best.is = true;
        best.leaf = _names[part];
        best.tree.count = 0;
      }
      return;
    }
    if (std::popcount(parts) <= all_trees)
      cut_in_two<1 << (all_trees - 1)>(p, whole, parts, best);
    else
      cut_in_two<1 << (most_parts - 1)>(p, whole, parts, best);
    if (std::popcount(parts) == 2)
      strip(p, whole, parts, best);
    if (std::popcount(parts) == 3 and _count <= all_trees)
      meet(p, parts, best);
  }

  /// The trees of a polygon with two parts or more.
  template <int Most>
  void cut_in_two(const Piece& p, const Moments& whole, unsigned parts,
                  Found& best) const
  {
    // The last part is always outside: the other half are the same cuts.
    const unsigned last = std::bit_floor(parts);
    std::array<Way, Most> ways;
    int num = 0;
    for (unsigned in = (parts - 1) & parts; in != 0; in = (in - 1) & parts)
      if ((in & last) == 0)
      {
        const Straight s = cut(p, whole, group(in), group(parts & ~in));
        ways[num++] = {s.error, in, s.plane};
      }
    sort_few(ways.data(), num,
             [](const Way& a, const Way& b) { return a.error < b.error; });
    if (std::popcount(parts) > all_trees)
      num = std::min(num, 2);
    for (int k = 0; k < num and ways[k].error < best.error; ++k)
      follow(p, parts, ways[k], best);
  }

  /// Targets as fractions of a polygon's volume.
  [[nodiscard]] Target share(int part, double all) const
  {
    return {_parts[part].fraction / all, _parts[part].centroid};
  }

  /// Two parts that one cut does not fit.
  void strip(const Piece& p, const Moments& whole, unsigned parts,
             Found& best) const
  {
    const int a = std::countr_zero(parts),
              b = std::countr_zero(parts & (parts - 1));
    // Parts stand by fraction: a is the smaller one.
    const double all = _parts[a].fraction + _parts[b].fraction;
    if (not best.is
        or not(best.error * _parts[b].fraction
               > _filament * _filament * least_spread(p) * _parts[a].fraction
                     * all))
      return;
    const Strip found =
        best_strip<G>(p, whole, share(a, all), share(b, all), radius());
    if (not(all * found.error < 0.25 * best.error))
    {
      best.unresolved = 1;
      return;
    }
    const auto leaf = [this](int part)
    { return static_cast<std::int8_t>(~_names[part]); };
    static_cast<Tally&>(best) = {.error = all * found.error, .filaments = 1};
    best.tree.count = 0;
    best.tree.add({found.below, leaf(b), 1});
    best.tree.add({found.upto, leaf(a), leaf(b)});
  }

  /// Three parts that meet in a point.
  void meet(const Piece& p, unsigned parts, Found& best) const
  {
    // What trees bring to round-off needs no other.
    if (not(best.error > 1e-20 * least_spread(p)))
      return;
    std::array<int, 3> part{};
    std::array<Target, 3> targets;
    double all = 0;
    for (int i = 0; i < 3; ++i, parts &= parts - 1)
    {
      part[i] = std::countr_zero(parts);
      all += _parts[part[i]].fraction;
    }
    for (int i = 0; i < 3; ++i)
      targets[i] = share(part[i], all);
    auto found =
        best_junction<G>(p, targets, radius(), 1e-28 * least_spread(p));
    Partition cuts;
    if (not found or not(all * found->error < best.error))
      return;
    for (int& i : found->part)
      i = _names[part[i]];
    if (not found->cuts(cuts))
      return;
    static_cast<Tally&>(best) = {.error = all * found->error};
    best.is = true;
    best.tree = cuts;
  }

  /// Least mean square of the distances of vertices from the middle, in any
  /// direction.
  [[nodiscard]] static double least_spread(const Piece& p)
  {
    Point mean;
    for (int i = 0; i < p.size; ++i)
      mean = mean + 1.0 / p.size * p[i];
    double xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < p.size; ++i)
    {
      const Point d = p[i] - mean;
      xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    // The product of both over their sum: at least half the lesser.
    return (xx * yy - xy * xy) / ((xx + yy) * p.size);
  }

  /// The trees that start with a cut.
  void follow(const Piece& p, unsigned parts, const Way& way, Found& best) const
  {
    Piece in, out;
    split(p, way.plane, in, out);
    Found left, right;
    left.error = best.error;
    divide(in, way.in, left);
    if (not left.is)
      return;
    right.error = best.error - left.error;
    divide(out, parts & ~way.in, right);
    if (not right.is or not(left.error + right.error < best.error))
      return;
    best.is = true;
    best.error = left.error + right.error;
    best.filaments = left.filaments + right.filaments;
    best.unresolved = left.unresolved + right.unresolved;
    best.tree.count = 0;
    const int root = best.tree.add({.plane = way.plane});
    const int to_in = append(left.tree, left.leaf, best.tree);
    const int to_out = append(right.tree, right.leaf, best.tree);
    best.tree.cuts[root].in = static_cast<std::int8_t>(to_in);
    best.tree.cuts[root].out = static_cast<std::int8_t>(to_out);
  }

  double _filament;
  Point _origin;
  int _count;
  Piece _cell;
  std::array<Target, most_parts> _parts; ///< measured from the origin
  std::array<int, most_parts> _names;
};
} // namespace remap
