// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The same answer on one, two and three ranks, however the cells are dealt out.

#include "remap/tests/ranks.h"
#include "remap/remap.h"
#include "remap/smoothing/boundary_curve.h"
#include "remap/smoothing/smooth.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using meshes::Diagonal;

namespace
{
constexpr int n = 10;

/// What a run leaves, in global numbers.
struct Result
{
  std::vector<double> x, cells, points, nodes, velocity;
  Ledger ledger;
  int cycles = 0;
};

/// What all ranks start from.
struct Start
{
  Geometry geometry;
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  std::vector<double> x = meshes::shaken(data.x, 0.02, 7);
  std::vector<double> cells, points, nodes, velocity;
  Scheme scheme;
  std::vector<Kind> kinds;
  std::vector<double> direction;

  Start(Geometry g, Scheme s) : geometry(g), scheme(s)
  {
    std::mt19937 engine(8);
    std::uniform_real_distribution<double> draw(0.0, 1.0);
    cells.resize(6 * data.cells.size() / 3);
    points.resize(3 * 4 * data.cells.size() / 3);
    nodes.resize(3 * data.x.size() / 2);
    velocity.resize(2 * data.x.size() / 2);
    for (auto* field : {&cells, &points, &nodes, &velocity})
      std::generate(field->begin(), field->end(),
                    [&] { return 0.1 + draw(engine); });
    for (std::size_t i = 0; i < data.x.size(); i += 2)
    {
      const Point p = {data.x[i], data.x[i + 1]};
      const bool vertical = p.x == 0 or p.x == 1;
      kinds.push_back(p.y == 1 and not vertical   ? Kind::surface
                      : not meshes::on_outline(p) ? Kind::free
                      : vertical != (p.y == 0)    ? Kind::slide
                                                  : Kind::fixed);
      direction.push_back(vertical ? 0 : 1);
      direction.push_back(vertical ? 1 : 0);
    }
  }
};

/// Smooth what is bad, then carry the fields; three times.
Result smooth_and_remap(const Start& start, const ranks::Part& part,
                        const Host& host)
{
  const Mesh mesh = part.mesh();
  Smoothing smoothing(
      mesh, {.geometry = start.geometry, .threshold = 0.75, .sweeps = 3}, host);
  Result out;
  out.x = ranks::Part::take(start.x, part.nodes, 2);
  const PointMesh points(mesh, {{0, 1}, {1, 2}, {2, 0}}, part.data.x);
  Remapper remapper(mesh, {.geometry = start.geometry,
                           .scheme = start.scheme,
                           .nodal_scheme = start.scheme,
                           .max_loss = 0.2,
                           .boundaries = std::vector(4, Boundary::free_surface),
                           .points = &points,
                           .cell_components = 5,
                           .point_components = 4,
                           .nodal_components = 3,
                           .per_mass = true});
  const auto all_cells = ranks::Part::take(start.cells, part.cells, 6);
  std::vector<double> density;
  for (std::size_t i = 0; i < all_cells.size(); ++i)
    (i % 6 == 0 ? density : out.cells).push_back(all_cells[i]);
  out.points = ranks::Part::take(start.points, part.cells, 12);
  out.velocity = ranks::Part::take(start.velocity, part.nodes, 2);
  out.nodes = ranks::Part::take(start.nodes, part.nodes, 3);
  const auto spacing =
      facet_lengths(mesh, ranks::Part::take(start.data.x, part.nodes, 2));
  const auto direction = ranks::Part::take(start.direction, part.nodes, 2);
  std::vector<Kind> kinds;
  for (std::int64_t i : part.nodes)
    kinds.push_back(start.kinds[i]);
  std::vector<std::uint8_t> flags(mesh.num_nodes());
  for (int k = 0; k < 3; ++k)
  {
    // The body moves with its cells, walls stay; then it is remapped.
    for (std::size_t i = 0; i < out.x.size(); i += 2)
    {
      const double s = 0.02 * std::sin(3 * out.x[i] + 2 * k)
                       * std::sin(std::numbers::pi * out.x[i + 1]);
      if (kinds[i / 2] == Kind::free)
        out.x[i] += s, out.x[i + 1] -= s;
    }
    auto to = out.x;
    smoothing.flag(to, {}, flags, host);
    const Outcome smoothed = smoothing.smooth(
        to, flags, {.kinds = kinds, .direction = direction, .spacing = spacing},
        host);
    // A tensor over points, a vector per mass, and scalars that need a repair.
    const std::vector<double> low(5, 0.1), high(5, 1.1);
    const Field cells[] = {
        {.values = density},
        {.values = out.cells, .components = 5, .least = low, .most = high}};
    const Field in_points{.values = out.points, .components = 4, .group = 4};
    const Field nodes{.values = out.nodes, .components = 3};
    const Field velocity{.values = out.velocity, .components = 2, .group = 2};
    const Outcome carried = remapper.remap(out.x, to,
                                           {.cells = cells,
                                            .points = {&in_points, 1},
                                            .nodes = {&nodes, 1},
                                            .per_mass = {&velocity, 1},
                                            .density = 0},
                                           host, out.ledger);
    if (smoothed != Outcome::ok or carried != Outcome::ok)
      out.cycles = -1000; // Catch's checks are not for threads
    out.x = to;
    out.cycles += remapper.report().cycles;
  }
  return out;
}

/// Largest difference of owned rows, in global numbers.
double gap(std::span<const double> all, std::span<const double> part,
           std::span<const std::int64_t> ids, int block)
{
  double out = 0;
  for (std::size_t i = 0; i < ids.size(); ++i)
    for (int k = 0; k < block; ++k)
      out = std::max(out,
                     std::abs(all[block * ids[i] + k] - part[block * i + k]));
  return out;
}
} // namespace

