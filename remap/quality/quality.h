// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: how good a triangle is. In: coordinates; out: a number that is 1
// at best, falls to 0 with a triangle's area and is not positive when inverted.
// None depends on size, place or rotation.
#pragma once

#include "remap/geometry/measure.h"

#include <cmath>
#include <cstdint>
#include <span>

namespace remap::quality
{
/// Radius ratio 2 r_in / R_circ = 16 A² / ((a + b + c) a b c), with the sign of
/// the area; 1 for an equilateral triangle.
inline double radius_ratio(Point a, Point b, Point c)
{
  const double area2 = twice_area(a, b, c);
  const double la = std::sqrt(dot(c - b, c - b));
  const double lb = std::sqrt(dot(a - c, a - c));
  const double lc = std::sqrt(dot(b - a, b - a));
  const double q = 4 * area2 * area2 / ((la + lb + lc) * la * lb * lc);
  return area2 > 0 ? q : (area2 < 0 ? -q : 0.0);
}

/// Target triangle with edges u = b − a and v = c − a, reduced to what
/// |T|²/(2 det T) needs, T = A W⁻¹, W = [u v], A = [b − a  c − a]:
/// |T|²/(2 det T) = (α p·p − 2 β p·q + γ q·q) / det A with p, q the edges of A.
struct Target
{
  double alpha = 0; ///< v·v / (2 det W)
  double beta = 0;  ///< u·v / (2 det W)
  double gamma = 0; ///< u·u / (2 det W)

  static constexpr Target of(Point u, Point v)
  {
    const double w = 2 * cross(u, v);
    return {dot(v, v) / w, dot(u, v) / w, dot(u, u) / w};
  }

  /// The same target seen from the next vertex: edges v − u and −u.
  constexpr Target next() const
  {
    return {gamma, gamma - beta, alpha - 2 * beta + gamma};
  }
};

/// The equilateral target; `shape` is then the mean ratio 4√3 A / Σ l².
inline constexpr Target equilateral = {
    0.57735026918962576451, 0.28867513459481288225, 0.57735026918962576451};

/// |T|²/(2 det T) for edges p = b − a, q = c − a: 1 at the target's shape,
/// unbounded as the area falls to 0, negative when inverted.
constexpr double distortion(const Target& w, Point p, Point q)
{
  return (w.alpha * dot(p, p) - 2 * w.beta * dot(p, q) + w.gamma * dot(q, q))
         / cross(p, q);
}

/// Shape against a target, 2 det T / |T|².
constexpr double shape(const Target& w, Point a, Point b, Point c)
{
  const Point p = b - a;
  const Point q = c - a;
  return cross(p, q)
         / (w.alpha * dot(p, p) - 2 * w.beta * dot(p, q) + w.gamma * dot(q, q));
}
} // namespace remap::quality
