// SPDX-License-Identifier: LGPL-3.0-or-later
// Water at rest and in steady flow: signs, weights, discharges.
#include "soil.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using namespace mmale::test;
using Catch::Approx;

namespace
{
constexpr double long_time = 1e9; // [s]: c_v t / H^2 = 1e7

/// A column 1 m high and 0.25 m wide on which gravity acts or not.
scene::Stage column(bool gravity)
{
  auto s = trough();
  if (gravity)
    s.gravity = {constant(0), constant(-9.81)};
  return s;
}

double height_of(Body& body)
{
  return body.state().x[2 * body.node(0, 1) + 1]
         - body.state().x[2 * body.node(0, 0) + 1];
}
} // namespace

TEST_CASE("at rest water is hydrostatic and the skeleton carries its buoyant "
          "weight",
          "[water][flow]")
{
  const Soil soil{.E = 1e9, .density = 1600}; // strains of 1e-6
  Body body(soil.rectangle(0.25, 1, 2, 8));
  auto s = column(true);
  s.boundary["top"].drained = true;
  body.set_stage(s);
  REQUIRE(body.step(0, long_time));
  const State& state = body.state();
  const double H = height_of(body);
  for (int n = 0; n < body.num_nodes(); ++n)
  {
    const double depth = H - state.x[2 * n + 1];
    // gamma_w depth; the column holds it by straight lines exactly
    CHECK(state.p_w[n] == Approx(9810 * depth).epsilon(1e-6).margin(1e-3));
  }
  // vertical effective stress in the middle of the cells; the mass of 1 m3
  // dry is 1600 kg, its pores hold 0.4 m3
  const double buoyant = (1600 + 0.4 * 1000 - 1000) * 9.81;
  for (int c = 0; c < body.num_cells(); ++c)
  {
    double depth = H, p_w = 0;
    for (int n : body.cell(c))
    {
      depth -= state.x[2 * n + 1] / 3;
      p_w += state.p_w[n] / 3;
    }
    const double stress = state.s[4 * c + 1] - state.P[c];
    // a cell carries the mean weight between its upper and its lower nodes
    CHECK(stress + p_w == Approx(-buoyant * depth).margin(buoyant / 8 * 0.5));
  }
  const auto [x, y] = body.reaction("bottom");
  CHECK(y == Approx(2000 * 9.81 * 0.25).epsilon(1e-3)); // water squeezed out
  CHECK(std::abs(body.discharge("top")) < 1e-12);
}

TEST_CASE("steady flow through a column: Darcy's discharge", "[water][flow]")
{
  const bool gravity = GENERATE(false, true);
  const Soil soil{.E = 1e9, .density = 1600}; // strains of 1e-6
  auto scene = soil.rectangle(0.25, 1, 4, 8);
  scene.mesh.distortion = 0.2; // straight lines on any mesh
  Body body(scene);
  auto s = column(gravity);
  s.boundary["top"].drained = true;
  s.boundary["bottom"].pore_pressure = constant(15e3);
  body.set_stage(s);
  REQUIRE(body.step(0, long_time));
  REQUIRE(body.step(long_time, 2 * long_time)); // on geometry that stays
  const double H = height_of(body);
  const double drop = 15e3 - (gravity ? 9810 * H : 0);
  const double q = soil.mobility() * drop / H * 0.25;
  CAPTURE(gravity, H, q);
  CHECK(body.discharge("top") == Approx(q).epsilon(1e-6));
  CHECK(body.discharge("bottom") == Approx(-q).epsilon(1e-6));
  for (int n = 0; n < body.num_nodes(); ++n)
    CHECK(body.state().p_w[n]
          == Approx(15e3 * (1 - body.state().x[2 * n + 1] / H))
                 .epsilon(1e-6)
                 .margin(0.1));
}

TEST_CASE("a seepage face lets water out and none in", "[water][flow]")
{
  const Soil soil{.E = 1e9, .density = 1600}; // strains of 1e-6
  const bool rising = GENERATE(true, false);
  Body body(soil.rectangle(0.25, 1, 4, 8));
  auto s = column(true);
  s.boundary["top"].seepage_face = true;
  s.boundary["bottom"].pore_pressure = constant(rising ? 15e3 : 5e3);
  body.set_stage(s);
  for (int i = 0; i < 4; ++i)
    REQUIRE(body.step(i * long_time, (i + 1) * long_time));
  const double H = height_of(body);
  const double top = body.state().p_w[body.node(0.125, 1)];
  if (rising)
  {
    CHECK(top == Approx(0).margin(1e-6));
    CHECK(body.discharge("top")
          == Approx(soil.mobility() * (15e3 / H - 9810) * 0.25).epsilon(1e-5));
  }
  else // closed: suction above, and no flow
  {
    CHECK(top == Approx(5e3 - 9810 * H).epsilon(1e-5));
    CHECK(std::abs(body.discharge("bottom")) < 1e-12);
  }
}
