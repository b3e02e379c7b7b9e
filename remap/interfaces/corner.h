// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: moment of fluid in a triangle of the plane, with two parts: of all
// lines that leave each part its area, the one that brings the centroids
// nearest to where they shall be.
//
// A line cuts a corner off, A, A + s b, A + t c with the edges b, c and s t the
// corner's fraction; its centroid A + (s b + t c)/3 runs along a hyperbola as s
// does. The squared distance from a place is stationary at the roots of a
// quartic in s. Three corners, and either part may be the corner: six branches,
// on each of which the minima are found for certain.
#pragma once

#include "remap/geometry/polygon.h"

#include <algorithm>
#include <cmath>

namespace remap
{
/// Where the parts of a cell shall be.
struct Target
{
  double fraction = 0; ///< of the cell's volume
  Point centroid;
};

/// A straight interface, and how far the centroids are off.
struct Straight
{
  HalfPlane plane;  ///< holds the first part; the normal has length 1
  double error = 0; ///< Σ over both parts of fraction · distance²
};

namespace tip
{
/// Distance² of the corner's centroid from a place, times 9, along a branch.
struct Branch
{
  double bb, cc;   ///< squared lengths of the edges
  double bp, cp;   ///< edges times three times the place, seen from the corner
  double fraction; ///< s t

  /// Slope in log s, by s and t = fraction/s.
  [[nodiscard]] double slope(double s, double t) const
  {
    return s * (bb * s - bp) - t * (cc * t - cp);
  }
  [[nodiscard]] double slope_of_slope(double s, double t) const
  {
    return s * (2 * bb * s - bp) + t * (2 * cc * t - cp);
  }

  /// Has the quartic three positive roots? Otherwise it has one. By the signs
  /// of its coefficients and its discriminant, which says that the place lies
  /// beyond the hyperbola's evolute.
  /// @param[in] slack relative; > 0: also if it nearly has
  [[nodiscard]] bool folds(double slack = 0) const
  {
    const double k = fraction * bb * cc, d = bp * cp - (4 - slack) * k;
    if (not(bp > 0 and cp > 0 and d > 0))
      return false;
    const double b2 = bb * cp * cp, c2 = cc * bp * bp;
    const double e = std::max(0.0, std::abs(b2 - c2) - slack * (b2 + c2));
    return 4 * d * d * d > 27 * fraction * e * e;
  }

  /// The root between lo, where the slope is negative, and hi, where it is
  /// positive; exactly one.
  [[nodiscard]] double root(double s, double lo, double hi) const
  {
    for (int i = 0; i < 100; ++i)
    {
      const double t = fraction / s;
      const double f = slope(s, t), df = slope_of_slope(s, t);
      (f > 0 ? hi : lo) = s;
      double next = s - s * f / df;
      if (not(next >= lo and next <= hi))
        next = std::sqrt(lo * hi);
      const double step = std::abs(next - s);
      s = next;
      if (step <= 1e-15 * s)
        break;
    }
    return s;
  }

