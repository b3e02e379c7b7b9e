// SPDX-License-Identifier: LGPL-3.0-or-later
// Saturated soil in motion.
#include "column.h"
#include "soil.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace mmale;
using namespace mmale::test;
using Catch::Approx;

namespace
{
/// A column of the grains, water and skeleton of a sand whose waves are known:
/// frequency of its lowest mode, times 4 H / 2 pi.
double wave_speed(const char* drainage)
{
  // K_skeleton = 50 MPa, G = 30 MPa; bulk density 1957 kg/m3
  const double K = 50e6, G = 30e6;
  const Soil soil{.E = 9 * K * G / (3 * K + G),
                  .nu = (3 * K - 2 * G) / (2 * (3 * K + G)),
                  .density = 1957 - 420,
                  .n = 0.42,
                  .k = 1e-9};
  auto scene = Column::scene(16, 1);
  soil.put_into(scene);
  scene.water->drainage = drainage;
  scene.solver.tolerance = 1e-9; // the water strains a hundredth as much
  Column column(scene, {});
  column.add_mode(1, 1e-6);
  column.begin();
  const double dt = 4 * Column::height / 1585.648 / 200;
  // a quarter of a period: until the velocity changes its sign
  double before = column.velocity(), t = 0;
  for (;;)
  {
    column.step(dt);
    const double now = column.velocity();
    t += dt;
    if (now < 0)
      return Column::height / (t - dt * now / (now - before));
    before = now;
  }
}

/// Exact displacement of the surface of a half-space under f(t), u-p without
/// relative acceleration; Simpson's rule.
double surface(double t, double M, double rho, double b)
{
  const auto f = [&](double x)
  {
    const double load = 3000 * (1 - std::cos(75 * (t - x)));
    return load * std::exp(-b * x) * std::cyl_bessel_i(0.0, b * x);
  };
  const int n = 20000;
  double sum = f(0) + f(t);
  for (int i = 1; i < n; ++i)
    sum += (i % 2 ? 4 : 2) * f(i * t / n);
  return sum * t / n / 3 / std::sqrt(M * rho);
}
} // namespace

TEST_CASE("a P-wave runs at its undrained speed", "[water][waves]")
{
  // (K_w + K + 4 G / 3) / rho; without K and G it would be 1571.080 m/s
  CHECK(wave_speed("undrained") == Approx(1585.648).epsilon(0.002));
  CHECK(wave_speed("seepage") == Approx(1585.648).epsilon(0.002));
}

TEST_CASE("a saturated column under 75 rad/s", "[water][waves]")
{
  const double M = 22.3333e6, nu = 0.25, b = 1e4 / (2 * 1e-2 * 670);
  // gamma_w = 1e4 N/m3 in the reference; constituents incompressible there
  const Soil soil{.E = M * (1 + nu) * (1 - 2 * nu) / (1 - nu),
                  .nu = nu,
                  .density = 0.67 * 2000,
                  .n = 0.33,
                  .k = 1e-2 * 9.81 / 10,
                  .K_f = 2.2e13,
                  .K_s = 3.6e14};
  auto scene = soil.rectangle(0.1, 10, 1, 100);
  scene.mesh.grading = scene::Grading{{0.05, 10}, 0.02, 1.05, 0.1};
  scene.mesh.cells = {0, 0};
  scene.mesh.size = 0.2;
  scene.water->time_weight = 0.5;
  Body body(scene);
  auto s = trough();
  s.dynamics.emplace();
  s.boundary["top"].drained = true;
  const double dt = 1e-3;
  scene::TimeSeries& load = s.boundary["top"].pressure.emplace();
  for (int i = 0; i <= 200; ++i)
  {
    load.time.push_back(i * dt);
    load.value.push_back(3000 * (1 - std::cos(75 * i * dt)));
  }
  body.set_stage(s);
  const int top = body.node(0, 10);
  const double y = body.state().x[2 * top + 1];
  const std::map<int, double> reference{
      {50, 2.338250e-4}, {100, 1.598014e-4}, {200, 3.242571e-4}};
  for (int i = 0; i < 200; ++i)
  {
    REQUIRE(body.step(i * dt, (i + 1) * dt));
    if (not reference.contains(i + 1))
      continue;
    const double u = y - body.state().x[2 * top + 1];
    CHECK(surface((i + 1) * dt, M, 670, b)
          == Approx(reference.at(i + 1)).epsilon(1e-5));
    CHECK(u == Approx(reference.at(i + 1)).epsilon(0.005));
  }
}
