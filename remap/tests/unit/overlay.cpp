// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The overlay against what it owes: parts of old cells add up to them, parts of
// new cells fill them, at any displacement; and against exact set differences
// where the outline moves.

#include "remap/remap.h"
#include "remap/tests/carry.h"
#include "remap/tests/meshes.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int n = 24;
constexpr double h = 1.0 / n;

/// Inner nodes in an eddy that moves them by up to `by`; one to one for
/// by < 1/π. The outline stays.
std::vector<double> stirred(std::span<const double> x, double by)
{
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); i += 2)
  {
    if (meshes::on_outline({x[i], x[i + 1]}))
      continue;
    const double s = std::sin(std::numbers::pi * x[i])
                     * std::sin(std::numbers::pi * x[i + 1]);
    out[i] += 0.8 * by * s;
    out[i + 1] -= 0.6 * by * s;
  }
  return out;
}

/// All nodes moved by a vector.
std::vector<double> shifted(std::span<const double> x, Point by)
{
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); i += 2)
    out[i] += by.x, out[i + 1] += by.y;
  return out;
}

struct Case
{
  Geometry geometry = Geometry::plane;
  double cells = 1; ///< displacement in cells
  Diagonal diagonal = Diagonal::crossed;
  meshes::Data data = meshes::rectangle(n, n, diagonal);
  Mesh mesh = data.mesh();
  std::vector<double> from = meshes::shaken(data.x, 0.1 * h, 3);
  std::vector<double> to =
      stirred(meshes::shaken(data.x, 0.1 * h, 4), cells* h);
};
} // namespace

TEST_CASE("overlay: parts add up to old cells and fill new ones", "[overlay]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto cells = GENERATE(0.1, 0.5, 1.0, 2.0, 3.0, 5.0);
  const auto diagonal =
      GENERATE(Diagonal::right, Diagonal::crossed, Diagonal::four);
  INFO("displacement " << cells);
  const Case k{geometry, cells, diagonal};
  Overlay overlay(k.mesh);
  const auto touched = carry::touched(k.mesh, k.from, k.to);
  REQUIRE(carry::intersect(overlay, geometry, k.from, k.to, touched)
          == Outcome::ok);
  const carry::Carrier carrier(k.mesh, geometry, k.from, k.to);
  std::vector<Moments> out(k.mesh.num_cells()), in = out;
  const auto moments = [](double v, Point at)
  { return Moments{v, v * at.x, v * at.y}; };
  for (const auto& p : overlay.pieces())
  {
    REQUIRE(p.from >= 0);
    REQUIRE(p.to >= 0);
    CHECK(p.volume > 0);
    out[p.from] += moments(p.volume, p.at);
    in[p.to] += moments(p.volume, p.at);
  }
  int emptied = 0;
  std::vector<double> v(k.mesh.num_cells()), c(2 * v.size());
  cell_volumes(k.mesh, geometry, k.to, v, c);
  for (std::int32_t i : touched)
  {
    const auto& rest = overlay.rest(i);
    emptied += rest.volume == 0;
    out[i] += moments(rest.volume, rest.at);
    in[i] += moments(rest.volume, rest.at);
    // A cell has an area of about h²/2, a piece an error of some eps h².
    const double round_off = 32 * eps * h * h;
    CHECK(std::abs(out[i].v - carrier.before[i]) < round_off);
    CHECK(std::abs(in[i].v - carrier.after[i]) < round_off);
    CHECK(std::abs(out[i].x - carrier.before[i] * carrier.at(i).x) < round_off);
    CHECK(std::abs(out[i].y - carrier.before[i] * carrier.at(i).y) < round_off);
    CHECK(std::abs(in[i].x - v[i] * c[2 * i]) < round_off);
    CHECK(std::abs(in[i].y - v[i] * c[2 * i + 1]) < round_off);
  }
  CHECK(overlay.matched() == 0); // walks find all
  // Some have left their place wholly.
  if (cells != 0.5)
    CHECK((emptied > 0) == (cells >= 1));
}

