// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: how good a triangle is. In: coordinates; out: a number that is 1
// at best, falls to 0 with a triangle's area and is not positive when inverted.
// None depends on size, place or rotation.
#pragma once

#include "remap/geometry/measure.h"

#include <cmath>
#include <cstdint>
#include <span>

namespace remap::quality
{
/// Radius ratio from twice the area and the lengths of the edges.
inline double radius_ratio(double area2, double la, double lb, double lc)
{
  const double q = 4 * area2 * area2 / ((la + lb + lc) * (la * lb * lc));
  return area2 > 0 ? q : (area2 < 0 ? -q : 0.0);
}

/// Radius ratio 2 r_in / R_circ = 16 A² / ((a + b + c) a b c), with the sign of
/// the area; 1 for an equilateral triangle.
inline double radius_ratio(Point a, Point b, Point c)
{
  return radius_ratio(twice_area(a, b, c), std::sqrt(dot(c - b, c - b)),
                      std::sqrt(dot(a - c, a - c)),
                      std::sqrt(dot(b - a, b - a)));
}

/// Shape of a target triangle with edges u = b − a and v = c − a, T = A W⁻¹, W
/// = [u v], A = [b − a  c − a]: with u laid along x and of length 1, v = (r, k)
/// and
///   |T|²/(2 det T) = (k |p|² + |q − r p|²/k)/(2 det A) with p, q the edges of
///   A,
/// a sum of squares: no digits are lost where cells are long and thin.
struct Target
{
  double r = 0;    ///< u·v / u·u
  double own = 0;  ///< k/2, k = u × v / u·u
  double rest = 0; ///< 1/(2k)

  static constexpr Target of(Point u, Point v)
  {
    const double k = cross(u, v) / dot(u, u);
    return {dot(u, v) / dot(u, u), k / 2, 1 / (2 * k)};
  }

  /// The same target seen from the next vertex: edges v − u and −u.
  constexpr Target next() const { return of({r - 1, 2 * own}, {-1, 0}); }
};

/// |T|² det A/(2 det T) for edges p, q of A.
constexpr double squares(const Target& w, Point p, Point q)
{
  const Point m = q - w.r * p;
  return w.own * dot(p, p) + w.rest * dot(m, m);
}

/// The equilateral target; `shape` is then the mean ratio 4√3 A / Σ l².
inline constexpr Target equilateral = {0.5, 0.43301270189221932338,
                                       0.57735026918962576451};

/// |T|²/(2 det T) for edges p = b − a, q = c − a: 1 at the target's shape,
/// unbounded as the area falls to 0, negative when inverted.
constexpr double distortion(const Target& w, Point p, Point q)
{
  return squares(w, p, q) / cross(p, q);
}

/// Shape against a target, 2 det T / |T|².
constexpr double shape(const Target& w, Point a, Point b, Point c)
{
  const Point p = b - a;
  const Point q = c - a;
  return cross(p, q) / squares(w, p, q);
}
} // namespace remap::quality
