// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Where smoothing fails: the naive way beside ours.

#include "remap/smoothing/smooth.h"
#include "remap/smoothing/untangle.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// Boundary nodes fixed, others free.
std::vector<Kind> inner_free(const Mesh& mesh)
{
  std::vector<Kind> out(mesh.num_nodes(), Kind::free);
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (mesh.on_boundary(f))
      for (std::int32_t i : mesh.facet(f))
        out[i] = Kind::fixed;
  return out;
}

/// Over a steep hill: the domain is not convex.
meshes::Data over_hill(int n, double height = 0.7, double width = 0.12)
{
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  for (std::size_t i = 0; i < data.x.size(); i += 2)
  {
    const double s = (data.x[i] - 0.5) / width;
    const double foot = height * std::exp(-s * s);
    data.x[i + 1] = foot + data.x[i + 1] * (1 - foot);
  }
  return data;
}

double worst(const Mesh& mesh, std::span<const double> x)
{
  return worst_quality(mesh, x, Measure::radius_ratio, {}, {});
}

/// Every node to the mean of its neighbours, unasked.
void plain_laplace(const Mesh& mesh, std::span<const Kind> kinds,
                   std::span<double> x, int sweeps)
{
  for (int k = 0; k < sweeps; ++k)
    for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
      if (kinds[i] == Kind::free)
      {
        Point sum{};
        for (std::int32_t j : mesh.node_nodes()[i])
          sum = sum + point(x, j);
        const double count = static_cast<double>(mesh.node_nodes()[i].size());
        x[2 * i] = sum.x / count;
        x[2 * i + 1] = sum.y / count;
      }
}
} // namespace

TEST_CASE("plain averaging inverts cells of a domain that is not convex",
          "[smoothing][limits]")
{
  const meshes::Data data = over_hill(20);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  REQUIRE(worst(mesh, data.x) > 0);
  auto x = data.x;
  plain_laplace(mesh, kinds, x, 50);
  CHECK(worst(mesh, x) < -0.1);
}

TEMPLATE_LIST_TEST_CASE("ours does not, and makes them better",
                        "[smoothing][limits]", Smoothers)
{
  const meshes::Data data = over_hill(20);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  auto x = data.x;
  Smoothing smoothing(mesh, {.smoother = TestType{}, .sweeps = 50}, {});
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(worst(mesh, x) >= worst(mesh, data.x));
  CHECK(x != data.x);
}