  /// Largest of three positive roots, from above it: Newton steps on the
  /// quartic fall monotonically there, since all its roots are real.
  [[nodiscard]] double largest(double tolerance = 1e-15) const
  {
    double s = bp / bb;
    for (int i = 0; i < 100; ++i)
    {
      const double q = ((bb * s - bp) * s * s + fraction * cp) * s
                       - fraction * fraction * cc;
      const double dq = (4 * bb * s - 3 * bp) * s * s + fraction * cp;
      const double next = s - q / dq;
      if (not(next < s))
        break;
      const bool done = s - next <= tolerance * s;
      s = next;
      if (done)
        break;
    }
    return s;
  }
  /// The same seen from the other edge.
  [[nodiscard]] Branch mirrored() const { return {cc, bb, cp, bp, fraction}; }
};

/// Nearest yet.
struct Best
{
  double distance2 = 0; ///< of both parts, weighted
  double s = 0, t = 0;
  int at = -1;
  bool first = false; ///< the first part is the corner
};

/// Minima of one branch.
inline void look(const Triangle& v, int at, bool first, double fraction,
                 double weight, Point target, Best& best)
{
  const Point a = v[at], b = v[at == 2 ? 0 : at + 1] - a,
              c = v[at == 0 ? 2 : at - 1] - a, p = 3.0 * (target - a);
  const Branch branch = {dot(b, b), dot(c, c), dot(b, p), dot(c, p), fraction};
  const auto take = [&](double s, double t)
  {
    const Point off = s * b + t * c - p;
    const double distance2 = weight * dot(off, off);
    if (best.at < 0 or distance2 < best.distance2)
      best = {distance2, s, t, at, first};
  };
  // Slopes at the ends, with room for round-off: a minimum between two branches
  // may not fall in the gap.
  const double size = branch.bb + branch.cc;
  const double low =
      fraction * (fraction * branch.bb - branch.bp) + (branch.cp - branch.cc);
  const double high =
      (branch.bb - branch.bp) + fraction * (branch.cp - fraction * branch.cc);
  const bool falls = low <= 1e-14 * size, rises = high >= -1e-14 * size;
  if (falls and rises and not branch.folds())
  {
    // Seen from the tip the best lies nearly where the target does.
    const double ps = cross(p, c), pt = cross(b, p);
    const double start =
        ps > 0 and pt > 0 ? std::sqrt(fraction * ps / pt) : std::sqrt(fraction);
    const double s =
        branch.root(std::clamp(start, fraction, 1.0), fraction, 1.0);
    return take(s, std::min(1.0, fraction / s));
  }
  if (not branch.folds())
    return;
  // Minima are the outer two of three.
  if (const double s = branch.largest(); s >= fraction and s <= 1)
    take(s, std::min(1.0, fraction / s));
  if (const double t = branch.mirrored().largest(); t >= fraction and t <= 1)
    take(std::min(1.0, fraction / t), t);
}
} // namespace tip

/// Moment of fluid in a triangle of the plane: the line with the least
/// Σ fraction · distance² of both parts; the global minimum.
///
/// @param[in] t   counter-clockwise
/// @param[in] in  of what shall lie in the half-plane
/// @param[in] out of the rest; fractions in (0, 1) add up to 1
inline Straight best_cut(const Triangle& t, const Target& in, const Target& out)
{
  // Centroids that do not add up to the cell's are moved by the same way, which
  // is what the weighted sum of squares asks for. Then both parts are off
  // along one line, and distances · fractions agree.
  const Point centre = 1.0 / 3 * (t[0] + t[1] + t[2]);
  const Point miss = in.fraction * (in.centroid - centre)
                     + out.fraction * (out.centroid - centre);
  const Point g_in = in.centroid - miss, g_out = out.centroid - miss;
  tip::Best best;
  const double w_in = in.fraction / out.fraction,
               w_out = out.fraction / in.fraction;
  for (int i = 0; i < 3; ++i)
  {
    tip::look(t, i, true, in.fraction, w_in, g_in, best);
    tip::look(t, i, false, out.fraction, w_out, g_out, best);
  }
  if (best.at < 0) [[unlikely]]
  {
    // Only targets without a direction end here.
    best = {0, std::sqrt(in.fraction), std::sqrt(in.fraction), 0, true};
  }
  const int i = best.at;
  const Point b = t[i == 2 ? 0 : i + 1] - t[i],
              c = t[i == 0 ? 2 : i - 1] - t[i];
  const Point way = best.t * c - best.s * b; // the corner lies to its left
  const double length = std::sqrt(dot(way, way));
  const double turn = best.first ? 1 / length : -1 / length;
  return {
      {{turn * way.y, -turn * way.x}, t[i] + 0.5 * (best.s * b + best.t * c)},
      best.distance2 / 9 + dot(miss, miss)};
}
} // namespace remap
