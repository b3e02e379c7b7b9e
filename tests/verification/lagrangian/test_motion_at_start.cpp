// SPDX-License-Identifier: LGPL-3.0-or-later
// Bodies that move when a dynamic stage begins: in flight, onto dashpots, and
// on a base that is driven.
#include "column.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using Catch::Approx;
using test::Body;
using test::Column;

namespace
{
/// All nodes with one velocity along y.
void push(Body& body, double v)
{
  for (int n = 0; n < body.num_nodes(); ++n)
    body.state().v[2 * n + 1] = v;
}
} // namespace

TEST_CASE("a body without stress flies straight on", "[verification][dynamics]")
{
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  Body body(Column::scene(8, points));
  auto stage = test::stage(1);
  stage.dynamics.emplace();
  push(body, -5);
  body.set_stage(stage);
  const auto start = body.state().x;
  for (int k = 0; k < 20; ++k)
  {
    const auto taken = body.step(0.01 * k, 0.01 * (k + 1));
    CAPTURE(k, taken.cause, taken.residuals);
    REQUIRE(taken);
  }
  for (int n = 0; n < body.num_nodes(); ++n)
    CHECK(body.state().x[2 * n + 1]
          == Approx(start[2 * n + 1] - 1).margin(1e-9));
  CHECK(test::largest(body.state().s) < 1e-6 * Column::G);
}

TEST_CASE("an absorbing base stops a column that comes down on it",
          "[verification][waves]")
{
  // rho c v on the base is what it takes to stop it in one passage up and down
  Body body(Column::scene(20, 1));
  auto stage = test::stage(1);
  stage.dynamics.emplace();
  stage.boundary["left"].roller = stage.boundary["right"].roller = true;
  stage.boundary["bottom"].absorbing = true;
  push(body, -1e-4);
  body.set_stage(stage);
  const double before = body.kinetic_energy();
  const double dt = Column::height / Column::speed() / 40;
  for (int k = 0; k < 160; ++k)
    REQUIRE(body.step(k * dt, (k + 1) * dt));
  CHECK(body.kinetic_energy() < 0.02 * before);
}

TEST_CASE("held nodes of the explicit scheme move as they are told",
          "[verification][dynamics]")
{
  Body body(Column::scene(8, 1));
  auto stage = test::stage(1);
  stage.dynamics = scene::Dynamics{.beta = 0};
  stage.boundary["left"].roller = stage.boundary["right"].roller = true;
  stage.boundary["bottom"].velocity_y = test::constant(1e-4);
  body.set_stage(stage);
  const double dt = 0.2 * Column::height / 8 / Column::speed();
  for (int k = 0; k < 5; ++k)
  {
    REQUIRE(body.step(k * dt, (k + 1) * dt));
    for (int n : body.nodes("bottom"))
      CHECK(body.state().v[2 * n + 1] == Approx(1e-4));
  }
}
