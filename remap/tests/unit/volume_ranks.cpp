// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials on ranks: the same as on one, or the outcome that says that the
// halo is too thin.

#include "remap/tests/eulerian.h"
#include "remap/tests/ranks.h"
#include "remap/tests/shapes.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;

namespace
{
constexpr int n = 16;

struct Start
{
  meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  bool open = false;
  double courant = 0.5;
};

/// Parts of owned cells by global number, and how it ended.
struct Result
{
  Outcome outcome = Outcome::ok;
  std::map<std::int64_t, std::vector<Part>> cells;
  std::vector<Exchange> book;
  std::int64_t swept = 0;
};

Result run(const Start& start, const ranks::Part& part, const Host& host)
{
  const Mesh mesh = part.mesh();
  const auto x = ranks::Part::take(start.data.x, part.nodes, 2);
  auto bodies = shapes::quarters({0.5, 0.7}, 0.2);
  eulerian::Options options{.volumes = {.sliver = 1e-3}};
  if (start.open)
  {
    options.volumes.boundaries = std::vector(4, Boundary::open);
    options.volumes.beyond = {0, 1, 2, 3};
  }
  // Ghosts too: every rank knows the shapes.
  eulerian::Run run(mesh, x, shapes::lay(mesh, x, bodies), options, host);
  const auto flow =
      start.open ? eulerian::rotation({0.5, 0.5}) : eulerian::vortex(2);
  const double speed = start.open ? std::numbers::pi * std::sqrt(2.0) : 1;
  constexpr int steps = 12;
  Result out;
  for (int k = 0; k < steps and out.outcome == Outcome::ok; ++k)
  {
    const double dt = start.courant / n / speed;
    out.outcome = run.step(flow, k * dt, dt);
    out.swept += run.transport.report().slivers_swept;
  }
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
  {
    auto& parts = out.cells[part.cells[c]];
    if (run.materials.row(c) < 0)
      parts.push_back({run.materials.pure(c), 1, {}});
    else
      for (const Part& p : run.materials.parts(run.materials.row(c)))
        parts.push_back(p);
  }
  out.book = run.ledger.volume;
  return out;
}

std::vector<int> deal(const meshes::Data& data, int size, bool stripes)
{
  std::mt19937 engine(99);
  std::vector<int> out;
  for (std::size_t c = 0; c < data.cells.size(); c += 3)
  {
    const double at = stripes ? data.x[2 * data.cells[c] + 1]
                              : std::generate_canonical<double, 32>(engine);
    out.push_back(std::min(size - 1, static_cast<int>(at * size)));
  }
  return out;
}

std::vector<Result> run_on(const Start& start, int size, bool stripes)
{
  ranks::World world(start.data, deal(start.data, size, stripes), size);
  std::vector<Result> out(size);
  world.run([&](int r, const ranks::Part& p, const Host& host)
            { out[r] = run(start, p, host); });
  return out;
}
} // namespace

TEST_CASE(
    "volumes on ranks: materials, centroids and ledger equal those of one "
    "process",
    "[materials][ranks]")
{
  const int size = GENERATE(2, 3);
  const bool stripes = GENERATE(true, false);
  const bool open = GENERATE(false, true);
  INFO("size " << size << " stripes " << stripes << " open " << open);
  Start start;
  start.open = open;
  const Result alone = run_on(start, 1, true)[0];
  REQUIRE(alone.outcome == Outcome::ok);
  REQUIRE(alone.swept > 0);
  double inflow = 0;
  for (const Exchange& e : alone.book)
    inflow += e[static_cast<std::size_t>(Way::inflow)];
  CHECK((inflow > 1e-3) == open);
  std::int64_t swept = 0;
  for (const Result& r : run_on(start, size, stripes))
  {
    REQUIRE(r.outcome == Outcome::ok);
    swept += r.swept;
    for (std::size_t k = 0; k < alone.book.size(); ++k)
      for (std::size_t w = 0; w < num_ways; ++w)
        CHECK(std::abs(r.book[k][w] - alone.book[k][w]) < 1e-13);
    for (const auto& [c, parts] : r.cells)
    {
      const auto& wanted = alone.cells.at(c);
      REQUIRE(parts.size() == wanted.size());
      for (std::size_t k = 0; k < parts.size(); ++k)
      {
        CHECK(parts[k].material == wanted[k].material);
        CHECK(std::abs(parts[k].fraction - wanted[k].fraction) < 1e-13);
        const Point d = parts[k].centroid - wanted[k].centroid;
        CHECK(parts[k].fraction * std::hypot(d.x, d.y) < 1e-13);
      }
    }
  }
  CHECK(swept == alone.swept);
}

TEST_CASE(
    "volumes on ranks: a move beyond the halo is an outcome, on all ranks",
    "[materials][ranks]")
{
  Start start;
  start.courant = 2;
  CHECK(run_on(start, 1, true)[0].outcome == Outcome::ok);
  for (const Result& r : run_on(start, 3, true))
    CHECK(r.outcome == Outcome::beyond_halo);
}
