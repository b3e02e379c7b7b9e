// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>

using namespace mmale;
using Catch::Approx;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using test::Body;

namespace
{
scene::Scene metal(const char* law = "j2")
{
  auto scene = test::rectangle(1, 1, 4, 4, law,
                               {{"E", 2.6e6}, {"nu", 0.3}, {"density", 1e3}});
  if (scene.material["body"].law == "j2")
    scene.material["body"].parameters.insert(
        {{"yield_stress", 2e6}, {"hardening", 0}});
  scene.mesh.distortion = 0.3;
  return scene;
}

/// Give all cells one stress below yield.
void stress(Body& body, const Eigen::Vector4d& s, double p)
{
  for (int c = 0; c < body.num_cells(); ++c)
    Eigen::Vector4d::Map(body.state().s.data() + 4 * c) = s;
  std::ranges::fill(body.state().P, p);
  std::ranges::fill(body.state().p, p);
}
} // namespace

TEST_CASE("a stressed body turns without a change of its stress",
          "[verification][motion]")
{
  const double angle = std::numbers::pi / 180 * GENERATE(100.0, 170.0, -35.0);
  const int steps = GENERATE(1, 40);
  CAPTURE(angle, steps);
  const Eigen::Vector4d s(9e3, -4e3, -5e3, 3e3);
  const double p = 7e3;
  Body body(metal());
  stress(body, s, p);
  const auto start = body.state().x;
  const Matrix2d step = Eigen::Rotation2Dd(angle / steps).toRotationMatrix();
  const Vector2d centre(0.3, 1.4);
  for (int k = 0; k < steps; ++k)
    REQUIRE(test::solve_prescribed(
                body,
                [&](double x, double y) -> std::array<double, 2>
                {
                  const Vector2d u =
                      (step - Matrix2d::Identity()) * (Vector2d(x, y) - centre);
                  return {u[0], u[1]};
                })
            < 1e-12);
  const Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Matrix2d turned =
      R * Matrix2d{{s[0], s[3]}, {s[3], s[1]}} * R.transpose();
  const Eigen::Vector4d exact(turned(0, 0), turned(1, 1), s[2], turned(0, 1));
  double error = 0, place = 0;
  for (int c = 0; c < body.num_cells(); ++c)
    error = std::max(
        {error, (Eigen::Vector4d(body.state().s.data() + 4 * c) - exact).norm(),
         std::abs(body.state().P[c] - p)});
  for (int n = 0; n < body.num_nodes(); ++n)
    place = std::max(place, (Vector2d(&body.state().x[2 * n]) - centre
                             - R * (Vector2d(&start[2 * n]) - centre))
                                .norm());
  CHECK(place < 1e-12);
  // Strain at round-off, eps / cos^2(angle / 2) a step, times 2 G = 100 |s|:
  // relative to the modulus it is nothing.
  const double G = 1e6, mid = std::cos(angle / steps / 2);
  CHECK(error < 1e-14 * G * std::sqrt(steps) / (mid * mid));
  CHECK(error < 1e-12 * G);
  CHECK(test::largest(body.state().history) == 0);
}

TEST_CASE("a closed cycle of stretches brings stress and pressure back",
          "[verification][motion]")
{
  // Along x and y in turn, out and back in another order: no rotation, so the
  // increments add up. The body has a stress to come back to.
  auto scene = metal("elastic");
  scene.solver.tolerance = 1e-13;
  Body body(scene);
  auto stage = test::stage(8);
  stage.boundary["left"].roller = stage.boundary["bottom"].roller = true;
  stage.boundary["right"].displacement_x =
      scene::TimeSeries{{0, 2, 4, 6, 8}, {0, 0.2, 0.2, 0, 0}};
  stage.boundary["top"].displacement_y =
      scene::TimeSeries{{0, 2, 4, 6, 8}, {0, 0, -0.15, -0.15, 0}};
  body.set_stage(stage);
  const Eigen::Vector4d s(2e5, -3e5, 1e5, 0);
  const double p_0 = 4e5;
  stress(body, s, p_0);
  double peak = 0;
  for (int k = 0; k < 16; ++k)
  {
    const auto taken = body.step(0.5 * k, 0.5 * (k + 1));
    CAPTURE(k, taken.cause, taken.residuals);
    REQUIRE(taken);
    peak = std::max(
        {peak, test::largest(body.state().s), test::largest(body.state().p)});
  }
  CHECK(peak > 6e5);
  double error = 0;
  for (int c = 0; c < body.num_cells(); ++c)
    error = std::max(
        {error, (Eigen::Vector4d(body.state().s.data() + 4 * c) - s).norm(),
         std::abs(body.state().P[c] - p_0)});
  for (double p : body.state().p)
    error = std::max(error, std::abs(p - p_0));
  CHECK(error < 1e-10 * peak);
  for (double rho : body.state().density)
    CHECK(rho == Approx(1e3).epsilon(1e-12));
}

TEST_CASE("a body pushed unevenly and pulled back the same way is at rest up "
          "to second order",
          "[verification][motion]")
{
  // The law retraces its path exactly; the bubble works on the end geometry
  // of a step, which is another one on the way back.
  double left[2];
  for (int level = 0; level < 2; ++level)
  {
    const double push = 2e-3 / (1 << level);
    Body body(metal("elastic"));
    auto stage = test::stage(2);
    stage.boundary["bottom"].fixed = true;
    stage.boundary["top"].displacement_x =
        scene::TimeSeries{{0, 1, 2}, {0, push, 0}};
    stage.boundary["top"].displacement_y =
        scene::TimeSeries{{0, 1, 2}, {0, -push, 0}};
    body.set_stage(stage);
    REQUIRE(body.step(0, 1));
    const double peak = test::largest(body.state().p);
    REQUIRE(body.step(1, 2));
    left[level] = test::largest(body.state().p) / peak;
  }
  CAPTURE(left[0], left[1]);
  CHECK(left[0] < 2e-3);
  CHECK(std::log2(left[0] / left[1]) > 0.9);
}
