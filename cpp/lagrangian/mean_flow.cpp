// SPDX-License-Identifier: LGPL-3.0-or-later
// Pore water that flows, in layout `mean` (METHOD.md, Water).
#include "mean_element.h"

#include "mesh/corners.h"
#include "seepage.h"
#include <algorithm>
#include <cmath>

namespace mmale::lagrangian
{
namespace
{
/// Storage of the skeleton that is lumped, of its own. The bubble smooths p and
/// would let p_w overshoot by 2 % with 1; 1.2: the first node lacks 4 %.
constexpr double lumping = 1.1;
} // namespace

void MeanElement::make_flow(const scene::Water& water)
{
  const auto kernel = [&](ufcx_form* plane, ufcx_form* axi)
  {
    return BasicKernel<SeepageInput>(_axisymmetric ? *axi : *plane,
                                     IntegralKind::cell);
  };
  _flow.reset(new Flow{
      kernel(form_seepage_R_plane, form_seepage_R_axi),
      kernel(form_seepage_J_plane, form_seepage_J_axi),
      kernel(form_seepage_U_plane, form_seepage_U_axi),
      kernel(form_seepage_M_plane, form_seepage_M_axi),
      kernel(form_seepage_B_plane, form_seepage_B_axi),
      kernel(form_seepage_R_consistent_plane, form_seepage_R_consistent_axi),
      kernel(form_seepage_J_consistent_plane, form_seepage_J_consistent_axi),
      water.storage == "consistent",
      water.permeability / water.unit_weight(),
      std::vector<double>(_domain.num_owned_cells),
      {}});
}

void MeanElement::gather_flow(const State& state, int c,
                              std::span<const double> z, SeepageInput& in,
                              double* x) const
{
  gather(state, c, z, in.cell, x);
  if (not _newmark)
    in.cell.newmark = {}; // at rest
  const auto pores = material::pores(point(state, c).q);
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[c][v];
    in.p_w[v] = _seepage->trial()[n];
    in.p_w_n[v] = state.p_w[n];
    const auto [stored, slope] =
        medium().water()->stored({in.p_w_n[v], pores.n}, in.p_w[v]);
    in.stored[v] = stored;
    in.dstored_dp[v] = slope;
  }
  const double c_uniaxial = _flow->compliance[c];
  in.compliance = _flow->consistent ? 0 : lumping * c_uniaxial;
  in.mobility = _flow->mobility;
  in.share =
      c_uniaxial / (c_uniaxial + medium().water()->compressibility(pores));
  std::fill_n(in.size, 4, 0.0);
  for (int v = 0; v < 3; ++v)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
      {
        const auto arm = [&](int d)
        { return x[3 * v + d] - (x[d] + x[3 + d] + x[6 + d]) / 3; };
        in.size[2 * i + j] += arm(i) * arm(j) / 3;
      }
  in.radius = _axisymmetric ? (x[0] + x[3] + x[6]) / 3 : 1;
}

/// How large the flows are that meet in a cell's row.
void MeanElement::measure_flow(int c, const SeepageInput& in, const double* x,
                               const Constants& constants, FlowRow& row) const
{
  const double V = _volume[c];
  const double twice_area =
      (x[3] - x[0]) * (x[7] - x[1]) - (x[6] - x[0]) * (x[4] - x[1]);
  double gradient[2] = {0, 0}, sum = 0, shape_squared = 0;
  for (int v = 0; v < 3; ++v)
  {
    const double *a = x + 3 * ((v + 1) % 3), *b = x + 3 * ((v + 2) % 3);
    const double shape[2] = {(a[1] - b[1]) / twice_area,
                             (b[0] - a[0]) / twice_area};
    for (int d = 0; d < 2; ++d)
      gradient[d] += in.p_w[v] * shape[d];
    sum += std::abs(in.p_w[v]) * std::hypot(shape[0], shape[1]);
    shape_squared += shape[0] * shape[0] + shape[1] * shape[1];
  }
  for (int d = 0; d < 2; ++d)
    gradient[d] -= constants.rho_f * constants.g[d];
  const double flow = constants.dt * _flow->mobility * V;
  row.size_squared = flow * flow * shape_squared
                     * (gradient[0] * gradient[0] + gradient[1] * gradient[1]);
  const double carried = flow + in.compliance * V * (in.size[0] + in.size[3]);
  row.digits_squared = carried * carried * shape_squared * sum * sum;
}

FlowRow MeanElement::flow(const State& state, int c, std::span<const double> z,
                          const Constants& constants)
{
  SeepageInput in;
  double x[9];
  FlowRow row{};
  gather_flow(state, c, z, in, x);
  _flow->R(row.R, in, constants, x);
  if (_flow->consistent)
    _flow->R_consistent(row.R, in, constants, x);
  measure_flow(c, in, x, constants, row);
  return row;
}

FlowTangent MeanElement::flow_tangent(const State& state, int c,
                                      std::span<const double> z,
                                      const Constants& constants)
{
  SeepageInput in;
  double x[9], A[33] = {}, M[33] = {};
  FlowTangent out{};
  gather_flow(state, c, z, in, x);
  add_tangent(c, in.cell);
  _flow->by_pore_pressure(out.by_pore_pressure, in, constants, x);
  if (_flow->consistent)
    _flow->by_pore_pressure_consistent(out.by_pore_pressure, in, constants, x);
  _flow->by_nodes(A, in, constants, x);
  for (int i = 0; i < 3; ++i)
    std::copy_n(A + 11 * i, 9, out.by_nodes.begin() + 9 * i);
  _flow->of_momentum(M, in, constants, x);
  if (_newmark)
    _flow->of_bubble(M, in, constants, x);
  std::copy_n(M, 27, out.momentum.begin());
  if (_options.element != scene::Element::mini)
    return out;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 3; ++j)
      for (int b = 0; b < 2; ++b)
        out.momentum[3 * i + j] -=
            _flow->carried[2 * i + b] * M[27 + 3 * b + j];
  return out;
}
} // namespace mmale::lagrangian
