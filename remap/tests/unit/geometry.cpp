// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/geometry/swept.h"
#include "remap/geometry/volumes.h"
#include "remap/tests/meshes.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

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

/// Random points in a square beside the axis.
struct Points
{
  std::mt19937 engine;
  std::uniform_real_distribution<double> u{0.0, 1.0};
  explicit Points(unsigned seed) : engine(seed) {}
  Point operator()() { return {u(engine), u(engine)}; }
};
} // namespace

TEST_CASE("measure: a cone has its volume and moments", "[geometry]")
{
  // Per radian: ∫r dA = R²H/6, ∫r² dA = R³H/12, ∫rz dA = R²H²/24.
  const double R = 2, H = 3;
  const Moments m = triangle<Geometry::axisymmetric>({0, 0}, {R, 0}, {0, H});
  CHECK(m.v == Approx(R * R * H / 6).epsilon(4 * eps));
  CHECK(m.x == Approx(R * R * R * H / 12).epsilon(4 * eps));
  CHECK(m.y == Approx(R * R * H * H / 24).epsilon(4 * eps));
}

TEST_CASE("measure: a ring with square section follows Pappus", "[geometry]")
{
  // Radii 1 to 2, height 1: volume per radian (4 − 1)/2.
  const Moments m =
      quadrilateral<Geometry::axisymmetric>({1, 0}, {2, 0}, {2, 1}, {1, 1});
  CHECK(m.v == Approx(1.5).epsilon(4 * eps));
  // ∫r² dr over 1..2 = 7/3.
  CHECK(m.x == Approx(7.0 / 3).epsilon(4 * eps));
  CHECK(m.y == Approx(0.75).epsilon(4 * eps));
}

TEMPLATE_TEST_CASE("measure: three corners add up to their triangle",
                   "[geometry]", Plane, Axisymmetric)
{
  constexpr Geometry G = TestType::geometry;
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  Points draw(seed);
  for (int k = 0; k < 1000; ++k)
  {
    const Point a = draw(), b = draw(), c = draw();
    const Moments sum =
        corner<G>(a, b, c) + corner<G>(b, c, a) + corner<G>(c, a, b);
    const Moments all = triangle<G>(a, b, c);
    // Coordinates and areas are at most 1: an absolute tolerance of 16
    // roundings.
    CHECK(sum.v == Approx(all.v).margin(16 * eps));
    CHECK(sum.x == Approx(all.x).margin(16 * eps));
    CHECK(sum.y == Approx(all.y).margin(16 * eps));
    if (G == Geometry::plane)
      CHECK(corner<G>(a, b, c).v == Approx(all.v / 3).margin(16 * eps));
  }
}

TEMPLATE_TEST_CASE("swept: a triangle changes by what its facets sweep",
                   "[geometry]", Plane, Axisymmetric)
{
  constexpr Geometry G = TestType::geometry;
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  Points draw(seed);
  for (int k = 0; k < 1000; ++k)
  {
    const Point v[3] = {draw(), draw(), draw()};
    const Point w[3] = {draw(), draw(), draw()};
    Moments m = triangle<G>(v[0], v[1], v[2]);
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      m += -swept<G>({v[i], v[j], w[i], w[j]});
    }
    const Moments now = triangle<G>(w[0], w[1], w[2]);
    CHECK(m.v == Approx(now.v).margin(32 * eps));
    CHECK(m.x == Approx(now.x).margin(32 * eps));
    CHECK(m.y == Approx(now.y).margin(32 * eps));
  }
}

TEMPLATE_TEST_CASE("swept: parts of a region that crosses itself add up to it",
                   "[geometry]", Plane, Axisymmetric)
{
  constexpr Geometry G = TestType::geometry;
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  Points draw(seed);
  int cut = 0;
  for (int k = 0; k < 1000; ++k)
  {
    const Motion m{draw(), draw(), draw(), draw()};
    const SweptParts parts = swept_parts<G>(m);
    const Moments all = swept<G>(m);
    Moments sum;
    for (int i = 0; i < 2; ++i)
      sum +=
          {parts.v[i], parts.v[i] * parts.at[i].x, parts.v[i] * parts.at[i].y};
    if (parts.v[1] != 0)
    {
      ++cut;
      CHECK(parts.v[0] * parts.v[1] < 0);
    }
    CHECK(sum.v == Approx(all.v).margin(4 * eps));
    CHECK(sum.x == Approx(all.x).margin(4 * eps));
    CHECK(sum.y == Approx(all.y).margin(4 * eps));
  }
  // Four random points: both kinds of crossing are common.
  CHECK(cut > 100);
}

TEST_CASE(
    "swept: a facet that turns about its middle gives two equal triangles",
    "[geometry]")
{
  // From (−1,0)–(1,0) to (−1,−1)–(1,1): each side a triangle of area 1/2 with
  // its centroid at ±(2/3, 1/3).
  const Motion m{{-1, 0}, {1, 0}, {-1, -1}, {1, 1}};
  const SweptParts parts = swept_parts<Geometry::plane>(m);
  CHECK(std::abs(parts.v[0]) == Approx(0.5).epsilon(4 * eps));
  CHECK(parts.v[0] == Approx(-parts.v[1]).epsilon(4 * eps));
  for (const Point& c : parts.at)
  {
    CHECK(std::abs(c.x) == Approx(2.0 / 3).epsilon(8 * eps));
    CHECK(c.y == Approx(c.x / 2).epsilon(8 * eps));
  }
}

TEST_CASE("swept: a facet that moves to its left takes from its left volume",
          "[geometry]")
{
  // Way upwards, left is −x.
  const Motion m{{0, 0}, {0, 2}, {-0.5, 0}, {-0.5, 2}};
  CHECK(swept<Geometry::plane>(m).v == 1.0);
}

TEMPLATE_TEST_CASE("volumes: dual volumes fill what cells fill", "[geometry]",
                   Plane, Axisymmetric)
{
  constexpr Geometry G = TestType::geometry;
  const meshes::Data data =
      meshes::rectangle(7, 5, meshes::Diagonal::crossed, 0, 0, 2, 3);
  const Mesh mesh = data.mesh();
  const auto x = meshes::shaken(data.x, 0.1, 4, 0, 0, 2, 3);
  std::vector<double> cells(mesh.num_cells()), nodes(mesh.num_nodes()),
      corners(3 * mesh.num_cells());
  cell_volumes(mesh, G, x, cells);
  dual_volumes(mesh, G, x, nodes);
  corner_volumes(mesh, G, x, corners);
  const auto sum = [](const std::vector<double>& v)
  {
    double s = 0;
    for (double one : v)
      s += one;
    return s;
  };
  // A cylinder of radius 2 and height 3 per radian, or the rectangle.
  const double wanted = G == Geometry::plane ? 6.0 : 6.0;
  CHECK(sum(cells) == Approx(wanted).epsilon(1e-14));
  CHECK(sum(nodes) == Approx(wanted).epsilon(1e-14));
  CHECK(sum(corners) == Approx(wanted).epsilon(1e-14));
}
