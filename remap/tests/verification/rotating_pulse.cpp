// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The rotating pulse: a cylinder of height 100 and radius 0.15 at (0.5, 0.75)
// on the unit square, turned clockwise about the middle by half a degree a
// step; the nodes turn with it and then go home. One turn is 720 steps.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// Part of a triangle that lies in the cylinder, by 400 sample points.
double part_inside(Point a, Point b, Point c)
{
  constexpr int n = 20;
  int inside = 0;
  const auto test = [&](double s, double t)
  {
    const Point p = a + s * (b - a) + t * (c - a);
    const Point d = p - Point{0.5, 0.75};
    inside += dot(d, d) <= 0.15 * 0.15;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
    {
      test((i + 1.0 / 3) / n, (j + 1.0 / 3) / n);
      if (i + j < n - 1)
        test((i + 2.0 / 3) / n, (j + 2.0 / 3) / n);
    }
  return inside / double(n * n);
}

struct Pulse
{
  double highest = 0, lowest = 0, l1 = 0, mass_error = 0;
};

/// One turn on 35 × 35 squares cut like a chess board, 2450 triangles.
Pulse one_turn(const Scheme& scheme)
{
  const meshes::Data data = meshes::rectangle(35, 35, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  Remapper remapper(
      mesh, {.scheme = scheme, .boundaries = std::vector(4, Boundary::open)});
  std::vector<double> u(mesh.num_cells()), v(mesh.num_cells());
  cell_volumes(mesh, Geometry::plane, data.x, v);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Triple& n = mesh.cell(c);
    u[c] = 100
           * part_inside(point(data.x, n[0]), point(data.x, n[1]),
                         point(data.x, n[2]));
  }
  const auto u0 = u;
  const auto away = meshes::turned(data.x, -std::numbers::pi / 360, {0.5, 0.5});
  const std::vector<double> inflow(4, 0.0);
  const Field field{.values = u, .inflow = inflow};
  Ledger ledger;
  for (int step = 0; step < 720; ++step)
    REQUIRE(remapper.remap(away, data.x, {&field, 1}, {}, {}, ledger)
            == Outcome::ok);
  Pulse out;
  double before = 0, after = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
  {
    before += v[c] * u0[c];
    after += v[c] * u[c];
    out.l1 += v[c] * std::abs(u[c] - u0[c]);
  }
  out.l1 /= before;
  out.mass_error = (after - before - net(ledger.cells[0])) / before;
  out.highest = *std::max_element(u.begin(), u.end());
  out.lowest = *std::min_element(u.begin(), u.end());
  return out;
}
} // namespace

TEST_CASE("rotating pulse: donor cell falls to 57 % in one turn",
          "[verification]")
{
  const Pulse p = one_turn(scheme::DonorCell{});
  CHECK(p.highest == Approx(57).margin(3)); // the paper's figure
  CHECK(p.lowest >= 0);
  CHECK(std::abs(p.mass_error) < 1e-13);
}

TEST_CASE("rotating pulse: limited linear keeps height and bounds",
          "[verification]")
{
  const Pulse donor = one_turn(scheme::DonorCell{});
  const Pulse p = one_turn(scheme::LimitedLinear{});
  CHECK(p.highest > 99);
  CHECK(p.highest <= 100 * (1 + 1e-14));
  CHECK(p.lowest > -1e-13);
  CHECK(p.l1 < 0.5 * donor.l1);
  CHECK(std::abs(p.mass_error) < 1e-13);
}

TEST_CASE("rotating pulse: unlimited linear oscillates", "[verification]")
{
  const Pulse p = one_turn(scheme::Linear{});
  CHECK(p.highest > 110);
  CHECK(p.lowest < -3);
  CHECK(std::abs(p.mass_error) < 1e-13);
}
