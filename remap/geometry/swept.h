// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.2: the region that a facet sweeps when its ends move on straight
// lines. Volumes on both sides change by exactly these regions:
// V⁺ = V⁻ − ΣF, F counted positive out of the volume.
#pragma once

#include "remap/geometry/measure.h"

#include <algorithm>
#include <cmath>

namespace remap
{
/// A facet p → q before and after; its left volume lies to the left of p → q.
struct Motion
{
  Point p0, q0; ///< before
  Point p1, q1; ///< after
};

/// Signed swept region of a facet; its volume is positive when the left volume
/// loses.
template <Geometry G>
constexpr Moments swept(const Motion& m)
{
  return quadrilateral<G>(m.p0, m.q0, m.q1, m.p1);
}

/// The parts of a swept region: one, or two of opposite signs if the region's
/// outline crosses itself (a facet that turns about an inner point).
struct SweptParts
{
  Moments part[2];
  int count = 1;
};

/// Do the segments (a, b) and (c, d) cross in their interior? If so, where.
inline bool crossing(Point a, Point b, Point c, Point d, Point& at)
{
  const double sa = twice_area(c, d, a);
  const double sb = twice_area(c, d, b);
  if (not(sa * sb < 0))
    return false;
  if (not(twice_area(a, b, c) * twice_area(a, b, d) < 0))
    return false;
  at = a + (sa / (sa - sb)) * (b - a);
  return true;
}

/// Swept region, cut where its outline crosses itself, so that each part lies
/// on one side and has one donor. The parts add up to `swept` exactly.
template <Geometry G>
SweptParts swept_parts(const Motion& m)
{
  SweptParts out;
  const Moments all = swept<G>(m);
  out.part[0] = all;
  Point at;
  Moments first;
  if (crossing(m.p0, m.q0, m.p1, m.q1, at))
    first = triangle<G>(m.p0, at, m.p1);
  else if (crossing(m.p0, m.p1, m.q0, m.q1, at))
    first = triangle<G>(m.p0, m.q0, at);
  else
    return out;
  const Moments second = all - first;
  if (not(first.v * second.v < 0))
    return out;
  out.part[0] = first;
  out.part[1] = second;
  out.count = 2;
  return out;
}

/// Centroid of a part, held in the box around the motion: for slivers of
/// round-off size the quotient of moment and volume means nothing.
inline Point centroid_in(const Moments& part, const Motion& m)
{
  const auto [x0, x1] = std::minmax({m.p0.x, m.q0.x, m.p1.x, m.q1.x});
  const auto [y0, y1] = std::minmax({m.p0.y, m.q0.y, m.p1.y, m.q1.y});
  const Point c = part.centroid();
  return {std::min(std::max(c.x, x0), x1), std::min(std::max(c.y, y0), y1)};
}
} // namespace remap
