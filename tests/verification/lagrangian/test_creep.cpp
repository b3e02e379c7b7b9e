// SPDX-License-Identifier: LGPL-3.0-or-later
// Solids under a held load: nothing moves. Ground at rest under its weight, a
// load on half of its surface.
#include "body.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>

using namespace mmale;
using test::Body;

namespace
{
scene::Material ground(const std::string& which)
{
  const std::map<std::string, double> elastic{
      {"E", 1e7}, {"nu", 0.3}, {"density", 1800}};
  auto with = [&](std::map<std::string, double> more)
  {
    more.insert(elastic.begin(), elastic.end());
    return more;
  };
  const std::map<std::string, double> friction{
      {"cohesion", 100}, {"friction_deg", 22}, {"dilation_deg", 5}};
  if (which == "elastic")
    return {"elastic", elastic};
  if (which == "j2")
    return {"j2", with({{"yield_stress", 15e3}, {"hardening", 1e5}})};
  if (which == "drucker_prager")
    return {which, with(friction), {{"cone", "compression"}}};
  if (which == "mohr_coulomb")
    return {which, with(friction)};
  return {"hypoplastic",
          {{"grain_density", 2650}, {"void_ratio", 0.7}},
          {{"sand", "hochstetten"}, {"intergranular_strain", which}}};
}

/// In halves where the solver asks for it.
void step(Body& body, double t0, double t1, int deep = 0)
{
  const auto taken = body.step(t0, t1);
  if (taken)
    return;
  CAPTURE(t0, t1, taken.cause, taken.residuals);
  REQUIRE(deep < 6);
  step(body, t0, 0.5 * (t0 + t1), deep + 1);
  step(body, 0.5 * (t0 + t1), t1, deep + 1);
}
} // namespace

TEST_CASE("no solid creeps under a held load", "[verification][creep]")
{
  const auto which = GENERATE(as<std::string>{}, "elastic", "j2",
                              "drucker_prager", "mohr_coulomb", "off", "on");
  CAPTURE(which);
  auto scene = test::rectangle(2, 1, 6, 3, "elastic", {});
  scene.material["body"] = ground(which);
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.boundary["load"] = {.side = "top", .to = 0.67};
  scene.boundary["rest"] = {.side = "top", .from = 0.67};
  scene.initial.K0 = 0.5;
  scene.initial.surcharge = 10e3;
  scene.solver.tolerance = 1e-10;
  auto stage = test::stage(11, 0.1);
  stage.gravity = {test::constant(0), test::constant(-9.81)};
  stage.boundary["left"].roller = stage.boundary["right"].roller = true;
  stage.boundary["bottom"].fixed = true;
  stage.boundary["rest"].pressure = test::constant(10e3);
  stage.boundary["load"].pressure = scene::TimeSeries{{0, 1}, {10e3, 30e3}};
  scene.stage = {stage};
  Body body(scene);
  body.set_stage(stage);
  const auto moved = [&](std::span<const double> from)
  {
    double out = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
      out = std::max(out, std::abs(body.state().x[i] - from[i]));
    return out;
  };
  auto start = body.state().x;
  for (int k = 0; k < 10; ++k)
    step(body, 0.1 * k, 0.1 * (k + 1));
  const double settlement = moved(start);
  static double elastic = 0; // the first: the others are not
  if (which == "elastic")
    elastic = settlement;
  else
    CHECK(std::abs(settlement / elastic - 1) > 0.02);
  start = body.state().x;
  for (int k = 10; k < 110; ++k)
    step(body, 0.1 * k, 0.1 * (k + 1));
  const double crept = moved(start) / settlement;
  CAPTURE(settlement, crept);
  CHECK(crept < 1e-6);
}
