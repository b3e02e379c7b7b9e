// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the line with a given normal that cuts a given volume off a convex
// polygon. Closed form in the plane; in axisymmetry (Pappus) the volume is a
// cubic of the line's position between two vertices, solved by a safe Newton
// search. Volumes are met to some eps of the polygon's, tiny ones to some eps
// of themselves as far as coordinates resolve them.
#pragma once

#include "remap/geometry/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace remap
{
/// The part of a line that lies in a cell: what is cut off lies to the left of
/// the way from a to b.
struct Chord
{
  Point a, b;

  /// What lies to the left, with a normal of length 1.
  [[nodiscard]] HalfPlane left() const
  {
    HalfPlane out = HalfPlane::left_of(a, b);
    out.at = middle(a, b);
    const double length = std::sqrt(dot(out.normal, out.normal));
    out.normal = length > 0 ? (1 / length) * out.normal : Point{1, 0};
    return out;
  }
};

/// Cut of a triangle in the plane.
///
/// @param[in] t        counter-clockwise
/// @param[in] normal   out of what is cut off; any length; 0, where nothing
/// tells: x
/// @param[in] fraction of the area to be cut off, and its `rest` = 1 −
/// fraction,
///                     both given so that neither loses digits
inline HalfPlane place(const Triangle& t, Point normal, double fraction,
                       double rest)
{
  const double length = std::sqrt(dot(normal, normal));
  normal = length > 0 ? (1 / length) * normal : Point{1, 0};
  int low = 0, mid = 1, top = 2;
  double d[3];
  for (int i = 0; i < 3; ++i)
    d[i] = dot(normal, t[i] - t[0]);
  if (d[mid] < d[low])
    std::swap(mid, low);
  if (d[top] < d[mid])
    std::swap(top, mid);
  if (d[mid] < d[low])
    std::swap(mid, low);
  const double all = d[top] - d[low];
  // From the corner that is cut off, or left over.
  const bool below = fraction * all <= d[mid] - d[low];
  const int tip = below ? low : top, far = below ? top : low;
  const double near_side = std::abs(d[mid] - d[tip]);
  const double x = std::sqrt((below ? fraction : rest) * near_side * all);
  const double s = near_side > 0 ? std::min(1.0, x / near_side) : 1.0;
  const double r = all > 0 ? std::min(1.0, x / all) : 1.0;
  const Point at =
      t[tip] + 0.5 * (s * (t[mid] - t[tip]) + r * (t[far] - t[tip]));
  return {normal, at};
}

/// The point of a chord that the line may turn about: to first order, the
/// volume on its sides stays.
template <Geometry G>
inline Point pivot(const Chord& c, double radius)
{
  const double a = radius + c.a.x, b = radius + c.b.x;
  if (G == Geometry::plane or not(a + b > 0))
    return middle(c.a, c.b);
  return c.a + (a + 2 * b) / (3 * (a + b)) * (c.b - c.a);
}

namespace detail
{
/// Volume between two levels y = 0 … 1 of a trapezoid of this height, up to y:
/// chords from a to b at both, with weights 1 or radius + x.
template <Geometry G>
struct Slab
{
  double height, w0, w1, r0, r1; ///< widths, and mean radii of the chords

  [[nodiscard]] double up_to(double y) const
  {
    const double w = w1 - w0;
    if constexpr (G == Geometry::plane)
      return height * y * (w0 + 0.5 * y * w);
    const double r = r1 - r0;
    return height * y
           * (w0 * r0 + y * (0.5 * (w * r0 + w0 * r) + y / 3 * w * r));
  }
  [[nodiscard]] double chord(double y) const
  {
    const double w = height * (w0 + y * (w1 - w0));
    return G == Geometry::plane ? w : w * (r0 + y * (r1 - r0));
  }
  /// Where the volume is reached; 0 <= volume <= up_to(1).
  [[nodiscard]] double level(double volume) const
  {
    if constexpr (G == Geometry::plane)
    {
      const double root =
          std::sqrt(std::max(0.0, w0 * w0 + 2 * volume / height * (w1 - w0)));
      const double y = 2 * volume / height / (w0 + root);
      return y < 1 ? y : 1;
    }
    // The mean width as if all were at one radius is a start.
    const double radius = std::max(r0, r1);
    double lo = 0, hi = 1;
    double y =
        radius > 0
            ? Slab<Geometry::plane>{height, w0, w1, 1, 1}.level(volume / radius)
            : 1;
    for (int i = 0; i < 100; ++i)
    {
      const double miss = up_to(y) - volume;
      (miss > 0 ? hi : lo) = y;
      const double next = y - miss / chord(y);
      // Also when the chord has no weight.
      const double step_to = next > lo and next < hi ? next : 0.5 * (lo + hi);
      if (std::abs(step_to - y) <= 1e-16 * y or miss == 0)
        break;
      y = step_to;
    }
    return y;
  }
};
} // namespace detail

/// Chord at which a volume is cut off a convex polygon below a normal.
///
/// @param[in] p      counter-clockwise, convex to round-off
/// @param[in] normal of length 1, out of what is cut off
/// @param[in] volume between 0 and the polygon's
/// @param[in] radius of the origin that p is measured from (axisymmetric)
template <Geometry G, int N>
Chord place(const Polygon<N>& p, Point normal, double volume, double radius = 0)
{
  const int n = p.size;
  const Point along = {normal.y, -normal.x};
  std::array<double, N> d;
  int low = 0;
  for (int i = 0; i < n; ++i)
  {
    d[i] = dot(normal, p[i]);
    low = d[i] < d[low] ? i : low;
  }
  // Two ways up: to the right (b) counter-clockwise, to the left (a) back.
  int a = low, b = low, next_a = low == 0 ? n - 1 : low - 1,
      next_b = low == n - 1 ? 0 : low + 1;
  Chord at = {p[low], p[low]};
  double y = d[low], left = volume;
  const auto reach = [&](int from, int to, double level)
  {
    const double rise = d[to] - d[from];
    return rise > 0 ? p[from] + ((level - d[from]) / rise) * (p[to] - p[from])
                    : p[to];
  };
  for (int steps = 0; steps < 2 * n; ++steps)
  {
    const double level = std::min(d[next_a], d[next_b]);
    const Chord top = {d[next_a] <= level ? p[next_a] : reach(a, next_a, level),
                       d[next_b] <= level ? p[next_b]
                                          : reach(b, next_b, level)};
    const auto width = [along](const Chord& c)
    { return std::max(0.0, dot(along, c.b - c.a)); };
    const detail::Slab<G> slab = {level - y, width(at), width(top),
                                  radius + 0.5 * (at.a.x + at.b.x),
                                  radius + 0.5 * (top.a.x + top.b.x)};
    const bool last = next_a == next_b or (d[next_a] <= level and next_a == b)
                      or (d[next_b] <= level and next_b == a);
    if (level > y)
    {
      const double here = slab.up_to(1);
      if (left <= here or last)
      {
        const double f = left < here ? slab.level(left) : 1;
        return {at.b + f * (top.b - at.b), at.a + f * (top.a - at.a)};
      }
      left -= here;
      at = top;
      y = level;
    }
    if (d[next_a] <= level)
    {
      at.a = p[next_a];
      a = next_a;
      next_a = a == 0 ? n - 1 : a - 1;
    }
    if (d[next_b] <= level)
    {
      at.b = p[next_b];
      b = next_b;
      next_b = b == n - 1 ? 0 : b + 1;
    }
    if (last)
      break;
  }
  return {at.b, at.a};
}

/// Half-plane with a fraction of a convex polygon; its point is the chord's
/// pivot. Counted from the side of the smaller part.
template <Geometry G, int N>
HalfPlane place_fraction(const Polygon<N>& p, Point normal, double fraction,
                         double rest, double radius)
{
  const double length = std::sqrt(dot(normal, normal));
  const Point n = length > 0 ? 1 / length * normal : Point{1, 0};
  const double v = polygon::fan<G>(p.x.data(), p.y.data(), p.size, radius).v;
  const Chord c = fraction <= rest ? place<G>(p, n, fraction * v, radius)
                                   : place<G>(p, -1.0 * n, rest * v, radius);
  return {n, pivot<G>(c, radius)};
}
} // namespace remap
