// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: moment of fluid in a convex polygon, plane or axisymmetric, with
// two parts.
//
// A line that keeps the volume to its left turns once around the polygon. It
// turns about the weighted middle of its chord, so the centroid to its left
// moves along it, by I₂/V per radian, I₂ the chord's weighted second moment:
// the squared distance from a place is stationary where the way there from the
// centroid is normal to the line. Between the lines through vertices the ends
// stay on two edges, and everything is in closed form.
#pragma once

#include "remap/interfaces/corner.h"
#include "remap/interfaces/placement.h"
#include "remap/interfaces/sort.h"

#include <cstddef>
#include <memory>

namespace remap
{
namespace turning
{
/// Signed volume and first moments of a triangle; x is measured from a radius.
template <Geometry G>
inline Moments piece(Point a, Point b, Point c, double radius)
{
  const double area = 0.5 * twice_area(a, b, c);
  const Point s = a + b + c;
  const Moments plane = {area, area / 3 * s.x, area / 3 * s.y};
  if constexpr (G == Geometry::plane)
    return plane;
  const double xx = a.x * a.x + b.x * b.x + c.x * c.x;
  const double xy = a.x * a.y + b.x * b.y + c.x * c.y;
  return {radius * plane.v + plane.x,
          radius * plane.x + area / 12 * (s.x * s.x + xx),
          radius * plane.y + area / 12 * (s.x * s.y + xy)};
}

/// How far from b towards c the triangle (a, b, ·) has a volume, in [0, 1]; the
/// volume is negative if the triangle is clockwise.
template <Geometry G>
inline double share(Point a, Point b, Point c, double radius, double volume)
{
  const double twice = twice_area(a, b, c);
  double t = 2 * volume / twice;
  if constexpr (G == Geometry::axisymmetric)
  {
    // 6 V = twice t (3 radius + a + 2 b + t (c − b)), in x.
    const double p = 3 * radius + a.x + 2 * b.x, q = c.x - b.x;
    const double v = 6 * volume / twice;
    t = 2 * v / (p + std::sqrt(std::max(0.0, p * p + 4 * q * v)));
  }
  return t < 1 ? (t > 0 ? t : 0) : 1; // NaN, of 0/0: all of it
}

/// A chord between two edges, what is cut off, and how the distance changes.
struct Stand
{
  double s = 0;     ///< 1 where the chord starts at its edge's first vertex
  Chord chord;      ///< from the first edge to the second
  Point off;        ///< centroid less its target
  double slope = 0; ///< off along the chord
  double slope_of_slope = 0; ///< by the angle
  double step = 0;           ///< change of s per radian
};

/// All chords from one edge to another: what is cut off is the polygon from
/// the first chord's end over `first` … `last` to the second end.
template <Geometry G>
struct Pair
{
  Point before, first, last, behind;
  Moments core; ///< of the polygon first … last
  double radius, volume;
  Point target;

  [[nodiscard]] Stand at(double s) const
  {
    Stand out;
    out.s = s;
    const Point a = first + s * (before - first);
    const Moments one = piece<G>(a, first, last, radius);
    const double t = share<G>(a, last, behind, radius, volume - core.v - one.v);
    const Point b = last + t * (behind - last);
    const Moments m = core + one + piece<G>(a, last, b, radius);
    out.chord = {a, b};
    // By its own volume: round-off is the same in both.
    out.off = (m.v > 0 ? m.centroid() : a) - target;
    const Point way = b - a;
    const double length = std::sqrt(dot(way, way));
    const Point along = (1 / length) * way, up = {-along.y, along.x};
    out.slope = dot(out.off, along);
    double middle = 0.5 * length, second = length * length * length / 12;
    if constexpr (G == Geometry::axisymmetric)
    {
      const double r0 = radius + a.x, r1 = radius + b.x, r = r0 + r1;
      const double part = (r0 + 2 * r1) / (3 * r);
      middle = part * length;
      second =
          length * length * length * ((r0 + 3 * r1) / 12 - part * part * r / 2);
    }
    out.slope_of_slope = second / volume + dot(out.off, up);
    out.step = middle / dot(first - before, up);
    return out;
  }

