// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/geometry/polygon.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

template <Geometry G>
struct In
{
  static constexpr Geometry geometry = G;
};
using Plane = In<Geometry::plane>;
using Axisymmetric = In<Geometry::axisymmetric>;

Triangle moved(const Triangle& t, Point by)
{
  return {t[0] + by, t[1] + by, t[2] + by};
}

/// Regular polygon of circumradius 1.
template <int N>
Polygon<N> regular(Point centre, double turn)
{
  Polygon<N> p;
  for (int i = 0; i < N; ++i)
  {
    const double a = turn + 2 * std::numbers::pi * i / N;
    p.push(centre + Point{std::cos(a), std::sin(a)});
  }
  return p;
}
} // namespace

TEST_CASE("clip: a cone cut at half its radius", "[geometry]")
{
  // Per radian, z < H(1 − r/R), r < R/2: ∫rz' dr with z' the height,
  // V = HR²/12, ∫r²: HR³(1/24 − 1/64), ∫rz: H²R²(1/16 − 1/24 + 1/128).
  const double R = 2, H = 3;
  const Moments m = clipped<Geometry::axisymmetric>(
      {Point{0, 0}, {R, 0}, {0, H}}, HalfPlane::below({1, 0}, R / 2));
  CHECK(m.v == Approx(H * R * R / 12).epsilon(8 * eps));
  CHECK(m.x == Approx(H * R * R * R * (1. / 24 - 1. / 64)).epsilon(8 * eps));
  CHECK(m.y
        == Approx(H * H * R * R * (1. / 16 - 1. / 24 + 1. / 128))
               .epsilon(8 * eps));
}

TEST_CASE("overlap: two triangles make a hexagram", "[geometry]")
{
  // Regular, turned by half a turn: the hexagon has 2/3 of the area. Pappus
  // about an axis 3 away.
  const auto corner = [](double degrees) -> Point
  {
    const double a = degrees * std::numbers::pi / 180;
    return {3 + std::cos(a), 1 + std::sin(a)};
  };
  const Triangle up = {corner(90), corner(210), corner(330)};
  const Triangle down = {corner(270), corner(30), corner(150)};
  const double area = 2.0 / 3 * 3 * std::sqrt(3) / 4;
  const Moments m = overlap<Geometry::plane>(up, down);
  CHECK(m.v == Approx(area).epsilon(16 * eps));
  CHECK(m.x == Approx(3 * area).epsilon(16 * eps));
  CHECK(m.y == Approx(area).epsilon(16 * eps));
  const Moments ring = overlap<Geometry::axisymmetric>(up, down);
  CHECK(ring.v == Approx(3 * area).epsilon(16 * eps));
  CHECK(ring.y == Approx(3 * area).epsilon(16 * eps));
  // A regular hexagon of side s has ∫x² = 5√3/16 s⁴ about its middle.
  const double s = 1 / std::sqrt(3);
  CHECK(ring.x
        == Approx(9 * area + 5 * std::sqrt(3) / 16 * s * s * s * s)
               .epsilon(16 * eps));
}

TEMPLATE_TEST_CASE("split: both sides of a cut add up to the whole",
                   "[geometry]", Plane, Axisymmetric)
{
  constexpr Geometry G = TestType::geometry;
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> draw(0, 1);
  int both = 0;
  for (int k = 0; k < 1000; ++k)
  {
    const auto p = regular<12>({2 + draw(engine), draw(engine)}, draw(engine));
    const double a = 2 * std::numbers::pi * draw(engine);
    const HalfPlane h{{std::cos(a), std::sin(a)},
                      {1 + 3 * draw(engine), 3 * draw(engine) - 1}};
    Polygon<13> in, out, again;
    split(p, h, in, out);
    clip(p, h, again);
    REQUIRE(again.size == in.size);
    for (int i = 0; i < in.size; ++i)
      CHECK(again[i] == in[i]);
    const Moments m = moments<G>(in), n = moments<G>(out);
    CHECK(m.v >= 0);
    CHECK(n.v >= 0);
    both += m.v > 0 and n.v > 0;
    const Moments sum = m + n, all = moments<G>(p);
    // Some thirty products in all.
    CHECK(sum.v == Approx(all.v).epsilon(32 * eps));
    CHECK(sum.x == Approx(all.x).epsilon(32 * eps));
    CHECK(sum.y == Approx(all.y).margin(32 * eps * all.x));
  }
  CHECK(both > 300);
}

