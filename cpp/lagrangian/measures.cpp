// SPDX-License-Identifier: LGPL-3.0-or-later
// What a problem tells of its state.
#include "problem.h"

#include "mesh/corners.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace mmale::lagrangian
{
material::Moduli Problem::moduli(const State& state, double dt,
                                 Meets what) const
{
  double sum[3] = {0, 0, 0};
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    if (not _element->present(state, c))
      continue;
    const auto [G, K] = _element->moduli(state, c, dt, what);
    sum[0] += G;
    sum[1] += K;
    sum[2] += 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_DOUBLE, MPI_SUM, _domain.comm);
  return {sum[0] / sum[2], sum[1] / sum[2]};
}

/// Of a cell as it was when the step began.
std::array<double, 2> Problem::impedance(int c) const
{
  const auto [G, K] = _element->moduli(*_state, c, _constants.dt, Meets::wave);
  const double rho = _state->density[c];
  return {std::sqrt(rho * (K + 4 * G / 3)), std::sqrt(rho * G)};
}

material::Effort Problem::effort() const
{
  material::Effort e;
  for (int c = 0; c < _domain.num_owned_cells; ++c)
    e += _element->effort(c);
  std::array<long, 4> sum{e.substeps, e.rejected, e.apex, e.clipped};
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 4, MPI_LONG, MPI_SUM, _domain.comm);
  return {sum[0], sum[1], sum[2], sum[3]};
}

double Problem::imbalance(const State& state, double dt)
{
  prepare(state, 0, dt);
  _contact->begin_step(state.x, _t0, _t1);
  hold();
  auto z = _z.mutable_array();
  for (int i = 0; i < 3 * _domain.num_nodes(); ++i)
    z[i] = i % 3 == 2 ? state.p[i / 3] : 0;
  if (_pore_pressure)
  {
    _pore_pressure->begin(state.p_w, _t1, dt, _length);
    std::ranges::copy(state.p_w, _pore_pressure->trial().begin());
  }
  _element->begin_step(state, dt);
  if (not evaluate())
    throw std::runtime_error("the initial state fails: " + _failure.cause
                             + ", cell " + std::to_string(_failure.cell));
  std::vector<double> r(static_cast<std::size_t>(_block)
                        * _domain.num_owned_nodes);
  assemble_residual(r.data());
  const auto mass = mesh::lump(_domain, state.x, state.density,
                               _symmetry == scene::Symmetry::axisymmetric);
  double worst = 0, weight = 0;
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
  {
    weight += mass[n] * std::hypot(_constants.g[0], _constants.g[1]);
    for (int d = 0; d < 2; ++d)
      if (_holder[3 * n + d] < 0)
        worst = std::max(worst, std::abs(_force.array()[3 * n + d]));
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, _domain.comm);
  MPI_Allreduce(MPI_IN_PLACE, &weight, 1, MPI_DOUBLE, MPI_SUM, _domain.comm);
  return weight > 0 ? worst / weight : _norm_u;
}

std::vector<std::array<double, 2>> Problem::sum_reactions() const
{
  std::vector<double> sum(2 * _domain.boundary_names.size(), 0);
  const auto force = _force.array();
  const double turn =
      _symmetry == scene::Symmetry::axisymmetric ? 2 * std::numbers::pi : 1;
  for (int i = 0; i < 3 * _domain.num_owned_nodes; ++i)
    if (_holder[i] >= 0 and _holder[i] < by_scheme())
      sum[2 * _holder[i] + i % 3] += turn * force[i];
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()),
                MPI_DOUBLE, MPI_SUM, _domain.comm);
  std::vector<std::array<double, 2>> out(sum.size() / 2);
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b] = {sum[2 * b], sum[2 * b + 1]};
  return out;
}

std::vector<double> Problem::discharge() const
{
  return _pore_pressure ? _pore_pressure->discharge() : std::vector<double>();
}

std::array<double, 2> Problem::mismatch(const State& state) const
{
  double sum[3] = {0, 0, static_cast<double>(_domain.num_owned_cells)};
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const auto [pressure, volume] = _element->mismatch_squared(state, c);
    sum[0] += pressure;
    sum[1] += volume;
  }
  MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_DOUBLE, MPI_SUM, _domain.comm);
  return {std::sqrt(sum[0] / sum[2]), std::sqrt(sum[1] / sum[2])};
}
} // namespace mmale::lagrangian
