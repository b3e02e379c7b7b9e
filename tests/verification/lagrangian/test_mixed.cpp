// SPDX-License-Identifier: LGPL-3.0-or-later
// Cells that several materials share, and void.
#include "body.h"
#include "tangents.h"

#include "mesh/corners.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
scene::Region everywhere(std::string material)
{
  scene::Region r;
  r.material = std::move(material);
  r.shape = "everywhere";
  return r;
}

/// All below a line through `point`.
scene::Region behind(std::string material, scene::Point point,
                     scene::Point normal)
{
  scene::Region r;
  r.material = std::move(material);
  r.shape = "half_plane";
  r.point = point;
  r.normal = normal;
  return r;
}

scene::Material elastic(double E, double nu, double density)
{
  return {"elastic", {{"E", E}, {"nu", nu}, {"density", density}}};
}

/// Three materials that are one, cut by two slanted lines.
scene::Scene three(scene::Scene scene)
{
  const scene::Material one = scene.material.at("body");
  scene.material = {{"a", one}, {"b", one}, {"c", one}};
  scene.region = {everywhere("a"), behind("b", {0.53, 0.61}, {1, 2}),
                  behind("c", {0.31, 0.27}, {2, -1})};
  return scene;
}

/// Give all that bears load the pressure of its middle.
void set_pressure(Body& body, const std::function<double(double, double)>& p)
{
  State& state = body.state();
  const bridge::Materials& materials = *state.materials;
  for (int c = 0; c < body.num_cells(); ++c)
  {
    double x = 0, y = 0;
    for (int n : body.cell(c))
    {
      x += state.x[2 * n] / 3;
      y += state.x[2 * n + 1] / 3;
    }
    state.P[c] = p(x, y);
  }
  for (int slot = materials.num_cells(); slot < materials.num_slots(); ++slot)
  {
    const auto at = materials.part(slot).centroid;
    state.P[slot] = p(at.x, at.y);
  }
}

/// Sum of the cells' residuals at the nodes, shape (n, 3).
std::vector<double> nodal_residual(Body& body, const std::vector<double>& z)
{
  REQUIRE(body.evaluate(z));
  std::vector<double> sum(z.size(), 0);
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const auto R = body.residual(c, z);
    for (int i = 0; i < 9; ++i)
      sum[3 * body.cell(c)[i / 3] + i % 3] += R[i];
  }
  return sum;
}
} // namespace

TEST_CASE("three materials that are one answer like one",
          "[verification][mixed]")
{
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  const std::string law = GENERATE("elastic", "j2", "newtonian");
  auto scene = test::rectangle(1, 1, 5, 5, law, {{"density", 2}});
  auto& numbers = scene.material["body"].parameters;
  if (law == "newtonian")
    numbers.insert({{"viscosity", 20}, {"bulk_modulus", 300}});
  else
    numbers.insert({{"E", 100}, {"nu", 0.4}});
  if (law == "j2")
    numbers.insert({{"yield_stress", 1}, {"hardening", 3}});
  scene.mesh.distortion = 0.2;
  scene.mesh.origin = {0.3, 0};
  scene.symmetry = symmetry;
  scene.solver.tolerance = 1e-12;

  auto stage = test::stage();
  stage.gravity = {test::constant(0.3), test::constant(-1)};
  stage.boundary["bottom"].fixed = true;
  stage.boundary["top"].displacement_x = test::ramp(0.12);
  stage.boundary["top"].displacement_y = test::ramp(-0.05);
  // a fluid of a scene with one material has a bubble that remembers, which
  // cells that change hands have not
  auto alone = three(scene);
  alone.region = {everywhere("a")};
  Body one(law == "newtonian" ? alone : scene), many(three(scene));
  REQUIRE(many.state().materials->mixed().size() > 10);
  one.set_stage(stage);
  many.set_stage(stage);
  for (int k = 0; k < 4; ++k)
  {
    REQUIRE(one.step(k / 4., (k + 1) / 4.));
    REQUIRE(many.step(k / 4., (k + 1) / 4.));
    const double size = test::largest(one.state().p);
    double apart = 0, moved = 0;
    for (int n = 0; n < one.num_nodes(); ++n)
    {
      apart = std::max(apart, std::abs(one.state().p[n] - many.state().p[n]));
      for (int d = 0; d < 2; ++d)
        moved = std::max(moved, std::abs(one.state().x[2 * n + d]
                                         - many.state().x[2 * n + d]));
    }
    INFO(law << ", step " << k);
    CHECK(apart < 1e-10 * size);
    CHECK(moved < 1e-10);
  }
  const State &a = one.state(), &b = many.state();
  for (std::size_t i = 0; i < a.s.size(); ++i)
    CHECK(b.s[i] == Approx(a.s[i]).margin(1e-9 * test::largest(a.s)));
  for (int c = 0; c < one.num_cells(); ++c)
    CHECK(b.density[c] == Approx(a.density[c]).epsilon(1e-11));
}

