// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials where the outline moves: walls, free surfaces, open boundaries, and
// the book of what passed. Slivers. Outcomes.

#include "remap/materials/slivers.h"
#include "remap/tests/eulerian.h"
#include "remap/tests/meshes.h"
#include "remap/tests/shapes.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

#include <limits>

using namespace remap;
using meshes::Diagonal;

namespace
{
constexpr int n = 10;
constexpr double h = 1.0 / n;

/// A layer of material 1 below y = 0.43 in a square, whose outline moves.
struct Box
{
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  Mesh mesh = data.mesh();
  Materials materials{mesh.num_cells(), 3};
  MaterialLedger ledger;
  VolumeReport report;

  Box()
  {
    const auto layer = shapes::part_in(shapes::everything<Geometry::plane>,
                                       {{{0, 1}, {0, 0.43}}});
    materials = shapes::lay(mesh, data.x, {layer, shapes::disc({9, 9}, 0.1)});
  }
  [[nodiscard]] double volume(std::span<const double> x, int material) const
  {
    return eulerian::volume(mesh, Geometry::plane, x, materials, material);
  }
  Outcome carry(std::span<const double> to, VolumeOptions options)
  {
    Interfaces interfaces(mesh, {});
    interfaces.reconstruct(data.x, materials, {});
    VolumeTransport transport(mesh, std::move(options));
    const auto out = transport.carry(data.x, to, {}, interfaces.partitions(),
                                     materials, {}, ledger);
    report = transport.report();
    return out;
  }
  [[nodiscard]] std::vector<double> moved(double dx, double dy) const
  {
    std::vector<double> out = data.x;
    for (std::size_t i = 0; i < out.size(); i += 2)
      out[i] += dx, out[i + 1] += dy;
    return out;
  }
};

double at(const Exchange& e, Way way)
{
  return e[static_cast<std::size_t>(way)];
}
} // namespace

TEST_CASE(
    "volumes at boundaries: open ones let a given material in, and all is "
    "booked",
    "[materials][transport]")
{
  // By less than a cell, by more, by more than all.
  const double way = GENERATE(0.3 * h, 2.4 * h, 0.7);
  Box box;
  const auto to = box.moved(way, 0);
  REQUIRE(box.carry(to, {.boundaries = std::vector(4, Boundary::open),
                         .beyond = {0, 2, 0, 2}})
          == Outcome::ok);
  CHECK(box.volume(to, 2) == Catch::Approx(way).epsilon(1e-12));
  CHECK(box.volume(to, 1) == Catch::Approx(0.43 * (1 - way)).epsilon(1e-12));
  const auto& book = box.ledger.volume;
  CHECK(at(book[2], Way::inflow) == Catch::Approx(way).epsilon(1e-12));
  CHECK(at(book[1], Way::outflow) == Catch::Approx(-0.43 * way).epsilon(1e-12));
  CHECK(at(book[0], Way::outflow) == Catch::Approx(-0.57 * way).epsilon(1e-12));
  for (const Exchange& e : book)
    CHECK(at(e, Way::closed) == 0);
}

TEST_CASE(
    "volumes at boundaries: a free surface gains void, or more of what is "
    "there",
    "[materials][transport]")
{
  const bool void_beyond = GENERATE(true, false);
  Box box;
  // The top goes up by a wave: some is gained, some lost.
  std::vector<double> to = box.data.x;
  for (std::size_t i = 0; i < to.size(); i += 2)
    if (to[i + 1] == 1)
      to[i + 1] += 0.3 * h * std::sin(2 * std::numbers::pi * to[i]);
  std::vector<double> before(3);
  for (int k = 0; k < 3; ++k)
    before[k] = box.volume(box.data.x, k);
  REQUIRE(box.carry(
              to, {.boundaries = {Boundary::closed, Boundary::closed,
                                  Boundary::free_surface, Boundary::closed},
                   .beyond = void_beyond ? std::vector<std::int32_t>{-1, -1, 2}
                                         : std::vector<std::int32_t>{}})
          == Outcome::ok);
  // What is between the polygon through the nodes of the wave and the line.
  double half = 0;
  for (int i = 0; i < n / 2; ++i)
    half += 0.5 * h * 0.3 * h
            * (std::sin(2 * std::numbers::pi * i * h)
               + std::sin(2 * std::numbers::pi * (i + 1) * h));
  const auto& book = box.ledger.volume;
  const int gains = void_beyond ? 2 : 0;
  CHECK(at(book[gains], Way::gained) == Catch::Approx(half).epsilon(1e-12));
  CHECK(at(book[0], Way::lost) == Catch::Approx(-half).epsilon(1e-12));
  for (int k = 0; k < 3; ++k)
    CHECK(std::abs(box.volume(to, k) - before[k] - net(book[k])) < 1e-14);
}

