// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How triangles lie to each other: which edges of one pass through another, and
// with what length. For walks from triangle to triangle.
#pragma once

#include "remap/geometry/polygon.h"

#include <algorithm>
#include <cmath>

namespace remap::position
{
/// Twice the area to the left of a → b, seen from p; exactly 0 at a and b.
inline double depth(Point a, Point b, Point p)
{
  return cross(b - a, p - a);
}

/// How a triangle p lies to another, q.
struct Position
{
  /// Edges of p, one bit each, that pass through the inside of q with a part of
  /// q beyond them.
  unsigned edges = 0;
  /// Half-planes of q, one bit each, that p does not lie in wholly.
  unsigned cuts = 0;
};

/// The axes of an edge and a triangle that may part them are the edge's normal
/// and those of the triangle. Without branches: nobody can guess the answer.
inline Position of(const Triangle& p, const Triangle& q)
{
  const Point u = q[1] - q[0], v = q[2] - q[0];
  // Twice the areas with pairs of edges of q, and depths in its half-planes;
  // exactly 0 for shared vertices (but for fused multiply-add).
  double pu[3], pv[3], d[3][3], x[3], y[3];
  const double uv = cross(u, v);
  for (int i = 0; i < 3; ++i)
  {
    x[i] = p[i].x - q[0].x;
    y[i] = p[i].y - q[0].y;
    pu[i] = x[i] * u.y - y[i] * u.x;
    pv[i] = x[i] * v.y - y[i] * v.x;
    d[0][i] = -pu[i];
    d[1][i] = (pu[i] - pv[i]) + uv;
    d[2][i] = pv[i];
  }
  Position out;
  for (int j = 0; j < 3; ++j)
    out.cuts |= static_cast<unsigned>(
                    not(std::min(std::min(d[j][0], d[j][1]), d[j][2]) > 0))
                << j;
  for (int k = 0; k < 3; ++k)
  {
    const int l = k == 2 ? 0 : k + 1;
    // Depths of q's vertices inside this edge.
    const double pp = x[k] * y[l] - y[k] * x[l];
    const double beyond =
        std::min(std::min(pp, (pu[l] - pu[k]) + pp), (pv[l] - pv[k]) + pp);
    const double reach = std::min(
        std::min(std::max(d[0][k], d[0][l]), std::max(d[1][k], d[1][l])),
        std::max(d[2][k], d[2][l]));
    out.edges |=
        (static_cast<unsigned>(reach > 0) & static_cast<unsigned>(beyond < 0))
        << k;
  }
  return out;
}

/// Length of the part of a → b inside a triangle.
inline double length_inside(Point a, Point b, const Triangle& q)
{
  double from = 0, to = 1;
  for (int j = 0; j < 3; ++j)
  {
    const Point u = q[j], v = q[(j + 1) % 3];
    const double da = depth(u, v, a), db = depth(u, v, b);
    if (not(da > 0) and not(db > 0))
      return 0;
    if (not(da > 0))
      from = std::max(from, da / (da - db));
    if (not(db > 0))
      to = std::min(to, da / (da - db));
  }
  return std::max(0.0, to - from) * std::hypot(b.x - a.x, b.y - a.y);
}

/// In the box around a triangle: for slivers of round-off size the quotient of
/// moment and volume means little.
inline Point held_in(const Triangle& t, Point p)
{
  const auto hold = [](double v, double a, double b, double c)
  {
    const double lo = std::min(std::min(a, b), c);
    const double hi = std::max(std::max(a, b), c);
    return std::min(std::max(v, lo), hi);
  };
  return {hold(p.x, t[0].x, t[1].x, t[2].x), hold(p.y, t[0].y, t[1].y, t[2].y)};
}

inline double longest_edge(const Triangle& t)
{
  const Point a = t[1] - t[0], b = t[2] - t[1], c = t[0] - t[2];
  return std::sqrt(std::max(std::max(dot(a, a), dot(b, b)), dot(c, c)));
}

/// What a volume weighs an area with, at most.
template <Geometry G>
inline double weight(const Triangle& t)
{
  if constexpr (G == Geometry::plane)
    return 1;
  else
    return std::max(std::max(t[0].x, t[1].x), t[2].x);
}

/// Moments of a triangle about its first vertex.
template <Geometry G>
Moments about_first(const Triangle& t)
{
  double x[3], y[3];
  polygon::load(t, t[0], x, y);
  return polygon::fan<G>(x, y, 3, t[0].x);
}
} // namespace remap::position
