// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/domain/paint.h"
#include "remap/domain/partial_volumes.h"
#include "remap/geometry/position.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Triangle place(const meshes::Data& mesh, std::size_t c)
{
  return {point(mesh.x, mesh.cells[3 * c]),
          point(mesh.x, mesh.cells[3 * c + 1]),
          point(mesh.x, mesh.cells[3 * c + 2])};
}

template <Geometry G>
Moments cell_moments(const meshes::Data& mesh, std::size_t c)
{
  const Triangle t = polygon::turned(place(mesh, c));
  return triangle<G>(t[0], t[1], t[2]);
}

/// Cells shaken by up to a quarter of a square.
meshes::Data shaken(int n, unsigned seed, double x0 = 0)
{
  meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed, x0);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-0.25 / n, 0.25 / n);
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i)
      for (int k = 0; k < 2; ++k)
        data.x[static_cast<std::size_t>(2 * (j * (n + 1) + i) + k)] +=
            move(random);
  return data;
}

/// Volume and first moments of each material in all cells.
template <Geometry G>
std::vector<Moments> totals(const Materials& m, const meshes::Data& mesh)
{
  std::vector<Moments> out(static_cast<std::size_t>(m.num_materials()));
  const auto add = [&](int k, double v, Point g)
  { out[static_cast<std::size_t>(k)] += {v, v * g.x, v * g.y}; };
  for (std::int32_t c = 0; c < m.num_cells(); ++c)
  {
    const Moments all = cell_moments<G>(mesh, static_cast<std::size_t>(c));
    if (m.pure(c) >= 0)
      add(m.pure(c), all.v, all.centroid());
    else
      for (const Part& p : m.parts(m.row(c)))
        add(p.material, p.fraction * all.v, p.centroid);
  }
  return out;
}

template <Geometry G = Geometry::plane>
Painting painted(const std::vector<Coat>& coats, const meshes::Data& mesh,
                 int num_materials)
{
  return paint<G>(coats, mesh.cells, mesh.x, num_materials);
}

double sum(const std::vector<BarePlace>& bare)
{
  double out = 0;
  for (const BarePlace& b : bare)
    out += b.volume;
  return out;
}

Coat everywhere(int material)
{
  return {.domain = {}, .material = material, .everywhere = true};
}
} // namespace

TEST_CASE("paint: a later coat covers what lies under it", "[paint]")
{
  const meshes::Data mesh = shaken(7, 3);
  const Coat low{Domain::rectangle({0.11, 0.13}, {0.61, 0.73}), 1};
  const Coat high{Domain::rectangle({0.31, 0.33}, {0.91, 0.83}), 2};
  const double a = 0.5 * 0.6, b = 0.6 * 0.5, both = 0.3 * 0.4;
  const auto volumes = [&](const std::vector<Coat>& coats)
  {
    const Painting p = painted(coats, mesh, 3);
    CHECK(p.bare.empty());
    CHECK(p.crowded.empty());
    return totals<Geometry::plane>(p.materials, mesh);
  };
  const auto first = volumes({everywhere(0), low, high});
  CHECK(first[1].v == Approx(a - both).epsilon(64 * eps));
  CHECK(first[2].v == Approx(b).epsilon(64 * eps));
  CHECK(first[0].v == Approx(1 - a - b + both).epsilon(64 * eps));
  const auto other = volumes({everywhere(0), high, low});
  CHECK(other[1].v == Approx(a).epsilon(64 * eps));
  CHECK(other[2].v == Approx(b - both).epsilon(64 * eps));
  // The overlap's moments: its centre is (0.46, 0.53).
  CHECK(other[1].x - first[1].x == Approx(both * 0.46).epsilon(256 * eps));
  CHECK(other[1].y - first[1].y == Approx(both * 0.53).epsilon(256 * eps));
}

