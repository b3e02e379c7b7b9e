// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "body.h"
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace mmale::test
{
/// A column on a smooth base between smooth walls: P-waves along y and nothing
/// else, c^2 = (K + 4 G / 3) / rho. Strains of 1e-7, so that all is linear.
class Column
{
public:
  static constexpr double height = 2, E = 1e7, nu = 0.3, rho = 2000;
  static constexpr double G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));

  static double speed() { return std::sqrt((K + 4 * G / 3) / rho); }
  /// Of mode k = 1, 2, ...: sin((2 k - 1) pi y / 2 H).
  static double wave_number(int k = 1)
  {
    return (2 * k - 1) * std::numbers::pi / (2 * height);
  }
  static double frequency(int k = 1) { return speed() * wave_number(k); }

  /// n cells over the height, 2 over the width.
  static scene::Scene scene(int n, int points)
  {
    auto s = rectangle(4 * height / n, height, 2, n, "elastic",
                       {{"E", E}, {"nu", nu}, {"density", rho}});
    s.mesh.diagonal = scene::Diagonal::alternating;
    s.solver.tolerance = points == 1 ? 1e-12 : 1e-11;
    use_points(s, points);
    return s;
  }
  static scene::Stage stage(const scene::Dynamics& dynamics)
  {
    auto s = test::stage(1e9);
    s.boundary["left"].roller = s.boundary["right"].roller = true;
    s.boundary["bottom"].roller = true;
    s.dynamics = dynamics;
    return s;
  }

  Column(int n, int points, const scene::Dynamics& dynamics)
      : Column(scene(n, points), dynamics)
  {
  }
  /// At rest; give it a velocity, then `begin`.
  Column(const scene::Scene& scene, const scene::Dynamics& dynamics)
      : body(scene), _stage(stage(dynamics)), _start(body.state().x)
  {
  }

  /// Add the velocity of a mode, by its largest value [m/s].
  void add_mode(int k, double v)
  {
    for (int n = 0; n < body.num_nodes(); ++n)
      body.state().v[2 * n + 1] += v * shape(k, n);
  }
  void begin() { body.set_stage(_stage); }
  void step(double dt)
  {
    const auto taken = body.step(_time, _time + dt);
    CAPTURE(taken.cause, taken.residuals);
    _time += dt;
    REQUIRE(taken);
  }

  /// Share of a mode in the displacement and in the velocity (x and v). Nodes
  /// weigh alike but for the ends, which are half.
  double displacement(int k = 1) { return share(k, true); }
  double velocity(int k = 1) { return share(k, false); }

  Body body;

private:
  double shape(int k, int n) const
  {
    return std::sin(wave_number(k) * _start[2 * n + 1]);
  }
  double share(int k, bool displacement)
  {
    double sum = 0, square = 0;
    for (int n = 0; n < body.num_nodes(); ++n)
    {
      const double y = _start[2 * n + 1], s = shape(k, n);
      const double weight = y > height * (1 - 1e-12) ? 0.5 : 1;
      sum += weight * s
             * (displacement ? body.state().x[2 * n + 1] - y
                             : body.state().v[2 * n + 1]);
      square += weight * s * s;
    }
    return sum / square;
  }

  scene::Stage _stage;
  std::vector<double> _start;
  double _time = 0;
};
} // namespace mmale::test