TEST_CASE("overlay: uniform, linear and bounded fields, at any displacement",
          "[overlay]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto cells = GENERATE(0.1, 1.0, 3.0);
  INFO("displacement " << cells);
  const Case k{geometry, cells};
  Overlay overlay(k.mesh);
  const auto touched = carry::touched(k.mesh, k.from, k.to);
  REQUIRE(carry::intersect(overlay, geometry, k.from, k.to, touched)
          == Outcome::ok);
  const carry::Carrier carrier(k.mesh, geometry, k.from, k.to);
  const auto size = static_cast<std::size_t>(k.mesh.num_cells());

  const std::vector<double> uniform(size, 3.7);
  for (double u : carrier.apply(overlay, uniform, {}))
    CHECK(u == Approx(3.7).epsilon(3e-14));

  // With its own gradient a linear field is exact.
  std::vector<double> v(size), c(2 * size), linear(size);
  const auto f = [](double x, double y) { return 2 + 3 * x - 5 * y; };
  for (std::size_t i = 0; i < size; ++i)
  {
    const Point p = carrier.at(static_cast<std::int32_t>(i));
    linear[i] = f(p.x, p.y);
  }
  cell_volumes(k.mesh, geometry, k.to, v, c);
  const std::vector<Point> slope(size, {3, -5});
  const auto moved = carrier.apply(overlay, linear, slope);
  for (std::size_t i = 0; i < size; ++i)
    CHECK(moved[i] == Approx(f(c[2 * i], c[2 * i + 1])).margin(3e-13));

  // Noise between 0 and 1 with jumps: order 2, limited, keeps mass and bounds.
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> draw(-0.5, 1.5);
  std::vector<double> noise(size);
  std::generate(noise.begin(), noise.end(),
                [&] { return std::clamp(draw(engine), 0.0, 1.0); });
  const auto limited =
      carrier.apply(overlay, noise, carrier.limited(overlay, noise, {}));
  CHECK(carrier.mass(carrier.after, limited)
        == Approx(carrier.mass(carrier.before, noise)).epsilon(1e-13));
  for (double u : limited)
  {
    CHECK(u >= -3e-14);
    CHECK(u <= 1 + 3e-14);
  }
}

TEST_CASE("overlay: three cells in one step, where swept regions fail",
          "[overlay]")
{
  // In one step a cell would lose more than it has: the swept form leaves the
  // bounds (here [1, 2]), the overlay does not.
  const Case k{Geometry::plane, 3};
  std::vector<double> u(k.mesh.num_cells());
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = i / (2 * n) % 2 == 0 ? 1 : 2; // rows
  const auto u0 = u;
  Remapper swept(k.mesh, {.scheme = scheme::DonorCell{},
                          .max_loss = std::numeric_limits<double>::infinity()});
  const Field field{.values = u};
  Ledger ledger;
  REQUIRE(swept.remap(k.from, k.to, {&field, 1}, {}, {}, ledger)
          == Outcome::ok);
  CHECK(*std::max_element(u.begin(), u.end()) > 3);

  Overlay overlay(k.mesh);
  REQUIRE(overlay.intersect<Geometry::plane>(
              k.from, k.to, carry::touched(k.mesh, k.from, k.to))
          == Outcome::ok);
  const carry::Carrier carrier(k.mesh, Geometry::plane, k.from, k.to);
  const auto w = carrier.apply(overlay, u0, {});
  CHECK(*std::max_element(w.begin(), w.end()) <= 2 + 1e-13);
  CHECK(*std::min_element(w.begin(), w.end()) >= 1 - 1e-13);
}

TEST_CASE("overlay: a body that moves gains ahead and loses behind",
          "[overlay]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto cells = GENERATE(0.3, 1.0, 3.4);
  INFO("displacement " << cells);
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed, 1);
  const Mesh mesh = data.mesh();
  const auto from = meshes::shaken(data.x, 0.1 * h, 3, 1);
  const double by = cells * h;
  const auto to = shifted(meshes::shaken(data.x, 0.2 * h, 4, 1), {by, 0});
  Overlay overlay(mesh);
  REQUIRE(carry::intersect(overlay, geometry, from, to,
                           carry::touched(mesh, from, to))
          == Outcome::ok);
  std::vector<double> gained(4), lost(4);
  for (const auto& p : overlay.pieces())
  {
    if (p.from >= 0 and p.to >= 0)
      continue;
    REQUIRE(p.marker >= 0);
    (p.from < 0 ? gained : lost)[p.marker] += p.volume;
    CHECK((p.from < 0 ? p.at.x >= 2 : p.at.x <= 1 + by));
  }
  // Height 1; rings from 2 to 2 + by and from 1 to 1 + by. Cells that lie
  // outside at a corner may be nearest to another side.
  const bool plane = geometry == Geometry::plane;
  const double ahead = plane ? by : by * (2 + by / 2);
  const double behind = plane ? by : by * (1 + by / 2);
  CHECK(gained[0] + gained[1] + gained[2] + gained[3]
        == Approx(ahead).epsilon(1e-12));
  CHECK(lost[0] + lost[1] + lost[2] + lost[3] == Approx(behind).epsilon(1e-12));
  CHECK(gained[1] >= (cells < 1 ? 1 - 1e-12 : 0.8) * ahead);
  CHECK(lost[3] >= (cells < 1 ? 1 - 1e-12 : 0.8) * behind);
}