TEST_CASE("tangent of mixed cells against differences", "[verification][mixed]")
{
  const auto rule =
      GENERATE(scene::VoidRule::surface, scene::VoidRule::closing);
  const double squeeze = GENERATE(-0.02, -0.4);
  auto scene = test::rectangle(1, 1, 3, 3, "elastic",
                               {{"E", 100}, {"nu", 0.3}, {"density", 1}});
  scene.material["fluid"] = {
      "newtonian", {{"viscosity", 5}, {"bulk_modulus", 80}, {"density", 2}}};
  scene.material["gone"] = {"void", {}};
  scene.region = {everywhere("gone"), behind("body", {0, 0.45}, {0.2, 1}),
                  behind("fluid", {0.55, 0}, {1, -0.3})};
  scene.mesh.distortion = 0.2;
  scene.solver.void_rule = rule;
  // the bubble's own geometry is not in the tangent
  scene.solver.element = scene::Element::equal_order;
  Body body(scene);
  auto z = test::trial(body, 0.005, 3, 4);
  // gaps open at one squeeze, closed at the other
  for (int n = 0; n < body.num_nodes(); ++n)
    z[3 * n + 1] += squeeze * body.state().x[2 * n + 1];
  INFO(static_cast<int>(rule) << " " << squeeze);
  // open gaps keep next to nothing of their volume equation
  CHECK(test::tangent_error(body, z, 1e-6, 1e-9) < 1e-4);
}

TEST_CASE("a fluid at rest is in balance wherever its surface cuts the cells",
          "[verification][mixed]")
{
  constexpr double rho = 1000, g = 9.81;
  const double level = GENERATE(0.5, 0.53, 0.61, 0.699);
  const double slope = GENERATE(0.0, 0.3); // gravity may be slanted too
  auto scene = test::rectangle(
      1, 1, 10, 10, "newtonian",
      {{"viscosity", 1e-3}, {"bulk_modulus", 2.2e9}, {"density", rho}});
  scene.material["gone"] = {"void", {{"density", 1e-30}}};
  scene.mesh.distortion = 0.2;
  scene.solver.spray_below = 0; // what bears nothing is not in balance
  scene.region = {everywhere("gone"), behind("body", {0.5, level}, {slope, 1})};
  const auto out_of_balance = [&](scene::VoidRule rule)
  {
    scene.solver.void_rule = rule;
    Body body(scene);
    const std::array<double, 2> gravity{-slope * g, -g};
    body.set_gravity(gravity, gravity);
    std::vector<double> z(3 * body.num_nodes(), 0);
    for (int n = 0; n < body.num_nodes(); ++n)
      z[3 * n + 2] = rho * g
                     * (level - body.state().x[2 * n + 1]
                        - slope * (body.state().x[2 * n] - 0.5));
    // the law's answer is p itself: what it starts from does not matter but
    // for theta, which is none
    set_pressure(body, [&](double x, double y)
                 { return rho * g * (level - y - slope * (x - 0.5)); });
    const auto R = nodal_residual(body, z);
    std::vector<bool> wall(body.num_nodes(), false);
    for (const char* side : {"left", "right", "bottom", "top"})
      for (int n : body.nodes(side))
        wall[n] = true;
    double worst = 0;
    for (int n = 0; n < body.num_nodes(); ++n)
      for (int i = 0; i < 2 and not wall[n]; ++i)
      {
        REQUIRE(std::isfinite(R[3 * n + i]));
        worst = std::max(worst, std::abs(R[3 * n + i]));
      }
    return worst / (rho * g * 0.01); // the weight of a node
  };
  CHECK(out_of_balance(scene::VoidRule::surface) < 1e-11);
  if (level > 0.5)
    CHECK(out_of_balance(scene::VoidRule::closing) > 0.05);
}

