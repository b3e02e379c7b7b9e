// SPDX-License-Identifier: LGPL-3.0-or-later
#include "simulation.h"

#include "initial.h"
#include "mesh/gmsh.h"
#include <algorithm>
#include <cmath>

namespace mmale
{
namespace
{
using scene::Point;

double cross(const Point& a, const Point& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Area that a circle around the origin shares with the triangle (0, a, b),
/// signed as a, b turn.
double shared_area(const Point& a, const Point& b, double radius)
{
  // the edge a + t (b - a), cut where it enters and leaves the circle
  const Point d{b[0] - a[0], b[1] - a[1]};
  const double dd = d[0] * d[0] + d[1] * d[1];
  const double half = (a[0] * d[0] + a[1] * d[1]) / dd;
  const double inside =
      half * half - (a[0] * a[0] + a[1] * a[1] - radius * radius) / dd;
  const double root = inside > 0 ? std::sqrt(inside) : 0;
  const double t[4] = {0, std::clamp(-half - root, 0.0, 1.0),
                       std::clamp(-half + root, 0.0, 1.0), 1};
  double out = 0;
  for (int i = 0; i < 3; ++i)
  {
    const Point p{a[0] + t[i] * d[0], a[1] + t[i] * d[1]},
        q{a[0] + t[i + 1] * d[0], a[1] + t[i + 1] * d[1]};
    const double turn = cross(p, q);
    out += i == 1 ? 0.5 * turn
                  : 0.5 * radius * radius
                        * std::atan2(turn, p[0] * q[0] + p[1] * q[1]);
  }
  return out;
}

/// A tracer's mean over a cell: by the share of the cell in the circle, or by
/// where the cell's centre lies.
double tracer_value(const scene::Tracer& tracer, const mesh::Domain& domain,
                    int cell)
{
  std::array<Point, 3> x; // from the circle's centre
  for (int v = 0; v < 3; ++v)
    for (int d = 0; d < 2; ++d)
      x[v][d] =
          domain.initial_x[2 * domain.cells[cell][v] + d] - tracer.centre[d];
  double share = 0;
  if (tracer.cut_cells == "centre")
    share = std::hypot(x[0][0] + x[1][0] + x[2][0], x[0][1] + x[1][1] + x[2][1])
            < 3 * tracer.radius;
  else
  {
    const double area =
        0.5 * (cross(x[0], x[1]) + cross(x[1], x[2]) + cross(x[2], x[0]));
    for (int v = 0; v < 3; ++v)
      share += shared_area(x[v], x[(v + 1) % 3], tracer.radius) / area;
    share = std::clamp(share, 0.0, 1.0); // round-off
  }
  return tracer.outside + share * (tracer.inside - tracer.outside);
}
} // namespace

Simulation::Simulation(MPI_Comm comm, const scene::Scene& scene,
                       const mesh::Grid* grid)
    : scene(scene),
      domain(mesh::make_domain(
          comm, grid ? *grid : mesh::obtain_grid(comm, scene), scene.boundary))
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
    for (const auto& [name, material] : scene.material)
      laws.push_back(material::make_law(material));
    problem = std::make_unique<lagrangian::Problem>(
        domain, laws, scene.symmetry, scene.solver, scene.water, clock);
    state.points = problem->element().num_points();
    for (std::size_t i = 0; i < 2 * nodes; ++i)
      state.v[i] = scene.initial.velocity[i % 2];
    if (laws.size() > 1)
      fill_initial(scene, domain, laws, state);
    else
      fill_initial(scene, domain, problem->element(), state);
  }
  if (scene.remap.mode != scene::RemapMode::lagrangian)
    remap = std::make_unique<bridge::RemapStep>(domain, scene, laws, clock);
}
} // namespace mmale
