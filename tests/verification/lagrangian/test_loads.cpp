// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
const std::map<std::string, double> rubber{
    {"E", 1e6}, {"nu", 0.45}, {"density", 1200}};
} // namespace

TEST_CASE("a column stands on its weight, with p linear over the depth",
          "[verification][loads]")
{
  const bool round = GENERATE(false, true);
  const double b = 0.8, h = 2, g = 9.81;
  auto scene = test::rectangle(b, h, 4, 10, "elastic", rubber);
  scene.mesh.distortion = 0.25;
  scene.solver.tolerance = 1e-12;
  scene.material["body"].parameters["E"] = 1e9; // strains of 2e-5
  scene.material["body"].parameters["nu"] = 0.49999;
  if (round)
    scene.symmetry = scene::Symmetry::axisymmetric;
  Body body(scene);
  auto stage = test::stage();
  stage.boundary["bottom"].roller = true;
  stage.boundary["left"].roller = stage.boundary["right"].roller = true;
  stage.gravity = {test::constant(0), test::constant(-g)};
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  const double area = round ? std::numbers::pi * b * b : b;
  CHECK(body.reaction("bottom")[1]
        == Approx(1200 * g * h * area).epsilon(1e-10));
  // Confined and nearly incompressible: sigma_yy = -rho g depth = -p, to
  // 4 G / 3 K = 3e-5; the field is linear, so that a plane mesh has it. About
  // an axis the one point of a cell does not integrate r p exactly: cells on
  // the axis are 3 % off.
  double error = 0;
  for (int n = 0; n < body.num_nodes(); ++n)
  {
    const double depth = h - body.state().x[2 * n + 1];
    error = std::max(error, std::abs(body.state().p[n] - 1200 * g * depth));
  }
  CHECK(error < (round ? 0.05 : 1e-4) * 1200 * g * h);
}

TEST_CASE("a pressure follows the surface it acts on, and the reactions "
          "balance it",
          "[verification][loads]")
{
  // The right side leans and bends under the load; whatever its shape, the
  // pressure on it and on the top pulls with p times the chord, turned by a
  // right angle: from corner to corner of the deformed body.
  auto scene = test::rectangle(0, 0, 5, 5, "elastic", rubber);
  scene.mesh.shape = "quadrilateral";
  scene.mesh.corners = {{{0, 0}, {1.2, 0.1}, {0.9, 1.1}, {0.1, 1}}};
  scene.solver.tolerance = 1e-11;
  Body body(scene);
  const double pressure = 5e4; // large: a twentieth of the modulus
  auto stage = test::stage();
  stage.boundary["bottom"].fixed = true;
  stage.boundary["right"].pressure = test::constant(pressure);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  const auto& x = body.state().x;
  const int foot = body.node(1.2, 0.1), head = body.node(0.9, 1.1);
  const double dx = x[2 * head] - x[2 * foot],
               dy = x[2 * head + 1] - x[2 * foot + 1];
  CHECK(std::abs(x[2 * head] - 0.9) > 0.05); // it has moved
  // outward normal of the chord, times its length: (dy, -dx)
  const auto reaction = body.reaction("bottom");
  CHECK(reaction[0] == Approx(pressure * dy).epsilon(1e-9));
  CHECK(reaction[1] == Approx(-pressure * dx).epsilon(1e-9));
}

TEST_CASE("a pressure all around only compresses", "[verification][loads]")
{
  auto scene = test::rectangle(1, 1, 4, 4, "elastic", rubber);
  scene.mesh.distortion = 0.3;
  scene.solver.tolerance = 1e-11;
  if (GENERATE(false, true))
    scene.symmetry = scene::Symmetry::axisymmetric;
  const bool round = scene.symmetry == scene::Symmetry::axisymmetric;
  Body body(scene);
  const double pressure = 2e5;
  auto stage = test::stage();
  stage.boundary["left"].roller = stage.boundary["bottom"].roller = true;
  stage.boundary["right"].pressure = test::constant(pressure);
  stage.boundary["top"].pressure = test::constant(pressure);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  // in the plane sigma_xx = sigma_yy = -pressure; about the axis all three
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const double* s = &body.state().s[4 * c];
    const double p = body.state().P[c];
    CHECK(s[0] - p == Approx(-pressure).epsilon(1e-9));
    CHECK(s[1] - p == Approx(-pressure).epsilon(1e-9));
    if (round)
      CHECK(s[2] - p == Approx(-pressure).epsilon(1e-9));
    CHECK(std::abs(s[3]) < 1e-9 * pressure);
  }
}

TEST_CASE("a traction is force over the present length of its side",
          "[verification][loads]")
{
  auto scene = test::rectangle(1, 1, 4, 4, "elastic", rubber);
  scene.solver.tolerance = 1e-11;
  Body body(scene);
  auto stage = test::stage();
  stage.boundary["bottom"].fixed = true;
  stage.boundary["top"].traction_x = test::constant(3e4);
  stage.boundary["top"].traction_y = test::constant(1e4);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  const auto nodes = body.nodes("top");
  std::vector<std::array<double, 2>> points;
  for (int n : nodes)
    points.push_back({body.state().x[2 * n], body.state().x[2 * n + 1]});
  std::ranges::sort(points);
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    length += std::hypot(points[i][0] - points[i - 1][0],
                         points[i][1] - points[i - 1][1]);
  CHECK(std::abs(length - 1) > 1e-3);
  CHECK(body.reaction("bottom")[0] == Approx(-3e4 * length).epsilon(1e-8));
  CHECK(body.reaction("bottom")[1] == Approx(-1e4 * length).epsilon(1e-8));
}