TEST_CASE("paint: parts of a cell add up to it, and to the domain", "[paint]")
{
  const unsigned seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  const meshes::Data mesh = shaken(9, seed, 0.5);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Coat> coats = {everywhere(0)};
  for (int k = 1; k < 6; ++k)
    coats.push_back(
        {Domain::circle({0.7 + 0.6 * any(random), 0.2 + 0.6 * any(random)},
                        0.05 + 0.1 * any(random), 1e-3),
         k});
  const auto check = [&]<Geometry G>()
  {
    const Painting p = painted<G>(coats, mesh, 6);
    const Materials& m = p.materials;
    CHECK(p.bare.empty());
    CHECK(m.mixed().size() > 20);
    double gap = 0, shift = 0, least = 1;
    for (const std::int32_t c : m.mixed())
    {
      double sum = 0;
      Point g;
      for (const Part& part : m.parts(m.row(c)))
      {
        sum += part.fraction;
        g = g + part.fraction * part.centroid;
        least = std::min(least, part.fraction);
      }
      const Moments all = cell_moments<G>(mesh, static_cast<std::size_t>(c));
      const Point off = g - all.centroid();
      gap = std::max(gap, std::abs(sum - 1));
      shift = std::max({shift, std::abs(off.x), std::abs(off.y)});
    }
    CHECK(gap < 4 * eps);
    CHECK(shift < 16 * eps);
    CHECK(least > 0);
    // The last one is seen whole.
    const Moments sum = totals<G>(m, mesh)[5];
    const Moments exact = coats[5].domain.template moments<G>();
    CHECK(sum.v == Approx(exact.v).epsilon(1e-14));
    CHECK(sum.x == Approx(exact.x).epsilon(1e-14));
    CHECK(sum.y == Approx(exact.y).epsilon(1e-14));
  };
  check.operator()<Geometry::plane>();
  check.operator()<Geometry::axisymmetric>();
}

TEST_CASE("paint: a disc in a disc, and a torus in a torus", "[paint]")
{
  const meshes::Data mesh = shaken(12, 5);
  const double R = 0.55, r = 0.1, outer = 0.3;
  const std::vector<Coat> coats = {everywhere(0),
                                   {Domain::circle({R, 0.5}, outer, 1e-6), 1},
                                   {Domain::circle({R, 0.5}, r, 1e-6), 2}};
  const auto flat =
      totals<Geometry::plane>(painted(coats, mesh, 3).materials, mesh);
  CHECK(flat[2].v == Approx(pi * r * r).epsilon(1e-13));
  CHECK(flat[1].v == Approx(pi * (outer * outer - r * r)).epsilon(1e-13));
  CHECK(flat[1].x / flat[1].v == Approx(R).epsilon(1e-13));
  // Pappus, per radian.
  const auto turned = totals<Geometry::axisymmetric>(
      painted<Geometry::axisymmetric>(coats, mesh, 3).materials, mesh);
  CHECK(turned[2].v == Approx(pi * R * r * r).epsilon(1e-13));
  CHECK(turned[1].v == Approx(pi * R * (outer * outer - r * r)).epsilon(1e-13));
  CHECK(turned[0].v == Approx(0.5 - pi * R * outer * outer).epsilon(1e-13));
}

