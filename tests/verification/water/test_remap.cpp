// SPDX-License-Identifier: LGPL-3.0-or-later
// What a remap keeps of sand with water in its pores.
#include "simulation.h"
#include "soil.h"
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <numbers>
#include <vector>

using namespace mmale;

namespace
{
constexpr int cells = 8;
constexpr double depth = 0.5; // of the sand that has turned liquid [m]

/// Total pressure, linear in depth: the weight of all [Pa].
double total(double y)
{
  return 2e4 * (1 - y);
}
/// The grains of liquid sand bear nothing; those below bear their weight [Pa].
double effective(double y)
{
  return 1e4 * std::max(0.0, 1 - depth - y);
}

/// A square of soil whose inner nodes come home in a remap.
scene::Scene eulerian(scene::Scene scene)
{
  scene.remap.mode = scene::RemapMode::eulerian;
  scene.remap.every = 1;
  scene.stage.push_back(test::stage());
  return scene;
}

/// Pressures of cells, then of nodes.
using Pressures = std::vector<double>;

double height(const Simulation& sim, int c)
{
  double y = 0;
  for (int n : sim.domain.cells[c])
    y += sim.domain.initial_x[2 * n + 1] / 3;
  return y;
}

/// Move the inner nodes, each time another way, and let remaps bring them home.
void remap(Simulation& sim, int times)
{
  for (int k = 1; k <= times; ++k)
  {
    std::vector<double>& x = sim.state.x;
    for (std::size_t i = 0; i < x.size(); i += 2)
    {
      const double bump = std::sin(std::numbers::pi * x[i])
                          * std::sin(std::numbers::pi * x[i + 1]);
      const double sign = k % 2 ? 1 : -1;
      x[i] += 0.02 * sign * bump;
      x[i + 1] -= 0.03 * sign * bump;
    }
    bridge::RemapLog log;
    REQUIRE(sim.remap->due(sim.state, k));
    sim.remap->run(sim.state, {}, log);
    INFO(log.trouble);
    REQUIRE(log.done);
  }
}

/// A pressure that travels by itself, in a body without water.
Pressures alone(double (*pressure)(double), int times)
{
  const auto scene =
      eulerian(test::rectangle(1, 1, cells, cells, "elastic",
                               {{"E", 1e7}, {"nu", 0.25}, {"density", 2000}}));
  Simulation sim(MPI_COMM_SELF, scene);
  State& state = sim.state;
  for (std::size_t c = 0; c < state.P.size(); ++c)
    state.P[c] = pressure(height(sim, static_cast<int>(c)));
  for (std::size_t n = 0; n < state.p.size(); ++n)
    state.p[n] = pressure(state.x[2 * n + 1]);
  remap(sim, times);
  Pressures out = state.P;
  out.insert(out.end(), state.p.begin(), state.p.end());
  return out;
}

/// Effective pressures of soil with water, after remaps.
Pressures with_water(int times)
{
  const auto scene = eulerian(test::Soil().rectangle(1, 1, cells, cells));
  Simulation sim(MPI_COMM_SELF, scene);
  State& state = sim.state;
  constexpr std::size_t h = material::Water::num_history; // elastic has none
  for (std::size_t c = 0; c < state.P.size(); ++c)
  {
    const double y = height(sim, static_cast<int>(c));
    state.P[c] = total(y);
    material::set_pores({total(y) - effective(y), 0.4},
                        std::span(state.history).subspan(h * c, h));
  }
  for (std::size_t n = 0; n < state.p.size(); ++n)
  {
    const double y = state.x[2 * n + 1];
    state.p[n] = total(y);
    state.p_w[n] = total(y) - effective(y);
  }
  remap(sim, times);
  Pressures out = state.P;
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] -= material::pores(std::span(state.history).subspan(h * c, h)).p_w;
  for (std::size_t n = 0; n < state.p.size(); ++n)
    out.push_back(state.p[n] - state.p_w[n]);
  return out;
}
} // namespace

TEST_CASE("a remap leaves no tension in liquid sand; where total and pore "
          "pressure travel, there is",
          "[remap][water]")
{
  constexpr int times = 10;
  const Pressures ours = with_water(times);
  Pressures naive = alone(total, times);
  const Pressures water =
      alone([](double y) { return total(y) - effective(y); }, times);
  for (std::size_t i = 0; i < naive.size(); ++i)
    naive[i] -= water[i];

  const double bears = effective(0); // at the bottom
  const auto cell = 2 * cells * cells;
  for (const bool nodes : {false, true})
  {
    const auto least = [&](const Pressures& p)
    {
      const auto middle = p.begin() + cell;
      return nodes ? *std::min_element(middle, p.end())
                   : *std::min_element(p.begin(), middle);
    };
    CAPTURE(nodes, least(ours), least(naive));
    CHECK(least(ours) > -1e-12 * total(0)); // round-off of the sum p' + p_w
    CHECK(least(naive) < -1e-2 * bears);
  }
}
