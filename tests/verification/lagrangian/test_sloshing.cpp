// SPDX-License-Identifier: LGPL-3.0-or-later
// Water in a basin, against the linear theory of sloshing, and viscous flow
// between plates.
#include "basin.h"
#include "roughness.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using Catch::Approx;
using test::Basin;

namespace
{
/// Period over the exact one, from the second time that the surface is even,
/// with 50 steps a period; 0 where a step fails.
///
/// @param[out] peak of the surface over that of theory
double measured_period(Basin& basin, double& peak)
{
  const double A = Basin::amplitude, dt = Basin::period() / 50;
  basin.push(A * Basin::frequency());
  basin.begin(dt);
  double last = 0;
  int crossings = 0;
  peak = 0;
  for (int k = 1; k <= 55; ++k)
  {
    if (not basin.try_step(dt))
      return 0;
    const double now = basin.surface();
    peak = std::max(peak, std::abs(now) / A);
    if (last * now < 0 and ++crossings == 2)
      return (k - 1 + last / (last - now)) / 50;
    last = now;
  }
  return 0;
}
} // namespace

TEST_CASE("a basin sloshes at its exact frequency, up to h^2",
          "[verification][fluid]")
{
  double error[3];
  for (int level = 0; level < 3; ++level)
  {
    Basin basin(Basin::scene(8 << level));
    double peak;
    const double period = measured_period(basin, peak);
    // the trapezoid rule's own: 1 + (w dt)^2 / 12
    const double trapezoid = std::pow(2 * std::numbers::pi / 50, 2) / 12;
    error[level] = period - 1 - trapezoid;
    CAPTURE(level, period, peak);
    if (level == 2)
    {
      CHECK(std::abs(period - 1) < 5e-3);
      CHECK(peak == Approx(1).epsilon(0.01));
    }
  }
  CAPTURE(error[0], error[1], error[2]);
  CHECK(std::log2(error[0] / error[1]) > 1.8);
  CHECK(std::log2(error[1] / error[2]) > 1.8);
}

namespace
{
/// Many periods, 50 steps each; what is left of the amplitude, the mean period
/// over the exact one and the roughness of p over rho g A.
struct Many
{
  int steps = 0; ///< that went well
  double period = 0, amplitude = 0, roughness = 0;
};

Many slosh(Basin& basin, int periods)
{
  const double A = Basin::amplitude, dt = Basin::period() / 50;
  basin.push(A * Basin::frequency());
  basin.begin(dt);
  Many out;
  double last = 0, first_crossing = 0, crossing = 0;
  int crossings = 0;
  for (int k = 1; k <= 50 * periods and basin.try_step(dt); ++k)
  {
    const double now = basin.surface();
    if (last * now < 0)
    {
      crossing = (k - 1 + last / (last - now)) / 50;
      first_crossing = crossings++ == 0 ? crossing : first_crossing;
    }
    if (k % 50 == 1)
      out.amplitude = 0;
    out.amplitude = std::max(out.amplitude, std::abs(now) / A);
    last = now;
    out.steps = k;
  }
  out.period = 2 * (crossing - first_crossing) / (crossings - 1);
  out.roughness = test::roughness(basin.body, basin.body.state().p)
                  / (Basin::rho * Basin::g * A);
  return out;
}

void check_many(const Many& got, int periods, double trapezoid_and_mesh)
{
  CAPTURE(got.steps, got.period, got.amplitude, got.roughness);
  REQUIRE(got.steps == 50 * periods);
  CHECK(std::abs(got.period - 1) < trapezoid_and_mesh);
  CHECK(got.amplitude == Approx(1).epsilon(0.05));
  // a mesh that moves with water for long gets noisy; this bounds the noise
  CHECK(got.roughness < 3);
}
} // namespace

TEST_CASE("a basin goes on sloshing: 20 periods of 8 cells",
          "[verification][fluid]")
{
  Basin basin(Basin::scene(8), {.alpha = -0.05});
  check_many(slosh(basin, 20), 20, 0.035);
}

TEST_CASE("a basin goes on sloshing: 20 periods of 16 cells",
          "[verification][fluid][slow]")
{
  Basin basin(Basin::scene(16), {.alpha = -0.05});
  check_many(slosh(basin, 20), 20, 1e-2);
}

TEST_CASE("water does not slosh with a bubble that has no inertia",
          "[verification][fluid]")
{
  // next to no viscosity holds the bubbles of layout quadrature
  const int points = GENERATE(3, 6);
  Basin basin(Basin::scene(16, points));
  double peak;
  const double period = measured_period(basin, peak);
  CAPTURE(points, period, peak);
  CHECK((std::abs(period - 1) > 0.02 or std::abs(peak - 1) > 0.1));
}

TEST_CASE("viscous flow between plates, held for 50 steps",
          "[verification][fluid]")
{
  // u = f y (H - y) / 2 viscosity of a body force f; no pressure
  constexpr int n = 16;
  constexpr double viscosity = 3, f = 1.5, dt = 1e-5;
  auto scene = test::rectangle(
      0.5, 1, n / 2, n, "newtonian",
      {{"viscosity", viscosity}, {"bulk_modulus", 1e9}, {"density", 1}});
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.solver.tolerance = 1e-10;
  test::Body body(scene);
  auto stage = test::stage(1, dt);
  stage.gravity = {test::constant(f), test::constant(0)};
  stage.boundary["bottom"].fixed = stage.boundary["top"].fixed = true;
  stage.boundary["left"].displacement_y = test::constant(0);
  stage.boundary["right"].displacement_y = test::constant(0);
  body.set_stage(stage);
  const auto start = body.state().x;
  double first = 0;
  for (int k = 0; k < 50; ++k)
  {
    const auto taken = body.step(k * dt, (k + 1) * dt);
    CAPTURE(k, taken.cause, taken.residuals);
    REQUIRE(taken);
    if (k == 0)
      first = test::largest(body.state().p);
  }
  double worst = 0;
  for (int i = 0; i < body.num_nodes(); ++i)
  {
    const double y = start[2 * i + 1];
    const double exact = f * y * (1 - y) / (2 * viscosity);
    const double u = (body.state().x[2 * i] - start[2 * i]) / (50 * dt);
    worst = std::max(worst, std::abs(u - exact));
  }
  CHECK(worst < 5e-3 * f / (8 * viscosity));
  // the mesh's error, of the shear stress f H / 2 at the plates; held, not
  // grown
  const double last = test::largest(body.state().p);
  CAPTURE(first, last, worst);
  CHECK(first < 0.08 * f / 2);
  CHECK(std::abs(last - first) < 1e-3 * f / 2);
}