TEST_CASE("clip: a polygon of 16 vertices by each of its own edges is itself",
          "[geometry]")
{
  const auto p = regular<16>({1, 2}, 0.3);
  for (int i = 0; i < p.size; ++i)
  {
    Polygon<17> in, out;
    split(p, HalfPlane::left_of(p[i], p[(i + 1) % p.size]), in, out);
    CHECK(moments<Geometry::plane>(in).v
          == Approx(moments<Geometry::plane>(p).v).epsilon(16 * eps));
    CHECK(moments<Geometry::plane>(out).v <= eps);
  }
}

TEST_CASE("clip: vertices in line up to round-off, along the cut", "[geometry]")
{
  // A square with a zigzag of one rounding on its upper side, from each vertex
  // on: a line along that side leaves more than one run of vertices inside.
  const double up = 1 + eps, down = 1 - eps;
  const std::array<Point, 9> v = {Point{0, 0},  {1, 0},       {1, 1},
                                  {0.8, down},  {0.7, up},    {0.5, down},
                                  {0.375, 1.0}, {0.25, down}, {0, 1}};
  for (int first = 0; first < 9; ++first)
  {
    Polygon<9> p;
    for (int i = 0; i < 9; ++i)
      p.push(v[(first + i) % 9]);
    Polygon<10> in, out;
    split(p, HalfPlane::below({0, 1}, 1), in, out);
    CHECK(moments<Geometry::plane>(in).v == Approx(1).epsilon(4 * eps));
    CHECK(moments<Geometry::plane>(out).v <= 4 * eps);
    split(p, HalfPlane::below({0, -1}, -1), in, out);
    CHECK(moments<Geometry::plane>(out).v == Approx(1).epsilon(4 * eps));
    CHECK(moments<Geometry::plane>(in).v <= 4 * eps);
  }
}

TEST_CASE("overlap: degenerate pairs", "[geometry]")
{
  const Triangle t = {Point{0, 0}, {1, 0}, {0, 1}};
  const auto area = [](const Triangle& a, const Triangle& b)
  { return overlap<Geometry::plane>(a, b).v; };
  CHECK(area(t, t) == 0.5);
  // Clockwise, in any place of the pair.
  const Triangle back = {t[0], t[2], t[1]};
  CHECK(area(back, t) == 0.5);
  CHECK(area(t, back) == 0.5);
  CHECK(area(back, back) == 0.5);
  // Beside a shared edge, at a shared vertex, apart.
  CHECK(area(t, {Point{1, 0}, {1, 1}, {0, 1}}) == 0);
  CHECK(area(t, {Point{0, 0}, {-1, 0}, {0, -1}}) == 0);
  CHECK(area(t, moved(t, {2, 0})) == 0);
  // A shared edge, one inside the other.
  CHECK(area(t, {Point{0, 0}, {1, 0}, {0, 0.5}}) == 0.25);
  CHECK(area({Point{0, 0}, {1, 0}, {0, 0.5}}, t) == 0.25);
  // No area: a line, a point.
  CHECK(area(t, {Point{0, 0}, {1, 0}, {0.5, 0}}) == 0);
  CHECK(area({Point{0, 0}, {1, 0}, {0.5, 0}}, t) == 0);
  CHECK(area(t, {t[0], t[0], t[0]}) == 0);
  CHECK(area({t[1], t[1], t[1]}, t) == 0);
  // Moved by less than round-off of its size.
  CHECK(area(t, moved(t, {1e-17, -1e-17})) == Approx(0.5).epsilon(4 * eps));
}

TEST_CASE("overlap: far from the origin no digits are lost", "[geometry]")
{
  // Numbers that stay exact when 2^40 is added: the same triangles, so the same
  // area. The naive sum of cross products of the corners loses it all.
  const Triangle a = {Point{0, 0}, {1, 0.25}, {0.125, 1}};
  const Triangle b = {Point{0.5, -0.25}, {1, 1}, {-0.25, 0.5}};
  const Point far = {std::ldexp(1.0, 40), std::ldexp(1.0, 40)};
  const Triangle p = moved(a, far), q = moved(b, far);
  const double here = overlap<Geometry::plane>(a, b).v;
  CHECK(overlap<Geometry::plane>(p, q).v == Approx(here).epsilon(4 * eps));
  double naive = 0;
  for (int i = 0; i < 3; ++i)
    naive += cross(p[i], p[(i + 1) % 3]) / 2;
  CHECK(std::abs(naive - 0.5 * twice_area(a[0], a[1], a[2])) > 0.1);
}
