// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: cells whose facets are bent so that each sweeps a given volume,
// and what half-planes cut from them. A facet is bent by one more vertex, in
// its middle and moved along its normal: what one neighbour gains the other
// loses. Such a cell need not be convex; cut polygons may have edges that lie
// on each other, whose areas cancel.
#pragma once

#include "remap/geometry/polygon.h"
#include "remap/geometry/swept.h"
#include "remap/interfaces/partition.h"
#include "remap/mesh.h"

#include <cmath>
#include <span>

namespace remap::bent
{
/// A bent cell after its cuts: three of a triangle, twelve of a partition.
using Region = Polygon<72>;

/// Part of a polygon, convex or not, in a half-plane.
///
/// @source Sutherland & Hodgman (1974)
template <int N>
inline void clip(const Polygon<N>& p, const HalfPlane& h, Region& in)
{
  in.size = 0;
  const int n = p.size;
  if (n == 0)
    return;
  const double *x = p.x.data(), *y = p.y.data();
  double depth[N];
  for (int i = 0; i < n; ++i)
    depth[i] = h.depth(x[i], y[i]);
  for (int i = n - 1, j = 0; j < n; i = j++)
  {
    const bool from = depth[i] > 0, to = depth[j] > 0;
    if (from != to)
      in.push(from ? polygon::crossing(x, y, depth, i, j)
                   : polygon::crossing(x, y, depth, j, i));
    if (to)
      in.push(p[j]);
  }
}

/// Both sides of a cut through a polygon, convex or not.
inline void split(const Region& p, const HalfPlane& h, Region& in, Region& out)
{
  in.size = out.size = 0;
  const int n = p.size;
  if (n == 0)
    return;
  const double *x = p.x.data(), *y = p.y.data();
  double depth[Region::capacity];
  for (int i = 0; i < n; ++i)
    depth[i] = h.depth(x[i], y[i]);
  for (int i = n - 1, j = 0; j < n; i = j++)
  {
    const bool from = depth[i] > 0, to = depth[j] > 0;
    if (from != to)
    {
      const Point c = from ? polygon::crossing(x, y, depth, i, j)
                           : polygon::crossing(x, y, depth, j, i);
      in.push(c);
      out.push(c);
    }
    (to ? in : out).push(p[j]);
  }
}

/// Moments about the origin that coordinates are measured from.
template <Geometry G, int N>
inline Moments moments(const Polygon<N>& p, Point origin)
{
  return p.size < 3 ? Moments{}
                    : polygon::fan<G>(p.x.data(), p.y.data(), p.size, origin.x);
}

/// Pieces of a polygon by parts of a partition: use(part, moments about
/// `origin`). Coordinates are measured from there, the partition's are not.
template <Geometry G, class Use>
void split_by(const Region& p, const Partition& by, int node, Point origin,
              Use& use)
{
  if (node < 0)
    return use(~node, moments<G>(p, origin));
  const Cut& cut = by.cuts[node];
  const HalfPlane h{cut.plane.normal, cut.plane.at - origin};
  Region in, out;
  split(p, h, in, out);
  if (in.size > 2)
    split_by<G>(in, by, cut.in, origin, use);
  if (out.size > 2)
    split_by<G>(out, by, cut.out, origin, use);
}

/// The vertex that bends a facet p → q so that what lies between it and the
/// straight facet, to its left, has a given signed volume.
template <Geometry G>
inline Point vertex(Point p, Point q, double volume)
{
  const Point along = q - p, left{-along.y, along.x};
  const double square = dot(along, along);
  double s; // |q - p| · height
  if constexpr (G == Geometry::plane)
    s = 2 * volume / square;
  else
  {
    // area (r_p + r_q + r) / 3 with r = (r_p + r_q) / 2 + s left.x
    const double b = square * (p.x + q.x) / 4;
    const double a = square * left.x / 6;
    s = 2 * volume / (b + std::sqrt(std::max(0.0, b * b + 4 * a * volume)));
  }
  return middle(p, q) + s * left;
}

/// A cell at its new place.
struct Cell
{
  Polygon<6> outline; ///< from `origin`
  Point origin;       ///< its first node
  Triangle nodes;     ///< from `origin`
  Moments whole;      ///< about `origin`
  double length = 0;  ///< of its longest edge
  bool good = false;  ///< is all of its outline seen from its middle?
};

/// Volume between the straight facet and the one that has swept a given volume
/// on its way; 0 if that is round-off.
template <Geometry G>
inline double surplus(const Mesh& mesh, std::span<const double> x_old,
                      std::span<const double> x_new, double volume,
                      std::int32_t f)
{
  const auto [a, b] = mesh.facet(f);
  const Point o = point(x_old, a);
  Point p0{}, q0 = point(x_old, b) - o, p1 = point(x_new, a) - o,
              q1 = point(x_new, b) - o;
  if constexpr (G == Geometry::axisymmetric)
    p0.x += o.x, q0.x += o.x, p1.x += o.x, q1.x += o.x;
  const double straight = swept<G>({p0, q0, p1, q1}).v;
  const double bend = volume - straight;
  const double scale = std::abs(volume) + std::abs(straight);
  return std::abs(bend) > 1e-15 * scale ? bend : 0.0;
}

/// @param[in] volumes that facets sweep, counted as `swept` does, shape
/// (num_facets); empty: facets stay straight
template <Geometry G>
inline Cell cell(const Mesh& mesh, std::span<const double> x_old,
                 std::span<const double> x_new, std::span<const double> volumes,
                 std::int32_t c)
{
  Cell out;
  const Triple& n = mesh.cell(c);
  out.origin = point(x_new, n[0]);
  for (int i = 0; i < 3; ++i)
    out.nodes[i] = point(x_new, n[i]) - out.origin;
  double square = 0;
  for (int i = 0; i < 3; ++i)
  {
    const Point edge = out.nodes[(i + 1) % 3] - out.nodes[i];
    square = std::max(square, dot(edge, edge));
    out.outline.push(out.nodes[i]);
    if (volumes.empty())
      continue;
    const std::int32_t f = mesh.cell_facets(c)[i];
    const double bend = surplus<G>(mesh, x_old, x_new, volumes[f], f);
    if (bend == 0)
      continue;
    const auto [a, b] = mesh.facet(f);
    out.outline.push(vertex<G>(point(x_new, a), point(x_new, b), bend)
                     - out.origin);
  }
  out.length = std::sqrt(square);
  out.whole = moments<G>(out.outline, out.origin);
  const Point g = 1.0 / 3 * (out.nodes[0] + out.nodes[1] + out.nodes[2]);
  out.good = out.whole.v > 0;
  for (int i = 0; i < out.outline.size; ++i)
    out.good = out.good
               and twice_area(g, out.outline[i],
                              out.outline[(i + 1) % out.outline.size])
                       > 0;
  return out;
}
} // namespace remap::bent
