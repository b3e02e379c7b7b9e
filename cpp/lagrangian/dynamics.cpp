// SPDX-License-Identifier: LGPL-3.0-or-later
// Inertia in the problem of a step (METHOD.md, step 1d).
#include "problem.h"

#include "mesh/corners.h"
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace mmale::lagrangian
{
void Problem::begin_stage(State& state)
{
  if (not _newmark)
  {
    for (auto* v : {&state.a, &state.force, &state.inner, &state.p_rate,
                    &state.held_back})
      v->clear();
    return;
  }
  const std::size_t size = 2 * static_cast<std::size_t>(_domain.num_nodes());
  const bool from_statics = state.a.empty();
  if (from_statics)
  {
    if (state.time > 0) // a static stage has left its motion
      std::ranges::fill(state.v, 0.0);
    for (auto* v : {&state.a, &state.force, &state.inner})
      v->assign(size, 0);
  }
  if (_newmark->scheme().damping_stiffness == 0)
    state.p_rate.clear();
  else if (state.p_rate.empty())
    state.p_rate.assign(_domain.num_nodes(),
                        std::numeric_limits<double>::quiet_NaN());
  // An absorbing boundary goes on carrying what it carried at the end of
  // statics; what a dynamic stage makes it carry cannot be told from waves.
  int absorbing = not _conditions->absorbing_nodes().empty();
  MPI_Allreduce(MPI_IN_PLACE, &absorbing, 1, MPI_INT, MPI_MAX, _domain.comm);
  if (not absorbing)
    state.held_back.clear();
  else if (state.held_back.empty())
    state.held_back.assign(size, 0);
  if (absorbing and from_statics)
  {
    std::vector<double> moving(size, 0);
    moving.swap(state.v); // what it carries at rest
    rebalance(state, 0);
    moving.swap(state.v);
    for (int n : _conditions->absorbing_nodes())
      for (int i = 2 * n; i < 2 * n + 2; ++i)
        state.held_back[i] = -state.force[i];
  }
  rebalance(state, 0);
  _gravity = _conditions->gravity(0); // the accelerations have met it
}

void Problem::begin_newmark(const State& state)
{
  _newmark->begin_step(state, _constants.dt);
  _constants.c_a = _newmark->c_a;
  _constants.c_v = _newmark->c_v;
  _constants.c_r = _newmark->c_r;
  _constants.b = _newmark->scheme().damping_stiffness;
  _total.resize(2 * static_cast<std::size_t>(_domain.num_owned_nodes));
}

/// From forces of cells and loads to those of the scheme: HHT's mean over the
/// step's two ends, and inertia. Keeps the forces of the end in `_total`.
void Problem::add_inertia(std::span<double> force, double& size)
{
  const auto z = _z.array();
  const double weight = _newmark->weight();
  const double digits =
      4 * std::numeric_limits<double>::epsilon() / _options.tolerance;
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
    for (int d = 0; d < 2; ++d)
    {
      const int i = 2 * n + d;
      const double m = _newmark->mass(n), u = z[3 * n + d];
      double& f = force[3 * n + d];
      f += m * _newmark->scheme().damping_mass * _newmark->v(i, u);
      if (not _state->held_back.empty())
        f += _state->held_back[i];
      _total[i] = f;
      const double ma = m * _newmark->a(i, u);
      f = weight * f + (1 - weight) * _state->force[i] + ma;
      // in flight a is the difference of large numbers
      const double lost = m * _newmark->c_a * u * digits;
      size += ma * ma + lost * lost;
    }
}

/// Nodal forces of the cells after `evaluate`, with what damps in proportion to
/// mass; owned and ghost nodes, shape (n, 2).
std::vector<double> Problem::inner_forces()
{
  dolfinx::la::Vector<double> sum(_domain.space->dofmap()->index_map, 2);
  auto f = sum.mutable_array();
  std::ranges::fill(f, 0.0);
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const auto R = _element->forces(*_state, c, _z.array(), _constants);
    for (int i = 0; i < 6; ++i)
      f[2 * _domain.cells[c][i / 2] + i % 2] += R[i];
  }
  sum.scatter_rev(std::plus<double>());
  for (int i = 0; i < 2 * _domain.num_owned_nodes; ++i)
    f[i] += _newmark->mass(i / 2) * _newmark->scheme().damping_mass
            * _newmark->v(i, _z.array()[3 * (i / 2) + i % 2]);
  sum.scatter_fwd();
  return {sum.array().begin(), sum.array().end()};
}

