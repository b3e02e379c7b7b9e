// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What every smoother owes: no inverted cell, no worse worst cell, rigid motion
// changes nothing, what has no flag stays.

#include "remap/smoothing/smooth.h"
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
/// Inner nodes free, corners fixed, sides as told.
std::vector<Kind> kinds_of(const meshes::Data& data, Kind sides)
{
  std::vector<Kind> out;
  for (std::size_t i = 0; i < data.x.size() / 2; ++i)
  {
    const double x = data.x[2 * i], y = data.x[2 * i + 1];
    const bool vertical = x == 0 or x == 1;
    const bool horizontal = y == 0 or y == 1;
    out.push_back(vertical and horizontal  ? Kind::fixed
                  : vertical or horizontal ? sides
                                           : Kind::free);
  }
  return out;
}

/// Along the sides of the unit square.
std::vector<double> directions_of(const meshes::Data& data)
{
  std::vector<double> out;
  for (std::size_t i = 0; i < data.x.size() / 2; ++i)
  {
    const bool vertical = data.x[2 * i] == 0 or data.x[2 * i] == 1;
    out.push_back(vertical ? 0.0 : 1.0);
    out.push_back(vertical ? 1.0 : 0.0);
  }
  return out;
}

/// A lattice of equilateral triangles, rows shifted to and fro.
meshes::Data lattice(int nx, int ny)
{
  meshes::Data data = meshes::rectangle(nx, ny, Diagonal::right);
  const double a = 1.0, b = std::numbers::sqrt3 / 2;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
    {
      const std::size_t k = 2 * static_cast<std::size_t>(j * (nx + 1) + i);
      // Diagonals like / are short when each row shifts to the left.
      data.x[k] = a * i - 0.5 * a * j;
      data.x[k + 1] = b * j;
    }
  return data;
}

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
} // namespace

TEMPLATE_LIST_TEST_CASE("smoother: never inverts and never makes worse",
                        "[conformance]", Smoothers)
{
  const auto diagonal =
      GENERATE(Diagonal::right, Diagonal::crossed, Diagonal::four);
  const auto seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u);
  const auto measure = GENERATE(Measure::radius_ratio, Measure::shape);
  INFO("seed " << seed);
  const meshes::Data data = meshes::rectangle(10, 10, diagonal);
  const Mesh mesh = data.mesh();
  // Shaken so far that some cells are nearly flat, none inverted.
  double by = 0.06;
  auto x = meshes::shaken(data.x, by, seed);
  while (worst_quality(mesh, x, measure, {}, {}) <= 0)
    x = meshes::shaken(data.x, by *= 0.95, seed);
  const double before = worst_quality(mesh, x, measure, {}, {});
  const auto kinds = kinds_of(data, Kind::slide);
  const auto direction = directions_of(data);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  double last = before;
  for (int k = 0; k < 5; ++k)
  {
    Smoothing smoothing(
        mesh, {.smoother = TestType{}, .measure = measure, .sweeps = 1}, {});
    REQUIRE(
        smoothing.smooth(x, flags, {.kinds = kinds, .direction = direction}, {})
        == Outcome::ok);
    const double now = worst_quality(mesh, x, measure, {}, {});
    CHECK(now >= last);
    CHECK(smoothing.report().worst_after == now);
    last = now;
  }
  CHECK(last > before);
  // Walls are kept to the last bit.
  for (std::size_t i = 0; i < data.x.size(); ++i)
    if (data.x[i] == 0 or data.x[i] == 1)
      CHECK(x[i] == data.x[i]);
}

TEMPLATE_LIST_TEST_CASE("smoother: the best mesh stays to the last bit",
                        "[conformance]", Smoothers)
{
  const meshes::Data data = lattice(8, 8);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  // Anywhere, at any angle: rigid motion of the best mesh.
  for (double angle : {0.0, 0.3, 2.0, 3.1})
  {
    auto x = meshes::turned(data.x, angle, {100, -20});
    const auto x0 = x;
    Smoothing smoothing(mesh, {.smoother = TestType{}}, {});
    REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
    CHECK(x == x0);
    CHECK(smoothing.report().moved == 0);
  }
}

