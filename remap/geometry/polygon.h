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

#include <array>
#include <bit>
#include <cassert>

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
/// Vertices inside a half-plane: `count` of them from `first` on, cyclic.
struct Run
{
  int first, count;
};

/// Round-off on vertices nearly in line may leave more than one run of vertices
/// inside, which a convex polygon cannot have: the run of the deepest is it.
inline Run deepest_run(unsigned inside, const double* depth, int n)
{
  const int deepest =
      static_cast<int>(std::max_element(depth, depth + n) - depth);
  Run run{deepest, 1};
  const auto is_in = [&](int i) { return (inside >> ((i + n) % n) & 1u) != 0; };
  while (run.count < n and is_in(run.first - 1))
    run.first = (run.first + n - 1) % n, ++run.count;
  while (run.count < n and is_in(run.first + run.count))
    ++run.count;
  return run;
}

/// @param[in] inside one bit a vertex, some set and some not
/// @param[in] depth  of every vertex, shape (n)
inline Run inside_run(unsigned inside, const double* depth, int n)
{
  const unsigned all = (1u << n) - 1;
  const unsigned starts = inside & ~((inside << 1 | inside >> (n - 1)) & all);
  if ((starts & (starts - 1)) != 0) [[unlikely]]
    return deepest_run(inside, depth, n);
  return {std::countr_zero(starts), std::popcount(inside)};
}

/// Where the line crosses the edge from vertex i, inside, to vertex j, outside.
inline Point crossing(const double* x, const double* y, const double* depth,
                      int i, int j)
{
  const double t = depth[i] / (depth[i] - depth[j]);
  return {x[i] + t * (x[j] - x[i]), y[i] + t * (y[j] - y[i])};
}

/// Cut of a polygon with N vertices to one with N + 1, of which the last may
/// repeat: with a fixed number no loop has an end to guess.
///
/// @param[in]  x, y   shape (N)
/// @param[out] px, py shape (N + 1)
/// @return false if nothing is left; then px, py are not written
template <int N>
inline bool cut(const HalfPlane& h, const double* x, const double* y,
                double* px, double* py)
{
  double depth[N];
  unsigned inside = 0;
  for (int i = 0; i < N; ++i)
    depth[i] = h.depth(x[i], y[i]);
  for (int i = 0; i < N; ++i)
    inside |= static_cast<unsigned>(depth[i] > 0) << i;
  if (inside == 0)
    return false;
  if (inside == (1u << N) - 1)
  {
    for (int i = 0; i <= N; ++i)
      px[i] = x[std::min(i, N - 1)], py[i] = y[std::min(i, N - 1)];
    return true;
  }
  const auto [first, count] = inside_run(inside, depth, N);
  const int before = first == 0 ? N - 1 : first - 1;
  const int last = first + count - 1 - (first + count > N ? N : 0);
  const int after = last == N - 1 ? 0 : last + 1;
  const Point in = crossing(x, y, depth, first, before);
  const Point out = crossing(x, y, depth, last, after);
  px[0] = in.x;
  py[0] = in.y;
  for (int k = 1; k <= N; ++k)
  {
    const int i = first + k - 1 - (first + k > N ? N : 0);
    px[k] = k <= count ? x[i] : out.x;
    py[k] = k <= count ? y[i] : out.y;
  }
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
  mx /= 6;
  my /= 6;
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

/// Overlap of two counter-clockwise triangles, moments about b's first vertex.
template <Geometry G>
inline Moments overlap_from(const Triangle& a, const Triangle& b)
{
  const Point o = b[0], u = b[1] - o, v = b[2] - o;
  double x0[3], y0[3], x1[4], y1[4], x2[5], y2[5], x3[6], y3[6];
  load(a, o, x0, y0);
  if (not cut<3>(HalfPlane::left_of({}, u), x0, y0, x1, y1)
      or not cut<4>({{-v.y, v.x}, {}}, x1, y1, x2, y2)
      or not cut<5>(HalfPlane::left_of(u, v), x2, y2, x3, y3))
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
  // From its own first vertex, so that far from the origin digits are kept.
  if (p.size < 3)
    return {};
  std::array<double, N> x, y;
  for (int i = 0; i < p.size; ++i)
    x[i] = p.x[i] - p.x[0], y[i] = p.y[i] - p.y[0];
  return polygon::shifted(polygon::fan<G>(x.data(), y.data(), p.size, p.x[0]),
                          p[0]);
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
  std::array<double, N> depth;
  unsigned inside = 0;
  for (int i = 0; i < n; ++i)
  {
    depth[i] = h.depth(p.x[i], p.y[i]);
    inside |= static_cast<unsigned>(depth[i] > 0) << i;
  }
  if (inside == 0 or inside == (1u << n) - 1)
  {
    Polygon<M>& all = inside == 0 ? out : in;
    for (int i = 0; i < n; ++i)
      all.push(p[i]);
    return;
  }
  const auto [first, count] = polygon::inside_run(inside, depth.data(), n);
  const int before = (first + n - 1) % n;
  const int last = (first + count - 1) % n;
  const int after = (last + 1) % n;
  const double *x = p.x.data(), *y = p.y.data(), *d = depth.data();
  const Point a = polygon::crossing(x, y, d, first, before);
  const Point b = polygon::crossing(x, y, d, last, after);
  in.push(a);
  for (int k = 0; k < count; ++k)
    in.push(p[(first + k) % n]);
  in.push(b);
  out.push(b);
  for (int k = 0; k < n - count; ++k)
    out.push(p[(after + k) % n]);
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
  std::array<double, N> depth;
  unsigned inside = 0;
  for (int i = 0; i < n; ++i)
  {
    depth[i] = h.depth(p.x[i], p.y[i]);
    inside |= static_cast<unsigned>(depth[i] > 0) << i;
  }
  if (inside == 0)
    return;
  if (inside == (1u << n) - 1)
  {
    for (int i = 0; i < n; ++i)
      in.push(p[i]);
    return;
  }
  const auto [first, count] = polygon::inside_run(inside, depth.data(), n);
  const int before = first == 0 ? n - 1 : first - 1;
  const int last = first + count - 1 - (first + count > n ? n : 0);
  const int after = last == n - 1 ? 0 : last + 1;
  const double *x = p.x.data(), *y = p.y.data(), *d = depth.data();
  in.push(polygon::crossing(x, y, d, first, before));
  for (int i = first;; i = i == n - 1 ? 0 : i + 1)
  {
    in.push(p[i]);
    if (i == last)
      break;
  }
  in.push(polygon::crossing(x, y, d, last, after));
}

/// Volume and first moments of the part of a triangle in a half-plane.
template <Geometry G>
[[nodiscard]] Moments clipped(const Triangle& t, const HalfPlane& h)
{
  const Triangle a = polygon::turned(t);
  const Point o = a[0];
  double x[3], y[3], px[4], py[4];
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
