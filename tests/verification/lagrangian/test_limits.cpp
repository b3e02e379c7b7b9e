// SPDX-License-Identifier: LGPL-3.0-or-later
// Where methods fail, both sides: the explicit scheme's step, a stiff tangent
// without its geometric part near buckling, thin cells.
#include "body.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <numbers>
#include <random>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
constexpr double E = 1e7, nu = 0.3, rho = 2000;

scene::Scene square(int points)
{
  auto scene = test::rectangle(1, 1, 4, 4, "elastic",
                               {{"E", E}, {"nu", nu}, {"density", rho}});
  scene.mesh.distortion = 0.25;
  test::use_points(scene, points);
  return scene;
}

/// Highest frequency of a body whose bottom is held: its stiffness from the
/// cells' tangents at rest with the pressures eliminated, its mass from areas.
double highest_frequency(Body& body)
{
  const int nodes = body.num_nodes();
  const std::vector<double> z(3 * nodes, 0);
  REQUIRE(body.evaluate(z));
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * nodes, 2 * nodes),
                  B = Eigen::MatrixXd::Zero(2 * nodes, nodes),
                  C = Eigen::MatrixXd::Zero(nodes, 2 * nodes),
                  D = Eigen::MatrixXd::Zero(nodes, nodes);
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(2 * nodes);
  const auto& x = body.state().x;
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const auto J = body.jacobian(c, z);
    const auto [i, j, k] = body.cell(c);
    const double area =
        0.5
        * std::abs((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
                   - (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1]));
    for (int a = 0; a < 9; ++a)
    {
      const int m = body.cell(c)[a / 3];
      if (a % 3 != 2)
        mass[2 * m + a % 3] += rho * area / 3;
      for (int b = 0; b < 9; ++b)
      {
        const int n = body.cell(c)[b / 3];
        const double value = J[9 * a + b];
        if (a % 3 != 2 and b % 3 != 2)
          A(2 * m + a % 3, 2 * n + b % 3) += value;
        else if (a % 3 != 2)
          B(2 * m + a % 3, n) += value;
        else if (b % 3 != 2)
          C(m, 2 * n + b % 3) += value;
        else
          D(m, n) += value;
      }
    }
  }
  Eigen::MatrixXd K = A - B * D.partialPivLu().solve(C);
  for (int n : body.nodes("bottom"))
    for (int i = 2 * n; i < 2 * n + 2; ++i)
    {
      K.row(i).setZero();
      K.col(i).setZero();
    }
  const Eigen::VectorXd w = mass.cwiseSqrt().cwiseInverse();
  K = w.asDiagonal() * K * w.asDiagonal();
  return std::sqrt(K.eigenvalues().real().maxCoeff());
}
} // namespace

TEST_CASE("the explicit scheme is stable below 2 / w_max and not above",
          "[verification][limits]")
{
  const int points = GENERATE(1, 3, 6);
  const double share = GENERATE(0.97, 1.03);
  CAPTURE(points, share);
  Body body(square(points));
  const double dt = share * 2 / highest_frequency(body);
  std::mt19937_64 random(4);
  for (double& v : body.state().v)
    v = 1e-6 * (static_cast<double>(random() % 2001) / 1000 - 1);
  for (int n : body.nodes("bottom"))
    body.state().v[2 * n] = body.state().v[2 * n + 1] = 0;
  auto stage = test::stage(1e3);
  stage.boundary["bottom"].fixed = true;
  stage.dynamics = scene::Dynamics{.beta = 0};
  body.set_stage(stage);
  double most = 0;
  for (int k = 0; k < 200 and most < 1; ++k)
  {
    if (not body.step(k * dt, (k + 1) * dt))
    {
      most = 1;
      break;
    }
    most = std::max(most, test::largest(body.state().v));
  }
  CAPTURE(most);
  if (share < 1)
    CHECK(most < 2e-5); // a wave's focus is a few times its start
  else
    CHECK(most > 1e-3);
}

namespace
{
struct Buckling
{
  bool ok;
  int iterations;
};

/// A slender clamped column, out of true by a small push, pressed to a share of
/// Euler's strain pi^2 / 12 (b / 2 H)^2 and beyond in 10 steps.
Buckling press(int points, bool geometric, double share)
{
  const double b = 1, H = 10;
  auto scene = test::rectangle(b, H, 2, 20, "elastic",
                               {{"E", E}, {"nu", nu}, {"density", rho}});
  scene.solver.geometric_stiffness = geometric;
  scene.solver.factorisation = scene::Factorisation::lu; // Newton itself
  scene.solver.lag_jacobian = 1;
  scene.solver.max_iterations = 50;
  test::use_points(scene, points);
  Body body(scene);
  auto stage = test::stage(2);
  stage.boundary["bottom"].fixed = true;
  // E / (1 - nu^2) in the plane; the strain is the load over that
  const double euler = std::numbers::pi * std::numbers::pi / 12
                       * std::pow(b / (2 * H), 2) * E / (1 - nu * nu);
  stage.boundary["top"].traction_x = test::constant(1e-4 * euler);
  stage.boundary["top"].traction_y =
      scene::TimeSeries{{0, 1}, {0, -share * euler}};
  body.set_stage(stage);
  Buckling out{true, 0};
  for (int k = 0; k < 5; ++k)
  {
    const auto taken = body.step(0.2 * k, 0.2 * (k + 1));
    out.iterations += taken.iterations;
    out.ok = out.ok and taken.ok;
    if (not out.ok)
      break;
  }
  return out;
}
} // namespace

TEST_CASE("near buckling Newton needs the geometric stiffness",
          "[verification][limits]")
{
  const int points = GENERATE(1, 3);
  const auto far = press(points, false, 0.2), near = press(points, false, 0.95),
             with = press(points, true, 0.95);
  CAPTURE(points, far.iterations, near.ok, near.iterations, with.iterations);
  CHECK(far.ok);
  REQUIRE(with.ok);
  CHECK(with.iterations <= 25);
  CHECK((not near.ok or near.iterations > 2.5 * with.iterations));
}

TEST_CASE("thin cells pass the patch test and converge",
          "[verification][limits]")
{
  const double aspect = GENERATE(1.0, 30.0, 1e3);
  const int points = GENERATE(1, 3, 6);
  CAPTURE(aspect, points);
  auto scene = test::rectangle(1, 1 / aspect, 4, 4, "elastic",
                               {{"E", E}, {"nu", nu}, {"density", rho}});
  scene.mesh.distortion = 0.25;
  scene.solver.tolerance = 1e-12;
  test::use_points(scene, points);
  Body body(scene);
  auto stage = test::stage();
  stage.boundary["left"].roller = stage.boundary["bottom"].roller = true;
  stage.boundary["right"].traction_x = test::constant(0.02 * E);
  stage.boundary["top"].traction_y = test::constant(-0.01 * E);
  body.set_stage(stage);
  const auto taken = body.step(0, 1);
  CAPTURE(taken.cause, taken.residuals);
  REQUIRE(taken);
  CHECK(taken.iterations <= 8);
  double error = 0;
  for (std::size_t q = 0; q < body.state().P.size(); ++q)
  {
    const double* s = &body.state().s[4 * q];
    const double p = body.state().P[q];
    error = std::max({error, std::abs(s[0] - p - 0.02 * E),
                      std::abs(s[1] - p + 0.01 * E), std::abs(s[3])});
  }
  CHECK(error < 1e-10 * E);
}