TEST_CASE("paint: coats with an edge in common leave nothing between them",
          "[paint]")
{
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  const meshes::Data mesh = shaken(8, seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  // Left and right of a slanted line; the right one has one more vertex on it,
  // rounded, and the line goes on in thirds of the left one's edge.
  const Point a{0.3 + 0.3 * any(random), 0}, b{0.3 + 0.3 * any(random), 1};
  const auto on = [&](double s) { return a + s * (b - a); };
  const std::vector<Coat> coats = {
      everywhere(0),
      {Domain::polygon({{0, 0}, a, on(1. / 3), on(2. / 3), b, {0, 1}}), 1},
      {Domain::polygon({{1, 0}, {1, 1}, b, on(0.7), on(0.1), a}), 2}};
  const Painting p = painted(coats, mesh, 3);
  const auto sums = totals<Geometry::plane>(p.materials, mesh);
  CHECK(sums[0].v == 0);
  CHECK(sums[1].v == Approx((a.x + b.x) / 2).epsilon(64 * eps));
  CHECK(sums[2].v == Approx(1 - (a.x + b.x) / 2).epsilon(64 * eps));
  // Without the coat below there is no place bare either.
  const Painting two = painted({coats[1], coats[2]}, mesh, 3);
  CHECK(two.bare.empty());
  // What the domains leave of the cells one by one is not nothing.
  const auto left =
      partial_volumes<Geometry::plane>(coats[1].domain, mesh.cells, mesh.x);
  const auto right =
      partial_volumes<Geometry::plane>(coats[2].domain, mesh.cells, mesh.x);
  int slivers = 0;
  for (std::size_t c = 0; c < left.parts.size(); ++c)
    slivers += cell_moments<Geometry::plane>(mesh, c).v - left.parts[c].v
                   - right.parts[c].v
               != 0;
  CHECK(slivers > 0);
}

TEST_CASE("paint: edges on the mesh's lines and through nodes make pure cells",
          "[paint]")
{
  // Tenths and thirds as they are typed, and as the mesh has them; at the
  // origin and away from it.
  const double x0 = GENERATE(0.0, 0.7, 100.3);
  const auto diagonal =
      GENERATE(meshes::Diagonal::crossed, meshes::Diagonal::four,
               meshes::Diagonal::right);
  INFO("from " << x0);
  const meshes::Data mesh = meshes::rectangle(10, 30, diagonal, x0, 0.1);
  SECTION("lines")
  {
    const Painting p =
        painted({everywhere(0),
                 {Domain::rectangle({x0, 0.1}, {x0 + 0.3, 0.1 + 1. / 3}), 1},
                 {Domain::rectangle({x0 + 0.3, 0.1}, {x0 + 0.7, 0.3}), 2},
                 {Domain::rectangle({x0 - 1, 0.9}, {x0 + 2, 3}), 1}},
                mesh, 3);
    CHECK(p.materials.mixed().empty());
    const auto sums = totals<Geometry::plane>(p.materials, mesh);
    CHECK(sums[1].v == Approx(0.1 + 0.2).epsilon(1e-13));
    CHECK(sums[2].v == Approx(0.4 * 0.2).epsilon(1e-13));
  }
  SECTION("diagonals of the squares")
  {
    // A falling line from node to node; only cells cut the rising way are
    // halved by it, both of each square.
    const double h = 1. / 30, w = 1. / 10;
    const Painting p = painted(
        {everywhere(0),
         {Domain::polygon({{x0, 0.1}, {x0 + 10 * w, 0.1}, {x0, 0.1 + 10 * h}}),
          1}},
        mesh, 2);
    for (const std::int32_t c : p.materials.mixed())
      for (const Part& part : p.materials.parts(p.materials.row(c)))
        CHECK(std::abs(part.fraction - 0.5) < 1e-12);
    CHECK(p.materials.mixed().size()
          == (diagonal == meshes::Diagonal::right ? 20 : 0));
  }
}

TEST_CASE("paint: a line through a node cuts no cell that it only touches",
          "[paint]")
{
  // One node with cells all around it; lines through it at any angle pass
  // through two of the cells.
  std::vector<double> x = {1, 1};
  std::vector<std::int32_t> cells;
  for (int k = 0; k < 7; ++k)
  {
    const double a = 2 * pi * k / 7;
    x.insert(x.end(), {1 + 0.1 * std::cos(a), 1 + 0.1 * std::sin(a)});
    cells.insert(cells.end(), {0, k + 1, (k + 1) % 7 + 1});
  }
  for (int i = 0; i < 50; ++i)
  {
    const double a = 0.123 + 0.01 * i;
    const Point n{std::cos(a), std::sin(a)};
    const std::vector<Coat> coats = {
        everywhere(0), {Domain::half_plane({n, {1, 1}}, {-5, -4}, {5, 3}), 1}};
    const Painting p = paint<Geometry::plane>(coats, cells, x, 2);
    CHECK(p.materials.mixed().size() == 2);
  }
}

TEST_CASE("paint: what no coat covers is told", "[paint]")
{
  const meshes::Data mesh = shaken(6, 4);
  SECTION("a hole between coats")
  {
    const std::vector<Coat> coats = {
        {Domain(std::vector<Ring>{{{-1, -1}, {2, -1}, {2, 2}, {-1, 2}},
                                  {{0.42, 0.45}, {0.48, 0.45}, {0.48, 0.47}}}),
         0}};
    const Painting p = painted(coats, mesh, 1);
    CHECK(sum(p.bare) == Approx(0.06 * 0.02 / 2).epsilon(1e-12));
    REQUIRE(not p.bare.empty());
    const BarePlace first = p.bare.front();
    CHECK(not coats[0].domain.holds(first.at));
    const Triangle t =
        polygon::turned(place(mesh, static_cast<std::size_t>(first.cell)));
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(twice_area(t[k], t[(k + 1) % 3], first.at) > 0);
    // The cells are full all the same.
    CHECK(totals<Geometry::plane>(p.materials, mesh)[0].v
          == Approx(1).epsilon(16 * eps));
  }
  SECTION("half of the body")
  {
    const Painting p =
        painted({{Domain::rectangle({-1, -1}, {0.55, 2}), 1}}, mesh, 2);
    CHECK(sum(p.bare) == Approx(0.45).epsilon(1e-13));
    for (const BarePlace& b : p.bare)
      CHECK(b.at.x > 0.55);
    CHECK(std::ranges::is_sorted(p.bare, {}, &BarePlace::cell));
    const auto sums = totals<Geometry::plane>(p.materials, mesh);
    CHECK(sums[0].v + sums[1].v == Approx(1).epsilon(16 * eps));
  }
  SECTION("no coats at all")
  {
    const Painting p = painted({}, mesh, 2);
    CHECK(sum(p.bare) == Approx(1).epsilon(64 * eps));
    CHECK(p.bare.size() == 72);
  }
}

TEST_CASE("paint: more materials than a cell can hold are told", "[paint]")
{
  const std::vector<double> x = {0, 0, 1, 0, 0, 1};
  const std::vector<std::int32_t> cell = {0, 1, 2};
  const auto stripes = [&](int n)
  {
    std::vector<Coat> coats = {everywhere(0)};
    for (int k = 1; k < n; ++k)
      coats.push_back({Domain::rectangle({-1, k / 10.0}, {2, 2}), k});
    return paint<Geometry::plane>(coats, cell, x, n);
  };
  const Painting fits = stripes(most_parts);
  CHECK(fits.crowded.empty());
  REQUIRE(fits.materials.mixed().size() == 1);
  const auto parts = fits.materials.parts(0);
  REQUIRE(parts.size() == most_parts);
  for (std::size_t k = 0; k + 1 < parts.size(); ++k)
  {
    // Between the heights k/10 and (k + 1)/10, of the cell's area of 1/2.
    const double from = 1 - static_cast<double>(k) / 10;
    CHECK(
        parts[k].fraction
        == Approx(from * from - (from - 0.1) * (from - 0.1)).epsilon(64 * eps));
  }
  CHECK(stripes(most_parts + 1).crowded == std::vector{0});
  // The same material twice is one part.
  const std::vector<Coat> twice = {
      everywhere(0),
      {Domain::rectangle({0, 0}, {0.1, 0.1}), 1},
      {Domain::rectangle({0.3, 0.3}, {0.4, 0.4}), 1}};
  const Painting one = paint<Geometry::plane>(twice, cell, x, 2);
  REQUIRE(one.materials.parts(0).size() == 2);
  CHECK(one.materials.parts(0)[1].fraction == Approx(0.04).epsilon(16 * eps));
  CHECK(one.materials.parts(0)[1].centroid.x == Approx(0.2).epsilon(16 * eps));
}

TEST_CASE("paint: thin coats stay, down to round-off", "[paint]")
{
  const meshes::Data mesh = shaken(10, 5);
  for (const double width : {1e-3, 1e-8, 1e-12})
  {
    const Painting p = painted(
        {everywhere(0),
         {Domain::polygon(
              {{0.1, 0.2}, {0.9, 0.7}, {0.9, 0.7 + width}, {0.1, 0.2 + width}}),
          1}},
        mesh, 2);
    const double found = totals<Geometry::plane>(p.materials, mesh)[1].v;
    CHECK(std::abs(found - 0.8 * width) < 40 * eps);
  }
  // Of the width of a rounding error nothing is left.
  const Painting none = painted(
      {everywhere(0),
       {Domain::polygon(
            {{0.1, 0.2}, {0.9, 0.7}, {0.9, 0.7 + 2 * eps}, {0.1, 0.2 + eps}}),
        1}},
      mesh, 2);
  CHECK(none.materials.mixed().empty());
}

TEST_CASE("paint: volume fractions alone cannot be painted over", "[paint]")
{
  // What is left of the earlier coat is not what the later one leaves room
  // for: two strips across each other in one cell.
  const std::vector<double> x = {0, 0, 1, 0, 0, 1};
  const std::vector<std::int32_t> cell = {0, 1, 2};
  const std::vector<Coat> coats = {everywhere(0),
                                   {Domain::rectangle({-1, 0.1}, {2, 0.3}), 1},
                                   {Domain::rectangle({0.1, -1}, {0.3, 2}), 2}};
  const Painting p = paint<Geometry::plane>(coats, cell, x, 3);
  const auto parts = p.materials.parts(0);
  REQUIRE(parts.size() == 3);
  const double strip = 0.2 * (0.9 + 0.7) / 2, both = 0.2 * 0.2;
  CHECK(parts[1].fraction == Approx(2 * (strip - both)).epsilon(16 * eps));
  const auto part = [&](std::size_t k)
  {
    return 2
           * partial_volumes<Geometry::plane>(coats[k].domain, cell, x)
                 .parts[0]
                 .v;
  };
  const double by_fractions = std::min(part(1), 1 - part(2));
  CHECK(by_fractions - parts[1].fraction == Approx(2 * both).epsilon(1e-12));
}

TEST_CASE(
    "paint: any part of the cells has the same materials, to the last bit",
    "[paint]")
{
  const meshes::Data mesh = shaken(20, 2);
  const std::vector<Coat> coats = {
      everywhere(0),
      {Domain::circle({0.5, 0.5}, 0.4, 1e-4), 1},
      {Domain::half_plane({{0.3, 1}, {0.5, 0.4}}, {-1, -1}, {2, 2}), 2},
      {Domain::circle({0.6, 0.4}, 0.2, 1e-4), 3}};
  const Painting all = painted(coats, mesh, 4);
  CHECK(all.materials.mixed().size() > 80);
  const std::size_t share = GENERATE(1u, 7u, 80u, 400u);
  for (std::size_t from = 0; from + share <= 800; from += share)
  {
    const auto some = paint<Geometry::plane>(
        coats, std::span(mesh.cells).subspan(3 * from, 3 * share), mesh.x, 4);
    for (std::size_t i = 0; i < share; ++i)
    {
      const auto c = static_cast<std::int32_t>(i);
      const auto d = static_cast<std::int32_t>(from + i);
      REQUIRE(some.materials.pure(c) == all.materials.pure(d));
      if (some.materials.pure(c) >= 0)
        continue;
      const auto p = some.materials.parts(some.materials.row(c));
      const auto q = all.materials.parts(all.materials.row(d));
      REQUIRE(std::ranges::equal(p, q,
                                 [](const Part& a, const Part& b)
                                 {
                                   return a.material == b.material
                                          and a.fraction == b.fraction
                                          and a.centroid == b.centroid;
                                 }));
    }
  }
}

TEST_CASE("paint: coats that are covered wholly leave no trace", "[paint]")
{
  const meshes::Data mesh = shaken(9, 6);
  const Coat top{Domain::circle({0.45, 0.5}, 0.31, 1e-4), 2};
  const Painting bare = painted({everywhere(0), top}, mesh, 4);
  const Painting hidden = painted({everywhere(3),
                                   {Domain::circle({0.2, 0.7}, 0.6, 1e-3), 1},
                                   everywhere(0),
                                   {Domain::circle({0.45, 0.5}, 0.2, 1e-3), 3},
                                   top},
                                  mesh, 4);
  REQUIRE(std::ranges::equal(bare.materials.mixed(), hidden.materials.mixed()));
  for (std::int32_t c = 0; c < bare.materials.num_cells(); ++c)
    for (int k = 0; k < 4; ++k)
      CHECK(std::abs(bare.materials.fraction(c, k)
                     - hidden.materials.fraction(c, k))
            < 16 * eps);
  CHECK_THROWS_AS(painted({everywhere(4)}, mesh, 4), std::invalid_argument);
}
