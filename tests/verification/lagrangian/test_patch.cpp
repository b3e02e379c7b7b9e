// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include <Eigen/Dense>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>

using namespace mmale;
using Catch::Approx;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using test::Body;

namespace
{
constexpr double E = 2.6e6, nu = 0.3;
constexpr double G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));

/// A distorted mesh of 2 x 5 x 4 triangles; J2 that does not yield.
scene::Scene patch(const char* law, int points)
{
  auto scene = test::rectangle(1, 0.8, 5, 4, law,
                               {{"E", E}, {"nu", nu}, {"density", 1e3}});
  if (scene.material["body"].law == "j2")
    scene.material["body"].parameters.insert(
        {{"yield_stress", 10 * E}, {"hardening", 0}});
  scene.mesh.distortion = 0.35;
  test::use_points(scene, points);
  return scene;
}

/// Largest distance of the points' stress (s and P) from one stress.
double stress_error(Body& body, const Eigen::Vector4d& s, double p)
{
  double out = 0;
  for (std::size_t q = 0; q < body.state().P.size(); ++q)
  {
    out = std::max(out,
                   (Eigen::Vector4d(body.state().s.data() + 4 * q) - s).norm());
    out = std::max(out, std::abs(body.state().P[q] - p));
  }
  for (double nodal : body.state().p)
    out = std::max(out, std::abs(nodal - p));
  return out;
}

Eigen::Vector4d deviator(double x, double y, double z)
{
  const double mean = (x + y + z) / 3;
  return {x - mean, y - mean, z - mean, 0};
}
} // namespace

TEST_CASE("patch test: a linear displacement of the boundary is found inside, "
          "with one stress",
          "[verification][patch]")
{
  // A stretch along turned axes, f = Q diag(a, b) Q^T: no rotation, so that the
  // time-centred increments are 2 (a - 1) / (a + 1) along the axes.
  const char* law = GENERATE("elastic", "j2");
  const int points = GENERATE(1, 3, 6);
  CAPTURE(law, points);
  const double a = GENERATE(1.2, 1 + 1e-6), b = 2 - 0.93 * a;
  const Matrix2d Q = Eigen::Rotation2Dd(0.6).toRotationMatrix();
  const Matrix2d f = Q * Vector2d(a, b).asDiagonal() * Q.transpose();
  Body body(patch(law, points));
  const auto start = body.state().x;
  const double update =
      test::solve_prescribed(body,
                             [&](double x, double y) -> std::array<double, 2>
                             {
                               const Vector2d u =
                                   (f - Matrix2d::Identity()) * Vector2d(x, y);
                               return {u[0], u[1]};
                             });
  CHECK(update < 1e-12);

  double error = 0;
  for (int n = 0; n < body.num_nodes(); ++n)
    error = std::max(
        error, (Vector2d(&body.state().x[2 * n]) - f * Vector2d(&start[2 * n]))
                   .norm());
  CHECK(error < 1e-12 * std::hypot(1, 0.8));

  Eigen::Vector4d s =
      2 * G * deviator(2 * (a - 1) / (a + 1), 2 * (b - 1) / (b + 1), 0);
  const Matrix2d turned = Q * s.head<2>().asDiagonal() * Q.transpose();
  s << turned(0, 0), turned(1, 1), s[2], turned(0, 1);
  const double p = -K * std::log(a * b);
  // Relative to the stress; at strains of 1e-6 the coordinates have lost six
  // digits before the law sees them.
  const double lost = 1e-12 + 1e-15 / (a - 1);
  CHECK(stress_error(body, s, p) < lost * (s.norm() + std::abs(p)));
}

TEST_CASE("patch test: any linear displacement leaves the stress constant",
          "[verification][patch]")
{
  const Matrix2d f{{1.1, 0.3}, {-0.2, 0.95}};
  Body body(patch("elastic", GENERATE(1, 3, 6)));
  test::solve_prescribed(body,
                         [&](double x, double y) -> std::array<double, 2>
                         {
                           const Vector2d u =
                               f * Vector2d(x, y) - Vector2d(x, y);
                           return {u[0], u[1]};
                         });
  const Eigen::Vector4d s(body.state().s.data());
  CHECK(s.norm() > 0.1 * G);
  CHECK(stress_error(body, s, -K * std::log(f.determinant()))
        < 1e-12 * s.norm());
}

