// SPDX-License-Identifier: LGPL-3.0-or-later
// What a remap keeps of the history of sand: grains, and frames.
#include "body.h"
#include "simulation.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace mmale;

namespace
{
constexpr double grain_density = 2650;
constexpr int size = 5; // void ratio and intergranular strain

/// A square of sand, turned by an angle about the origin, Eulerian: a remap
/// brings the nodes home.
scene::Scene square(double angle)
{
  auto scene =
      test::rectangle(1, 1, 8, 8, "hypoplastic",
                      {{"grain_density", grain_density}, {"void_ratio", 0.7}});
  scene.material["body"].texts = {{"sand", "hochstetten"},
                                  {"intergranular_strain", "on"}};
  scene.mesh.shape = "quadrilateral";
  const double c = std::cos(angle), s = std::sin(angle);
  scene.mesh.corners = {{{0, 0}, {c, s}, {c - s, s + c}, {-s, c}}};
  scene.remap.mode = scene::RemapMode::eulerian;
  scene.remap.every = 1;
  scene.stage.push_back(test::stage());
  return scene;
}

/// A symmetric tensor, xx yy zz xy, turned by an angle.
std::array<double, 4> turned(std::array<double, 4> t, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c * t[0] + s * s * t[1] - 2 * s * c * t[3],
          s * s * t[0] + c * c * t[1] + 2 * s * c * t[3], t[2],
          s * c * (t[0] - t[1]) + (c * c - s * s) * t[3]};
}

/// Sand with a jump of the void ratio and a rough intergranular strain, its
/// inner nodes away from home; after the remap.
struct Remapped
{
  explicit Remapped(double angle)
      : scene(square(angle)), sim(MPI_COMM_SELF, scene)
  {
    State& state = sim.state;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(-1, 1);
    for (std::size_t c = 0; c < state.density.size(); ++c)
    {
      double* q = state.history.data() + size * c;
      q[0] = c % 16 < 8 ? 0.6 : 0.9;
      const auto h = turned({4e-5 * share(random), 4e-5 * share(random),
                             4e-5 * share(random), 4e-5 * share(random)},
                            angle);
      std::ranges::copy(h, q + 1);
      state.density[c] = grain_density / (1 + q[0]);
      state.P[c] = 1e4;
    }
    const double c = std::cos(angle), s = std::sin(angle);
    for (int n = 0; n < sim.domain.num_nodes(); ++n)
    {
      double* X = state.x.data() + 2 * n;
      const double x = c * X[0] + s * X[1], y = -s * X[0] + c * X[1];
      const double bump =
          std::sin(std::numbers::pi * x) * std::sin(std::numbers::pi * y);
      const double u = 0.05 * bump, v = -0.03 * bump * std::cos(3 * x);
      X[0] += c * u - s * v;
      X[1] += s * u + c * v;
    }
    before = grains();
    bridge::RemapLog log;
    REQUIRE(sim.remap->due(state, 1));
    sim.remap->run(state, {}, log);
    INFO(log.trouble);
    REQUIRE(log.done);
  }

  /// Volume of the grains by the void ratio, and by the mass [m3/m].
  std::array<double, 2> grains() const
  {
    std::array<double, 2> out{0, 0};
    const State& state = sim.state;
    for (int c = 0; c < sim.domain.num_owned_cells; ++c)
    {
      const auto [i, j, k] = sim.domain.cells[c];
      const auto& x = state.x;
      const double area =
          0.5
          * ((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
             - (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1]));
      out[0] += area / (1 + state.history[size * c]);
      out[1] += area * state.density[c] / grain_density;
    }
    return out;
  }

  scene::Scene scene;
  Simulation sim;
  std::array<double, 2> before;
};
} // namespace

TEST_CASE("a remap keeps the volume of the grains", "[remap]")
{
  const Remapped sand(0);
  const auto after = sand.grains();
  CHECK(std::abs(after[0] / sand.before[0] - 1) < 1e-14);
  CHECK(std::abs(after[1] / sand.before[1] - 1) < 1e-14);
  // 1 / (1 + e) and density travel alike, so each cell's mass and void ratio
  // still agree
  double apart = 0, moved = 0;
  const auto& state = sand.sim.state;
  for (std::size_t c = 0; c < state.density.size(); ++c)
  {
    const double e = state.history[size * c];
    apart = std::max(apart,
                     std::abs(state.density[c] * (1 + e) / grain_density - 1));
    moved = std::max(moved, std::abs(e - (c % 16 < 8 ? 0.6 : 0.9)));
    CHECK(e >= 0.6 - 1e-14);
    CHECK(e <= 0.9 + 1e-14);
  }
  CHECK(apart < 1e-13);
  CHECK(moved > 0.01);
}

TEST_CASE("a remap of history does not depend on the frame", "[remap]")
{
  const double angle = 0.6;
  const Remapped one(0), other(angle);
  const auto& a = one.sim.state;
  const auto& b = other.sim.state;
  REQUIRE(a.history.size() == b.history.size());
  double apart[2] = {0, 0}, moved = 0;
  // cells are numbered by the grid, which does not know the angle
  for (std::size_t c = 0; c < a.density.size(); ++c)
  {
    const double* p = a.history.data() + size * c;
    const double* q = b.history.data() + size * c;
    apart[0] = std::max(apart[0], std::abs(p[0] - q[0]));
    const auto h = turned({p[1], p[2], p[3], p[4]}, angle);
    for (int i = 0; i < 4; ++i)
    {
      apart[1] = std::max(apart[1], std::abs(h[i] - q[1 + i]));
      moved = std::max(moved, std::abs(p[1 + i]));
    }
  }
  CHECK(apart[0] < 1e-12);
  CHECK(apart[1] < 1e-14);
  CHECK(moved > 1e-5);
}
