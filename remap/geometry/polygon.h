// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.2 and 4.4: convex polygons on the stack, cut by half-planes, with
// volume and first moments; the exact overlap of two triangles. Nothing is
// allocated. Volumes are never negative and never NaN for finite input: a
// cut divides only by the difference of a positive and a non-positive distance.
//
// Corners that a cut makes are computed from the corner inside towards the one
// outside, so two polygons that share an edge share them to the last bit.
#pragma once

#include "remap/geometry/measure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace remap
{
/// Three vertices, in either order.
using Triangle = std::array<Point, 3>;

/// The points x with normal · (x − at) <= 0. The normal points out and need
/// not have length 1. Given by a point, so that distances keep their digits
/// far from the origin.
struct HalfPlane
{
  Point normal;
  Point at;

  /// All points to the left of the way from a to b.
  static constexpr HalfPlane left_of(Point a, Point b)
  {
    return {{b.y - a.y, a.x - b.x}, a};
  }
  /// All points with normal · x <= d.
  static constexpr HalfPlane below(Point normal, double d)
  {
    return {normal, (d / dot(normal, normal)) * normal};
  }
  /// The other side of the same line.
  [[nodiscard]] constexpr HalfPlane flipped() const
  {
    return {-1.0 * normal, at};
  }
  /// Length of the normal times the distance from the line, positive inside.
  [[nodiscard]] constexpr double depth(double x, double y) const
  {
    return normal.x * (at.x - x) + normal.y * (at.y - y);
  }
};

/// Convex polygon with room for so many vertices, counter-clockwise.
template <int Capacity>
struct Polygon
{
  static constexpr int capacity = Capacity;
  int size = 0;
  std::array<double, Capacity> x, y; ///< the first `size` count

  Polygon() = default;
  explicit Polygon(const Triangle& t)
    requires(Capacity >= 3)
      : size(3)
  {
    for (int i = 0; i < 3; ++i)
      x[i] = t[i].x, y[i] = t[i].y;
  }
  [[nodiscard]] Point operator[](int i) const { return {x[i], y[i]}; }
  void push(Point p)
  {
    assert(size < Capacity);
    x[size] = p.x;
    y[size] = p.y;
    ++size;
  }
};

namespace polygon
{
/// Round-off on vertices nearly in line may leave more than one run of vertices
/// inside, which a convex polygon cannot have: the run of the deepest is it.
inline unsigned deepest_run(unsigned inside, const double* depth, int n)
{
  const auto next = [n](int i) { return i == n - 1 ? 0 : i + 1; };
  const auto is_in = [inside](int i) { return (inside >> i & 1u) != 0; };
  const int deepest =
      static_cast<int>(std::max_element(depth, depth + n) - depth);
  unsigned out = 1u << deepest;
  for (int i = next(deepest); is_in(i) and i != deepest; i = next(i))
    out |= 1u << i;
  for (int i = deepest; is_in(i); i = i == 0 ? n - 1 : i - 1)
    if (out |= 1u << i; out == (1u << n) - 1)
      break;
  return out;
}

/// Vertices inside that follow on one outside: one bit for each run.
constexpr unsigned starts(unsigned inside, int n)
{
  return inside & ~((inside << 1 | inside >> (n - 1)) & ((1u << n) - 1));
}

/// Some vertices in, some out: the run of those inside.
struct Run
{
  int before, first, last, behind; ///< cyclic; outside, inside, inside, outside

  constexpr Run(unsigned inside, int n)
      : first(std::countr_zero(starts(inside, n)))
  {
    last = first + std::popcount(inside) - 1;
    last -= last < n ? 0 : n;
    before = first == 0 ? n - 1 : first - 1;
    behind = last == n - 1 ? 0 : last + 1;
  }
};

/// Bits of the vertices inside; one run of them.
/// @param[out] depth shape (n)
inline unsigned inside_bits(const HalfPlane& h, const double* x,
                            const double* y, int n, double* depth)
{
  unsigned inside = 0;
  for (int i = 0; i < n; ++i)
    depth[i] = h.depth(x[i], y[i]);
  for (int i = 0; i < n; ++i)
    inside |= static_cast<unsigned>(depth[i] > 0) << i;
  const unsigned runs = starts(inside, n);
  if ((runs & (runs - 1)) != 0) [[unlikely]]
    return deepest_run(inside, depth, n);
  return inside;
}

/// Where the line crosses the edge from vertex i, inside, to vertex j, outside.
/// With both inside, as it comes: some point, never NaN.
inline Point crossing(const double* x, const double* y, const double* depth,
                      int i, int j)
{
  const double t = depth[i] / (depth[i] + std::abs(depth[j]));
  return {x[i] + t * (x[j] - x[i]), y[i] + t * (y[j] - y[i])};
}

/// Which vertices make the cut of a polygon with N vertices, by the bits of
/// those inside. Looked up, since nobody can guess which it will be.
template <int N>
struct Cuts
{
  struct Entry
  {
    std::uint8_t before, first, last, behind;
    std::uint8_t take[N + 1]; ///< N, N + 1: the crossings into and out of h
  };
  Entry entries[1 << N] = {};

  constexpr Cuts()
  {
    constexpr unsigned all = (1u << N) - 1;
    for (unsigned inside = 1; inside <= all; ++inside)
    {
      Entry& e = entries[inside];
      if (inside == all)
      {
        for (int k = 0; k <= N; ++k)
          e.take[k] = static_cast<std::uint8_t>(std::min(k, N - 1));
        continue;
      }
      const Run run(inside, N);
      e.before = static_cast<std::uint8_t>(run.before);
      e.first = static_cast<std::uint8_t>(run.first);
      e.last = static_cast<std::uint8_t>(run.last);
      e.behind = static_cast<std::uint8_t>(run.behind);
      e.take[0] = N;
      for (int k = 1; k <= N; ++k)
        e.take[k] = static_cast<std::uint8_t>(
            k <= std::popcount(inside) ? (run.first + k - 1) % N : N + 1);
    }
  }
};
template <int N>
inline constexpr Cuts<N> cuts;

/// Cut of a polygon with N vertices to one with N + 1, of which the last may
/// repeat: with a fixed number no loop has an end to guess.
///
/// @param[in,out] x, y   N vertices, room for N + 2
/// @param[out]    px, py N + 1 vertices
/// @return false if nothing is left; then px, py are not written
template <int N>
inline bool cut(const HalfPlane& h, double* x, double* y, double* px,
                double* py)
{
  double depth[N];
  const unsigned inside = inside_bits(h, x, y, N, depth);
  if (inside == 0)
    return false;
  const auto& e = cuts<N>.entries[inside];
  const Point in = crossing(x, y, depth, e.first, e.before);
  const Point out = crossing(x, y, depth, e.last, e.behind);
  x[N] = in.x, y[N] = in.y;
  x[N + 1] = out.x, y[N + 1] = out.y;
  for (int k = 0; k <= N; ++k)
    px[k] = x[e.take[k]], py[k] = y[e.take[k]];
  return true;
}

/// Moments about the origin that the coordinates are measured from, at radius
/// `radius` in axisymmetry: ∫dV, ∫x dV, ∫y dV. A negative volume is round-off
/// and counts as none.
template <Geometry G>
inline Moments fan(const double* x, const double* y, int n, double radius)
{
  // Triangles from the first vertex. w: twice the area; w, x, y, and in
  // axisymmetry xx, xy, are sums over them about that vertex.
  double w = 0, mx = 0, my = 0;
  [[maybe_unused]] double xx = 0, xy = 0;
  for (int i = 1; i + 1 < n; ++i)
  {
    const double ax = x[i] - x[0], ay = y[i] - y[0];
    const double bx = x[i + 1] - x[0], by = y[i + 1] - y[0];
    const double wi = ax * by - ay * bx;
    w += wi;
    mx += wi * (ax + bx);
    my += wi * (ay + by);
    if constexpr (G == Geometry::axisymmetric)
    {
      xx += wi * (ax * ax + ax * bx + bx * bx);
      xy += wi * ((ax + bx) * (ay + by) + ax * ay + bx * by);
    }
  }
  if (not(w > 0))
    return {};
  // About the first vertex, then about the origin.
  const double area = w / 2;
  mx *= 1.0 / 6;
  my *= 1.0 / 6;
  if constexpr (G == Geometry::plane)
    return {area, mx + area * x[0], my + area * y[0]};
  else
  {
    const double r = radius + x[0];
    const double v = r * area + mx;
    const double vx = r * mx + xx / 12, vy = r * my + xy / 24;
    return v > 0 ? Moments{v, vx + v * x[0], vy + v * y[0]} : Moments{};
  }
}

/// Moments about another origin, `by` away from the old one.
constexpr Moments shifted(const Moments& m, Point by)
{
  return {m.v, m.x + m.v * by.x, m.y + m.v * by.y};
}

/// Vertices measured from `origin`.
inline void load(const Triangle& t, Point origin, double* x, double* y)
{
  for (int i = 0; i < 3; ++i)
    x[i] = t[i].x - origin.x, y[i] = t[i].y - origin.y;
}

/// Overlap of two counter-clockwise triangles, moments about q's first vertex.
///
/// @param[in] cuts half-planes of q, a bit each, that p does not lie in wholly.
/// All of them without knowing: to find out by a branch would cost more than
/// the cut.
template <Geometry G>
inline Moments overlap_from(const Triangle& p, const Triangle& q,
                            unsigned cuts = 7)
{
  constexpr std::uint8_t first[8] = {0, 0, 1, 0, 2, 0, 1, 0};
  constexpr std::uint8_t second[8] = {0, 0, 0, 1, 0, 2, 2, 1};
  const Point o = q[0], u = q[1] - o, v = q[2] - o;
  const HalfPlane planes[3] = {
      HalfPlane::left_of({}, u), HalfPlane::left_of(u, v), {{-v.y, v.x}, {}}};
  const int n = std::popcount(cuts);
  double x0[5], y0[5], x1[6], y1[6], x2[7], y2[7], x3[6], y3[6];
  load(p, o, x0, y0);
  if (n == 0)
    return fan<G>(x0, y0, 3, o.x);
  if (not cut<3>(planes[first[cuts]], x0, y0, x1, y1))
    return {};
  if (n == 1)
    return fan<G>(x1, y1, 4, o.x);
  if (not cut<4>(planes[second[cuts]], x1, y1, x2, y2))
    return {};
  if (n == 2)
    return fan<G>(x2, y2, 5, o.x);
  if (not cut<5>(planes[2], x2, y2, x3, y3))
    return {};
  return fan<G>(x3, y3, 6, o.x);
}

/// With its vertices counter-clockwise.
inline Triangle turned(const Triangle& t)
{
  return twice_area(t[0], t[1], t[2]) < 0 ? Triangle{t[0], t[2], t[1]} : t;
}
} // namespace polygon

/// Volume and first moments of a convex polygon.
template <Geometry G, int N>
[[nodiscard]] Moments moments(const Polygon<N>& p)
{
  return p.size < 3 ? Moments{}
                    : polygon::fan<G>(p.x.data(), p.y.data(), p.size, 0);
}

/// Both sides of a cut. They share the two new corners to the last bit.
///
/// @param[in]  p    convex, counter-clockwise
/// @param[in]  h    half-plane
/// @param[out] in   what lies in h; room for one vertex more than p has
/// @param[out] out  what does not; the same room
template <int N, int M>
void split(const Polygon<N>& p, const HalfPlane& h, Polygon<M>& in,
           Polygon<M>& out)
{
  assert(p.size < 32 and p.size < M);
  in.size = out.size = 0;
  const int n = p.size;
  if (n == 0)
    return;
  const double *x = p.x.data(), *y = p.y.data();
  std::array<double, N> depth;
  const unsigned inside = polygon::inside_bits(h, x, y, n, depth.data());
  if (inside == 0 or inside == (1u << n) - 1)
  {
    Polygon<M>& all = inside == 0 ? out : in;
    for (int i = 0; i < n; ++i)
      all.push(p[i]);
    return;
  }
  const auto next = [n](int i) { return i == n - 1 ? 0 : i + 1; };
  const polygon::Run run(inside, n);
  const Point a = polygon::crossing(x, y, depth.data(), run.first, run.before);
  const Point b = polygon::crossing(x, y, depth.data(), run.last, run.behind);
  in.push(a);
  for (int i = run.first; i != run.behind; i = next(i))
    in.push(p[i]);
  in.push(b);
  out.push(b);
  for (int i = run.behind; i != run.first; i = next(i))
    out.push(p[i]);
  out.push(a);
}

/// Part of a convex polygon in a half-plane.
///
/// @param[out] in room for one vertex more than p has; size 0: nothing is left
/// @source Sutherland & Hodgman (1974), one edge of their loop. Departure: a
/// convex polygon has one run of vertices inside, found from its bits.
template <int N, int M>
void clip(const Polygon<N>& p, const HalfPlane& h, Polygon<M>& in)
{
  assert(p.size < 32 and p.size < M);
  in.size = 0;
  const int n = p.size;
  if (n == 0)
    return;
  const double *x = p.x.data(), *y = p.y.data();
  std::array<double, N> depth;
  const unsigned inside = polygon::inside_bits(h, x, y, n, depth.data());
  if (inside == 0)
    return;
  if (inside == (1u << n) - 1)
  {
    for (int i = 0; i < n; ++i)
      in.push(p[i]);
    return;
  }
  const polygon::Run run(inside, n);
  in.push(polygon::crossing(x, y, depth.data(), run.first, run.before));
  for (int i = run.first; i != run.behind; i = i == n - 1 ? 0 : i + 1)
    in.push(p[i]);
  in.push(polygon::crossing(x, y, depth.data(), run.last, run.behind));
}

/// Volume and first moments of the part of a triangle in a half-plane.
template <Geometry G>
[[nodiscard]] Moments clipped(const Triangle& t, const HalfPlane& h)
{
  const Triangle a = polygon::turned(t);
  const Point o = a[0];
  double x[5], y[5], px[4], py[4];
  polygon::load(a, o, x, y);
  if (not polygon::cut<3>({h.normal, h.at - o}, x, y, px, py))
    return {};
  return polygon::shifted(polygon::fan<G>(px, py, 4, o.x), o);
}

/// Volume and first moments of the overlap of two triangles, in any order and
/// of any shape; none if one has no area or they only touch.
template <Geometry G>
[[nodiscard]] Moments overlap(const Triangle& a, const Triangle& b)
{
  const Triangle s = polygon::turned(a), t = polygon::turned(b);
  return polygon::shifted(polygon::overlap_from<G>(s, t), t[0]);
}
} // namespace remap