/// Work of the step, by the trapezoid rule: exact for linear forces.
void Problem::book_work(State& state, std::span<const double> inner)
{
  double work[2] = {0, 0};
  for (int i = 0; i < 2 * _domain.num_owned_nodes; ++i)
  {
    const int z = 3 * (i / 2) + i % 2;
    const double u = _z.array()[z], m = _newmark->mass(i / 2);
    work[0] += 0.5 * u * (state.inner[i] + inner[i]);
    work[1] -=
        0.5 * u * (state.force[i] - state.inner[i] + _total[i] - inner[i]);
    if (_holder[z] >= 0 and _holder[z] < by_scheme()) // with its reaction
      work[1] += 0.5 * u
                 * (state.force[i] + m * state.a[i] + _total[i]
                    + m * _newmark->a(i, u));
  }
  MPI_Allreduce(MPI_IN_PLACE, work, 2, MPI_DOUBLE, MPI_SUM, _domain.comm);
  state.work.internal += work[0];
  state.work.external += work[1];
  std::ranges::copy(inner, state.inner.begin());
}

/// Velocity, acceleration and forces at the end of the step.
void Problem::finish_newmark(State& state)
{
  std::ranges::copy(_total, state.force.begin());
  std::vector<double> a;
  if (_newmark->is_explicit())
  {
    a.resize(state.a.size());
    for (int i = 0; i < 2 * _domain.num_owned_nodes; ++i)
    {
      const int z = 3 * (i / 2) + i % 2;
      a[i] = _holder[z] == by_scheme() ? -_total[i] / _newmark->mass(i / 2)
                                       : _newmark->a(i, _z.array()[z]);
    }
    _domain.node_halo->update(a, 2);
  }
  _newmark->finish(state, _z.array(), a);
  _domain.node_halo->update(state.force, 2);
}

void Problem::rebalance(State& state, double t)
{
  if (not _newmark)
    return;
  _state = &state;
  find_void(state);
  auto z = _z.mutable_array();
  for (int n = 0; n < _domain.num_nodes(); ++n)
  {
    z[3 * n] = z[3 * n + 1] = 0;
    z[3 * n + 2] = state.p[n];
  }
  _constants = {};
  _constants.spring = _options.bubble_spring;
  std::ranges::copy(_conditions->gravity(t), _constants.g);
  std::ranges::copy(_constants.g, _constants.g_n);
  _constants.b = _newmark->scheme().damping_stiffness;
  _newmark->freeze(state);
  if (_pore_pressure)
    std::ranges::copy(state.p_w, _pore_pressure->trial().begin());
  _loads.begin_step(_conditions->loads(t), &*_newmark,
                    [this](int cell) { return impedance(cell); });
  _element->begin_step(state, 0);
  if (not evaluate())
    throw std::runtime_error("no balance at t = " + std::to_string(state.time)
                             + " s: " + _failure.cause);
  state.inner = inner_forces();
  auto force = _force.mutable_array();
  std::ranges::fill(force, 0.0);
  _loads.add_residual(state, z, force);
  _force.scatter_rev(std::plus<double>());
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
    for (int d = 0; d < 2; ++d)
    {
      const int i = 2 * n + d;
      state.force[i] = state.inner[i] + force[3 * n + d]
                       + (state.held_back.empty() ? 0 : state.held_back[i]);
      if (_conditions->holder()[3 * n + d] < 0 and bears(n, d))
        state.a[i] = -state.force[i] / _newmark->mass(n);
    }
  _domain.node_halo->update(state.force, 2);
  _domain.node_halo->update(state.a, 2);
}

double Problem::kinetic_energy(const State& state) const
{
  const auto mass = mesh::lump(_domain, state.x, state.density,
                               _symmetry == scene::Symmetry::axisymmetric);
  double sum = 0;
  for (int i = 0; i < 2 * _domain.num_owned_nodes; ++i)
    sum += 0.5 * mass[i / 2] * state.v[i] * state.v[i];
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, _domain.comm);
  return sum;
}
} // namespace mmale::lagrangian
