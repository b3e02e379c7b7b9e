// SPDX-License-Identifier: LGPL-3.0-or-later
#include "loads.h"

#include "load.h"
#include <algorithm>

namespace mmale::lagrangian
{
Loads::Loads(const mesh::Domain& domain, scene::Symmetry symmetry)
    : _domain(domain),
      _R(symmetry == scene::Symmetry::axisymmetric ? *form_load_R_axi
                                                   : *form_load_R_plane,
         IntegralKind::facet),
      _J(symmetry == scene::Symmetry::axisymmetric ? *form_load_J_axi
                                                   : *form_load_J_plane,
         IntegralKind::facet),
      _R_dashpots(symmetry == scene::Symmetry::axisymmetric
                      ? *form_load_R_dashpots_axi
                      : *form_load_R_dashpots_plane,
                  IntegralKind::facet),
      _J_dashpots(symmetry == scene::Symmetry::axisymmetric
                      ? *form_load_J_dashpots_axi
                      : *form_load_J_dashpots_plane,
                  IntegralKind::facet)
{
}

void Loads::begin_step(std::vector<Load> loads, const Newmark* newmark,
                       const Impedance& impedance)
{
  _newmark = newmark;
  _facets.clear();
  for (const Load& load : loads)
    for (const mesh::Facet& f : _domain.facets)
      if (f.boundary == load.boundary and f.cell < _domain.num_owned_cells)
      {
        Loaded loaded{f, {}, load.absorbing and newmark};
        std::copy_n(load.traction, 2, loaded.constants.t);
        loaded.constants.p_a = load.pressure;
        if (loaded.dashpots)
        {
          const auto [normal, across] = impedance(f.cell);
          loaded.constants.z_p = normal;
          loaded.constants.z_s = across;
          loaded.constants.c_v = newmark->c_v;
        }
        _facets.push_back(loaded);
      }
  std::ranges::stable_sort(_facets, {},
                           [](const Loaded& l) { return l.facet.cell; });
}

void Loads::gather(const State& state, int cell, std::span<const double> z,
                   CellInput& in, double* x) const
{
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[cell][v];
    for (int d = 0; d < 2; ++d)
    {
      in.w[3 * v + d] = z[3 * n + d];
      x[3 * v + d] = state.x[2 * n + d] + z[3 * n + d];
      in.newmark.v_0[2 * v + d] = _newmark ? _newmark->v_0[2 * n + d] : 0;
    }
    in.w[3 * v + 2] = z[3 * n + 2];
    x[3 * v + 2] = 0;
  }
  in.w[9] = in.w[10] = 0;
}

void Loads::add_residual(const State& state, std::span<const double> z,
                         std::span<double> force) const
{
  for (const auto& [f, constants, dashpots] : _facets)
  {
    CellInput in;
    double R[11] = {}, x[9];
    gather(state, f.cell, z, in, x);
    _R(R, in, constants, x, f.local);
    if (dashpots)
      _R_dashpots(R, in, constants, x, f.local);
    const auto& nodes = _domain.cells[f.cell];
    for (int i = 0; i < 9; ++i)
      force[3 * nodes[i / 3] + i % 3] += R[i];
  }
}

void Loads::add_jacobian(const State& state, int cell,
                         std::span<const double> z, double* J) const
{
  for (const auto& [f, constants, dashpots] : std::ranges::equal_range(
           _facets, cell, {}, [](const Loaded& l) { return l.facet.cell; }))
  {
    if (constants.p_a == 0 and not dashpots)
      continue;
    CellInput in;
    double A[121] = {}, x[9];
    gather(state, cell, z, in, x);
    if (constants.p_a != 0)
      _J(A, in, constants, x, f.local);
    if (dashpots)
      _J_dashpots(A, in, constants, x, f.local);
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j)
        J[9 * i + j] += A[11 * i + j];
  }
}
} // namespace mmale::lagrangian