  /// Half-way between two chords: where the edges' lines meet at some distance
  /// the ends' distances from there go like reciprocals.
  [[nodiscard]] double between(double s, double r) const
  {
    const Point u = before - first, v = behind - last;
    const double apex = cross(last - first, v) / cross(u, v);
    const double product = (s - apex) * (r - apex);
    const double mean = apex + std::copysign(std::sqrt(product), s - apex);
    return mean > std::min(s, r) and mean < std::max(s, r) ? mean
                                                           : 0.5 * (s + r);
  }

  /// The minimum between chords where the distance falls and rises.
  [[nodiscard]] Stand minimum(Stand from, Stand to) const
  {
    Stand x = std::abs(from.slope) < std::abs(to.slope) ? from : to;
    for (int i = 0; i < 100; ++i)
    {
      double s = x.s - x.step * x.slope / x.slope_of_slope;
      // The chord's start runs from s = 1 to 0.
      if (not(x.slope_of_slope > 0 and s < from.s and s > to.s))
        s = between(from.s, to.s);
      const double moved = std::abs(s - x.s);
      if (not(s < from.s and s > to.s) or moved <= 1e-15 * std::abs(s))
        break;
      x = at(s);
      (x.slope > 0 ? to : from) = x;
      if (x.slope == 0)
        break;
    }
    return x;
  }
};

/// Where the line that starts at vertex i cuts off the volume: edge, and how
/// far along it.
template <Geometry G, int N>
int reach(const Polygon<N>& p, int i, double volume, double radius)
{
  const int n = p.size;
  double left = volume;
  int j = i + 1 < n ? i + 1 : 0;
  for (int k = 2; k < n; ++k)
  {
    const int next = j + 1 < n ? j + 1 : 0;
    const double here = piece<G>(p[i], p[j], p[next], radius).v;
    if (left <= here or k == n - 1)
      return j;
    left -= here;
    j = next;
  }
  return j;
}

/// Nearest of all lines.
struct Best
{
  double distance2 = -1;
  Chord chord;

  void take(const Stand& s)
  {
    const double d = dot(s.off, s.off);
    if (distance2 < 0 or d < distance2)
      distance2 = d, chord = s.chord;
  }
};

/// Mean radius of a chord, as if all were there: what the plane's formulas
/// take.
template <Geometry G>
double weight(const Pair<G>& pair, const Chord& c)
{
  return G == Geometry::plane ? 1 : pair.radius + 0.5 * (c.a.x + c.b.x);
}

/// The distance along a pair's chords as a branch of the quartic of corner.h,
/// and where on the first edge the lines of both edges meet. In axisymmetry as
/// if all were at the radius of the chord.
struct Corner
{
  tip::Branch branch;
  double apex, unit; ///< s = apex + unit · distance from there

