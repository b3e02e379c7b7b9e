// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: the cells around one node, as a smoother sees them.
#pragma once

#include "remap/quality/quality.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace remap
{
/// A cell of a patch seen from the node: (node, a, b) counter-clockwise.
struct PatchCell
{
  Point a, b;
  quality::Target target; ///< its shape, seen from the node
};

/// Cells around a node, one after the other counter-clockwise: each cell's `b`
/// is the next one's `a`, but where the boundary is between. If `along` is set,
/// the node may only move on that line; its length is 1.
struct Patch
{
  Point x;
  std::span<const PatchCell> cells;
  std::optional<Point> along;
};

/// A smoother proposes a place for a patch's node. Constraints, acceptance and
/// safety are not its business. The place must move with a rigid motion of the
/// patch, and be the node's own place if nothing is to be gained.
template <class S>
concept Smoother = requires(const Patch& patch) {
  { S::name } -> std::convertible_to<std::string_view>;
  { S::propose(patch) } -> std::same_as<Point>;
};

/// Σ |T|²/(2 det T) around a node put at x; infinite if a cell inverts.
inline double distortion(std::span<const PatchCell> cells, Point x)
{
  double f = 0;
  for (const PatchCell& c : cells)
  {
    const Point p = c.a - x;
    const Point q = c.b - x;
    if (not(cross(p, q) > 0))
      return std::numeric_limits<double>::infinity();
    f += quality::distortion(c.target, p, q);
  }
  return f;
}

/// How the worst cell of a patch is judged.
enum class Measure
{
  radius_ratio, ///< for equilateral targets
  shape,        ///< against each cell's target
};

/// Worst quality around a node put at x; not positive if a cell inverts.
inline double worst(std::span<const PatchCell> cells, Point x, Measure measure)
{
  double q = std::numeric_limits<double>::infinity();
  // A cell's second edge at the node is the next one's first.
  Point last = x;
  double length = 0;
  for (const PatchCell& c : cells)
  {
    double one = 0;
    if (measure == Measure::shape)
      one = quality::shape(c.target, x, c.a, c.b);
    else
    {
      const double first =
          c.a == last ? length : std::sqrt(dot(c.a - x, c.a - x));
      last = c.b;
      length = std::sqrt(dot(c.b - x, c.b - x));
      one = quality::radius_ratio(twice_area(x, c.a, c.b), first, length,
                                  std::sqrt(dot(c.b - c.a, c.b - c.a)));
    }
    // NaN must not pass: fmin would drop it.
    if (not(one > 0))
      return one;
    q = std::min(q, one);
  }
  return q;
}

/// f(place) for every neighbour of a patch's node.
template <class F>
void each_neighbour(std::span<const PatchCell> cells, F&& f)
{
  Point last = cells.back().b;
  for (const PatchCell& c : cells)
  {
    f(c.a);
    if (not(last == c.a)) // the end of the fan before
      f(last);
    last = c.b;
  }
}

/// Foot of p on the patch's line, p itself if it has none.
inline Point on_line(const Patch& patch, Point p)
{
  if (not patch.along)
    return p;
  return patch.x + dot(p - patch.x, *patch.along) * *patch.along;
}
} // namespace remap
