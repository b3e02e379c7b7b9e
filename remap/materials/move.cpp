// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/move.h"

#include "remap/geometry/position.h"
#include "remap/interfaces/placement.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace remap;

namespace
{
Triangle place_of(const Mesh& mesh, std::span<const double> x, std::int32_t c)
{
  const Triple& n = mesh.cell(c);
  return {point(x, n[0]), point(x, n[1]), point(x, n[2])};
}

/// The affine map of a triangle to its new place.
class Affine
{
public:
  Affine(const Triangle& from, const Triangle& to)
      : _from(from[0]), _to(to[0]), _u(from[1] - from[0]),
        _v(from[2] - from[0]), _u1(to[1] - to[0]), _v1(to[2] - to[0]),
        _area(cross(_u, _v))
  {
  }

  [[nodiscard]] Point vector(Point w) const
  {
    const double s = cross(w, _v) / _area, t = cross(_u, w) / _area;
    return s * _u1 + t * _v1;
  }
  [[nodiscard]] Point operator()(Point p) const
  {
    return _to + vector(p - _from);
  }
  [[nodiscard]] HalfPlane operator()(const HalfPlane& h) const
  {
    // Left of a way that follows the line.
    const Point along = vector({-h.normal.y, h.normal.x});
    const double length = std::hypot(along.x, along.y);
    return {{along.y / length, -along.x / length}, (*this)(h.at)};
  }

private:
  Point _from, _to, _u, _v, _u1, _v1;
  double _area;
};

/// Largest s in [0, 1] with g + s (p − g) inside a triangle that g is in.
double way_inside(const Triangle& t, Point g, Point p)
{
  double s = 1;
  for (int k = 0; k < 3; ++k)
  {
    const Point a = t[k], b = t[(k + 1) % 3];
    const double at_g = position::depth(a, b, g);
    const double at_p = position::depth(a, b, p);
    if (at_p < 0)
      s = std::min(s, at_g / (at_g - at_p));
  }
  return s;
}

/// Make the sum rule hold, with all centroids inside.
template <Geometry G>
void obey(const Triangle& t, std::span<Part> parts, MoveReport& report)
{
  const Point g = t[0] + position::about_first<G>(t).centroid();
  Point sum;
  for (const Part& p : parts)
    sum = sum + p.fraction * (p.centroid - g);
  const double size = position::longest_edge(t);
  report.shift = std::max(report.shift, std::hypot(sum.x, sum.y) / size);
  double s = 1;
  for (Part& p : parts)
  {
    p.centroid = p.centroid - sum;
    s = std::min(s, way_inside(t, g, p.centroid));
  }
  if (s == 1)
    return;
  ++report.held;
  for (Part& p : parts)
    p.centroid = g + s * (p.centroid - g);
}

template <Geometry G>
MoveReport affine(const Mesh& mesh, std::span<const double> x0,
                  std::span<const double> x1, Materials& materials)
{
  MoveReport report;
  for (std::int32_t c : materials.mixed())
  {
    const Triangle to = place_of(mesh, x1, c);
    const Affine map(place_of(mesh, x0, c), to);
    const auto parts = materials.parts(materials.row(c));
    for (Part& p : parts)
      p.centroid = map(p.centroid);
    obey<G>(to, parts, report);
  }
  return report;
}

/// Moments of the parts of a cell, about an origin.
using PartMoments = std::array<Moments, most_parts>;

/// Volume of some polygon by the leaves below a node: `add(part, volume)`.
template <Geometry G, class Use>
void each_leaf(const Piece& p, const Partition& by, int node, double radius,
               Use&& use)
{
  if (p.size < 3)
    return;
  if (node < 0)
    return use(~node, polygon::fan<G>(p.x.data(), p.y.data(), p.size, radius));
  Piece in, out;
  split(p, by.cuts[node].plane, in, out);
  each_leaf<G>(in, by, by.cuts[node].in, radius, use);
  each_leaf<G>(out, by, by.cuts[node].out, radius, use);
}

/// Cuts of a partition moved parallel to themselves, one after the other, so
/// that each part's volume grows by its factor.
template <Geometry G>
class Growth
{
public:
  Growth(const Partition& by, double radius,
         std::span<const double, most_parts> factors)
      : _by(by), _radius(radius), _factors(factors)
  {
  }

