// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: a region of the plane bounded by polygons, with holes: what a
// material fills at the start, whatever the mesh. Valid by construction: outer
// rings counter-clockwise, holes clockwise, no two edges cross or lie on each
// other; rings may touch in points.
#pragma once

#include "remap/geometry/polygon.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace remap
{
/// Closed line through points [m]; the last joins the first.
using Ring = std::vector<Point>;

/// What is inside where rings lie in each other. Directions matter to
/// `nonzero` alone.
enum class FillRule
{
  evenodd, ///< where an odd number of rings runs around
  nonzero  ///< where they do not run around as often one way as the other
};

/// Rings that are filled together, like one path of a drawing.
struct Shape
{
  std::vector<Ring> rings;
  FillRule rule = FillRule::evenodd;
};

/// Something that keeps rings from bounding a domain.
struct Fault
{
  std::size_t ring = 0;   ///< counted through all shapes, and
  std::size_t vertex = 0; ///< the vertex where it shows
  std::string what;
  bool crossing = false; ///< rings cross or lie on each other: what they fill
                         ///< is known all the same, see cgal/clean.h
};

class Domain
{
public:
  /// Nothing at all.
  Domain() = default;

  /// What is in any of some shapes.
  /// @param[in] shapes rings in any direction and order; points that repeat the
  ///                   one before are left out
  /// @throws std::invalid_argument with every fault, one a line
  explicit Domain(std::span<const Shape> shapes);

  /// One shape.
  explicit Domain(std::vector<Ring> rings, FillRule rule = FillRule::evenodd);

  /// Every fault of some shapes, with the numbers of the rings and vertices as
  /// given; empty is good.
  [[nodiscard]] static std::vector<Fault> faults(std::span<const Shape> shapes);

  /// An upright rectangle between two corners.
  [[nodiscard]] static Domain rectangle(Point low, Point high);
  /// A polygon without holes, in either direction.
  [[nodiscard]] static Domain polygon(Ring ring);
  /// A disc: a regular polygon of the disc's area, nowhere farther than
  /// `tolerance` from its circle.
  [[nodiscard]] static Domain circle(Point centre, double radius,
                                     double tolerance);
  /// The part of a half-plane in a box.
  [[nodiscard]] static Domain half_plane(const HalfPlane& half, Point low,
                                         Point high);

  [[nodiscard]] std::span<const Ring> rings() const { return _rings; }
  /// Box around it; without rings, low is above high.
  [[nodiscard]] Point low() const { return _low; }
  [[nodiscard]] Point high() const { return _high; }

  /// Is a point inside? Exact, but on the outline either.
  [[nodiscard]] bool holds(Point p) const;

  /// Volume and first moments of all of it.
  template <Geometry G>
  [[nodiscard]] Moments moments() const;

private:
  std::vector<Ring> _rings;
  Point _low{1, 1}, _high{0, 0};
};

namespace rings
{
/// How often a ring runs around a point, counter-clockwise; on the ring either.
[[nodiscard]] int winding(std::span<const Point> ring, Point p);

/// Moments of closed lines, each area as often as they run around it, about
/// `origin`, which should be near. Sums that may be negative.
template <Geometry G>
class Sums
{
public:
  explicit Sums(Point origin) : _origin(origin) {}

  /// @param[in] ring measured from the origin
  void add(std::span<const Point> ring)
  {
    if (ring.empty())
      return;
    Point a = ring.back();
    for (const Point b : ring)
    {
      const double w = cross(a, b);
      _w += w;
      _x += w * (a.x + b.x);
      _y += w * (a.y + b.y);
      if constexpr (G == Geometry::axisymmetric)
      {
        _xx += w * (a.x * a.x + a.x * b.x + b.x * b.x);
        _xy += w * ((a.x + b.x) * (a.y + b.y) + a.x * a.y + b.x * b.y);
      }
      a = b;
    }
  }

  /// About the origin.
  [[nodiscard]] Moments local() const
  {
    const double area = _w / 2, x = _x / 6, y = _y / 6;
    if constexpr (G == Geometry::plane)
      return {area, x, y};
    else
    {
      const double r = _origin.x;
      return {r * area + x, r * x + _xx / 12, r * y + _xy / 24};
    }
  }

private:
  Point _origin;
  double _w = 0, _x = 0, _y = 0, _xx = 0, _xy = 0;
};
} // namespace rings
} // namespace remap
