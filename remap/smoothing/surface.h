// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: a node of a free surface moves parallel to the chord of its two
// neighbours on the surface. The plane area does not change by that; in
// axisymmetry a step across the chord keeps the volume. Two neighbours move
// against each other and keep both.
#pragma once

#include "remap/geometry/measure.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace remap::surface
{
/// Step across the chord that gives the triangle (before, p, after) the volume
/// `wanted`: A(δ) (r̄(δ)) is quadratic in the step δ, closed form.
///
/// @param[in] wanted Σr · 2A of the triangle, six volumes [m³]
inline Point keep_volume(Point before, Point p, Point after, double wanted)
{
  const Point chord = after - before;
  const double length = std::sqrt(dot(chord, chord));
  const Point n = {chord.y / length, -chord.x / length};
  // (r + δ n_r) (a + δ length') = wanted, with 2A = a + slope δ
  const double a = twice_area(before, p, after);
  const double slope = twice_area(before, p + n, after) - a;
  const double r = before.x + p.x + after.x;
  const double c2 = slope * n.x;
  const double c1 = slope * r + a * n.x;
  const double c0 = a * r - wanted;
  const double root = c1 * c1 - 4 * c2 * c0;
  if (not(root >= 0) or c1 == 0)
    return p;
  // The root that tends to −c0/c1 when c2 vanishes.
  const double delta = -2 * c0 / (c1 + std::copysign(std::sqrt(root), c1));
  return p + delta * n;
}

/// A node's place at part `tau` of the chord, at the height it has above it,
/// the plane area (or the volume) kept.
template <Geometry G>
Point at(Point before, Point p, Point after, double tau)
{
  const Point chord = after - before;
  const double now = dot(p - before, chord) / dot(chord, chord);
  const Point q = p + (tau - now) * chord;
  if constexpr (G == Geometry::plane)
    return q;
  else
    return keep_volume(before, q, after,
                       twice_area(before, p, after)
                           * (before.x + p.x + after.x));
}

/// Part of the chord at which the two facets have lengths as l1 : l2.
///
/// Solves (τ² + k²) l2² = ((1 − τ)² + k²) l1², k = height / chord.
inline double part(Point before, Point p, Point after, double l1, double l2)
{
  const Point chord = after - before;
  const double cc = dot(chord, chord);
  const double k = cross(chord, p - before) / cc;
  const double a = l2 * l2 - l1 * l1;
  const double b = 2 * l1 * l1;
  const double c = -l1 * l1 + k * k * a;
  const double root = b * b - 4 * a * c;
  // A tall peak may leave no such place: as far as it goes.
  const double tau =
      root >= 0 ? -2 * c / (b + std::sqrt(root)) : (a > 0 ? 0.0 : 1.0);
  return std::min(std::max(tau, 0.05), 0.95);
}

/// Steps of b and c on the way a, b, c, d: across its chord, along `across`.
struct Step
{
  Point across{};    ///< length 1
  double first = 0;  ///< of b [m]
  double second = 0; ///< of c, so that the plane area is kept [m]
};

/// Steps after which one of the turns at b and c, of opposite signs, is gone
/// and the other one smaller; none where the way turns back along its chord.
///
/// Across the chord heights are linear in the steps: b is above the line a c by
/// e, c above the line b d by f.
inline Step straighten(Point a, Point b, Point c, Point d)
{
  const Point chord = d - a;
  const double length = std::sqrt(dot(chord, chord));
  const Point t = (1 / length) * chord;
  Step out{{-t.y, t.x}};
  const double ab = dot(b - a, t), bc = dot(c - b, t), cd = dot(d - c, t);
  if (not(ab > 0 and bc > 0 and cd > 0))
    return out;
  const double hb = dot(b - a, out.across), hc = dot(c - a, out.across);
  const double rb = ab / (ab + bc), rc = cd / (bc + cd);
  const double e = hb - rb * hc, f = hc - rc * hb;
  const double ratio = (ab + bc) / (bc + cd); // of the steps
  const double first = e / (1 + ratio * rb);
  const double second = f / (ratio + rc);
  if (not(first * second < 0))
    return out;
  out.first =
      -std::copysign(std::min(std::abs(first), std::abs(second)), first);
  out.second = -ratio * out.first;
  return out;
}

/// Where b and c are after a part of the steps, the volume kept.
inline std::pair<Point, Point> pair_at(Geometry geometry, Point a, Point b,
                                       Point c, Point d, double part,
                                       const Step& step)
{
  const Point first = b + (part * step.first) * step.across;
  const Point second = c + (part * step.second) * step.across;
  if (geometry == Geometry::plane)
    return {first, second};
  const auto six = [](Point p, Point q, Point r)
  { return twice_area(p, q, r) * (p.x + q.x + r.x); };
  return {first,
          keep_volume(first, second, d,
                      six(first, c, d) - six(a, first, c) + six(a, b, c))};
}
} // namespace remap::surface
