// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: what nodes of kind `curve` are held to. The host may bring its
// own, a rigid profile for one; `boundary_curve.h` has that of a body's curved
// boundary.
#pragma once

#include "remap/geometry/measure.h"

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace remap
{
/// A curve, or one for each node.
///
/// Asked node by node, and on the rank that owns the node: neither
/// communication nor allocation. The same answer on any number of ranks.
class Guide
{
public:
  /// A place on the curve.
  struct Foot
  {
    Point at;    ///< [m]
    Point along; ///< tangent there, any length > 0
  };

  Guide() = default;
  Guide(const Guide&) = default;
  Guide& operator=(const Guide&) = default;
  virtual ~Guide() = default;

  /// Place of a node's curve that is nearest to p.
  [[nodiscard]] virtual Foot foot(std::int32_t node, Point p) const = 0;
};

/// Straight pieces between given points: the profile of a rigid body. The same
/// for all nodes.
class Polyline : public Guide
{
public:
  /// @param[in] points at least two, no two in a row at one place
  explicit Polyline(std::vector<Point> points) : _points(std::move(points)) {}

  [[nodiscard]] Foot foot(std::int32_t, Point p) const override
  {
    Foot out{};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < _points.size(); ++k)
    {
      const Point a = _points[k - 1];
      const Point d = _points[k] - a;
      const double part =
          std::min(std::max(dot(p - a, d) / dot(d, d), 0.0), 1.0);
      const Point at = a + part * d;
      if (const double gap = dot(p - at, p - at); gap < nearest)
        nearest = gap, out = {at, d};
    }
    return out;
  }

private:
  std::vector<Point> _points;
};
} // namespace remap