  /// @param[in] before, now polygons of this node
  /// @param[in,out] moments of the parts, grow by what is found
  void grow(const Piece& before, const Piece& now, int node,
            PartMoments& moments) const
  {
    if (now.size < 3)
      return;
    if (node < 0)
    {
      moments[~node] += volume(now);
      return;
    }
    const Cut& cut = _by.cuts[node];
    Piece in, out, in_now, out_now;
    split(before, cut.plane, in, out);
    const double vi = grown(in, cut.in), vo = grown(out, cut.out);
    const double all = volume(now).v;
    const Chord chord = place<G>(
        now, cut.plane.normal, vi + vo > 0 ? all * vi / (vi + vo) : 0, _radius);
    split(now, {cut.plane.normal, middle(chord.a, chord.b)}, in_now, out_now);
    grow(in, in_now, cut.in, moments);
    grow(out, out_now, cut.out, moments);
  }

private:
  [[nodiscard]] Moments volume(const Piece& p) const
  {
    return p.size < 3
               ? Moments{}
               : polygon::fan<G>(p.x.data(), p.y.data(), p.size, _radius);
  }
  [[nodiscard]] double grown(const Piece& p, int node) const
  {
    double sum = 0;
    each_leaf<G>(p, _by, node, _radius, [&](int part, const Moments& m)
                 { sum += _factors[part] * m.v; });
    return sum;
  }

  const Partition& _by;
  double _radius;
  std::span<const double, most_parts> _factors;
};

/// Centroids of one cell after its interfaces have moved.
template <Geometry G>
void regrow(const Triangle& t, const Affine& map, const Partition& partition,
            std::span<const double> fractions, std::span<Part> parts)
{
  const Point o = t[0];
  Partition by = partition;
  for (int k = 0; k < by.count; ++k)
  {
    by.cuts[k].plane = map(by.cuts[k].plane);
    by.cuts[k].plane.at = by.cuts[k].plane.at - o;
  }
  Piece cell;
  for (const Point& v : t)
    cell.push(v - o);
  const int root = by.count > 0 ? 0 : ~0;
  PartMoments before{}, after{};
  each_leaf<G>(cell, by, root, o.x,
               [&](int part, const Moments& m) { before[part] += m; });
  // By the volumes that the cuts make now: in axisymmetry the affine map does
  // not keep fractions.
  const double whole = position::about_first<G>(t).v;
  std::array<double, most_parts> factors{};
  for (std::size_t k = 0; k < parts.size(); ++k)
    factors[k] = before[k].v > 0 ? fractions[k] * whole / before[k].v : 0;
  Growth<G>(by, o.x, factors).grow(cell, cell, root, after);
  for (std::size_t k = 0; k < parts.size(); ++k)
  {
    // What the centroid was off its polygon it stays off.
    if (before[k].v > 0 and after[k].v > 0)
      parts[k].centroid =
          parts[k].centroid + (after[k].centroid() - before[k].centroid());
    parts[k].fraction = fractions[k];
  }
}

template <Geometry G>
MoveReport regrown(const Mesh& mesh, std::span<const double> x0,
                   std::span<const double> x1,
                   std::span<const Partition> partitions,
                   std::span<const double> fractions, Materials& materials)
{
  MoveReport report;
  for (std::int32_t c : materials.mixed())
  {
    const std::int32_t row = materials.row(c);
    const Triangle to = place_of(mesh, x1, c);
    const Affine map(place_of(mesh, x0, c), to);
    const auto parts = materials.parts(row);
    for (Part& p : parts)
      p.centroid = map(p.centroid);
    regrow<G>(
        to, map, partitions[row],
        fractions.subspan(materials.first_slot(row) - materials.num_cells(),
                          parts.size()),
        parts);
    obey<G>(to, parts, report);
  }
  return report;
}
} // namespace

MoveReport remap::move(const Mesh& mesh, Geometry geometry,
                       std::span<const double> x0, std::span<const double> x1,
                       Materials& materials)
{
  return geometry == Geometry::plane
             ? affine<Geometry::plane>(mesh, x0, x1, materials)
             : affine<Geometry::axisymmetric>(mesh, x0, x1, materials);
}

MoveReport remap::move(const Mesh& mesh, Geometry geometry,
                       std::span<const double> x0, std::span<const double> x1,
                       std::span<const Partition> partitions,
                       std::span<const double> fractions, Materials& materials)
{
  return geometry == Geometry::plane
             ? regrown<Geometry::plane>(mesh, x0, x1, partitions, fractions,
                                        materials)
             : regrown<Geometry::axisymmetric>(mesh, x0, x1, partitions,
                                               fractions, materials);
}