  /// What is cut off is a corner with a constant part less, or the other way
  /// round: that shifts the target.
  /// @return false if the edges are too near to parallel
  template <Geometry G>
  bool load(const Pair<G>& pair, const Stand& at)
  {
    const Point u = pair.before - pair.first, v = pair.behind - pair.last;
    apex = cross(pair.last - pair.first, v) / cross(u, v);
    if (not(std::abs(apex) < 1e5))
      return false;
    const Point o = pair.first + apex * u;
    const Point a = at.chord.a - o, b = at.chord.b - o;
    const double s = std::sqrt(dot(a, a)), t = std::sqrt(dot(b, b));
    // > 0: the apex is cut off
    const double volume = 0.5 * cross(b, a) * weight(pair, at.chord);
    const Point p = a + b - (3 * pair.volume / volume) * at.off;
    branch = {1, 1, dot(a, p) / s, dot(b, p) / t, s * t};
    unit = std::copysign(1 / std::sqrt(dot(u, u)), at.s - apex);
    return s > 0 and t > 0 and (at.s - apex) * (at.s - apex) > 0;
  }
};

/// Chords between which the slope rises all the way, or falls: for parallel
/// edges, where it is a cubic in s.
/// @return how many
template <Geometry G>
int bends(const Pair<G>& pair, const Stand& at, double* s)
{
  const Point u = pair.before - pair.first, w = at.chord.b - at.chord.a;
  const double q = -cross(w, u) * weight(pair, at.chord) / (6 * pair.volume);
  const double uu = dot(u, u), wu = dot(w, u);
  const double d =
      wu * wu - 2.0 / 3 * uu * (dot(w, w) - 2 * dot(u, at.off) / q);
  if (not(d > 0))
    return 0;
  s[0] = at.s + 0.5 * (wu + std::sqrt(d)) / uu;
  s[1] = at.s + 0.5 * (wu - std::sqrt(d)) / uu;
  return 2;
}

/// Minima between chords of a pair of edges, by the slope's signs at both and
/// at some places between.
template <Geometry G>
void look_between(const Pair<G>& pair, Stand from, const Stand& to,
                  const double* s, int num, Best& best)
{
  for (int i = 0; i <= num; ++i)
  {
    if (i < num and not(s[i] < from.s and s[i] > to.s))
      continue;
    const Stand next = i < num ? pair.at(s[i]) : to;
    best.take(next);
    if (from.slope <= 0 and next.slope >= 0)
      best.take(pair.minimum(from, next));
    from = next;
  }
}

/// Where to look between two chords, so that signs of the slope tell all: if
/// the distance folds, seen from a chord on the way, where it should be
/// stationary.
template <Geometry G>
int folds(const Pair<G>& pair, const Stand& at, double* s)
{
  constexpr double slack = G == Geometry::plane ? 1e-8 : 0.02;
  constexpr double tolerance = G == Geometry::plane ? 1e-12 : 1e-9;
  Corner corner;
  if (not corner.load(pair, at))
    return bends(pair, at, s);
  if (not corner.branch.folds(slack))
    return 0;
  const double far = corner.branch.largest(tolerance),
               near = corner.branch.fraction
                      / corner.branch.mirrored().largest(tolerance);
  for (int i = 0; const double r : {far, std::sqrt(near * far), near})
    s[i++] = corner.apex + corner.unit * r;
  return 3 + bends(pair, at, s + 3);
}

/// No centroid between two chords is nearer. Its way is a curve that turns
/// left, along each chord where it is: it lies to the left of both, and to the
/// right of the straight way.
inline double bound(const Stand& from, const Stand& to)
{
  const auto beyond = [](const Stand& x)
  {
    const Point way = x.chord.b - x.chord.a;
    return cross(way, x.off) / std::sqrt(dot(way, way));
  };
  const Point way = to.off - from.off;
  const double straight = cross(from.off, way) / std::sqrt(dot(way, way));
  // NaN of a chord without length is no bound.
  return std::max(std::max(std::max(0.0, beyond(from)), beyond(to)), straight);
}

/// Minima between two chords of a pair of edges.
template <Geometry G>
void look(const Pair<G>& pair, const Stand& from, const Stand& to, Best& best,
          int depth = 0)
{
  best.take(to);
  if (const double b = bound(from, to);
      not(from.s > to.s) or b * b > best.distance2)
    return;
  if constexpr (G == Geometry::axisymmetric)
  {
    // Turns of at most a twelfth of the circle, where the weight does not
    // change too much.
    const Point a = from.chord.b - from.chord.a, b = to.chord.b - to.chord.a;
    const double with = dot(a, b);
    if (depth < 4
        and not(with > 0 and with * with >= 0.75 * dot(a, a) * dot(b, b)))
      if (const double x = pair.between(from.s, to.s); x < from.s and x > to.s)
      {
        const Stand mid = pair.at(x);
        look(pair, from, mid, best, depth + 1);
        return look(pair, mid, to, best, depth + 1);
      }
  }
  double s[8];
  int num = 0;
  const double x = pair.between(from.s, to.s);
  if (not(x < from.s and x > to.s))
    return;
  s[num++] = x;
  num += folds(pair, pair.at(x), s + num);
  sort_few(s, num, [](double a, double b) { return a > b; });
  look_between(pair, from, to, s, num, best);
}

/// Chords between two lines through vertices.
template <Geometry G>
struct Interval
{
  Pair<G> pair;
  Stand from, to;
  double bound = 0;
};

/// All chords from edge i that cut off the volume: an interval for each edge
/// that they end on.
///
/// @param[in] j, end first and last of these edges
/// @param[out] out   room for as many as there are vertices
/// @return how many
template <Geometry G, int N>
int intervals(const Polygon<N>& p, int i, int j, int end, double volume,
              Point target, double radius, Interval<G>* out)
{
  const int n = p.size, first = i + 1 < n ? i + 1 : 0;
  double s = 1;
  for (int k = 0; k < n; ++k)
  {
    const int behind = j + 1 < n ? j + 1 : 0;
    Interval<G>& x = *std::construct_at(out + k);
    x.pair = {p[i], p[first], p[j], p[behind], {}, radius, volume, target};
    for (int c = first; c != j;)
    {
      const int next = c + 1 < n ? c + 1 : 0;
      if (c != first)
        x.pair.core += piece<G>(p[first], p[c], p[next], radius);
      c = next;
    }
    double to = 0;
    if (j != end)
    {
      // Where the far end is at `behind`.
      Moments more = x.pair.core;
      if (j != first)
        more += piece<G>(p[first], p[j], p[behind], radius);
      to = share<G>(p[behind], p[first], p[i], radius, more.v - volume);
    }
    x.from = x.pair.at(s);
    s = std::min(to, s);
    x.to = x.pair.at(s);
    x.bound = bound(x.from, x.to);
    if (j == end)
      return k + 1;
    j = behind;
  }
  return n;
}

/// The nearest centroid to the left of a chord.
/// @param[in] p      measured from a point at `radius`
/// @param[in] volume at most about half of all
template <Geometry G, int N>
Best nearest(const Polygon<N>& p, double volume, Point target, double radius)
{
  const int n = p.size;
  // Room that is not cleared first: most of it stays unused.
  alignas(Interval<G>) std::byte room[2 * N * sizeof(Interval<G>)];
  Interval<G>* const all = reinterpret_cast<Interval<G>*>(room);
  int num = 0;
  const int start = reach<G>(p, 0, volume, radius);
  for (int i = 0, j = start; i < n; ++i)
  {
    const int first = i + 1 < n ? i + 1 : 0;
    const int end = first == 0 ? start : reach<G>(p, first, volume, radius);
    num += intervals<G>(p, i, j, end, volume, target, radius, all + num);
    j = end;
  }
  // The most promising first: it often leaves nothing to the others.
  Best best;
  std::array<int, 2 * N> order;
  for (int i = 0; i < num; ++i)
  {
    order[i] = i;
    best.take(all[i].from);
  }
  sort_few(order.data(), num,
           [&](int a, int b) { return all[a].bound < all[b].bound; });
  for (int i = 0; i < num; ++i)
    look(all[order[i]].pair, all[order[i]].from, all[order[i]].to, best);
  return best;
}
} // namespace turning

/// Moment of fluid in a convex polygon: as `best_cut` of a triangle. Fractions
/// are of `whole`, and so is the error: Σ fraction · distance².
///
/// @param[in] p      counter-clockwise, measured from a point at `radius`
/// @param[in] whole  volume and first moments of p
/// @param[in] in,out fractions > 0 of p add up to 1; centroids
template <Geometry G, int N>
Straight best_cut(const Polygon<N>& p, const Moments& whole, const Target& in,
                  const Target& out, double radius)
{
  const Point centre = whole.centroid();
  const Point miss = in.fraction * (in.centroid - centre)
                     + out.fraction * (out.centroid - centre);
  // The smaller part keeps its digits.
  const bool first = in.fraction <= out.fraction;
  const Target& small = first ? in : out;
  const Target& large = first ? out : in;
  const turning::Best best = turning::nearest<G>(p, small.fraction * whole.v,
                                                 small.centroid - miss, radius);
  // Chords run from the start over the part on their right.
  HalfPlane plane = Chord{best.chord.b, best.chord.a}.left();
  if (not first)
    plane = plane.flipped();
  return {plane,
          small.fraction / large.fraction * best.distance2 + dot(miss, miss)};
}
} // namespace remap
