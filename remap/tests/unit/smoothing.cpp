// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/geometry/volumes.h"
#include "remap/smoothing/colouring.h"
#include "remap/smoothing/smooth.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// A block with a wavy top whose surface nodes have been carried to the right.
struct Wave
{
  static constexpr int n = 16;
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  Mesh mesh = data.mesh();
  std::vector<double> spacing = facet_lengths(mesh, data.x);
  std::vector<double> x = carried();
  std::vector<Kind> kinds = all_kinds();

  [[nodiscard]] std::vector<double> carried() const
  {
    std::vector<double> out = data.x;
    for (std::size_t i = 0; i < out.size(); i += 2)
    {
      const double s = data.x[i], y = data.x[i + 1];
      out[i] = s + 0.06 * y * std::sin(std::numbers::pi * s);
      out[i + 1] = y * (1 + 0.05 * std::sin(2 * std::numbers::pi * s));
    }
    return out;
  }
  [[nodiscard]] std::vector<Kind> all_kinds() const
  {
    std::vector<Kind> out;
    for (std::size_t i = 0; i < data.x.size(); i += 2)
    {
      const Point p = {data.x[i], data.x[i + 1]};
      const bool top = p.y == 1 and p.x > 0 and p.x < 1;
      out.push_back(top                     ? Kind::surface
                    : meshes::on_outline(p) ? Kind::fixed
                                            : Kind::free);
    }
    return out;
  }
  [[nodiscard]] double volume(Geometry geometry) const
  {
    std::vector<double> v(mesh.num_cells());
    cell_volumes(mesh, geometry, x, v);
    double sum = 0;
    for (double one : v)
      sum += one;
    return sum;
  }
  /// Largest over smallest facet length of the surface.
  [[nodiscard]] double unevenness() const
  {
    double lo = 1e9, hi = 0;
    const auto now = facet_lengths(mesh, x);
    for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
      if (mesh.marker(f) == 2)
      {
        lo = std::min(lo, now[f] / spacing[f]);
        hi = std::max(hi, now[f] / spacing[f]);
      }
    return hi / lo;
  }
};
} // namespace

TEST_CASE("smoothing: surface nodes regain their spacing and keep the volume",
          "[smoothing]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  Wave w;
  const double volume = w.volume(geometry);
  const double before = w.unevenness();
  REQUIRE(before > 1.2);
  Smoothing smoothing(w.mesh, {.geometry = geometry, .sweeps = 300}, {});
  const std::vector<std::uint8_t> flags(w.mesh.num_nodes(), 1);
  REQUIRE(
      smoothing.smooth(w.x, flags, {.kinds = w.kinds, .spacing = w.spacing}, {})
      == Outcome::ok);
  // 16 nodes relax like heat: 300 sweeps leave nothing to speak of.
  CHECK(w.unevenness() < 1.001);
  CHECK(std::abs(w.volume(geometry) - volume) < 1e-13 * volume);
}

TEST_CASE("smoothing: a graded surface regains its grading", "[smoothing]")
{
  Wave w;
  // Wanted: facets that grow by a tenth from left to right.
  double at = 1;
  std::vector<std::pair<double, std::int32_t>> top;
  for (std::int32_t f = 0; f < w.mesh.num_facets(); ++f)
    if (w.mesh.marker(f) == 2)
      top.emplace_back(w.data.x[2 * w.mesh.facet(f)[0]], f);
  std::sort(top.begin(), top.end());
  for (const auto& [s, f] : top)
    w.spacing[f] = at *= 1.1;
  Smoothing smoothing(w.mesh, {.threshold = 0.1, .sweeps = 400}, {});
  const std::vector<std::uint8_t> flags(w.mesh.num_nodes(), 1);
  REQUIRE(
      smoothing.smooth(w.x, flags, {.kinds = w.kinds, .spacing = w.spacing}, {})
      == Outcome::ok);
  CHECK(w.unevenness() < 1.01);
}

TEST_CASE(
    "smoothing: without a spacing surface nodes go where cells get better",
    "[smoothing]")
{
  Wave w;
  const double volume = w.volume(Geometry::plane);
  Smoothing smoothing(w.mesh, {}, {});
  const std::vector<std::uint8_t> flags(w.mesh.num_nodes(), 1);
  REQUIRE(smoothing.smooth(w.x, flags, {.kinds = w.kinds}, {}) == Outcome::ok);
  CHECK(smoothing.report().worst_after > smoothing.report().worst_before);
  CHECK(std::abs(w.volume(Geometry::plane) - volume) < 1e-14);
}

