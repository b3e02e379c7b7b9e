// SPDX-License-Identifier: LGPL-3.0-or-later
// Lysmer's dashpots under a column: what comes back, and what they carry at
// rest.
#include "column.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using Catch::Approx;
using test::Body;
using test::Column;

namespace
{
double energy(Body& body)
{
  return body.kinetic_energy() + body.state().work.internal;
}
} // namespace

TEST_CASE("an absorbing base lets a pulse out, a fixed one sends it back",
          "[verification][waves]")
{
  const int points = GENERATE(1, 3);
  const bool shear = GENERATE(false, true);
  const bool absorbing = GENERATE(true, false);
  CAPTURE(points, shear, absorbing);
  constexpr int n = 80;
  const double c = shear ? std::sqrt(Column::G / Column::rho) : Column::speed();
  const double length = 24 * Column::height / n; // of the pulse
  Body body(Column::scene(n, points));
  auto stage = test::stage(1e3);
  for (const char* side : {"left", "right"})
  {
    stage.boundary[side].roller = not shear;
    if (shear)
      stage.boundary[side].displacement_y = test::constant(0);
  }
  stage.boundary["bottom"].absorbing = absorbing;
  stage.boundary["bottom"].fixed = not absorbing;
  scene::TimeSeries pulse; // sin^2, of no net sign: up, then down
  for (int k = 0; k <= 48; ++k)
  {
    const double s = k / 48.0;
    pulse.time.push_back(s * length / c);
    pulse.value.push_back(std::pow(std::sin(2 * std::numbers::pi * s), 2)
                          * (s < 0.5 ? 1 : -1));
  }
  (shear ? stage.boundary["top"].traction_x
         : stage.boundary["top"].traction_y) = pulse;
  stage.dynamics = scene::Dynamics{};
  body.set_stage(stage);
  const double dt = 0.5 * Column::height / n / c;
  const int entered = 48, met = entered + 2 * n + 60;
  double all = 0;
  for (int k = 0; k < met; ++k)
  {
    REQUIRE(body.step(k * dt, (k + 1) * dt));
    if (k == entered + 10)
      all = energy(body);
  }
  // what the load has done: force times the speed t / (rho c), 3/8 of the time
  CHECK(
      all
      == Approx(0.375 * length / c / (Column::rho * c) * 4 * Column::height / n)
             .epsilon(0.02));
  const double left = energy(body) / all;
  CAPTURE(left);
  if (absorbing)
    CHECK(std::abs(left) < 0.01);
  else
    CHECK(left == Approx(1).epsilon(1e-3));
}

TEST_CASE("an absorbing base goes on carrying what it carried at rest",
          "[verification][waves]")
{
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  auto scene = Column::scene(20, points);
  scene.solver.tolerance = 1e-10; // strains of 1e-3
  Body body(scene);
  const double g = 9.81;
  auto rest = test::stage();
  rest.boundary["left"].roller = rest.boundary["right"].roller = true;
  rest.boundary["bottom"].fixed = true;
  rest.gravity = {test::constant(0), test::constant(-g)};
  body.set_stage(rest);
  REQUIRE(body.step(0, 1));
  body.state().time = 1;
  auto stage = rest;
  stage.boundary["bottom"] = {};
  stage.boundary["bottom"].absorbing = true;
  stage.dynamics = scene::Dynamics{};
  body.set_stage(stage);
  const auto start = body.state().x;
  const double dt = 0.1 * Column::height / Column::speed();
  double moved = 0;
  for (int k = 0; k < 50; ++k)
  {
    const auto taken = body.step(k * dt, (k + 1) * dt);
    CAPTURE(k, taken.cause, taken.residuals);
    REQUIRE(taken);
    for (std::size_t i = 0; i < start.size(); ++i)
      moved = std::max(moved, std::abs(body.state().x[i] - start[i]));
  }
  // of free fall over the same time
  const double fall = 0.5 * g * std::pow(50 * dt, 2);
  CAPTURE(moved, fall);
  // layout quadrature: the spring of the static step's bubbles is let go
  CHECK(moved < (points == 1 ? 1e-8 : 1e-6) * fall);
}