TEST_CASE("patch test about an axis: u_r = c r, u_z = d z",
          "[verification][patch]")
{
  // the hoop stretches as the radius does
  const double a = 1.15, b = 0.9;
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  auto scene = patch("elastic", points);
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.mesh.origin = {GENERATE(0.0, 0.7), 0.0};
  Body body(scene);
  const auto start = body.state().x;
  const double update = test::solve_prescribed(
      body, [&](double r, double z) -> std::array<double, 2>
      { return {(a - 1) * r, (b - 1) * z}; });
  CHECK(update < 1e-12);
  double error = 0;
  for (int n = 0; n < body.num_nodes(); ++n)
    error = std::max(
        error, std::hypot(body.state().x[2 * n] - a * start[2 * n],
                          body.state().x[2 * n + 1] - b * start[2 * n + 1]));
  CHECK(error < 1e-12);
  const double e_r = 2 * (a - 1) / (a + 1), e_z = 2 * (b - 1) / (b + 1);
  const Eigen::Vector4d s = 2 * G * deviator(e_r, e_z, e_r);
  CHECK(stress_error(body, s, -K * std::log(a * a * b)) < 1e-12 * 2 * G);
}

TEST_CASE("patch test by tractions, through the solver",
          "[verification][patch]")
{
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  auto scene = patch("elastic", points);
  scene.solver.tolerance = 1e-11;
  Body body(scene);
  auto stage = test::stage();
  stage.boundary["left"].roller = stage.boundary["bottom"].roller = true;
  stage.boundary["right"].traction_x = test::constant(0.1 * E);
  stage.boundary["top"].traction_y = test::constant(-0.05 * E);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  // sigma_xx and sigma_yy are the tractions; no shear; one stress in all cells
  const Eigen::Vector4d s(body.state().s.data());
  const double p = body.state().P[0];
  CHECK(s[0] - p == Approx(0.1 * E).epsilon(1e-10));
  CHECK(s[1] - p == Approx(-0.05 * E).epsilon(1e-10));
  CHECK(std::abs(s[3]) < 1e-10 * E);
  CHECK(stress_error(body, s, p) < 1e-10 * E);
  // and the rollers carry them over the present lengths of the sides
  const auto& x = body.state().x;
  const int corner = body.node(1, 0.8);
  CHECK(body.reaction("left")[0]
        == Approx(-0.1 * E * x[2 * corner + 1]).epsilon(1e-9));
  CHECK(body.reaction("bottom")[1]
        == Approx(0.05 * E * x[2 * corner]).epsilon(1e-9));
}

TEST_CASE("patch test by tractions about an axis, through the solver",
          "[verification][patch]")
{
  // A disc or a ring of one radial stress: the same pull inside and outside.
  const int points = GENERATE(1, 3, 6);
  const double inner = GENERATE(0.0, 0.7);
  CAPTURE(points, inner);
  auto scene = patch("elastic", points);
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.mesh.origin = {inner, 0};
  scene.solver.tolerance = 1e-12;
  Body body(scene);
  auto stage = test::stage();
  stage.boundary["bottom"].roller = true;
  if (inner == 0)
    stage.boundary["left"].roller = true;
  else
    stage.boundary["left"].traction_x = test::constant(-0.1 * E);
  stage.boundary["right"].traction_x = test::constant(0.1 * E);
  stage.boundary["top"].traction_y = test::constant(-0.05 * E);
  body.set_stage(stage);
  REQUIRE(body.step(0, 1));
  const Eigen::Vector4d s(body.state().s.data());
  const double p = body.state().P[0];
  CHECK(s[0] - p == Approx(0.1 * E).epsilon(1e-11));
  CHECK(s[1] - p == Approx(-0.05 * E).epsilon(1e-11));
  CHECK(s[2] - p == Approx(0.1 * E).epsilon(1e-11));
  CHECK(stress_error(body, s, p) < 1e-12 * E);
}

TEST_CASE("patch test of weight: pressure in balance with gravity moves "
          "nothing",
          "[verification][patch]")
{
  // p linear over the depth and no deviator: every inner node is in balance,
  // and no bubble moves, so that no point gets a stress.
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  const double g = 9.81, rho = 1e3;
  Body body(patch("elastic", points));
  std::vector<double> z(3 * body.num_nodes(), 0);
  for (int n = 0; n < body.num_nodes(); ++n)
    z[3 * n + 2] = body.state().p[n] =
        1e4 - rho * g * body.state().x[2 * n + 1];
  body.set_gravity({0, -g}, {0, -g});
  REQUIRE(body.evaluate(z));
  std::vector<double> force(2 * body.num_nodes(), 0);
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const auto R = body.residual(c, z);
    for (int i = 0; i < 9; ++i)
      if (i % 3 != 2)
        force[2 * body.cell(c)[i / 3] + i % 3] += R[i];
  }
  CHECK(test::largest(force) > 100); // what the boundary carries
  for (const char* side : {"left", "right", "bottom", "top"})
    for (int n : body.nodes(side))
      force[2 * n] = force[2 * n + 1] = 0;
  CHECK(test::largest(force) < 1e-11 * rho * g);
  body.accept(z);
  CHECK(test::largest(body.state().s) < 1e-12 * rho * g);
}
