// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"
#include "step_control.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
/// A block between rough plates, ideally plastic.
scene::Scene block(scene::Tangent tangent, double E = 2.6e6)
{
  auto scene = test::rectangle(1, 1, 8, 8, "j2",
                               {{"E", E},
                                {"nu", 0.3},
                                {"yield_stress", 2e4},
                                {"hardening", 2e4},
                                {"density", 1e3}});
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.solver.tangent = tangent;
  scene.solver.tolerance = 1e-11;
  scene.solver.max_iterations = 200;
  scene.solver.lag_jacobian = 1; // the order is that of a fresh matrix
  return scene;
}

scene::Stage squeeze(double speed)
{
  auto stage = test::stage();
  stage.boundary["bottom"].fixed = true;
  stage.boundary["top"].displacement_x = test::constant(0);
  stage.boundary["top"].velocity_y = test::constant(-speed);
  return stage;
}

/// Residuals of a plastic step after a first one. Strains are small but many
/// times the yield strain: the tangent leaves out how the bubble changes with
/// the geometry, which makes the end of a step of 2 % linear at a rate of 6e-4.
std::vector<double> residuals(scene::Tangent tangent, double step)
{
  Body body(block(tangent, 2.6e9));
  body.set_stage(squeeze(step));
  const auto first = body.step(0, 1);
  CAPTURE(first.cause, first.residuals);
  REQUIRE(first);
  const auto taken = body.step(1, 1.8); // not foreseen by the step before
  CAPTURE(taken.cause, taken.residuals);
  REQUIRE(taken);
  double plastic = 0;
  for (double e : body.state().history)
    plastic += e > 0;
  CHECK(plastic > 0.5 * body.num_cells());
  return taken.residuals;
}

/// Order of the last three residuals above round-off.
double order(const std::vector<double>& r)
{
  std::size_t n = r.size();
  while (n > 3 and r[n - 1] < 1e-13)
    --n;
  return std::log(r[n - 1] / r[n - 2]) / std::log(r[n - 2] / r[n - 3]);
}
} // namespace

TEST_CASE("residuals fall quadratically with the consistent tangent, linearly "
          "with the continuum one",
          "[verification][newton]")
{
  const auto consistent = residuals(scene::Tangent::consistent, 2e-5);
  const auto continuum = residuals(scene::Tangent::continuum, 2e-5);
  INFO("consistent " << Catch::StringMaker<std::vector<double>>::convert(
           consistent));
  INFO("continuum " << Catch::StringMaker<std::vector<double>>::convert(
           continuum));
  CHECK(order(consistent) > 1.8);
  CHECK(order(continuum) < 1.3);
  CHECK(continuum.size() > consistent.size() + 3);
}

TEST_CASE("too large a step fails, names the place, and leaves the state as it "
          "was",
          "[verification][newton]")
{
  auto scene = block(scene::Tangent::consistent);
  scene.solver.max_iterations = 10;
  scene.solver.tolerance = 1e-8;
  Body body(scene);
  body.set_stage(squeeze(0.9));
  const auto before = body.state().x;
  const auto taken = body.step(0, 1);
  CHECK_FALSE(taken);
  CHECK_FALSE(taken.cause.empty());
  CHECK(taken.cell >= 0);
  CHECK(taken.cell < body.num_cells());
  CHECK(taken.place[0] > 0);
  CHECK(taken.place[0] < 1);
  CHECK(body.state().x == before);
  CHECK(test::largest(body.state().s) == 0);
  CHECK(test::largest(body.state().history) == 0);
  CHECK(test::largest(body.state().p) == 0);
}

TEST_CASE("step control recovers from a step that is too large",
          "[verification][newton]")
{
  auto scene = block(scene::Tangent::consistent);
  scene.solver.max_iterations = 10;
  scene.solver.tolerance = 1e-8;
  const auto stage = squeeze(0.25);
  Body body(scene);
  body.set_stage(stage);
  StepControl control(stage, {}, 15);
  int rejected = 0, taken = 0;
  while (not control.finished())
  {
    const auto step = body.step(control.time(), control.next());
    if (step)
    {
      control.accepted(step.iterations);
      ++taken;
      continue;
    }
    ++rejected;
    REQUIRE(control.failed());
  }
  CAPTURE(rejected, taken);
  CHECK(rejected > 0);
  CHECK(body.state().x[2 * body.node(0.5, 1) + 1] == Approx(0.75));
  // The same end as with many small steps: of first order in the step.
  Body fine(scene);
  fine.set_stage(stage);
  for (int k = 0; k < 50; ++k)
    REQUIRE(fine.step(k / 50.0, (k + 1) / 50.0));
  CHECK(body.reaction("top")[1]
        == Approx(fine.reaction("top")[1]).epsilon(0.05));
}

TEST_CASE("every factorisation and every rhythm of it gives the same answer",
          "[verification][newton]")
{
  const bool elastic = GENERATE(true, false);
  auto scene = block(scene::Tangent::consistent);
  if (elastic)
    scene.material.begin()->second.parameters["yield_stress"] = 1e9;
  scene.solver.tolerance = 1e-9;
  scene.solver.lag_jacobian = GENERATE(0, 1, 3);
  scene.solver.factorisation =
      GENERATE(scene::Factorisation::automatic, scene::Factorisation::lu,
               scene::Factorisation::ldlt);
  CAPTURE(elastic, scene.solver.lag_jacobian, scene.solver.factorisation);
  auto plain = scene;
  plain.solver.lag_jacobian = 1;
  plain.solver.factorisation = scene::Factorisation::lu;
  plain.solver.tolerance = 1e-12;
  Body body(scene), reference(plain);
  body.set_stage(squeeze(2e-3));
  reference.set_stage(squeeze(2e-3));
  // the first step starts at rest: what is held has all its way to go
  for (int k = 0; k < 5; ++k)
  {
    const auto taken = body.step(k, k + 1);
    CAPTURE(k, taken.cause, taken.residuals);
    REQUIRE(taken);
    REQUIRE(reference.step(k, k + 1));
    // tolerance times the condition of a yielding block
    CHECK(body.reaction("top")[1]
          == Approx(reference.reaction("top")[1]).epsilon(1e-7));
  }
}

TEST_CASE("an elastic step takes LDLT as few iterations as LU",
          "[verification][newton]")
{
  int iterations[2];
  for (const bool ldlt : {false, true})
  {
    auto scene = block(scene::Tangent::consistent);
    scene.material.begin()->second.parameters["yield_stress"] = 1e9;
    scene.solver.tolerance = 1e-8;
    scene.solver.factorisation =
        ldlt ? scene::Factorisation::ldlt : scene::Factorisation::lu;
    Body body(scene);
    body.set_stage(squeeze(1e-4));
    const auto taken = body.step(0, 1);
    CAPTURE(ldlt, taken.cause, taken.residuals);
    REQUIRE(taken);
    iterations[ldlt] = taken.iterations;
  }
  CHECK(iterations[true] == iterations[false]);
}
