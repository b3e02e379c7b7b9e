// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3: how much of a gradient may be used. In: the change that the full
// gradient predicts at a point where the value will be taken, and the largest
// fall and rise to the neighbours. Out: a factor in [0, 1].
#pragma once

#include <concepts>

namespace remap
{
/// A limiter gives the factor for one point; the smallest over all points of a
/// volume holds. Bounds: lo <= factor · d <= hi for every d.
template <class L>
concept Limiter = requires(double d, double lo, double hi) {
  { L::factor(d, lo, hi) } -> std::same_as<double>;
};

namespace limiter
{
/// The largest factor that keeps the bounds.
/// @source Barth & Jespersen (1989). Departure: it is taken at the places where
/// values will be used (swept centroids and the centroid of what remains), not
/// at the vertices; that is what the bounds of the result need, and no more.
struct barth_jespersen
{
  /// @param[in] d  predicted change
  /// @param[in] lo largest fall to a neighbour, <= 0
  /// @param[in] hi largest rise to a neighbour, >= 0
  static double factor(double d, double lo, double hi)
  {
    if (d > hi)
      return hi / d;
    if (d < lo)
      return lo / d;
    return 1;
  }
};

/// No limit: exact for linear fields, oscillates at jumps.
struct none
{
  static double factor(double, double, double) { return 1; }
};
} // namespace limiter
} // namespace remap
