// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: volumes and first moments of triangles, corners and swept
// regions. Plane: per unit thickness [m^3/m]; axisymmetric: per radian
// [m^3/rad], x is the radius r. All are signed and exact polynomials of the
// coordinates, so parts add up to the whole to round-off (Pappus included).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace remap
{
/// Coordinates (x, y), in axisymmetry (r, z) [m].
struct Point
{
  double x = 0;
  double y = 0;

  friend constexpr Point operator+(Point a, Point b)
  {
    return {a.x + b.x, a.y + b.y};
  }
  friend constexpr Point operator-(Point a, Point b)
  {
    return {a.x - b.x, a.y - b.y};
  }
  friend constexpr Point operator*(double s, Point a)
  {
    return {s * a.x, s * a.y};
  }
  friend constexpr bool operator==(Point a, Point b) = default;
};

constexpr double dot(Point a, Point b)
{
  return a.x * b.x + a.y * b.y;
}
constexpr double cross(Point a, Point b)
{
  return a.x * b.y - a.y * b.x;
}
constexpr Point middle(Point a, Point b)
{
  return 0.5 * (a + b);
}

/// Point i of an array of coordinates, shape (n, 2).
inline Point point(std::span<const double> x, std::int32_t i)
{
  return {x[2 * i], x[2 * i + 1]};
}

/// Which weight an area carries: 1, or r.
enum class Geometry
{
  plane,
  axisymmetric
};

/// Volume and first moments of a region: ∫dV, ∫x dV, ∫y dV.
struct Moments
{
  double v = 0;
  double x = 0;
  double y = 0;

  constexpr Moments& operator+=(Moments b)
  {
    v += b.v, x += b.x, y += b.y;
    return *this;
  }
  friend constexpr Moments operator+(Moments a, Moments b) { return a += b; }
  friend constexpr Moments operator-(Moments a, Moments b)
  {
    return {a.v - b.v, a.x - b.x, a.y - b.y};
  }
  constexpr Moments operator-() const { return {-v, -x, -y}; }
  /// Place of the mean value of a linear field.
  constexpr Point centroid() const { return {x / v, y / v}; }
};

/// Twice the signed plane area of a triangle, positive counter-clockwise.
constexpr double twice_area(Point a, Point b, Point c)
{
  return cross(b - a, c - a);
}

/// Signed volume and first moments of a triangle.
template <Geometry G>
constexpr Moments triangle(Point a, Point b, Point c)
{
  const double area = 0.5 * twice_area(a, b, c);
  const Point s = a + b + c;
  if constexpr (G == Geometry::plane)
    return {area, area / 3 * s.x, area / 3 * s.y};
  else
  {
    // ∫r² and ∫rz of products of linear functions over a triangle.
    const double rr = a.x * a.x + b.x * b.x + c.x * c.x;
    const double rz = a.x * a.y + b.x * b.y + c.x * c.y;
    return {area / 3 * s.x, area / 12 * (s.x * s.x + rr),
            area / 12 * (s.x * s.y + rz)};
  }
}

/// Signed volume and first moments of the polygon a, b, c, d. It may be
/// non-convex or cross itself: the parts then count with their signs.
template <Geometry G>
constexpr Moments quadrilateral(Point a, Point b, Point c, Point d)
{
  return triangle<G>(a, b, c) + triangle<G>(a, c, d);
}

/// Corner of vertex a in triangle (a, b, c): the part between a, the middles of
/// its two facets, and the centroid. The three corners add up to the triangle.
template <Geometry G>
constexpr Moments corner(Point a, Point b, Point c)
{
  const Point g = 1.0 / 3 * (a + b + c);
  return quadrilateral<G>(a, middle(a, b), g, middle(a, c));
}
} // namespace remap
