// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the region that a facet sweeps when its ends move on straight
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
/// the area `area2`; r is the first coordinate of the origin. In plain numbers:
/// only of these compilers make vector instructions.
template <Geometry G>
[[gnu::always_inline]] constexpr void
triangle_at(double area2, double ax, double ay, double bx, double by,
            [[maybe_unused]] double r, double& v, double& x, double& y)
{
  const double sx = ax + bx, sy = ay + by;
  v = 0.5 * area2;
  x = area2 * (1.0 / 6) * sx;
  y = area2 * (1.0 / 6) * sy;
  if constexpr (G == Geometry::axisymmetric)
  {
    const double t = area2 * (1.0 / 24);
    const double flat = v, fx = x, fy = y;
    v = r * flat + fx;
    x = r * fx + t * (sx * sx + ax * ax + bx * bx);
    y = r * fy + t * (sx * sy + ax * ay + bx * by);
  }
}

// By value: std::min's references keep loops from becoming vector instructions.
[[gnu::always_inline]] constexpr double lesser(double a, double b)
{
  return a < b ? a : b;
}
[[gnu::always_inline]] constexpr double greater(double a, double b)
{
  return a > b ? a : b;
}

/// Between the least and the largest of 0, a, b, c.
[[gnu::always_inline]] constexpr double held(double value, double a, double b,
                                             double c)
{
  const double lo = lesser(lesser(0.0, a), lesser(b, c));
  const double hi = greater(greater(0.0, a), greater(b, c));
  return lesser(greater(value, lo), hi);
}

/// `swept_parts` in plain numbers: ends p0, q0 before and p1, q1 after in, two
/// volumes and centroids out. Without branches, because the motion cannot be
/// foreseen, and so that a loop over facets becomes vector instructions.
template <Geometry G>
[[gnu::always_inline]] constexpr void
swept_parts(double p0x, double p0y, double q0x, double q0y, double p1x,
            double p1y, double q1x, double q1y, double (&v)[2], double (&x)[2],
            double (&y)[2])
{
  // From p0: facet before d, way of p a, diagonal c; facet after e, way of q b.
  const double dx = q0x - p0x, dy = q0y - p0y;
  const double ax = p1x - p0x, ay = p1y - p0y;
  const double cx = q1x - p0x, cy = q1y - p0y;
  const double ex = cx - ax, ey = cy - ay;
  const double bx = cx - dx, by = cy - dy;
  // Four products tell on which side of each line each other end lies.
  const double da = dx * ay - dy * ax, db = dx * by - dy * bx;
  const double ea = ex * ay - ey * ax, eb = ex * by - ey * bx;
  const bool facets = (da * db < 0) & (ea * eb < 0); // they cross: it turns
  const bool paths = (da * ea < 0) & (db * eb < 0);  // it is turned over
  const double above = facets ? ea : db;
  const double s = above / (facets | paths ? above - eb : 1.0);
  double v0, x0, y0, v1, x1, y1, v2, x2, y2;
  triangle_at<G>(db, dx, dy, cx, cy, p0x, v0, x0, y0);
  triangle_at<G>(ea, cx, cy, ax, ay, p0x, v1, x1, y1);
  v0 += v1, x0 += x1, y0 += y1;
  // The triangle from p0 to where the facets, or the paths, cross.
  const double sd = facets ? s : 1.0, sa = facets ? 1.0 : s;
  triangle_at<G>(s * da, sd * dx, sd * dy, sa * ax, sa * ay, p0x, v2, x2, y2);
  const bool two = (facets | paths) & (v2 * (v0 - v2) < 0);
  v[0] = two ? v2 : v0;
  v[1] = two ? v0 - v2 : 0.0;
  const double over0 = 1 / (v[0] != 0 ? v[0] : 1.0);
  const double over1 = 1 / (v[1] != 0 ? v[1] : 1.0);
  x[0] = p0x + held((two ? x2 : x0) * over0, dx, ax, cx);
  y[0] = p0y + held((two ? y2 : y0) * over0, dy, ay, cy);
  x[1] = p0x + held((x0 - x2) * over1, dx, ax, cx);
  y[1] = p0y + held((y0 - y2) * over1, dy, ay, cy);
}
} // namespace detail

/// See SweptParts.
template <Geometry G>
constexpr SweptParts swept_parts(const Motion& m)
{
  double v[2], x[2], y[2];
  detail::swept_parts<G>(m.p0.x, m.p0.y, m.q0.x, m.q0.y, m.p1.x, m.p1.y, m.q1.x,
                         m.q1.y, v, x, y);
  return {{v[0], v[1]}, {{x[0], y[0]}, {x[1], y[1]}}};
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
  void sweep();
};
} // namespace remap