TEST_CASE("a gap between two bodies closes before it carries, and opens again",
          "[verification][mixed]")
{
  // two blocks, 0.02 apart within a row of cells that are 0.1 high
  const auto scene_of = [](scene::VoidRule rule)
  {
    auto scene = test::rectangle(1, 1, 10, 10, "elastic",
                                 {{"E", 1e4}, {"nu", 0.0}, {"density", 1}});
    scene.material["upper"] = elastic(1e4, 0, 1);
    scene.material["gone"] = {"void", {}};
    scene.region = {everywhere("upper"), behind("gone", {0, 0.56}, {0, 1}),
                    behind("body", {0, 0.54}, {0, 1})};
    scene.solver.void_rule = rule;
    scene.solver.max_iterations = 40;
    return scene;
  };
  const auto press = [&](scene::VoidRule rule, double way)
  {
    Body body(scene_of(rule));
    auto stage = test::stage();
    for (const char* side : {"left", "right", "bottom"})
      stage.boundary[side].roller = true;
    stage.boundary["top"].displacement_y = test::ramp(way);
    stage.boundary["top"].displacement_x = test::constant(0);
    body.set_stage(stage);
    constexpr int steps = 8;
    for (int k = 0; k < steps; ++k)
    {
      const auto taken = body.step(k / double(steps), (k + 1) / double(steps));
      INFO(k << " " << taken.cause << " " << taken.place[0] << " "
             << taken.place[1]);
      for (double r : taken.residuals)
        UNSCOPED_INFO(r);
      REQUIRE(taken);
    }
    return body.reaction("top")[1]; // on the body, up is positive
  };
  using enum scene::VoidRule;
  // stiffness of the column but for the gap: E / 0.98
  // what is left is the ersatz stiffness
  CHECK(std::abs(press(by_bodies, -0.018)) < 1e-2 * 1e4 * 0.018);
  CHECK(std::abs(press(by_bodies, 0.018)) < 1e-2 * 1e4 * 0.018);
  CHECK(-press(by_bodies, -0.04) == Approx(1e4 * 0.02).epsilon(0.1));
  // as a free surface the void presses and pulls from the start
  CHECK(-press(surface, -0.018) > 0.5 * 1e4 * 0.018);
  CHECK(press(surface, 0.018) > 0.5 * 1e4 * 0.018);
}

TEST_CASE("layers under one pressure are as stiff as Reuss says",
          "[verification][mixed]")
{
  // steel and water in each cell; all around held, so that shear is none
  constexpr double K_water = 2.2e9, K_steel = 160e9;
  const double share = GENERATE(0.1, 0.5, 0.9);
  auto scene = test::rectangle(
      1, 1, 1, 1, "newtonian",
      {{"viscosity", 1e-3}, {"bulk_modulus", K_water}, {"density", 1000}});
  scene.material["steel"] =
      elastic(9 * 160e9 * 80e9 / (3 * 160e9 + 80e9),
              (3 * 160e9 - 2 * 80e9) / (6 * 160e9 + 2 * 80e9), 7850);
  // parallel to the diagonal: both cells have the same fractions
  const double offset = 1 - std::sqrt(share);
  scene::Region upper, lower;
  upper.material = lower.material = "steel";
  upper.shape = lower.shape = "polygon";
  lower.points = {{offset, 0}, {1, 0}, {1, 1 - offset}};
  upper.points = {{0, offset}, {1 - offset, 1}, {0, 1}};
  scene.region = {everywhere("body"), lower, upper};
  Body body(scene);
  REQUIRE(body.state().materials->mixed().size() == 2);
  auto stage = test::stage();
  for (const char* side : {"left", "right", "bottom"})
    stage.boundary[side].roller = true;
  stage.boundary["top"].displacement_y = test::ramp(-1e-4);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  // sum of f exp(-p / K) = J, by Newton from Reuss's modulus
  double exact = 1e-4 / (share / K_steel + (1 - share) / K_water);
  for (int i = 0; i < 5; ++i)
  {
    const double s = share * std::exp(-exact / K_steel),
                 w = (1 - share) * std::exp(-exact / K_water);
    exact += (s + w - (1 - 1e-4)) / (s / K_steel + w / K_water);
  }
  CHECK(body.state().p[0] == Approx(exact).epsilon(1e-7));
  // and the fractions follow each material's own strain
  const double J = 1 - 1e-4;
  const auto parts = body.state().materials->parts(0);
  const double water = parts[0].fraction * J / (1 - share);
  const double steel = parts[1].fraction * J / share;
  const double p = body.state().p[0];
  CHECK(std::log(water) == Approx(-p / K_water).epsilon(1e-6));
  CHECK(std::log(steel) == Approx(-p / K_steel).epsilon(1e-3));
}
