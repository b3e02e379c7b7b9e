// SPDX-License-Identifier: LGPL-3.0-or-later
#include "simulation.h"

#include <algorithm>
#include <cmath>

namespace mmale
{
namespace
{
/// A tracer's mean over a cell: the share of points inside its circle, taken
/// where the cell's centre is.
double tracer_value(const scene::Tracer& tracer, const mesh::Domain& domain,
                    int cell)
{
  double centre[2] = {0, 0};
  for (int n : domain.cells[cell])
    for (int d = 0; d < 2; ++d)
      centre[d] += domain.initial_x[2 * n + d] / 3;
  const double distance =
      std::hypot(centre[0] - tracer.centre[0], centre[1] - tracer.centre[1]);
  return distance < tracer.radius ? tracer.inside : tracer.outside;
}
} // namespace

Simulation::Simulation(MPI_Comm comm, const scene::Scene& scene)
    : scene(scene), domain(mesh::make_domain(comm, mesh::make_grid(scene.mesh),
                                             scene.boundary))
{
  const std::size_t nodes = domain.num_nodes(), cells = domain.num_cells();
  state.x = domain.initial_x;
  state.v.assign(2 * nodes, 0);
  for (const auto& [name, tracer] : scene.tracer)
  {
    auto& values = state.tracer[name];
    values.resize(cells);
    for (std::size_t c = 0; c < cells; ++c)
      values[c] = tracer_value(tracer, domain, static_cast<int>(c));
  }
  if (not scene.motion)
  {
    const auto& material = scene.material.begin()->second;
    law = material::make_law(material.law, material.parameters);
    problem = std::make_unique<lagrangian::Problem>(
        domain, *law, scene.symmetry, scene.solver, clock);
    state.p.assign(nodes, 0);
    state.s.assign(4 * cells, 0);
    state.P.assign(cells, 0);
    state.density.assign(cells, problem->element().density());
    state.history.assign(cells * problem->element().num_history(), 0);
  }
  if (scene.remap.mode != scene::RemapMode::lagrangian)
    remap = std::make_unique<bridge::RemapStep>(domain, scene, law, clock);
}
} // namespace mmale