TEST_CASE("ranks: positions, fields and ledger do not depend on their number",
          "[ranks]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const int size = GENERATE(2, 3);
  const int how = GENERATE(0, 1, 2);
  INFO("size " << size << ", dealt " << how);
  const Scheme scheme =
      GENERATE(Scheme(scheme::LimitedLinear{}), Scheme(scheme::SmoothExtrema{}),
               Scheme(scheme::VanLeer{}), Scheme(scheme::Linear{}));
  const Start start(geometry, scheme);
  INFO(name_of(scheme));
  ranks::World one(start.data, ranks::deal(start.data, 1, 0), 1);
  Result alone;
  one.run([&](int, const ranks::Part& p, const Host& host)
          { alone = smooth_and_remap(start, p, host); });
  REQUIRE(alone.cycles > 0);
  // Back to global numbers: the parts are shuffled.
  const auto unshuffled = [](std::span<const double> v,
                             std::span<const std::int64_t> ids, int block)
  {
    std::vector<double> out(v.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
      std::copy_n(v.begin() + block * i, block, out.begin() + block * ids[i]);
    return out;
  };
  const ranks::Part& whole = one.parts[0];
  const auto x = unshuffled(alone.x, whole.nodes, 2);
  const auto cells = unshuffled(alone.cells, whole.cells, 5);
  const auto points = unshuffled(alone.points, whole.cells, 12);
  const auto velocity = unshuffled(alone.velocity, whole.nodes, 2);
  const auto nodes = unshuffled(alone.nodes, whole.nodes, 3);
  // It did something.
  REQUIRE(gap(start.x, alone.x, whole.nodes, 2) > 1e-3);

  ranks::World world(start.data, ranks::deal(start.data, size, how), size);
  std::vector<Result> results(size);
  world.run([&](int r, const ranks::Part& p, const Host& host)
            { results[r] = smooth_and_remap(start, p, host); });
  for (int r = 0; r < size; ++r)
  {
    const ranks::Part& p = world.parts[r];
    CHECK(results[r].cycles == alone.cycles);
    // Sums around a node run in global order: not even round-off differs.
    CHECK(gap(x, results[r].x, p.nodes, 2) == 0);
    // Ghosts too are as their owners have them.
    CHECK(gap(cells, results[r].cells, p.cells, 5) < 1e-13);
    CHECK(gap(points, results[r].points, p.cells, 12) < 1e-13);
    CHECK(gap(velocity, results[r].velocity, p.nodes, 2) < 1e-13);
    CHECK(gap(nodes, results[r].nodes, p.nodes, 3) < 1e-13);
    for (int k = 0; k < 2; ++k)
      CHECK(
          std::abs(net(results[r].ledger.cells[k]) - net(alone.ledger.cells[k]))
          < 1e-13);
    for (int k = 0; k < 3; ++k)
      CHECK(
          std::abs(net(results[r].ledger.nodes[k]) - net(alone.ledger.nodes[k]))
          < 1e-13);
  }
}

TEMPLATE_LIST_TEST_CASE("ranks: every smoother and kind of node, from a tangle",
                        "[ranks]", Smoothers)
{
  // A bulging top is a curve, the left side slides, the rest stays; inner nodes
  // are shaken by a cell's breadth, so that cells are inverted.
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  auto x = meshes::shaken(data.x, 1.0 / n, 12);
  std::vector<Kind> kinds;
  std::vector<double> direction;
  for (std::size_t i = 0; i < x.size(); i += 2)
  {
    const Point p = {data.x[i], data.x[i + 1]};
    x[i + 1] *= 1 + 0.2 * std::sin(std::numbers::pi * p.x);
    const bool corner = (p.x == 0 or p.x == 1) and (p.y == 0 or p.y == 1);
    kinds.push_back(not meshes::on_outline(p) ? Kind::free
                    : p.y == 1 and not corner ? Kind::curve
                    : p.x == 0 and not corner ? Kind::slide
                                              : Kind::fixed);
    direction.insert(direction.end(), {0.0, 1.0});
  }
  const auto run = [&](const ranks::Part& part, const Host& host)
  {
    const Mesh mesh = part.mesh();
    auto at = ranks::Part::take(x, part.nodes, 2);
    const auto along = ranks::Part::take(direction, part.nodes, 2);
    std::vector<Kind> local;
    for (std::int64_t i : part.nodes)
      local.push_back(kinds[i]);
    BoundaryCurve curve(mesh);
    curve.follow(at, local, host);
    Smoothing smoothing(mesh,
                        {.smoother = TestType{},
                         .threshold = 0.2,
                         .sweeps = 4,
                         .relaxation = 1.3},
                        host);
    const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
    const Outcome o = smoothing.smooth(
        at, flags, {.kinds = local, .direction = along, .guide = &curve}, host);
    // Catch's checks are not for threads.
    if (o != Outcome::ok or not(smoothing.report().worst_before < 0)
        or not(smoothing.report().worst_after > 0.01))
      at.clear();
    return at;
  };
  ranks::World one(data, ranks::deal(data, 1, 0), 1);
  std::vector<double> alone(x.size());
  one.run(
      [&](int, const ranks::Part& p, const Host& host)
      {
        const auto at = run(p, host);
        for (std::size_t i = 0; i < at.size(); ++i)
          alone[2 * p.nodes[i / 2] + i % 2] = at[i];
      });
  REQUIRE(gap(x, alone, one.parts[0].nodes, 2) > 1e-3);
  const int size = GENERATE(2, 3);
  const int how = GENERATE(0, 2);
  ranks::World world(data, ranks::deal(data, size, how), size);
  std::vector<std::vector<double>> at(size);
  world.run([&](int r, const ranks::Part& p, const Host& host)
            { at[r] = run(p, host); });
  for (int r = 0; r < size; ++r)
  {
    REQUIRE(not at[r].empty());
    CHECK(gap(alone, at[r], world.parts[r].nodes, 2) == 0);
  }
}
