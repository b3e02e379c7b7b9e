// SPDX-License-Identifier: LGPL-3.0-or-later
#include "pore_pressure.h"

#include <algorithm>
#include <numbers>

namespace mmale::lagrangian
{
namespace
{
std::shared_ptr<const dolfinx::common::IndexMap>
node_map(const mesh::Domain& domain)
{
  return domain.space->dofmap()->index_map;
}
} // namespace

PorePressure::PorePressure(const mesh::Domain& domain, scene::Symmetry symmetry,
                           const scene::Water& water)
    : _domain(domain), _symmetry(symmetry), _water(water),
      _holder(domain.num_nodes(), -1), _prescribed(domain.num_nodes(), 0),
      _p_w(node_map(domain), 1), _residual(node_map(domain), 1)
{
}

void PorePressure::set_stage(const scene::Stage& stage)
{
  _series.clear();
  _held.clear();
  std::vector<bool> taken(_domain.num_nodes(), false);
  // A pressure that is prescribed goes before a face that may close.
  for (const bool face : {false, true})
    for (const auto& [name, c] : stage.boundary)
    {
      const bool prescribed = c.drained or c.pore_pressure;
      if (face ? not c.seepage_face : not prescribed)
        continue;
      const int b = _domain.boundary(name);
      if (not face)
        _series.push_back(
            c.pore_pressure.value_or(scene::TimeSeries{{}, {0.0}}));
      for (int n : _domain.boundary_nodes(b))
        if (not taken[n])
        {
          taken[n] = true;
          _held.push_back(
              {n, b, face ? -1 : static_cast<int>(_series.size()) - 1});
        }
    }
  _has_face = std::ranges::any_of(stage.boundary, [](const auto& entry)
                                  { return entry.second.seepage_face; });
}

void PorePressure::begin(std::span<const double> p_w, double t1, double dt,
                         double length)
{
  std::ranges::fill(_holder, -1);
  _dt = dt;
  _little_pressure = 1e-9 * _water.unit_weight() * length;
  _exchange = _water.permeability / _water.unit_weight() * dt; // of a cell, 2D
  _little_flow = _exchange * _little_pressure + 1e-14 * length * length;
  for (const Held& h : _held)
  {
    if (h.series >= 0 or p_w[h.node] >= -_little_pressure)
      _holder[h.node] = h.boundary;
    _prescribed[h.node] = h.series >= 0 ? _series[h.series](t1) : 0;
  }
}

bool PorePressure::update()
{
  // Owners decide; ghosts follow.
  std::vector<double> held(_domain.num_nodes(), 0);
  int changed = 0;
  _unsettled = -1;
  for (const Held& h : _held)
  {
    if (h.series >= 0 or h.node >= _domain.num_owned_nodes)
      continue;
    const bool was = _holder[h.node] >= 0;
    const double outflow = -_residual.array()[h.node];
    const double rule = outflow + _exchange * _p_w.array()[h.node];
    const bool hold = rule > (was ? -_little_flow : _little_flow);
    held[h.node] = hold;
    if (hold != was)
    {
      changed = 1;
      _unsettled = h.node;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, _domain.comm);
  if (changed == 0)
    return false;
  _domain.node_halo->update(held, 1);
  for (const Held& h : _held)
    if (h.series < 0)
      _holder[h.node] = held[h.node] > 0 ? h.boundary : -1;
  return true;
}

std::vector<double> PorePressure::discharge() const
{
  std::vector<double> sum(_domain.boundary_names.size(), 0);
  const double turn =
      _symmetry == scene::Symmetry::axisymmetric ? 2 * std::numbers::pi : 1;
  for (int n = 0; _dt > 0 and n < _domain.num_owned_nodes; ++n)
    if (_holder[n] >= 0)
      sum[_holder[n]] -= turn * _residual.array()[n] / _dt;
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()),
                MPI_DOUBLE, MPI_SUM, _domain.comm);
  return sum;
}
} // namespace mmale::lagrangian
