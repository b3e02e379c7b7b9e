// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.2: the region that a facet sweeps when its ends move on straight
// lines. Volumes on both sides change by exactly these regions:
// V⁺ = V⁻ − ΣF, F counted positive out of the volume.
#pragma once

#include "remap/geometry/measure.h"

#include <algorithm>
#include <cmath>

namespace remap
{
/// A facet p → q before and after; its left volume lies to the left of p → q.
struct Motion
{
  Point p0, q0; ///< before
  Point p1, q1; ///< after
};

/// Signed swept region of a facet; its volume is positive when the left volume
/// loses.
template <Geometry G>
constexpr Moments swept(const Motion& m)
{
  return quadrilateral<G>(m.p0, m.q0, m.q1, m.p1);
}

/// The parts of a swept region: one, or two of opposite signs if the region's
/// outline crosses itself (a facet that turns about an inner point, or is
/// turned over), so that each part lies on one side and has one donor. A part
/// that is not there has no volume. The parts add up to `swept` to round-off.
struct SweptParts
{
  double v[2]; ///< volumes, positive when the left volume loses
  Point at[2]; ///< centroids, held in the box around the motion: for slivers of
               ///< round-off size the quotient of moment and volume means
               ///< nothing
};

namespace detail
{
/// Volume and first moments, from (0, 0), of the triangle 0, a, b with twice
/// the area `area2`; r is the first coordinate of the origin.
template <Geometry G>
constexpr Moments triangle_at(double area2, Point a, Point b,
                              [[maybe_unused]] double r)
{
  const double third = area2 / 6;
  const Point s = a + b;
  const Moments flat = {0.5 * area2, third * s.x, third * s.y};
  if constexpr (G == Geometry::plane)
    return flat;
  else
  {
    const double twelfth = area2 / 24;
    return {r * flat.v + flat.x,
            r * flat.x + twelfth * (s.x * s.x + a.x * a.x + b.x * b.x),
            r * flat.y + twelfth * (s.x * s.y + a.x * a.y + b.x * b.y)};
  }
}

/// Centroid from the origin, held between lo and hi.
constexpr Point held(const Moments& m, Point lo, Point hi)
{
  const double inverse = 1 / (m.v != 0 ? m.v : 1.0);
  return {std::min(std::max(m.x * inverse, lo.x), hi.x),
          std::min(std::max(m.y * inverse, lo.y), hi.y)};
}

constexpr Point least(Point a, Point b)
{
  return {std::min(a.x, b.x), std::min(a.y, b.y)};
}
constexpr Point most(Point a, Point b)
{
  return {std::max(a.x, b.x), std::max(a.y, b.y)};
}
} // namespace detail

/// See SweptParts. Without branches, because the motion cannot be foreseen, and
/// so that a loop over facets becomes vector instructions.
template <Geometry G>
constexpr SweptParts swept_parts(const Motion& m)
{
  const Point d = m.q0 - m.p0; // facet before
  const Point a = m.p1 - m.p0; // way of p
  const Point c = m.q1 - m.p0; // diagonal
  const Point e = c - a;       // facet after
  const Point b = c - d;       // way of q
  // Four products tell on which side of each line each other end lies.
  const double da = cross(d, a), db = cross(d, b);
  const double ea = cross(e, a), eb = cross(e, b);
  const bool facets = (da * db < 0) & (ea * eb < 0); // they cross: it turns
  const bool paths = (da * ea < 0) & (db * eb < 0);  // it is turned over
  const double above = facets ? ea : db;
  const double below = facets ? ea - eb : db - eb;
  const double s = above / (facets | paths ? below : 1.0);

  const Moments all = detail::triangle_at<G>(db, d, c, m.p0.x)
                      + detail::triangle_at<G>(ea, c, a, m.p0.x);
  // From p0 to where the facets, or the paths, cross.
  const Point u = {facets ? s * d.x : d.x, facets ? s * d.y : d.y};
  const Point w = {facets ? a.x : s * a.x, facets ? a.y : s * a.y};
  const Moments first = detail::triangle_at<G>(s * da, u, w, m.p0.x);
  const bool two = (facets | paths) & (first.v * (all.v - first.v) < 0);
  const Moments kept = {two ? first.v : all.v, two ? first.x : all.x,
                        two ? first.y : all.y};
  const Moments rest = {two ? all.v - first.v : 0.0,
                        two ? all.x - first.x : 0.0,
                        two ? all.y - first.y : 0.0};
  const Point lo = detail::least(detail::least({}, d), detail::least(a, c));
  const Point hi = detail::most(detail::most({}, d), detail::most(a, c));
  return {
      {kept.v, rest.v},
      {m.p0 + detail::held(kept, lo, hi), m.p0 + detail::held(rest, lo, hi)}};
}

/// Motions of many facets, taken together.
struct SweptBatch
{
  static constexpr int room = 64;
  int count = 0;
  double p0x[room], p0y[room], q0x[room], q0y[room];
  double p1x[room], p1y[room], q1x[room], q1y[room];
  double v[2][room], x[2][room], y[2][room]; ///< parts, see SweptParts

  void add(const Motion& m)
  {
    p0x[count] = m.p0.x, p0y[count] = m.p0.y;
    q0x[count] = m.q0.x, q0y[count] = m.q0.y;
    p1x[count] = m.p1.x, p1y[count] = m.p1.y;
    q1x[count] = m.q1.x, q1y[count] = m.q1.y;
    ++count;
  }

  template <Geometry G>
  void sweep()
  {
    for (int k = 0; k < count; ++k)
    {
      const SweptParts parts = swept_parts<G>({{p0x[k], p0y[k]},
                                               {q0x[k], q0y[k]},
                                               {p1x[k], p1y[k]},
                                               {q1x[k], q1y[k]}});
      v[0][k] = parts.v[0], v[1][k] = parts.v[1];
      x[0][k] = parts.at[0].x, x[1][k] = parts.at[1].x;
      y[0][k] = parts.at[0].y, y[1][k] = parts.at[1].y;
    }
  }
};
} // namespace remap
