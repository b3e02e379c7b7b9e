// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <numbers>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
constexpr double g = 9.81, height = 2, surcharge = 3e3, K0 = 0.45;
constexpr double grains = 2650, water = 1000;

/// Sand 1 m wide and 2 m deep between smooth walls.
scene::Scene ground(double void_ratio)
{
  auto scene =
      test::rectangle(1, height, 5, 10, "hypoplastic",
                      {{"grain_density", grains}, {"void_ratio", void_ratio}});
  scene.mesh.distortion = 0.25;
  scene.material["body"].texts = {{"sand", "hochstetten"},
                                  {"intergranular_strain", "off"}};
  scene.initial.K0 = K0;
  scene.initial.surcharge = surcharge;
  auto stage = test::stage(1, 0.1);
  for (const char* side : {"left", "right", "bottom"})
    stage.boundary[side].roller = true;
  stage.boundary["top"].pressure = test::constant(surcharge);
  stage.gravity = {test::constant(0), test::constant(-g)};
  scene.stage = {stage};
  return scene;
}

/// Largest distance that a node has gone.
double way(Body& body, const std::vector<double>& start)
{
  double far = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    far = std::max(far, std::abs(body.state().x[i] - start[i]));
  return far;
}

double centre_y(Body& body, int c)
{
  double y = 0;
  for (int n : body.cell(c))
    y += body.state().x[2 * n + 1] / 3;
  return y;
}
} // namespace

TEST_CASE("ground lies at rest under its weight, with the stress of its depth",
          "[verification][initial]")
{
  const int points = GENERATE(1, 3, 6);
  const double e = 0.72, rho = grains / (1 + e);
  auto scene = ground(e);
  test::use_points(scene, points);
  Body body(scene);
  const auto start = body.state().x;
  const auto [as_laid, settled] = body.settle();
  CHECK(as_laid < 1e-13); // one stress a cell is exact for uniform ground
  CHECK(settled < 1e-13);
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const double down = surcharge + rho * g * (height - centre_y(body, c));
    double p = 0, yy = 0, xx = 0;
    for (int q = points * c; q < points * (c + 1); ++q)
    {
      p += body.state().P[q] / points;
      xx += (body.state().s[4 * q] - body.state().P[q]) / points;
      yy += (body.state().s[4 * q + 1] - body.state().P[q]) / points;
    }
    CHECK(yy == Approx(-down).epsilon(1e-12));
    CHECK(xx == Approx(-K0 * down).epsilon(1e-12));
    CHECK(p == Approx((1 + 2 * K0) / 3 * down).epsilon(1e-12));
    CHECK(body.state().density[c] == Approx(rho).epsilon(1e-13));
  }
  for (int k = 0; k < 5; ++k)
    REQUIRE(body.step(0.1 * k, 0.1 * (k + 1)));
  CHECK(way(body, start) < 1e-13);
}

TEST_CASE("unstressed ground under the same weight comes down",
          "[verification][initial]")
{
  // what a scene without K0 does, and why it has one
  auto scene = ground(0.72);
  scene.initial.K0.reset();
  Body body(scene);
  const auto start = body.state().x;
  body.set_stage(scene.stage.front());
  const auto taken = body.step(0, 0.1);
  CHECK((not taken or way(body, start) > 1e-4));
}

TEST_CASE("ground that varies with depth, about an axis, settles into balance",
          "[verification][initial]")
{
  auto scene = ground(0.7);
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.initial.void_ratio = {{0, 0.88}, {0.7, 0.8}, {2, 0.66}};
  Body body(scene);
  const auto start = body.state().x;
  const auto [as_laid, settled] = body.settle();
  // the cells' one point does not integrate this stress: of the order of the
  // cell's share in the weight
  CHECK(as_laid > 1e-6);
  CHECK(as_laid < 1e-2);
  CHECK(settled < 1e-9);
  // the law has the void ratio of its depth
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const double depth = height - centre_y(body, c);
    const double e = depth < 0.7 ? 0.88 - 0.08 * depth / 0.7
                                 : 0.8 - 0.14 * (depth - 0.7) / 1.3;
    CHECK(body.state().history[c] == Approx(e).epsilon(1e-12));
  }
  for (int k = 0; k < 5; ++k)
    REQUIRE(body.step(0.1 * k, 0.1 * (k + 1)));
  CHECK(way(body, start) < 1e-9);
}

