// SPDX-License-Identifier: LGPL-3.0-or-later
#include "environment.h"
#include "lagrangian/conditions.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_session.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace mmale;
using Catch::Approx;
using lagrangian::Conditions;

namespace
{
/// [0, 1]^2, three edges a side; the left two thirds of the top are "punch".
mesh::Domain square()
{
  scene::Mesh m;
  m.shape = "rectangle";
  m.width = m.height = 1;
  m.cells = {3, 3};
  return mesh::make_domain(MPI_COMM_SELF, mesh::make_grid(m),
                           {{"punch", {.side = "top", .to = 0.6}}});
}

int node(const mesh::Domain& domain, double x, double y)
{
  for (int n = 0; n < domain.num_nodes(); ++n)
    if (std::hypot(domain.initial_x[2 * n] - x, domain.initial_x[2 * n + 1] - y)
        < 1e-12)
      return n;
  FAIL("no node at (" << x << ", " << y << ")");
  return -1;
}

scene::TimeSeries constant(double value)
{
  return {{}, {value}};
}

/// Increments of one unknown over a step.
double increment(const mesh::Domain& domain, const Conditions& c, int unknown,
                 double t0, double t1)
{
  std::vector<double> g(3 * domain.num_nodes(), 99);
  c.increments(t0, t1, g);
  return g[unknown];
}
} // namespace

TEST_CASE("a displacement is a place, a velocity its rate",
          "[unit][conditions]")
{
  const mesh::Domain domain = square();
  scene::Stage stage;
  stage.boundary["top"].displacement_x =
      scene::TimeSeries{{0, 1, 2}, {0, 0.3, -0.1}};
  stage.boundary["right"].velocity_y = constant(2);
  stage.boundary["left"].velocity_x = scene::TimeSeries{{0, 10}, {0, 20}};
  const Conditions c(domain, stage);
  const int top = 3 * node(domain, 1, 1);
  CHECK(increment(domain, c, top, 0.2, 0.5) == Approx(0.09));
  CHECK(increment(domain, c, top, 0.5, 1.5) == Approx(0.1 - 0.15));
  CHECK(increment(domain, c, top, 2, 3) == 0); // held after the last time
  const int right = 3 * node(domain, 1, 1. / 3) + 1;
  CHECK(increment(domain, c, right, 0.2, 0.5) == Approx(0.6));
  const int left = 3 * node(domain, 0, 1. / 3); // v = 2 t
  CHECK(increment(domain, c, left, 0.2, 0.5) == Approx(0.25 - 0.04));
  CHECK(increment(domain, c, left + 1, 0.2, 0.5) == 0); // free
}

TEST_CASE("a displacement that does not start from zero is caught up with in "
          "the first step",
          "[unit][conditions]")
{
  const mesh::Domain domain = square();
  scene::Stage stage;
  stage.boundary["bottom"].displacement_y = constant(-0.2);
  const Conditions c(domain, stage);
  const int unknown = 3 * node(domain, 1. / 3, 0) + 1;
  CHECK(increment(domain, c, unknown, 0, 0.1) == -0.2);
  CHECK(increment(domain, c, unknown, 0.1, 0.2) == 0);
}

TEST_CASE("a roller holds the normal, fixed holds both, pressure is free",
          "[unit][conditions]")
{
  const mesh::Domain domain = square();
  scene::Stage stage;
  stage.boundary["left"].roller = true;
  stage.boundary["bottom"].fixed = true;
  const Conditions c(domain, stage);
  const int left = domain.boundary("left"), bottom = domain.boundary("bottom");
  const auto holder = [&](double x, double y, int k)
  { return c.holder()[3 * node(domain, x, y) + k]; };
  CHECK(holder(0, 2. / 3, 0) == left);
  CHECK(holder(0, 2. / 3, 1) == -1);
  CHECK(holder(1. / 3, 0, 0) == bottom);
  CHECK(holder(1. / 3, 0, 1) == bottom);
  CHECK(holder(0, 0, 1) == bottom); // the roller leaves it to the bottom
  for (int n = 0; n < domain.num_nodes(); ++n)
    CHECK(c.holder()[3 * n + 2] == -1);
}

TEST_CASE("a corner belongs to what moves it, and so does its reaction",
          "[unit][conditions]")
{
  const mesh::Domain domain = square();
  const int punch = domain.boundary("punch"), left = domain.boundary("left");
  const int corner = node(domain, 0, 1), edge = node(domain, 2. / 3, 1);
  scene::Stage stage;
  stage.boundary["left"].roller = true;
  stage.boundary["punch"].velocity_y = constant(-1);
  SECTION("a smooth punch leaves the normal of the roller to it")
  {
    const Conditions c(domain, stage);
    CHECK(c.holder()[3 * corner] == left);
    CHECK(c.holder()[3 * corner + 1] == punch);
    CHECK(c.holder()[3 * edge] == -1);
    CHECK(c.holder()[3 * edge + 1] == punch);
  }
  SECTION("a rough one takes all of the node")
  {
    stage.boundary["punch"].displacement_x = constant(0);
    stage.boundary["top"].roller = true;
    const Conditions c(domain, stage);
    CHECK(c.holder()[3 * corner] == punch);
    CHECK(c.holder()[3 * edge] == punch);
    CHECK(c.holder()[3 * edge + 1] == punch); // not the roller beside it
    CHECK(c.holder()[3 * node(domain, 1, 1) + 1] == domain.boundary("top"));
  }
}

TEST_CASE("loads and gravity follow their time series", "[unit][conditions]")
{
  const mesh::Domain domain = square();
  scene::Stage stage;
  stage.boundary["punch"].pressure = scene::TimeSeries{{0, 2}, {0, 10}};
  stage.boundary["punch"].traction_x = constant(3);
  stage.boundary["left"].roller = true; // no load
  stage.gravity = {constant(0), scene::TimeSeries{{0, 1}, {0, -9.81}}};
  const Conditions c(domain, stage);
  const auto loads = c.loads(0.5);
  REQUIRE(loads.size() == 1);
  CHECK(loads[0].boundary == domain.boundary("punch"));
  CHECK(loads[0].pressure == 2.5);
  CHECK(loads[0].traction[0] == 3);
  CHECK(loads[0].traction[1] == 0);
  CHECK(c.gravity(0.5)[1] == Approx(-4.905));
  CHECK(c.gravity(7)[1] == -9.81);
  CHECK(Conditions(domain, {}).gravity(1)[1] == 0);
}

int main(int argc, char** argv)
{
  const Environment environment(argv[0], {});
  return Catch::Session().run(argc, argv);
}
