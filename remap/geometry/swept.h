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

/// Where the outline p0 q0 q1 p1 crosses itself.
struct Crossing
{
  enum
  {
    none,
    facets, ///< the facet before and the facet after cross: it turns
    paths,  ///< the ways of its ends cross: it is turned over
  } kind = none;
  Point at;
};

inline Crossing crossing(const Motion& m)
{
  const Point d = m.q0 - m.p0; // facet before
  const Point e = m.q1 - m.p1; // and after
  const Point a = m.p1 - m.p0; // way of p
  const Point b = m.q1 - m.q0; // and of q
  // Four products tell on which side of each line each other end lies.
  const double da = cross(d, a), db = cross(d, b);
  const double ea = cross(e, a), eb = cross(e, b);
  if (da * db < 0 and ea * eb < 0)
    return {Crossing::facets, m.p0 + (ea / (ea - eb)) * d};
  if (da * ea < 0 and db * eb < 0)
    return {Crossing::paths, m.p0 + (db / (db - eb)) * a};
  return {};
}

/// Swept region, cut where its outline crosses itself, so that each part lies
/// on one side and has one donor. The parts add up to `swept` to the last bit
/// but one: the second is the whole less the first.
template <Geometry G>
inline SweptParts swept_parts(const Motion& m)
{
  SweptParts out;
  const Moments all = swept<G>(m);
  out.part[0] = all;
  const Crossing x = crossing(m);
  if (x.kind == Crossing::none)
    return out;
  const Moments first = x.kind == Crossing::facets
                            ? triangle<G>(m.p0, x.at, m.p1)
                            : triangle<G>(m.p0, m.q0, x.at);
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
  // Pairwise, so that no branch is taken.
  const auto hold = [](double v, double a, double b, double c, double d)
  {
    const double lo = std::min(std::min(a, b), std::min(c, d));
    const double hi = std::max(std::max(a, b), std::max(c, d));
    return std::min(std::max(v, lo), hi);
  };
  const Point c = part.centroid();
  return {hold(c.x, m.p0.x, m.q0.x, m.p1.x, m.q1.x),
          hold(c.y, m.p0.y, m.q0.y, m.p1.y, m.q1.y)};
}
} // namespace remap