TEST_CASE("volumes at boundaries: nodes that slide on a straight wall book "
          "nothing, on a curved one what is left over",
          "[materials][transport]")
{
  const bool curved = GENERATE(true, false);
  Box box;
  const auto wall = [curved](double x, double y)
  { return curved ? y * (1 + 0.1 * std::sin(std::numbers::pi * x)) : y; };
  std::vector<double> to = box.data.x;
  for (std::size_t i = 0; i < to.size(); i += 2)
  {
    const double x = to[i], y = to[i + 1];
    const double s = x + 0.3 * h * std::sin(std::numbers::pi * x);
    box.data.x[i + 1] = wall(x, y);
    to[i] = s;
    to[i + 1] = wall(s, y);
  }
  const auto layer = shapes::part_in(shapes::everything<Geometry::plane>,
                                     {{{1, 0.2}, {0.43, 0}}});
  box.materials =
      shapes::lay(box.mesh, box.data.x, {layer, shapes::disc({9, 9}, 0.1)});
  std::vector<double> before(3);
  for (int k = 0; k < 3; ++k)
    before[k] = box.volume(box.data.x, k);
  REQUIRE(box.carry(to, {}) == Outcome::ok);
  for (int k = 0; k < 3; ++k)
  {
    const Exchange& e = box.ledger.volume[k];
    CHECK(std::abs(box.volume(to, k) - before[k] - net(e)) < 1e-14);
    CHECK(net(e) == at(e, Way::closed));
    if (curved and k < 2)
      CHECK(std::abs(net(e)) > 1e-6);
    else
      CHECK(net(e) == 0);
  }
}

TEST_CASE("volumes: slivers go to a neighbour against the same volume, or are "
          "kept and counted",
          "[materials][transport]")
{
  const auto data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const bool company = GENERATE(true, false);
  Materials m(mesh.num_cells(), 2);
  const auto add = [&](std::int32_t c, double fraction)
  {
    const auto [i, j, k] = mesh.cell(c);
    const Point g =
        1.0 / 3 * (point(data.x, i) + point(data.x, j) + point(data.x, k));
    m.add_row(c, std::vector<Part>{{0, 1 - fraction, g}, {1, fraction, g}});
  };
  const std::int32_t small = 90, large = mesh.cell_cells()[small][0];
  add(small, 3e-12);
  if (company)
    add(large, 0.3);
  const double before = eulerian::volume(mesh, Geometry::plane, data.x, m, 1);
  const double v = 0.5 * h * h;
  const auto report =
      sweep_slivers(mesh, m, 1e-10, [v](std::int32_t) { return v; }, {});
  CHECK(report.swept == (company ? 1 : 0));
  CHECK(report.kept == (company ? 0 : 1));
  CHECK(m.pure(small) == (company ? 0 : -1));
  CHECK(report.volume == Catch::Approx(company ? 3e-12 * v : 0).epsilon(1e-12));
  CHECK(std::abs(eulerian::volume(mesh, Geometry::plane, data.x, m, 1) - before)
        < 1e-17);
}

TEST_CASE("volumes: outcomes, with everything as it was",
          "[materials][transport]")
{
  Box box;
  const Materials start = box.materials;
  auto to = meshes::shaken(box.data.x, 0.2 * h, 1);
  Outcome wanted = Outcome::ok;
  SECTION("too few nodes")
  {
    to.pop_back();
    wanted = Outcome::wrong_size;
  }
  SECTION("a node nowhere")
  {
    to[100] = std::numeric_limits<double>::quiet_NaN();
    wanted = Outcome::not_finite;
  }
  SECTION("a cell of the interface turned over")
  {
    const std::int32_t c = start.mixed()[3];
    const auto [i, j, k] = box.mesh.cell(c);
    const Point p = point(to, i), a = point(to, j), b = point(to, k);
    const Point over = p + 1.5 * (a + b - 2.0 * p);
    to[2 * i] = over.x, to[2 * i + 1] = over.y;
    wanted = Outcome::inverted_target;
  }
  CHECK(box.carry(to, {}) == wanted);
  if (wanted == Outcome::inverted_target)
    CHECK(box.report.worst_cell >= 0);
  if (wanted == Outcome::ok)
    return;
  REQUIRE(box.materials.mixed().size() == start.mixed().size());
  for (std::int32_t c = 0; c < start.num_cells(); ++c)
    CHECK(box.materials.fraction(c, 1) == start.fraction(c, 1));
  CHECK(box.ledger.volume.empty());
  CHECK_THROWS_AS(VolumeTransport(box.mesh, {.sliver = 0.5}),
                  std::invalid_argument);
}
