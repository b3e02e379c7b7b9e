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
/// outline crosses itself (a facet that turns about an inner point). A part
/// that is not there has no volume.
struct SweptParts
{
  Moments part[2];
};

/// Where the outline p0 q0 q1 p1 crosses itself.
struct Crossing
{
  bool facets; ///< the facet before and the facet after cross: it turns
  bool paths;  ///< the ways of its ends cross: it is turned over
  Point at;    ///< only if one of them does
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
  // & and choices instead of branches: the motion cannot be foreseen.
  const bool facets = (da * db < 0) & (ea * eb < 0);
  const bool paths = (da * ea < 0) & (db * eb < 0);
  const double above = facets ? ea : db;
  const double below = facets ? ea - eb : db - da;
  const double s = above / (facets | paths ? below : 1.0);
  return {
      facets,
      paths,
      {m.p0.x + s * (facets ? d.x : a.x), m.p0.y + s * (facets ? d.y : a.y)}};
}

/// Swept region, cut where its outline crosses itself, so that each part lies
/// on one side and has one donor. The parts add up to `swept` to the last bit
/// but one: the second is the whole less the first.
template <Geometry G>
inline SweptParts swept_parts(const Motion& m)
{
  const Moments all = swept<G>(m);
  const Crossing x = crossing(m);
  const Point u = {x.facets ? x.at.x : m.q0.x, x.facets ? x.at.y : m.q0.y};
  const Point w = {x.facets ? m.p1.x : x.at.x, x.facets ? m.p1.y : x.at.y};
  const Moments first = triangle<G>(m.p0, u, w);
  const bool two = (x.facets | x.paths) & (first.v * (all.v - first.v) < 0);
  const Moments kept = {two ? first.v : all.v, two ? first.x : all.x,
                        two ? first.y : all.y};
  return {{kept, all - kept}};
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
