// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: what a region that leaves a mixed cell holds of each of the cell's
// parts. In: the region, swept by a facet or the overlap of an old with a new
// cell, and the cell's partition. Out: volume and first moments by part.
#pragma once

#include "remap/geometry/polygon.h"
#include "remap/geometry/swept.h"
#include "remap/interfaces/partition.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace remap
{
/// A region by the parts of its donor.
using ByPart = std::array<Moments, most_parts>;

namespace detail
{
/// Where the lines through a, b and through c, d cross, if both segments do.
inline bool crosses(Point a, Point b, Point c, Point d, Point& at)
{
  const double ac = cross(b - a, c - a), ad = cross(b - a, d - a);
  const double ca = cross(d - c, a - c), cb = cross(d - c, b - c);
  if (not(ac * ad < 0 and ca * cb < 0))
    return false;
  at = a + ca / (ca - cb) * (b - a);
  return true;
}
} // namespace detail

/// The region swept by a facet as triangles: use(triangle), counter-clockwise,
/// and only those on one side: `sign` > 0 for what the left volume loses.
template <class Use>
void swept_triangles(const Motion& m, double sign, Use&& use)
{
  const auto give = [&](Point a, Point b, Point c)
  {
    const double area = sign * twice_area(a, b, c);
    if (area > 0)
      use(sign > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  Point s;
  if (detail::crosses(m.p0, m.q0, m.q1, m.p1, s)) // the facet turns
  {
    give(m.p0, s, m.p1);
    give(s, m.q0, m.q1);
  }
  else if (detail::crosses(m.p0, m.p1, m.q0, m.q1, s)) // it is turned over
  {
    give(m.p0, m.q0, s);
    give(s, m.q1, m.p1);
  }
  else if (twice_area(m.p0, m.q0, m.q1) * twice_area(m.p0, m.q1, m.p1) < 0)
  {
    give(m.q0, m.q1, m.p1);
    give(m.q0, m.p1, m.p0);
  }
  else
  {
    give(m.p0, m.q0, m.q1);
    give(m.p0, m.q1, m.p1);
  }
}

/// What a facet sweeps to one side, by the parts of the cell it comes from.
template <Geometry G>
ByPart cut_swept(const Motion& m, double sign, const Partition& by)
{
  ByPart out{};
  swept_triangles(m, sign, [&](const Triangle& t)
                  { add_moments<G>(Polygon<3>(t), by, out); });
  return out;
}

/// Nearest place in a triangle, about.
inline Point held_inside(const Triangle& t, Point p)
{
  const double all = twice_area(t[0], t[1], t[2]);
  double w[3] = {twice_area(p, t[1], t[2]) / all,
                 twice_area(t[0], p, t[2]) / all,
                 twice_area(t[0], t[1], p) / all};
  if (w[0] >= 0 and w[1] >= 0 and w[2] >= 0)
    return p;
  double sum = 0;
  for (double& v : w)
  {
    v = std::isfinite(v) ? std::max(v, 0.0) : 1.0;
    sum += v;
  }
  return (w[0] / sum) * t[0] + (w[1] / sum) * t[1] + (w[2] / sum) * t[2];
}

/// Overlap of two triangles, counter-clockwise, by the parts of the first.
template <Geometry G>
ByPart cut_overlap(const Triangle& from, const Triangle& to,
                   const Partition& by)
{
  ByPart out{};
  Polygon<7> a(from), b;
  for (int k = 0; k < 3; ++k)
  {
    clip(a, HalfPlane::left_of(to[k], to[(k + 1) % 3]), b);
    a = b;
  }
  if (a.size > 2)
    add_moments<G>(a, by, out);
  return out;
}
} // namespace remap
