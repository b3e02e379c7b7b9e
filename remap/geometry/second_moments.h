// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: second moments of polygons about any point: how a material is
// spread in its cell. In axisymmetry weighted with the radius, as all volumes.
#pragma once

#include "remap/geometry/measure.h"
#include "remap/geometry/polygon.h"

namespace remap
{
/// ∫(x − a)² dV, ∫(x − a)(y − b) dV, ∫(y − b)² dV about a point (a, b).
struct SecondMoments
{
  double xx = 0;
  double xy = 0;
  double yy = 0;

  constexpr SecondMoments& operator+=(SecondMoments b)
  {
    xx += b.xx, xy += b.xy, yy += b.yy;
    return *this;
  }
};

/// Of the triangle about, p, q, counted with the sign of its area. Exact
/// polynomials: of order 2, in axisymmetry with the third moments of order 3.
template <Geometry G>
constexpr SecondMoments second_moments(Point about, Point p, Point q)
{
  const Point a = p - about, b = q - about;
  const double area = 0.5 * cross(a, b);
  const SecondMoments flat = {
      area / 6 * (a.x * a.x + a.x * b.x + b.x * b.x),
      area / 12 * ((a.x + b.x) * (a.y + b.y) + a.x * a.y + b.x * b.y),
      area / 6 * (a.y * a.y + a.y * b.y + b.y * b.y)};
  if constexpr (G == Geometry::plane)
    return flat;
  else
  {
    const double aa = a.x * a.x, ab = a.x * b.x, bb = b.x * b.x;
    const double xxx = area / 10 * (aa * (a.x + b.x) + bb * (a.x + b.x));
    const double xxy =
        area / 30
        * ((3 * aa + 2 * ab + bb) * a.y + (aa + 2 * ab + 3 * bb) * b.y);
    const double yya = a.y * a.y, yyab = a.y * b.y, yyb = b.y * b.y;
    const double xyy =
        area / 30
        * ((3 * yya + 2 * yyab + yyb) * a.x + (yya + 2 * yyab + 3 * yyb) * b.x);
    const double r = about.x;
    return {r * flat.xx + xxx, r * flat.xy + xxy, r * flat.yy + xyy};
  }
}

/// Of a polygon, counter-clockwise; it need not be convex.
template <Geometry G, int N>
[[nodiscard]] SecondMoments second_moments(const Polygon<N>& p, Point about)
{
  SecondMoments out;
  for (int i = 0; i < p.size; ++i)
    out += second_moments<G>(about, p[i], p[i + 1 < p.size ? i + 1 : 0]);
  return out;
}
} // namespace remap
