// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Remap by overlay owes what swept regions owe, over cells, points and dual
// volumes, for moves of any length; and it takes over where swept regions fail.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
constexpr int n = 14;

/// A shear wave that moves nodes by up to so many cells and back.
struct Wave
{
  Geometry geometry;
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  Mesh mesh = data.mesh();
  PointMesh points{mesh, {{0, 1}, {1, 2}, {2, 0}}, data.x};
  std::vector<double> to;

  Wave(Geometry g, double cells) : geometry(g), to(data.x)
  {
    for (std::size_t i = 0; i < to.size(); i += 2)
      to[i] += cells / n * std::sin(std::numbers::pi * data.x[i])
               * std::sin(2 * std::numbers::pi * data.x[i + 1]);
  }

  [[nodiscard]] Options options(const Scheme& scheme) const
  {
    return {.geometry = geometry,
            .method = Method::overlay,
            .scheme = scheme,
            .nodal_scheme = scheme,
            .boundaries = std::vector(4, Boundary::closed),
            .points = &points,
            .point_components = 1,
            .nodal_components = 1};
  }

  /// Volumes and centroids of cells (0), points (1), dual volumes (2).
  std::vector<double> volumes(int what, std::span<const double> x,
                              std::vector<double>& centroids) const
  {
    const Mesh& m = what == 1 ? points.mesh() : mesh;
    std::vector<double> nodes(x.begin(), x.end());
    nodes.resize(2 * m.num_nodes());
    if (what == 1)
      for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
        points.place(c, x, nodes);
    std::vector<double> out(what == 2 ? m.num_nodes() : m.num_cells());
    centroids.resize(2 * out.size());
    if (what == 2)
      dual_volumes(m, geometry, nodes, out, centroids);
    else
      cell_volumes(m, geometry, nodes, out, centroids);
    return out;
  }

  Outcome run(int what, std::vector<double>& u, const Options& options,
              Ledger& ledger, Report* report = nullptr) const
  {
    Remapper remapper(mesh, options);
    const Field field{.values = u};
    const std::span<const Field> one(&field, 1), none;
    const Outcome out = remapper.remap(data.x, to,
                                       {.cells = what == 0 ? one : none,
                                        .points = what == 1 ? one : none,
                                        .nodes = what == 2 ? one : none},
                                       {}, ledger);
    if (report)
      *report = remapper.report();
    return out;
  }
};
} // namespace

TEMPLATE_LIST_TEST_CASE("overlay: mass, bounds and linear fields",
                        "[conformance]", Schemes)
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const double cells = GENERATE(0.1, 0.5, 1.2, 3.0);
  const int what = GENERATE(0, 1, 2);
  CAPTURE(cells, what);
  const Wave wave(geometry, cells);
  std::vector<double> from, at;
  const auto before = wave.volumes(what, wave.data.x, from);
  const auto after = wave.volumes(what, wave.to, at);

  std::vector<double> jump, linear;
  const auto f = [](double x, double y) { return 2 + 3 * x - 5 * y; };
  for (std::size_t i = 0; i < before.size(); ++i)
  {
    jump.push_back(from[2 * i] + 0.3 * from[2 * i + 1] < 0.6 ? 0 : 1);
    linear.push_back(f(from[2 * i], from[2 * i + 1]));
  }
  double mass = 0;
  for (std::size_t i = 0; i < jump.size(); ++i)
    mass += before[i] * jump[i];
  Ledger ledger;
  REQUIRE(wave.run(what, jump, wave.options(TestType{}), ledger)
          == Outcome::ok);
  for (std::size_t i = 0; i < jump.size(); ++i)
    mass -= after[i] * jump[i];
  const auto& book = what == 0   ? ledger.cells
                     : what == 1 ? ledger.points
                                 : ledger.nodes;
  CHECK(std::abs(mass + net(book[0])) < 1e-13);
  if (TestType::bounded and not TestType::limiter::extends)
    for (double u : jump)
    {
      CHECK(u > -1e-13);
      CHECK(u < 1 + 1e-13);
    }
  if (TestType::linear and not TestType::bounded)
  {
    Ledger other;
    REQUIRE(wave.run(what, linear, wave.options(TestType{}), other)
            == Outcome::ok);
    for (std::size_t i = 0; i < linear.size(); ++i)
      CHECK(linear[i] == Approx(f(at[2 * i], at[2 * i + 1])).margin(1e-12));
  }
}

TEST_CASE("overlay: takes over where swept regions need too many sub-cycles",
          "[conformance]")
{
  const int what = GENERATE(0, 1, 2);
  const Wave wave(Geometry::plane, 2.0);
  std::vector<double> at;
  const auto before = wave.volumes(what, wave.data.x, at);
  std::vector<double> u, v;
  for (std::size_t i = 0; i < before.size(); ++i)
    u.push_back(std::sin(4 * at[2 * i]) + at[2 * i + 1]);
  v = u;
  auto w = u;
  Options options = wave.options(scheme::LimitedLinear{});
  Ledger ledger;
  REQUIRE(wave.run(what, u, options, ledger) == Outcome::ok);

  options.method = Method::swept;
  options.max_cycles = 1;
  CHECK(wave.run(what, v, options, ledger) == Outcome::too_many_cycles);
  options.overlay_ready = true;
  Report report;
  REQUIRE(wave.run(what, w, options, ledger, &report) == Outcome::ok);
  CHECK(report.overlaid);
  CHECK(report.cycles == 0);
  CHECK(u == w);

  // A few sub-cycles first, then the rest of the way.
  options.max_cycles = 3;
  std::vector<double> part(before.size(), 1.5);
  REQUIRE(wave.run(what, part, options, ledger, &report) == Outcome::ok);
  CHECK(report.overlaid);
  for (double one : part)
    CHECK(one == Approx(1.5).epsilon(1e-13));
}