TEST_CASE("a water table bears its share of the weight",
          "[verification][initial]")
{
  const bool seepage = GENERATE(false, true);
  const double table = GENERATE(1.2, 2.0, 2.7); // below, at, above the surface
  const double e = 0.72, n = e / (1 + e);
  auto scene = ground(e);
  scene.water.emplace();
  scene.water->drainage = seepage ? "seepage" : "undrained";
  scene.water->permeability = 1e-4;
  scene.water->density = water;
  scene.initial.water_table = table;
  const double stands = water * g * std::max(0.0, table - height);
  scene.stage[0].boundary["top"].pressure = test::constant(surcharge + stands);
  if (seepage)
    scene.stage[0].boundary["top"].pore_pressure =
        test::constant(water * g * (table - height));
  Body body(scene);
  const auto start = body.state().x;
  const auto [as_laid, settled] = body.settle();
  CHECK(settled < 1e-12);
  const double rho = (1 - n) * grains + n * water;
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const double y = centre_y(body, c);
    const double down = surcharge + stands + rho * g * (height - y);
    const double p_w = water * g * (table - y);
    const double across = K0 * (down - p_w) + p_w;
    CHECK(body.state().P[c] == Approx((down + 2 * across) / 3).epsilon(1e-12));
    CHECK(body.state().density[c] == Approx(rho).epsilon(1e-13));
  }
  for (int k = 0; k < 3; ++k)
  {
    const auto taken = body.step(0.1 * k, 0.1 * (k + 1));
    CAPTURE(seepage, table, taken.cause, taken.residuals);
    REQUIRE(taken);
  }
  CHECK(way(body, start) < 1e-10);
}

TEST_CASE("undrained ground settles, however stiff its water",
          "[verification][initial]")
{
  // Sand of no cohesion under a small surcharge and a plate at rest, about an
  // axis. Settled with the modulus of sand and water, the correction took cells
  // at the surface beyond what sand bears: 3e-7 to 3e-6 of the weight was left
  // on a node.
  const double stiff = GENERATE(1e2, 1e4); // K_w / G
  const int points = GENERATE(1, 3);
  CAPTURE(stiff, points);
  constexpr double E = 20e6, nu = 0.25, porosity = 0.4, load = 1e3;
  auto scene = test::rectangle(2, 1, 20, 10, "drucker_prager",
                               {{"E", E},
                                {"nu", nu},
                                {"cohesion", 0},
                                {"friction_deg", 30},
                                {"dilation_deg", 0},
                                {"density", 1600}});
  scene.material["body"].texts = {{"cone", "plane_strain"}};
  scene.mesh.distortion = 0.25;
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.water.emplace();
  scene.water->drainage = "undrained";
  scene.water->porosity = porosity;
  scene.water->bulk_modulus = porosity * stiff * E / (2 + 2 * nu);
  scene.water->grain_bulk_modulus = 1e15;
  test::use_points(scene, points);
  scene.boundary["plate"] = {.side = "top", .to = 0.5};
  scene.boundary["surface"] = {.side = "top", .from = 0.5};
  scene.initial.K0 = 0.5;
  scene.initial.surcharge = load;
  auto stage = test::stage(1, 0.1);
  stage.boundary["plate"].fixed = true;
  stage.boundary["left"].roller = stage.boundary["right"].roller = true;
  stage.boundary["bottom"].fixed = true;
  stage.boundary["surface"].pressure = test::constant(load);
  stage.gravity = {test::constant(0), test::constant(-10)};
  scene.stage = {stage};
  Body body(scene);
  const auto [as_laid, settled] = body.settle();
  CHECK(as_laid > 1e-5);
  CHECK(settled < 1e-9);
}

TEST_CASE("an initial stress that sand cannot bear, or that does not fit its "
          "loads, is refused",
          "[verification][initial]")
{
  using Catch::Matchers::ContainsSubstring;
  auto steep = ground(0.72);
  steep.initial.K0 = 0.02;
  Body a(steep);
  CHECK_THROWS_WITH(a.settle(), ContainsSubstring("K0"));
  auto loaded = ground(0.72);
  loaded.stage[0].boundary["top"].pressure = test::constant(1e5 * surcharge);
  Body b(loaded);
  CHECK_THROWS(b.settle());
}