TEMPLATE_LIST_TEST_CASE(
    "smoother: a turned mesh is smoothed to the turned mesh", "[conformance]",
    Smoothers)
{
  const meshes::Data data = meshes::rectangle(8, 8, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  const auto smooth = [&](std::vector<double> x)
  {
    Smoothing smoothing(mesh, {.smoother = TestType{}, .sweeps = 2}, {});
    REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
    return x;
  };
  const auto x = meshes::shaken(data.x, 0.03, 3);
  const auto a = meshes::turned(smooth(x), 1.1, {0.2, 0.7});
  const auto b = smooth(meshes::turned(x, 1.1, {0.2, 0.7}));
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK(a[i] == Approx(b[i]).margin(1e-12));
}

TEMPLATE_LIST_TEST_CASE("smoother: nodes without a flag stay to the last bit",
                        "[conformance]", Smoothers)
{
  const meshes::Data data = meshes::rectangle(10, 10, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  auto x = data.x;
  const std::int32_t bad = 5 * 11 + 5;
  x[2 * bad] += 0.09; // of h = 0.1
  const auto x0 = x;
  Smoothing smoothing(
      mesh, {.smoother = TestType{}, .threshold = 0.4, .rings = 1}, {});
  std::vector<std::uint8_t> flags(mesh.num_nodes());
  REQUIRE(smoothing.flag(x, {}, flags, {}));
  const auto kinds = kinds_of(data, Kind::fixed);
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(flags[bad] == 1);
  CHECK(std::count(flags.begin(), flags.end(), 1) < 40);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] == 0)
    {
      CHECK(x[2 * i] == x0[2 * i]);
      CHECK(x[2 * i + 1] == x0[2 * i + 1]);
    }
  CHECK(smoothing.report().worst_after > smoothing.report().worst_before);
}

TEMPLATE_LIST_TEST_CASE("smoother: an inverted start is untangled",
                        "[conformance]", Smoothers)
{
  const auto seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  const meshes::Data data = meshes::rectangle(12, 12, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  // By a whole cell in each direction: a quarter of the cells is inverted.
  auto x = meshes::shaken(data.x, 1.0 / 12, seed);
  REQUIRE(worst_quality(mesh, x, Measure::radius_ratio, {}, {}) < 0);
  Smoothing smoothing(mesh, {.smoother = TestType{}, .sweeps = 20}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  const auto kinds = kinds_of(data, Kind::slide);
  const auto direction = directions_of(data);
  REQUIRE(
      smoothing.smooth(x, flags, {.kinds = kinds, .direction = direction}, {})
      == Outcome::ok);
  CHECK(smoothing.report().worst_before < 0);
  CHECK(smoothing.report().untangled > 20);
  // The mesh before it was shaken had 0.83.
  CHECK(worst_quality(mesh, x, Measure::radius_ratio, {}, {}) > 0.5);
}

TEMPLATE_LIST_TEST_CASE("smoother: what cannot be untangled is reported, "
                        "nothing moves",
                        "[conformance]", Smoothers)
{
  const meshes::Data data = meshes::rectangle(6, 6, Diagonal::right);
  const Mesh mesh = data.mesh();
  auto x = data.x;
  x[2 * 24] += 0.4; // beyond two neighbours, and only the first may move
  const auto x0 = x;
  Smoothing smoothing(mesh, {.smoother = TestType{}}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  std::vector<Kind> kinds(mesh.num_nodes(), Kind::fixed);
  kinds[25] = Kind::free;
  CHECK(smoothing.smooth(x, flags, {.kinds = kinds}, {})
        == Outcome::inverted_start);
  CHECK(x == x0);
  const auto around = mesh.node_cells()[24];
  CHECK(std::find(around.begin(), around.end(), smoothing.report().worst_cell)
        != around.end());
}
