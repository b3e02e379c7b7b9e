// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <limits>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// Unit square, one cell field, all sides with one kind of boundary.
struct Square
{
  meshes::Data data = meshes::rectangle(4, 4, Diagonal::crossed);
  Mesh mesh = data.mesh();
  std::vector<double> u = std::vector<double>(mesh.num_cells(), 1.0);
  std::vector<double> inflow = std::vector<double>(4, 0.0);
  Ledger ledger;

  Outcome run(std::span<const double> to, Options options)
  {
    Remapper remapper(mesh, std::move(options));
    const Field field{.values = u, .inflow = inflow};
    const Outcome out = remapper.remap(data.x, to, {&field, 1}, {}, {}, ledger);
    report = remapper.report();
    return out;
  }
  Report report;

  /// The square stretched by a factor about its lower left corner.
  [[nodiscard]] std::vector<double> stretched(double sx, double sy) const
  {
    std::vector<double> out = data.x;
    for (std::size_t i = 0; i < out.size(); i += 2)
      out[i] *= sx, out[i + 1] *= sy;
    return out;
  }
  [[nodiscard]] double mass(std::span<const double> x) const
  {
    std::vector<double> v(mesh.num_cells());
    cell_volumes(mesh, Geometry::plane, x, v);
    double sum = 0;
    for (std::size_t c = 0; c < v.size(); ++c)
      sum += v[c] * u[c];
    return sum;
  }
};
} // namespace

TEST_CASE("remapper: a free surface gains the volume's own value", "[remap]")
{
  Square s;
  const auto to = s.stretched(1, 1.05);
  REQUIRE(s.run(to, {.boundaries = std::vector(4, Boundary::free_surface)})
          == Outcome::ok);
  for (double u : s.u)
    CHECK(u == Approx(1).epsilon(1e-14));
  const auto gained = s.ledger.cells[0][std::size_t(Way::gained)];
  CHECK(gained == Approx(0.05).epsilon(1e-13));
  CHECK(s.ledger.cell_volume[std::size_t(Way::gained)]
        == Approx(0.05).epsilon(1e-13));
  // Sides stretch in their own line: nothing passes them.
  CHECK(std::abs(net(s.ledger.cells[0]) - gained) < 1e-15);
}

TEST_CASE("remapper: an open boundary takes the inflow given for its marker",
          "[remap]")
{
  Square s;
  s.inflow = {7, 7, 3, 7}; // 3 over the top
  const auto to = s.stretched(1, 1.05);
  REQUIRE(s.run(to, {.boundaries = std::vector(4, Boundary::open)})
          == Outcome::ok);
  CHECK(s.ledger.cells[0][std::size_t(Way::inflow)]
        == Approx(3 * 0.05).epsilon(1e-13));
  CHECK(s.mass(to) == Approx(1.15).epsilon(1e-13));
}

TEST_CASE("remapper: what leaves over an open boundary is booked", "[remap]")
{
  Square s;
  std::iota(s.u.begin(), s.u.end(), 1.0);
  const double before = s.mass(s.data.x);
  const auto to = s.stretched(0.97, 1);
  REQUIRE(s.run(to, {.boundaries = std::vector(4, Boundary::open)})
          == Outcome::ok);
  const auto out = s.ledger.cells[0][std::size_t(Way::outflow)];
  CHECK(out < 0);
  CHECK(s.ledger.cell_volume[std::size_t(Way::outflow)]
        == Approx(-0.03).epsilon(1e-13));
  CHECK(s.mass(to) == Approx(before + net(s.ledger.cells[0])).epsilon(1e-14));
}

TEST_CASE("remapper: sliding along walls leaves round-off in the book",
          "[remap]")
{
  Square s;
  std::vector<double> to = s.data.x;
  for (std::size_t i = 0; i < to.size() / 2; ++i)
    if (to[2 * i] > 0 and to[2 * i] < 1)
      to[2 * i] += 0.05;
  REQUIRE(s.run(to, {.boundaries = std::vector(4, Boundary::closed)})
          == Outcome::ok);
  for (double part : s.ledger.cells[0])
    CHECK(std::abs(part) < 1e-16);
}