TEST_CASE("overlay: a cell that leaves the mesh finds it again across a gap",
          "[overlay]")
{
  // Two blocks of 4 × 4 squares, joined below, with a gap of one square
  // between, move by 2.5 squares: the left one reaches over the gap.
  meshes::Data all = meshes::rectangle(9, 6, Diagonal::crossed, 0, 0, 9, 6);
  meshes::Data data;
  data.x = all.x;
  for (std::size_t c = 0; c < all.cells.size(); c += 3)
  {
    double cx = 0, cy = 0;
    for (std::size_t i = c; i < c + 3; ++i)
      cx += all.x[2 * all.cells[i]] / 3, cy += all.x[2 * all.cells[i] + 1] / 3;
    if (not(cx > 4 and cx < 5 and cy > 2))
      data.cells.insert(data.cells.end(), all.cells.begin() + c,
                        all.cells.begin() + c + 3);
  }
  const Mesh mesh = data.mesh();
  const auto to = shifted(data.x, {2.5, 0});
  Overlay overlay(mesh);
  REQUIRE(overlay.intersect<Geometry::plane>(data.x, to,
                                             carry::touched(mesh, data.x, to))
          == Outcome::ok);
  double gained = 0, lost = 0, gained_in_gap = 0;
  for (const auto& p : overlay.pieces())
  {
    if (p.from < 0)
      gained += p.volume;
    if (p.from < 0 and p.at.x < 9)
      gained_in_gap += p.volume;
    if (p.to < 0)
      lost += p.volume;
  }
  CHECK(overlay.matched() > 0);
  // Ahead 2.5 × 6, the old gap 1 × 4; behind 2.5 × 6, the new gap 1 × 4.
  CHECK(gained == Approx(19));
  CHECK(lost == Approx(19));
  CHECK(gained_in_gap == Approx(4));
}

TEST_CASE("overlay: only what moved is worked on, and gets pieces", "[overlay]")
{
  const Case k;
  auto to = k.from;
  const std::int32_t node = (n + 1) * (n / 2) + n / 2;
  to[2 * node] += 0.3 * h;
  to[2 * node + 1] -= 0.2 * h;
  Overlay overlay(k.mesh);
  const auto touched = carry::touched(k.mesh, k.from, to);
  REQUIRE(touched.size() == k.mesh.node_cells()[node].size());
  REQUIRE(overlay.intersect<Geometry::plane>(k.from, to, touched)
          == Outcome::ok);
  CHECK(overlay.pieces().size() > 4);
  const auto in = [&](std::int32_t c)
  { return std::find(touched.begin(), touched.end(), c) != touched.end(); };
  double moved = 0;
  for (const auto& p : overlay.pieces())
  {
    CHECK(in(p.from));
    CHECK(in(p.to));
    moved += p.volume;
  }
  // A facet of length near h sweeps at most half of h times the way.
  CHECK(moved < 8 * 0.5 * 1.6 * h * 0.4 * h);
  // Nothing moved: nothing goes anywhere.
  REQUIRE(overlay.intersect<Geometry::plane>(k.from, k.from, touched)
          == Outcome::ok);
  CHECK(overlay.pieces().empty());
}

TEST_CASE("overlay: inverted cells are named", "[overlay]")
{
  const Case k;
  auto bad = k.from;
  const std::int32_t node = (n + 1) * (n / 2) + n / 2;
  bad[2 * node] += 3 * h;
  Overlay overlay(k.mesh);
  const auto touched = carry::touched(k.mesh, k.from, bad);
  CHECK(overlay.intersect<Geometry::plane>(k.from, bad, touched)
        == Outcome::inverted_target);
  CHECK(std::find(touched.begin(), touched.end(), overlay.worst_cell())
        != touched.end());
  CHECK(overlay.intersect<Geometry::plane>(bad, k.from, touched)
        == Outcome::inverted_start);
}
