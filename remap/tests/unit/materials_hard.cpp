// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials where something is missing or out of proportion: no gradient, no
// mass, cells of very different sizes, options that cannot hold.

#include "remap/domain/partial_volumes.h" // beside remap.h, in one file
#include "remap/materials/volume_transport.h"
#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>

#include <cmath>
#include <numeric>

using namespace remap;
using meshes::Diagonal;

namespace
{
Point middle_of(const Mesh& mesh, std::span<const double> x, std::int32_t c)
{
  const Triple& n = mesh.cell(c);
  return 1.0 / 3 * (point(x, n[0]) + point(x, n[1]) + point(x, n[2]));
}

/// Half of each of two materials in a cell, on one place.
void halve(Materials& m, const Mesh& mesh, std::span<const double> x,
           std::int32_t c)
{
  const Point g = middle_of(mesh, x, c);
  const Part parts[] = {{0, 0.5, g}, {1, 0.5, g}};
  m.add_row(c, parts);
}

/// Volume of each of two materials.
std::array<double, 2> volumes(const Materials& m, const Mesh& mesh,
                              std::span<const double> x)
{
  std::array<double, 2> out{};
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Triple& n = mesh.cell(c);
    const double v =
        twice_area(point(x, n[0]), point(x, n[1]), point(x, n[2])) / 2;
    for (int k = 0; k < 2; ++k)
      out[k] += m.fraction(c, k) * v;
  }
  return out;
}
} // namespace

TEST_CASE("interfaces: where no neighbour tells a direction there is a cut all "
          "the same, and volumes stay",
          "[remap][materials]")
{
  const auto name = GENERATE(from_range(names<Reconstructions>()));
  INFO(name);
  const meshes::Data data = meshes::rectangle(6, 6, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  Materials m(mesh.num_cells(), 2);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    halve(m, mesh, data.x, c);
  Interfaces interfaces(mesh, {.method = *find<Reconstructions>(name)});
  interfaces.reconstruct(data.x, m, {});
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const Partition& by = interfaces.partition(static_cast<std::int32_t>(r));
    for (int k = 0; k < by.count; ++k)
    {
      const HalfPlane& h = by.cuts[static_cast<std::size_t>(k)].plane;
      REQUIRE(std::isfinite(h.normal.x + h.normal.y + h.at.x + h.at.y));
    }
  }
  VolumeTransport transport(mesh, {});
  MaterialLedger ledger;
  const auto y = meshes::shaken(data.x, 0.2 / 6, 1);
  REQUIRE(transport.carry(data.x, y, {}, interfaces.partitions(), m, {}, ledger)
          == Outcome::ok);
  for (const double v : volumes(m, mesh, y))
    CHECK(std::abs(v - 0.5) < 1e-13);
}

TEST_CASE("volumes: slivers between cells of very different sizes",
          "[remap][materials]")
{
  // Columns that grow by 100 times to the right.
  meshes::Data data = meshes::rectangle(4, 4, Diagonal::crossed);
  for (std::size_t i = 0; i < data.x.size(); i += 2)
    data.x[i] = std::pow(100.0, std::round(4 * data.x[i])) - 1;
  const Mesh mesh = data.mesh();
  Materials m(mesh.num_cells(), 2);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Point g = middle_of(mesh, data.x, c);
    const double few = c % 2 == 0 ? 1e-3 : 0.1;
    const Part parts[] = {{0, 1 - few, g}, {1, few, g}};
    m.add_row(c, parts);
  }
  const auto before = volumes(m, mesh, data.x);
  Interfaces interfaces(mesh, {});
  interfaces.reconstruct(data.x, m, {});
  VolumeTransport transport(mesh, {.sliver = 5e-3});
  MaterialLedger ledger;
  REQUIRE(transport.carry(data.x, data.x, {}, interfaces.partitions(), m, {},
                          ledger)
          == Outcome::ok);
  CHECK(transport.report().slivers_swept > 0);
  const auto after = volumes(m, mesh, data.x);
  for (std::size_t k = 0; k < 2; ++k)
    CHECK(std::abs(after[k] - before[k]) < 1e-13 * (before[0] + before[1]));
}

TEST_CASE("volumes: options and materials that cannot be are refused",
          "[remap][materials]")
{
  const meshes::Data data = meshes::rectangle(4, 4, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto outcome = [&](const auto& spoil, VolumeOptions options)
  {
    Materials m(mesh.num_cells(), 2);
    halve(m, mesh, data.x, 5);
    Interfaces interfaces(mesh, {});
    interfaces.reconstruct(data.x, m, {});
    spoil(m);
    VolumeTransport transport(mesh, std::move(options));
    MaterialLedger ledger;
    return transport.carry(data.x, data.x, {}, interfaces.partitions(), m, {},
                           ledger);
  };
  const auto nothing = [](Materials&) {};
  CHECK(outcome(nothing, {}) == Outcome::ok);
  CHECK(outcome(nothing, {.beyond = {2}}) == Outcome::wrong_size);
  CHECK(outcome(nothing, {.beyond = {-2}}) == Outcome::wrong_size);
  CHECK(outcome([](Materials& m) { m.parts(0)[0].fraction = 0.25; }, {})
        == Outcome::bad_materials);
  CHECK(outcome([](Materials& m) { m.parts(0)[0].fraction = std::nan(""); }, {})
        == Outcome::bad_materials);
  CHECK(outcome([](Materials& m) { m.parts(0)[1].centroid.x = 7; }, {})
        == Outcome::bad_materials);
  CHECK(outcome([](Materials& m) { m.set_pure(0, 2); }, {})
        == Outcome::bad_materials);
  Materials m(mesh.num_cells(), 9);
  const std::vector<Part> many(9, {0, 1.0 / 9, {}});
  CHECK_THROWS_AS(m.add_row(0, many), std::invalid_argument);
  CHECK_THROWS_AS(m.add_row(0, std::span(many).first(1)),
                  std::invalid_argument);
}

TEST_CASE(
    "materials: velocities in a void without mass are refused, and losses "
    "beyond what a cell has",
    "[remap][materials]")
{
  const meshes::Data data = meshes::rectangle(6, 6, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  Materials m(mesh.num_cells(), 2);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    if (middle_of(mesh, data.x, c).y > 0.5)
      m.set_pure(c, 1);
  const Options options{
      .nodal_components = 2, .per_mass = true, .materials = {.number = 2}};
  std::vector<double> rho(mesh.num_cells(), 1000), v(2 * mesh.num_nodes(), 1);
  const std::vector<std::uint8_t> solid = {1, 0};
  const auto kept = v;
  const MaterialField field{.values = rho, .carriers = solid};
  const Field velocity{.values = v, .components = 2, .group = 2};
  Remapper remapper(mesh, options);
  Ledger ledger;
  CHECK(remapper.remap(data.x, meshes::shaken(data.x, 0.03, 1),
                       {.per_mass = {&velocity, 1},
                        .materials = &m,
                        .of_materials = {&field, 1},
                        .material_density = 0},
                       {}, ledger)
        == Outcome::no_mass);
  CHECK(v == kept);
  CHECK_THROWS_AS(Remapper(mesh, {.max_loss = 2, .materials = {.number = 2}}),
                  std::invalid_argument);
}
