// SPDX-License-Identifier: LGPL-3.0-or-later
#include "simulation.h"

#include <cmath>
#include <numbers>

namespace mmale
{
namespace
{
/// Scenes with prescribed motion turn the mesh as a rigid body.
void rotate(const scene::Motion& motion, double share, double dt, State& state)
{
  const double angle = 2 * std::numbers::pi * motion.revolutions * share;
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t n = 0; n < state.x.size(); n += 2)
  {
    const double dx = state.x[n] - motion.centre[0],
                 dy = state.x[n + 1] - motion.centre[1];
    const double x = motion.centre[0] + c * dx - s * dy,
                 y = motion.centre[1] + s * dx + c * dy;
    state.v[n] = (x - state.x[n]) / dt;
    state.v[n + 1] = (y - state.x[n + 1]) / dt;
    state.x[n] = x;
    state.x[n + 1] = y;
  }
}
} // namespace

bool step(Simulation& sim, const scene::Stage& stage, double t0, double t1,
          int number, StepLog& log)
{
  // 1 the material moves, and the mesh with it
  if (sim.problem)
  {
    if (not sim.problem->solve(sim.state, t0, t1, log.newton))
      return false;
  }
  else
    rotate(*sim.scene.motion, (t1 - t0) / stage.duration, t1 - t0, sim.state);
  sim.state.time += t1 - t0;

  // 2 the mesh moves alone, 3 the state travels through it, 4 and is made
  // admissible again
  if (sim.remap and sim.remap->due(sim.state, number))
  {
    const bool dynamic = not sim.state.a.empty();
    const double before = dynamic ? sim.problem->kinetic_energy(sim.state) : 0;
    std::vector<std::uint8_t> at_wall;
    if (sim.problem)
      at_wall = sim.problem->at_wall();
    sim.remap->run(sim.state, at_wall, log.remap);
    if (dynamic and log.remap.done)
    {
      sim.state.work.remap += sim.problem->kinetic_energy(sim.state) - before;
      sim.problem->rebalance(sim.state, t1);
    }
  }
  return true;
}
} // namespace mmale