TEST_CASE("a tangle: plain averaging leaves inverted cells, ours none",
          "[smoothing][limits]")
{
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  const meshes::Data data = over_hill(20, 0.5, 0.2);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  // Inner nodes anywhere within two cells of where they were.
  auto x = data.x;
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == Kind::free)
      x[2 * i] += shift(engine), x[2 * i + 1] += shift(engine);
  REQUIRE(worst(mesh, x) < -0.9);
  auto plain = x;
  plain_laplace(mesh, kinds, plain, 500);
  CHECK(worst(mesh, plain) < -0.1);

  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  Smoothing smoothing(mesh, {.sweeps = 100}, {});
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(smoothing.report().untangled > 200);
  // As good as from the mesh before the tangle.
  auto good = data.x;
  REQUIRE(smoothing.smooth(good, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(worst(mesh, x) > 0.5 * worst(mesh, good));
}

TEST_CASE("a tangle: node by node it may be for ever, ours is out",
          "[smoothing][limits]")
{
  const meshes::Data data = meshes::rectangle(40, 40, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  int stuck = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    INFO("seed " << seed);
    const auto start = meshes::shaken(data.x, 1.0 / 40, seed);
    // The naive way: to the largest smallest area, and nothing else.
    auto naive = start;
    for (int pass = 0; pass < 100 and worst(mesh, naive) <= 0; ++pass)
      for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
      {
        std::vector<PatchCell> cells;
        for (std::int32_t c : mesh.node_cells()[i])
        {
          const Triple& n = mesh.cell(c);
          const int v = n[0] == i ? 0 : (n[1] == i ? 1 : 2);
          cells.push_back({point(naive, n[(v + 1) % 3]),
                           point(naive, n[(v + 2) % 3]), quality::equilateral});
        }
        if (kinds[i] == Kind::fixed
            or smallest_area(cells, point(naive, i)) > 0)
          continue;
        const Point to = untangled({point(naive, i), cells, {}});
        naive[2 * i] = to.x, naive[2 * i + 1] = to.y;
      }
    stuck += worst(mesh, naive) <= 0;

    auto x = start;
    Smoothing smoothing(mesh, {.sweeps = 30}, {});
    REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
    CHECK(worst(mesh, x) > 0.5);
  }
  CHECK(stuck > 0);
}

TEST_CASE("untangled: the place of the largest smallest area, by hand",
          "[smoothing][limits]")
{
  // Around (0, 0), (3, 0), (0, 3): equal areas at the centroid.
  const auto w = quality::equilateral;
  const Point a{0, 0}, b{3, 0}, c{0, 3};
  const PatchCell cells[] = {{a, b, w}, {b, c, w}, {c, a, w}};
  const Point in = untangled({{5, 5}, cells, {}});
  CHECK(in.x == Approx(1));
  CHECK(in.y == Approx(1));
  const double r = 1 / std::numbers::sqrt2;
  const Point on = untangled({{-1, 0.5}, cells, Point{r, r}});
  // x = −1 + s, y = 1/2 + s, areas 3y, 9 − 3x − 3y and 3x: the least one is 3x
  // until x = 3 − x − y.
  CHECK(on.x == Approx(0.5));
  CHECK(on.y == Approx(2));
}

TEST_CASE("nearly inverted cells come back", "[smoothing][limits]")
{
  const double gap = GENERATE(1e-3, 1e-6, 1e-9, 1e-12);
  INFO("gap " << gap);
  const meshes::Data data = meshes::rectangle(8, 8, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  // A node within `gap` of a cell's breadth of the line of its neighbours.
  auto x = data.x;
  x[2 * 40] += (1 - gap) / 8;
  const double before = worst(mesh, x);
  REQUIRE(before > 0);
  REQUIRE(before < 10 * gap);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  Smoothing smoothing(mesh, {.sweeps = 30}, {});
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(worst(mesh, x) > 0.8); // 0.83 before the node was moved
}

TEST_CASE("aspect ratios to 1e4: kept with targets, lost without",
          "[smoothing][limits]")
{
  const double aspect = GENERATE(10.0, 100.0, 1e4);
  INFO("aspect " << aspect);
  meshes::Data data =
      meshes::rectangle(10, 10, Diagonal::crossed, 0, 0, 1, 1 / aspect);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  // Rows of a layer, graded towards the bottom: what a mesh is built for.
  for (std::size_t i = 1; i < data.x.size(); i += 2)
    data.x[i] *= 0.2 + 0.8 * aspect * data.x[i];
  const auto graded = shapes(mesh, data.x);
  auto x = data.x;
  std::mt19937 engine(6);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == Kind::free)
      // by a fifth of the first row's height
      x[2 * i] += 0.028 / aspect * shift(engine),
          x[2 * i + 1] += 0.028 / aspect * shift(engine);
  auto kept = x;
  Smoothing ours(mesh, {.measure = Measure::shape, .sweeps = 300}, {});
  REQUIRE(ours.smooth(kept, flags, {.kinds = kinds, .targets = graded}, {})
          == Outcome::ok);
  const auto off = [&](std::span<const double> at)
  {
    double out = 0; // in parts of the first row's height
    for (std::size_t i = 1; i < at.size(); i += 2)
      out = std::max(out, std::abs(at[i] - data.x[i]) * aspect / 0.028);
    return out;
  };
  // Steps below 1e-10 of the longest edge, 4e-6 rows at most, are not made.
  CHECK(off(kept) < 1e-4);
  // Averaging evens the rows out.
  auto lost = x;
  Smoothing naive(mesh, {.smoother = smoother::AverageArea{}, .sweeps = 300},
                  {});
  REQUIRE(naive.smooth(lost, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(off(lost) > 0.2);
}
