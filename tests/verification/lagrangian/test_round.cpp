// SPDX-License-Identifier: LGPL-3.0-or-later
// Lame's thick cylinder and sphere about the axis: orders of displacement and
// stress in every layout.
#include "body.h"
#include "lagrangian/kernel.h"

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>

using namespace mmale;
using test::Body;

namespace
{
constexpr double a = 0.1, b = 0.2, E = 1e9, nu = 0.3; // strains of 1e-9

/// Displacement along the radius and stresses for an inner pressure of 1.
struct Exact
{
  double u, radial, hoop;
};
Exact cylinder(double r)
{
  const double A = a * a / (b * b - a * a), B = A * b * b;
  return {(1 + nu) / E * ((1 - 2 * nu) * A * r + B / r), A - B / (r * r),
          A + B / (r * r)};
}
Exact sphere(double R)
{
  const double A = a * a * a / (b * b * b - a * a * a), c = std::pow(b / R, 3);
  return {A * R / E * ((1 - 2 * nu) + 0.5 * (1 + nu) * c), A * (1 - c),
          A * (1 + 0.5 * c)};
}

/// The four stresses rr zz tt rz at a place.
std::array<double, 4> stress(bool ball, double r, double z)
{
  if (not ball)
  {
    const auto [u, radial, hoop] = cylinder(r);
    return {radial, nu * (radial + hoop), hoop, 0};
  }
  const double R = std::hypot(r, z), c = r / R, s = z / R;
  const auto [u, radial, hoop] = sphere(R);
  return {radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, hoop,
          (radial - hoop) * c * s};
}

std::array<double, 3> shares(int points, int q)
{
  if (points == 1)
    return {1. / 3, 1. / 3, 1. / 3};
  return points == 3 ? lagrangian::points<3>()[q] : lagrangian::points<6>()[q];
}

/// Relative errors, RMS, of nodal displacements and of the points' stresses.
std::array<double, 2> errors(bool ball, int n, int points)
{
  auto scene =
      test::rectangle(b - a, ball ? 1 : 0.1, n, ball ? 2 * n : n, "elastic",
                      {{"E", E}, {"nu", nu}, {"density", 1e3}});
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.mesh.origin = {a, 0};
  scene.solver.tolerance = 1e-11;
  test::use_points(scene, points);
  Body body(scene);
  auto& x = body.state().x;
  if (ball) // a quarter of a ring: the height is the angle
    for (int i = 0; i < body.num_nodes(); ++i)
    {
      const double R = x[2 * i], t = 0.5 * std::numbers::pi * x[2 * i + 1];
      // cos(pi / 2) is not quite zero
      x[2 * i] = x[2 * i + 1] > 1 - 1e-12 ? 0 : R * std::cos(t);
      x[2 * i + 1] = R * std::sin(t);
    }
  const auto start = x;
  auto stage = test::stage();
  stage.boundary["bottom"].roller = true;
  if (ball)
    stage.boundary["top"].displacement_x = test::constant(0);
  else
    stage.boundary["top"].roller = true;
  stage.boundary["left"].pressure = test::constant(1);
  body.set_stage(stage);
  const auto taken = body.step(0, 1);
  CAPTURE(ball, n, points, taken.cause, taken.residuals);
  REQUIRE(taken);
  double off = 0, size = 0;
  for (int i = 0; i < body.num_nodes(); ++i)
  {
    const double r = start[2 * i], z = start[2 * i + 1];
    const double R = ball ? std::hypot(r, z) : r;
    const double u = (ball ? sphere(R) : cylinder(R)).u;
    // increments of a step of 1 s; the coordinates have lost their digits
    const double ux = body.state().v[2 * i], uy = body.state().v[2 * i + 1];
    off +=
        std::pow(ux - u * r / R, 2) + std::pow(uy - (ball ? u * z / R : 0), 2);
    size += u * u;
  }
  double stress_off = 0, stress_size = 0;
  for (int c = 0; c < body.num_cells(); ++c)
    for (int q = 0; q < points; ++q)
    {
      double r = 0, z = 0;
      for (int v = 0; v < 3; ++v)
      {
        r += shares(points, q)[v] * start[2 * body.cell(c)[v]];
        z += shares(points, q)[v] * start[2 * body.cell(c)[v] + 1];
      }
      const auto exact = stress(ball, r, z);
      const int at = points * c + q;
      for (int i = 0; i < 4; ++i)
      {
        const double s =
            body.state().s[4 * at + i] - (i < 3 ? body.state().P[at] : 0);
        stress_off += std::pow(s - exact[i], 2) * (i == 3 ? 2 : 1);
        stress_size += exact[i] * exact[i] * (i == 3 ? 2 : 1);
      }
    }
  return {std::sqrt(off / size), std::sqrt(stress_off / stress_size)};
}
} // namespace

TEST_CASE("Lame's cylinder and sphere: displacement of order 2, stress of "
          "order 1 at least",
          "[verification][lame]")
{
  const bool ball = GENERATE(false, true);
  const int points = GENERATE(1, 3, 6);
  const auto coarse = errors(ball, 8, points), fine = errors(ball, 16, points);
  CAPTURE(ball, points, coarse[0], fine[0], coarse[1], fine[1]);
  CHECK(fine[0] < 3e-3);
  CHECK(fine[1] < 4e-2);
  CHECK(std::log2(coarse[0] / fine[0]) > 1.85);
  CHECK(std::log2(coarse[1] / fine[1]) > 0.95);
}
