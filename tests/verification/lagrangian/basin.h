// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "body.h"
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace mmale::test
{
/// A basin of water between smooth walls on a smooth base, filled to its rim
/// and in its first mode of sloshing: by linear theory of an incompressible
/// fluid the surface is A sin(w t) cos(k x), k = pi / L, w^2 = g k tanh(k h).
class Basin
{
public:
  static constexpr double length = 1, depth = 0.5, g = 9.81, rho = 1000;
  static constexpr double k = std::numbers::pi / length;
  static constexpr double amplitude = 1e-4; ///< A [m]

  static double frequency() { return std::sqrt(g * k * std::tanh(k * depth)); }
  static double period() { return 2 * std::numbers::pi / frequency(); }

  /// n cells over the length; of water.
  static scene::Scene scene(int n, int points = 1)
  {
    auto s = rectangle(
        length, depth, n, n / 2, "newtonian",
        {{"viscosity", 1e-3}, {"bulk_modulus", 2.2e9}, {"density", rho}});
    s.mesh.diagonal = scene::Diagonal::alternating;
    s.solver.tolerance = 1e-10;
    use_points(s, points);
    return s;
  }

  explicit Basin(const scene::Scene& scene, scene::Dynamics dynamics = {})
      : body(scene), _start(body.state().x)
  {
    _stage = test::stage(1e9);
    _stage.boundary["left"].roller = _stage.boundary["right"].roller = true;
    _stage.boundary["bottom"].roller = true;
    _stage.gravity = {constant(0), constant(-g)};
    _stage.dynamics = dynamics;
    for (int i = 0; i < body.num_nodes(); ++i)
      body.state().p[i] = rho * g * (depth - _start[2 * i + 1]);
    for (int c = 0; c < body.num_cells(); ++c)
    {
      body.state().P[c] = 0;
      for (int i : body.cell(c))
        body.state().P[c] += body.state().p[i] / 3;
    }
  }

  /// Share of a unit of the surface's velocity in the motion at a node.
  std::array<double, 2> mode(int i) const
  {
    const double x = _start[2 * i], y = _start[2 * i + 1];
    const double scale = 1 / std::sinh(k * depth);
    return {-scale * std::sin(k * x) * std::cosh(k * y),
            scale * std::cos(k * x) * std::sinh(k * y)};
  }
  void push(double v)
  {
    for (int i = 0; i < body.num_nodes(); ++i)
      for (int d = 0; d < 2; ++d)
        body.state().v[2 * i + d] += v * mode(i)[d];
  }
  /// @param dt step that is to come [s]
  void begin(double dt)
  {
    _stage.step = dt;
    body.set_stage(_stage);
  }
  [[nodiscard]] bool try_step(double dt)
  {
    _time += dt;
    return bool(body.step(_time - dt, _time));
  }
  /// Surface's A, from its nodes.
  double surface()
  {
    double sum = 0, square = 0;
    for (int i : body.nodes("top"))
    {
      const double x = _start[2 * i], c = std::cos(k * x);
      const double weight = x < 1e-9 or x > length - 1e-9 ? 0.5 : 1;
      sum += weight * c * (body.state().x[2 * i + 1] - depth);
      square += weight * c * c;
    }
    return sum / square;
  }

  Body body;

private:
  scene::Stage _stage;
  std::vector<double> _start;
  double _time = 0;
};
} // namespace mmale::test