TEST_CASE("smoothing: optimisation finds the lattice again", "[smoothing]")
{
  // Equilateral cells are the exact optimum; the boundary is theirs.
  meshes::Data data = meshes::rectangle(8, 8, Diagonal::right);
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i)
    {
      const std::size_t k = 2 * static_cast<std::size_t>(9 * j + i);
      data.x[k] = i - 0.5 * j;
      data.x[k + 1] = std::numbers::sqrt3 / 2 * j;
    }
  const Mesh mesh = data.mesh();
  std::vector<Kind> kinds(mesh.num_nodes(), Kind::free);
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (mesh.on_boundary(f))
      for (std::int32_t i : mesh.facet(f))
        kinds[i] = Kind::fixed;
  auto x = data.x;
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == Kind::free)
      x[2 * i] += shift(engine), x[2 * i + 1] += shift(engine);
  Smoothing smoothing(mesh, {.sweeps = 200}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(x[i] == Approx(data.x[i]).margin(1e-7));
}

TEST_CASE("smoothing: initial shapes as targets keep a graded mesh graded",
          "[smoothing]")
{
  meshes::Data data = meshes::rectangle(10, 10, Diagonal::crossed);
  for (double& s : data.x)
    s = s * s * 0.8 + 0.2 * s; // cells ten times smaller at the corner
  const Mesh mesh = data.mesh();
  const auto targets = shapes(mesh, data.x);
  std::vector<Kind> kinds(mesh.num_nodes(), Kind::free);
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (mesh.on_boundary(f))
      for (std::int32_t i : mesh.facet(f))
        kinds[i] = Kind::fixed;
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  const Constraints constraints{.kinds = kinds, .targets = targets};
  Smoothing smoothing(mesh, {.measure = Measure::shape, .sweeps = 300}, {});

  auto x = data.x;
  REQUIRE(smoothing.smooth(x, flags, constraints, {}) == Outcome::ok);
  CHECK(x == data.x);

  // Shaken in proportion to the cells, it comes back.
  std::mt19937 engine(12);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (std::size_t i = 0; i < kinds.size(); ++i)
  {
    double size = 1;
    for (std::int32_t j : mesh.node_nodes()[i])
      size = std::min(size, std::hypot(data.x[2 * i] - data.x[2 * j],
                                       data.x[2 * i + 1] - data.x[2 * j + 1]));
    if (kinds[i] == Kind::free)
      x[2 * i] += size * shift(engine), x[2 * i + 1] += size * shift(engine);
  }
  REQUIRE(smoothing.smooth(x, flags, constraints, {}) == Outcome::ok);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(x[i] == Approx(data.x[i]).margin(1e-6));
}

TEST_CASE("smoothing: no two neighbours have one colour", "[smoothing]")
{
  const Mesh mesh = meshes::rectangle(30, 20, Diagonal::four).mesh();
  const auto colour = colour_nodes(mesh, {});
  for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
    for (std::int32_t j : mesh.node_nodes()[i])
      CHECK(colour[i] != colour[j]);
  CHECK(*std::max_element(colour.begin(), colour.end()) < 8);
  CHECK(*std::min_element(colour.begin(), colour.end()) == 0);
}

TEST_CASE("smoothing: troubles are outcomes", "[smoothing]")
{
  const meshes::Data data = meshes::rectangle(4, 4, Diagonal::right);
  const Mesh mesh = data.mesh();
  Smoothing smoothing(mesh, {}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  const std::vector<Kind> slide(mesh.num_nodes(), Kind::slide);
  auto x = data.x;
  std::vector<std::uint8_t> few(mesh.num_nodes() - 1);
  CHECK_THROWS_AS(smoothing.flag(x, {}, few, {}), std::invalid_argument);
  CHECK(smoothing.smooth(x, flags, {.kinds = slide}, {})
        == Outcome::wrong_size);
  x[3] = std::nan("");
  const std::vector<Kind> fixed(mesh.num_nodes(), Kind::fixed);
  CHECK(smoothing.smooth(x, flags, {.kinds = fixed}, {})
        == Outcome::not_finite);
  const SmoothingOptions bad{
      .threshold = 2, .rings = -1, .sweeps = 0, .relaxation = 0};
  CHECK(bad.complaints().size() == 4);
  CHECK_THROWS_AS(Smoothing(mesh, bad, {}), std::invalid_argument);
}
