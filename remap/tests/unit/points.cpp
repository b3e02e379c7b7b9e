// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Data at the points of a cell travel with the cells' own, and fill them.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;

namespace
{
const PointLayout three = {{1, 2}, {2, 0}, {0, 1}};
const PointLayout six = {{0, 1}, {0, 2}, {1, 2}, {1, 0}, {2, 0}, {2, 1}};

std::vector<double> volumes(const PointMesh& points, const Mesh& mesh,
                            Geometry geometry, std::span<const double> x,
                            std::vector<double>& centroids)
{
  std::vector<double> nodes(2 * points.mesh().num_nodes());
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    points.place(c, x, nodes);
  std::vector<double> out(points.mesh().num_cells());
  centroids.resize(2 * out.size());
  cell_volumes(points.mesh(), geometry, nodes, out, centroids);
  return out;
}
} // namespace

TEST_CASE("points: they fill their cell, conserve, and carry a linear field",
          "[points]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto layout = GENERATE(three, six);
  const auto data = meshes::rectangle(8, 8, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const PointMesh points(mesh, layout, data.x);
  const int per_cell = points.points();
  const auto to = meshes::shaken(data.x, 0.02, 4);

  std::vector<double> at, cells(mesh.num_cells());
  const auto before = volumes(points, mesh, geometry, data.x, at);
  cell_volumes(mesh, geometry, data.x, cells);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    double sum = 0;
    for (int q = 0; q < per_cell; ++q)
    {
      CHECK(before[per_cell * c + q] > 0);
      sum += before[per_cell * c + q];
    }
    CHECK(sum == Approx(cells[c]).epsilon(1e-14));
  }

  const auto f = [](double x, double y) { return 1 + 2 * x - 3 * y; };
  std::vector<double> u(before.size()), rho(mesh.num_cells(), 1.0);
  double integral = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    u[i] = f(at[2 * i], at[2 * i + 1]);
    integral += u[i] * before[i];
  }
  Remapper remapper(mesh, {.geometry = geometry,
                           .scheme = scheme::Linear{},
                           .boundaries = std::vector(4, Boundary::closed),
                           .points = &points,
                           .point_components = 1});
  const Field field{.values = u}, density{.values = rho};
  Ledger ledger;
  REQUIRE(remapper.remap(data.x, to,
                         {.cells = {&density, 1}, .points = {&field, 1}}, {},
                         ledger)
          == Outcome::ok);
  const auto after = volumes(points, mesh, geometry, to, at);
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    CHECK(u[i] == Approx(f(at[2 * i], at[2 * i + 1])).margin(1e-12));
    integral -= u[i] * after[i];
  }
  CHECK(std::abs(integral + net(ledger.points[0])) < 1e-14);
}

TEST_CASE("points: bad layouts are named", "[points]")
{
  CHECK(complaints(three).empty());
  CHECK(complaints(six).empty());
  CHECK(complaints(PointLayout{{0, 1}, {1, 2}}).size() == 1);
  CHECK(complaints(PointLayout{{0, 1}, {1, 0}, {2, 0}}).size() == 1);
  CHECK(complaints(PointLayout{{0, 0}, {1, 2}, {2, 0}}).size() == 1);
}

TEST_CASE("points: bad layouts and meshes are refused", "[points]")
{
  const auto data = meshes::rectangle(2, 2, meshes::Diagonal::right);
  const Mesh mesh = data.mesh(), other = data.mesh();
  CHECK_THROWS_AS(PointMesh(mesh, {{0, 1}, {1, 2}}, data.x),
                  std::invalid_argument);
  CHECK_THROWS_AS(PointMesh(mesh, three, std::span(data.x).subspan(2)),
                  std::invalid_argument);
  const PointMesh points(other, three, data.x);
  const Options options{.points = &points, .point_components = 1};
  CHECK_THROWS_AS(Remapper(mesh, options), std::invalid_argument);
  CHECK_NOTHROW(Remapper(other, options));
}

TEST_CASE("points: without a mesh for them there is a complaint", "[points]")
{
  CHECK(Options{.point_components = 2}.complaints().size() == 1);
  CHECK(Options{.per_mass = true}.complaints().size() == 1);
}
