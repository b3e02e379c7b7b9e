// SPDX-License-Identifier: LGPL-3.0-or-later
// The volume equation in dry sand: a rough punch is pushed in, lifted off until
// the grains under it come apart, and pushed in again.
#include "body.h"
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>

using namespace mmale;

namespace
{
constexpr double surcharge = 1e3; // [Pa]

scene::Scene ground(const std::string& law)
{
  auto scene = test::rectangle(2, 1, 8, 4, law, {});
  auto& material = scene.material["body"];
  if (law == "hypoplastic")
  {
    material.parameters = {{"grain_density", 2650}, {"void_ratio", 0.75}};
    material.texts = {{"sand", "hochstetten"}, {"intergranular_strain", "off"}};
  }
  else
    material.parameters = {{"E", 20e6},         {"nu", 0.25},
                           {"cohesion", 0},     {"friction_deg", 30},
                           {"dilation_deg", 0}, {"density", 1600}};
  if (law == "drucker_prager")
    material.texts = {{"cone", "plane_strain"}};
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.boundary["punch"] = {.side = "top", .to = 0.5};
  scene.boundary["surface"] = {.side = "top", .from = 0.5};
  scene.initial.K0 = 0.5;
  scene.initial.surcharge = surcharge;
  scene.solver.max_iterations = 40; // grains that part and meet are kinks
  return scene;
}

scene::Stage stage()
{
  auto s = test::stage(0.1, 1e-3);
  s.gravity = {{test::constant(0), test::constant(-10)}};
  s.boundary["punch"].displacement_x = test::constant(0);
  // 0.04 down, 0.02 up, 0.04 down
  s.boundary["punch"].displacement_y =
      scene::TimeSeries{{0, 0.04, 0.06, 0.1}, {0, -0.04, -0.02, -0.06}};
  s.boundary["surface"].pressure = test::constant(surcharge);
  s.boundary["left"].roller = s.boundary["right"].roller = true;
  s.boundary["bottom"].fixed = true;
  return s;
}

/// Steps from t0 to t1, halved where they fail.
/// @return sum of the squares of theta - ln J over the steps; NaN: broke
double go(test::Body& body, double t0, double t1)
{
  double gap = 0, dt = 1e-3;
  for (double t = t0; t < t1 - 1e-12;)
  {
    const double end = std::min(t1, t + dt);
    if (body.step(t, end))
    {
      gap += body.mismatch()[1] * body.mismatch()[1];
      t = end;
      dt = std::min(1e-3, 1.5 * dt);
    }
    else if ((dt = 0.5 * (end - t)) < 1e-6)
      return std::nan("");
  }
  return gap;
}
} // namespace

TEST_CASE("dry sand is pushed, lifted off and pushed again", "[sand]")
{
  const std::string law =
      GENERATE("drucker_prager", "mohr_coulomb", "hypoplastic");
  INFO(law);
  auto scene = ground(law);
  scene.stage = {stage()};
  test::Body body(scene);
  body.set_stage(stage());
  const auto force = [&body] { return -body.reaction("punch")[1]; };

  double gap = go(body, 0, 0.04);
  REQUIRE(std::isfinite(gap));
  const double pushed = force();
  CHECK(pushed > 10 * 0.5 * surcharge);

  gap += go(body, 0.04, 0.06);
  REQUIRE(std::isfinite(gap));
  // grains carry no tension but for what tells how far apart they are
  CHECK(force() < 0.02 * pushed);
  CHECK(force() > -0.05 * pushed);
  double apex = 0;
  for (double steps : body.state().apex)
    apex += steps;
  CHECK(apex > 0);

  gap += go(body, 0.06, 0.1);
  REQUIRE(std::isfinite(gap));
  CHECK(force() > pushed); // the gap has closed
  // theta and ln J differ cell by cell, by less than a tenth of the strains
  CHECK(std::sqrt(gap) < 0.01);
}
