// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/paint.h"

#include "remap/domain/outline_walk.h"
#include "remap/domain/slabs.h"
#include "remap/geometry/position.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace remap
{
namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

/// What a cell holds of one material, about its first corner.
struct Share
{
  int material;
  Moments moments;
};

template <Geometry G>
class Painter
{
public:
  Painter(std::span<const Coat> coats, const outline::Cells& cells,
          int num_materials)
      : _coats(coats), _cells(cells), _times(coats.size()), _near(coats.size()),
        _sums(static_cast<std::size_t>(num_materials) + 1), _rows(cells.size()),
        _out{.materials = Materials(static_cast<std::int32_t>(cells.size()),
                                    num_materials),
             .bare = {},
             .crowded = {}}
  {
    outline::Walk walk(_cells, *this);
    for (std::size_t k = 0; k < coats.size(); ++k)
      if (not coats[k].everywhere)
        for (const Ring& ring : coats[k].domain.rings())
          walk.add(static_cast<int>(k), ring);
    walk.run();
    for (std::size_t c = 0; c < _rows.size(); ++c)
      if (not _rows[c].empty())
        write(static_cast<std::int32_t>(c));
    std::ranges::sort(_out.bare, {}, &BarePlace::cell);
    std::ranges::sort(_out.crowded);
  }

  Painting result() { return std::move(_out); }

  /// As the walk wants it: one coat lies uppermost, found by one point.
  void apart(std::span<const std::int32_t> cells, const outline::Box& box,
             const outline::Seen& seen)
  {
    const Point p = middle(box.low, box.high);
    std::ranges::fill(_times, 0);
    seen.each([&](int k, std::span<const Point> ring)
              { _times[at(k)] += rings::winding(ring, p); });
    const int top = uppermost();
    for (const std::int32_t c : cells)
    {
      const Triangle t = _cells.place(c);
      if (top >= 0)
        _out.materials.set_pure(c, _coats[at(top)].material);
      else
        _out.bare.push_back(
            {c, position::about_first<G>(t).v, 1.0 / 3 * (t[0] + t[1] + t[2])});
    }
  }

  /// A cell that outlines come near.
  void cut(std::int32_t c, const outline::Box& box, const outline::Seen& seen)
  {
    const Triangle t = _cells.place(c);
    _origin = t[0];
    const Triangle local = {Point{}, t[1] - _origin, t[2] - _origin};
    const int covered = find_cover(box, seen, t);
    add_edges(box, seen, local, covered);
    std::ranges::fill(_sums, Moments{});
    double widest = 0;
    Point bare_at;
    int top = -1;
    const auto start = [&](Point p)
    {
      std::ranges::fill(_times, 0);
      each_local(seen, covered, [&](std::size_t k, std::span<const Point> ring)
                 { _times[k] += rings::winding(ring, p); });
      top = uppermost();
    };
    const auto pass = [&](int k, int turn)
    {
      _times[at(k)] += turn;
      top = uppermost();
    };
    const auto piece = [&](const std::array<Point, 4>& p)
    {
      const Moments m = moments_of(p);
      (top < 0 ? _sums.back() : _sums[at(_coats[at(top)].material)]) += m;
      if (top < 0 and m.v > widest)
      {
        widest = m.v;
        bare_at = _origin + 0.25 * (p[0] + p[1] + p[2] + p[3]);
      }
    };
    _slabs.visit(start, pass, piece);
    settle(c, t, bare_at);
  }

private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  /// The uppermost coat where outlines run around as `_times` says, or -1.
  int uppermost() const
  {
    for (std::size_t k = _coats.size(); k-- > 0;)
      if (_coats[k].everywhere or _times[k] > 0)
        return static_cast<int>(k);
    return -1;
  }

  /// Finds the coats with an edge near a cell, `_near`.
  /// @return the uppermost coat that covers the cell wholly, or -1: what lies
  /// under it is not seen
  int find_cover(const outline::Box& box, const outline::Seen& seen,
                 const Triangle& t)
  {
    std::ranges::fill(_near, false);
    std::ranges::fill(_times, 0);
    const Point p = 1.0 / 3 * (t[0] + t[1] + t[2]);
    seen.each(
        [&](int k, std::span<const Point> ring)
        {
          for (std::size_t i = 0; i < ring.size(); ++i)
            if (box.meets(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]))
              _near[at(k)] = true;
          _times[at(k)] += rings::winding(ring, p);
        });
    for (std::size_t k = _coats.size(); k-- > 0;)
      if (_coats[k].everywhere or (not _near[k] and _times[k] > 0))
        return static_cast<int>(k);
    return -1;
  }

  /// Rings of the coats that are seen in a cell, measured from its first
  /// corner.
  template <class V>
  void each_local(const outline::Seen& seen, int covered, V visit)
  {
    seen.each(
        [&](int k, std::span<const Point> ring)
        {
          if (k < covered)
            return;
          _ring.clear();
          for (const Point p : ring)
            _ring.push_back(p - _origin);
          visit(at(k), _ring);
        });
  }

  /// Only edges that meet the cell's box: they are the same however the
  /// outlines were thinned on the way.
  void add_edges(const outline::Box& box, const outline::Seen& seen,
                 const Triangle& local, int covered)
  {
    _slabs.begin(local);
    _reach = std::max(std::abs(_origin.x), std::abs(_origin.y));
    for (const Point p : local)
      _reach = std::max({_reach, std::abs(p.x), std::abs(p.y)});
    seen.each(
        [&](int k, std::span<const Point> ring)
        {
          for (std::size_t i = 0; k >= covered and i < ring.size(); ++i)
          {
            const Point a = ring[i];
            const Point b = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (not box.meets(a, b))
              continue;
            _slabs.add(k, a - _origin, b - _origin);
            for (const Point p : {a - _origin, b - _origin})
              _reach = std::max({_reach, std::abs(p.x), std::abs(p.y)});
          }
        });
  }

  Moments moments_of(const std::array<Point, 4>& p) const
  {
    double x[4], y[4];
    for (std::size_t i = 0; i < 4; ++i)
      x[i] = p[i].x, y[i] = p[i].y;
    return polygon::fan<G>(x, y, 4, _origin.x);
  }

  /// From the sums of a cell to what it holds.
  void settle(std::int32_t c, const Triangle& t, Point bare_at)
  {
    double size = 0;
    for (const Point p : t)
      size = std::max(
          {size, std::abs(p.x - _origin.x), std::abs(p.y - _origin.y)});
    const double noise = 16 * eps * _reach * size * position::weight<G>(t);
    if (_sums.back().v > noise)
      _out.bare.push_back({c, _sums.back().v, bare_at});
    const auto shares = std::span(_sums).first(_sums.size() - 1);
    const std::size_t largest = static_cast<std::size_t>(
        std::ranges::max_element(shares, {}, &Moments::v) - shares.begin());
    auto& row = _rows[static_cast<std::size_t>(c)];
    Moments rest = position::about_first<G>(t);
    for (std::size_t k = 0; k < shares.size(); ++k)
      if (k != largest and shares[k].v > noise)
      {
        row.push_back({static_cast<int>(k), shares[k]});
        rest = rest - shares[k];
      }
    if (row.size() >= static_cast<std::size_t>(most_parts))
    {
      _out.crowded.push_back(c);
      row.clear();
    }
    if (row.empty())
      return _out.materials.set_pure(c, static_cast<int>(largest));
    // All that is round-off, or bare, is in the largest.
    row.push_back({static_cast<int>(largest), rest});
    std::ranges::sort(row, {}, &Share::material);
  }

  void write(std::int32_t c)
  {
    const Triangle t = _cells.place(c);
    const Triangle local = {Point{}, t[1] - t[0], t[2] - t[0]};
    const double all = position::about_first<G>(t).v;
    _parts.clear();
    for (const Share& s : _rows[static_cast<std::size_t>(c)])
      _parts.push_back({s.material, s.moments.v / all,
                        t[0] + position::held_in(local, s.moments.centroid())});
    _out.materials.add_row(c, _parts);
  }

  std::span<const Coat> _coats;
  const outline::Cells& _cells;
  std::vector<int> _times;    ///< how often each coat's outline runs around
  std::vector<char> _near;    ///< of each coat: has it an edge near the cell?
  std::vector<Moments> _sums; ///< by material, and bare
  std::vector<std::vector<Share>> _rows; ///< of mixed cells; else empty
  std::vector<Part> _parts;
  outline::Slabs _slabs;
  Ring _ring;
  Point _origin;
  double _reach = 0;
  Painting _out;
};
} // namespace

template <Geometry G>
Painting paint(std::span<const Coat> coats, std::span<const std::int32_t> cells,
               std::span<const double> x, int num_materials)
{
  for (std::size_t k = 0; k < coats.size(); ++k)
    if (coats[k].material < 0 or coats[k].material >= num_materials)
      throw std::invalid_argument("coat " + std::to_string(k) + ": material "
                                  + std::to_string(coats[k].material) + " of "
                                  + std::to_string(num_materials));
  const outline::Cells all{cells, x};
  return Painter<G>(coats, all, num_materials).result();
}

template Painting paint<Geometry::plane>(std::span<const Coat>,
                                         std::span<const std::int32_t>,
                                         std::span<const double>, int);
template Painting paint<Geometry::axisymmetric>(std::span<const Coat>,
                                                std::span<const std::int32_t>,
                                                std::span<const double>, int);
} // namespace remap