TEST_CASE("remapper: volumes beside no moved node keep every bit", "[remap]")
{
  const meshes::Data data = meshes::rectangle(20, 20, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  Remapper remapper(mesh, {.nodal_components = 1});
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> draw(1.0, 2.0);
  std::vector<double> u(mesh.num_cells()), w(mesh.num_nodes());
  std::generate(u.begin(), u.end(), [&] { return draw(engine); });
  std::generate(w.begin(), w.end(), [&] { return draw(engine); });
  const auto u0 = u, w0 = w;
  std::vector<double> to = data.x;
  const std::int32_t moved = 10 * 21 + 10;
  to[2 * moved] += 0.01;
  const Field cells{.values = u}, nodes{.values = w};
  Ledger ledger;
  REQUIRE(remapper.remap(data.x, to, {&cells, 1}, {&nodes, 1}, {}, ledger)
          == Outcome::ok);
  const auto around = mesh.node_cells()[moved];
  CHECK(remapper.report().moved_nodes == 1);
  CHECK(remapper.report().touched_cells
        == static_cast<std::int32_t>(around.size()));
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    if (std::find(around.begin(), around.end(), c) == around.end())
      CHECK(u[c] == u0[c]);
    else
      CHECK(u[c] != u0[c]);
  const auto nodes_around = mesh.node_nodes()[moved];
  for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
    if (i != moved
        and std::find(nodes_around.begin(), nodes_around.end(), i)
                == nodes_around.end())
      CHECK(w[i] == w0[i]);
}

TEST_CASE("remapper: troubles are outcomes and leave the field alone",
          "[remap]")
{
  Square s;
  std::iota(s.u.begin(), s.u.end(), 1.0);
  const auto before = s.u;
  std::vector<double> to = s.data.x;
  const Options options{.boundaries = std::vector(4, Boundary::closed)};
  SECTION("a cell inverted at the target is named")
  {
    const std::int32_t node = s.mesh.cell(9)[0];
    to[2 * node] += 10;
    to[2 * node + 1] += 7;
    CHECK(s.run(to, options) == Outcome::inverted_target);
    CHECK(s.report.worst_cell >= 0);
    const auto around = s.mesh.node_cells()[node];
    CHECK(std::find(around.begin(), around.end(), s.report.worst_cell)
          != around.end());
  }
  SECTION("a cell inverted at the start")
  {
    std::swap(s.data.x, to);
    s.data.x[2 * 12] += 3;
    CHECK(s.run(to, options) == Outcome::inverted_start);
  }
  SECTION("NaN")
  {
    to[7] = std::nan("");
    CHECK(s.run(to, options) == Outcome::not_finite);
  }
  SECTION("an array that is too short")
  {
    to.pop_back();
    CHECK(s.run(to, options) == Outcome::wrong_size);
  }
  SECTION("a missing inflow")
  {
    s.inflow.clear();
    CHECK(s.run(to, {.boundaries = std::vector(4, Boundary::open)})
          == Outcome::wrong_size);
  }
  SECTION("a field wider than the room for it")
  {
    Options narrow = options;
    narrow.cell_components = 0;
    CHECK(s.run(to, narrow) == Outcome::wrong_size);
  }
  CHECK(s.u == before);
}

TEST_CASE("remapper: a move that passes through nothing says so", "[remap]")
{
  // x → −x, y → −3y: cells are upright at both ends, not between. Towards the
  // place where their volume vanishes the sub-cycles would never end; steps
  // that are allowed to be long land beyond it.
  Square s;
  const auto to = s.stretched(-1, -3);
  const std::vector closed(4, Boundary::closed);
  CHECK(s.run(to, {.boundaries = closed}) == Outcome::too_many_cycles);
  Square t;
  CHECK(t.run(to, {.max_loss = 12, .boundaries = closed})
        == Outcome::inverted_path);
  CHECK(t.report.worst_cell >= 0);
}

TEST_CASE("remapper: no more sub-cycles than allowed", "[remap]")
{
  // No single step is too long: only their number is.
  const std::vector closed(4, Boundary::closed);
  const auto run = [&](int most, bool overlay)
  {
    Square s;
    auto to = s.data.x;
    for (std::size_t i = 0; i < to.size(); i += 2)
      to[i] += 1;
    const Outcome out = s.run(
        to,
        {.max_cycles = most, .overlay_ready = overlay, .boundaries = closed});
    return std::pair(out, s.report);
  };
  const int needed = run(200, false).second.cycles;
  REQUIRE(needed > 4);
  CHECK(run(needed, false).first == Outcome::ok);
  CHECK(run(needed - 1, false).first == Outcome::too_many_cycles);
  const auto [out, report] = run(3, true);
  CHECK(out == Outcome::ok);
  CHECK(report.cycles < 3);
  CHECK(report.overlaid);
}

TEST_CASE("remapper: a range without end is one", "[remap]")
{
  Square s;
  for (std::size_t c = 0; c < s.u.size(); ++c)
    s.u[c] = c % 16 < 8 ? 0 : 1;
  const double before = s.mass(s.data.x);
  const auto to = meshes::shaken(s.data.x, 0.06, 3);
  const double least = 0, most = std::numeric_limits<double>::infinity();
  const Field field{.values = s.u, .least = {&least, 1}, .most = {&most, 1}};
  Remapper remapper(s.mesh, {.scheme = scheme::Linear{}});
  REQUIRE(remapper.remap(s.data.x, to, {&field, 1}, {}, {}, s.ledger)
          == Outcome::ok);
  CHECK(remapper.report().repaired > 0);
  CHECK(*std::min_element(s.u.begin(), s.u.end()) >= 0);
  CHECK(s.mass(to) == Approx(before).epsilon(1e-14));
}

TEST_CASE("remapper: a range upside down is refused, the report is new",
          "[remap]")
{
  Square s;
  const double least = 1, most = 0;
  const auto to = meshes::shaken(s.data.x, 0.06, 3);
  Remapper remapper(s.mesh, {});
  const Field good{.values = s.u};
  REQUIRE(remapper.remap(s.data.x, to, {&good, 1}, {}, {}, s.ledger)
          == Outcome::ok);
  CHECK(remapper.report().moved_nodes > 0);
  const Field bad{.values = s.u, .least = {&least, 1}, .most = {&most, 1}};
  CHECK(remapper.remap(s.data.x, to, {&bad, 1}, {}, {}, s.ledger)
        == Outcome::wrong_size);
  CHECK(remapper.report().moved_nodes == 0);
}

TEST_CASE("remapper: bad options are all named at once", "[remap]")
{
  const Options bad{.max_loss = std::nan(""), .max_cycles = 0};
  CHECK(bad.complaints().size() == 2);
  const Mesh mesh = meshes::rectangle(2, 2, Diagonal::right).mesh();
  CHECK_THROWS_AS(Remapper(mesh, bad), std::invalid_argument);
}

TEST_CASE("choice: members are found by name", "[remap]")
{
  CHECK(name_of(*find<Schemes>("donor_cell")) == "donor_cell");
  CHECK(not find<Schemes>("no such scheme"));
  CHECK(names<Schemes>().size() == std::tuple_size_v<Schemes>);
}
