// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/relax.h"
#include "remap/remap.h"
#include "remap/tests/meshes.h"
#include "remap/tests/ranks.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// Largest loss of a cell as the transport finds it, in one sub-cycle.
double loss_of(const Mesh& mesh, Geometry geometry,
               std::span<const double> from, std::span<const double> to,
               double max_loss = 1e9)
{
  Remapper remapper(mesh, {.geometry = geometry,
                           .max_loss = max_loss,
                           .boundaries = std::vector(4, Boundary::closed)});
  std::vector<double> u(mesh.num_cells(), 1.0);
  const Field field{.values = u};
  Ledger ledger;
  REQUIRE(remapper.remap(from, to, {&field, 1}, {}, {}, ledger) == Outcome::ok);
  return remapper.report().loss;
}
} // namespace

TEST_CASE("relax: one node between two places, known by hand", "[relax]")
{
  // The unit square in two, its middle node of four cells goes to the right by
  // 0.8 of the way to the wall: the right cell (base 1, height 1/2) loses
  // 0.8 of itself, and half as far 0.4.
  const meshes::Data data = meshes::rectangle(1, 1, Diagonal::four);
  const Mesh mesh = data.mesh();
  auto to = data.x;
  to[8] += 0.4;
  const Relaxation full = relax(mesh, Geometry::plane, 0.9, data.x, to, {});
  CHECK(full.part == 1);
  CHECK(full.loss == Approx(0.8).epsilon(1e-14));
  CHECK(to[8] == data.x[8] + 0.4);
  const Relaxation half = relax(mesh, Geometry::plane, 0.4, data.x, to, {});
  CHECK(half.part == Approx(0.5).epsilon(1e-9));
  CHECK(to[8] == Approx(data.x[8] + 0.2).epsilon(1e-9));
  CHECK(to[9] == data.x[9]);
}

TEST_CASE("relax: as far as the stated loss, and no farther", "[relax]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  const meshes::Data data = meshes::rectangle(10, 10, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto far = meshes::shaken(data.x, 0.03, seed);
  const double loss = loss_of(mesh, geometry, data.x, far);
  REQUIRE(loss > 0.5);
  for (double most : {0.05, 0.2, 0.4})
  {
    auto to = far;
    const Relaxation r = relax(mesh, geometry, most, data.x, to, {});
    // The transport's own loss is the judge.
    CHECK(r.loss == Approx(loss).epsilon(1e-12));
    CHECK(r.part < 1);
    CHECK(loss_of(mesh, geometry, data.x, to) == Approx(most).epsilon(1e-9));
    for (std::size_t i = 0; i < to.size(); ++i)
      CHECK(to[i]
            == Approx(data.x[i] + r.part * (far[i] - data.x[i])).margin(1e-15));
  }
}

TEST_CASE("relax: a way through inverted cells is left in time", "[relax]")
{
  // Shaken by a cell's breadth: the places are inverted. The transport cannot
  // go there; it can go where `relax` stops.
  const meshes::Data data = meshes::rectangle(10, 10, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  auto to = meshes::shaken(data.x, 0.1, 5);
  Remapper remapper(mesh, {.boundaries = std::vector(4, Boundary::closed)});
  std::vector<double> u(mesh.num_cells(), 1.0);
  const Field field{.values = u};
  Ledger ledger;
  CHECK(remapper.remap(data.x, to, {&field, 1}, {}, {}, ledger)
        == Outcome::inverted_target);
  const Relaxation r = relax(mesh, Geometry::plane, 0.9, data.x, to, {});
  CHECK(r.loss == std::numeric_limits<double>::infinity());
  CHECK(r.part > 0.01);
  CHECK(loss_of(mesh, Geometry::plane, data.x, to)
        == Approx(0.9).epsilon(1e-9));
}

TEST_CASE("relax: the same on any number of ranks", "[relax][ranks]")
{
  const meshes::Data data = meshes::rectangle(12, 12, Diagonal::crossed);
  const auto far = meshes::shaken(data.x, 0.03, 9);
  auto alone = far;
  const Relaxation r =
      relax(data.mesh(), Geometry::plane, 0.2, data.x, alone, {});
  REQUIRE(r.part < 1);
  const int size = GENERATE(2, 3);
  std::vector<int> owner;
  for (std::size_t c = 0; c < data.cells.size() / 3; ++c)
    owner.push_back(static_cast<int>(c * 7 % std::size_t(size)));
  ranks::World world(data, owner, size);
  std::vector<std::uint8_t> same(size, 1);
  world.run(
      [&](int rank, const ranks::Part& part, const Host& host)
      {
        auto to = ranks::Part::take(far, part.nodes, 2);
        const Relaxation one =
            relax(part.mesh(), Geometry::plane, 0.2,
                  ranks::Part::take(data.x, part.nodes, 2), to, host);
        if (one.part != r.part or one.loss != r.loss
            or to != ranks::Part::take(alone, part.nodes, 2))
          same[rank] = 0;
      });
  for (int k = 0; k < size; ++k)
    CHECK(same[k] == 1);
}
