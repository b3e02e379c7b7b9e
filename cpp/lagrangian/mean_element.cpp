// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mean_element.h"

#include "balance.h"
#include "inertia.h"
#include "mesh/corners.h"
#include <algorithm>
#include <limits>

namespace mmale::lagrangian
{
MeanElement::MeanElement(const mesh::Domain& domain,
                         const material::AnyLaw& law, scene::Symmetry symmetry,
                         const scene::Solver& options,
                         const std::optional<scene::Water>& water)
    : Element(domain, law, symmetry, options, water, 1),
      _R(_axisymmetric ? *form_balance_R_axi : *form_balance_R_plane,
         IntegralKind::cell),
      _J(_axisymmetric ? *form_balance_J_axi : *form_balance_J_plane,
         IntegralKind::cell),
      _B(_axisymmetric ? *form_balance_B_axi : *form_balance_B_plane,
         IntegralKind::cell),
      _inertia{{_axisymmetric ? *form_inertia_R_axi : *form_inertia_R_plane,
                IntegralKind::cell},
               {_axisymmetric ? *form_inertia_J_axi : *form_inertia_J_plane,
                IntegralKind::cell},
               {_axisymmetric ? *form_inertia_B_axi : *form_inertia_B_plane,
                IntegralKind::cell},
               {_axisymmetric ? *form_inertia_R_damping_axi
                              : *form_inertia_R_damping_plane,
                IntegralKind::cell},
               {_axisymmetric ? *form_inertia_J_damping_axi
                              : *form_inertia_J_damping_plane,
                IntegralKind::cell}},
      _cell(domain.num_owned_cells)
{
  if (_flows)
    make_flow(*water);
}

std::array<double, 2> MeanElement::mismatch_squared(const State& state,
                                                    int c) const
{
  const auto [i, j, k] = _domain.cells[c];
  const double p = (state.p[i] + state.p[j] + state.p[k]) / 3;
  const double d = _cell[c].answer.theta - _cell[c].motion.ln_J;
  return {(state.P[c] - p) * (state.P[c] - p), d * d};
}

double MeanElement::strain_squared(int c) const
{
  const Cell& cell = _cell[c];
  return cell.motion.de.squaredNorm() + cell.motion.ln_J * cell.motion.ln_J
         + cell.answer.theta * cell.answer.theta;
}

material::Effort MeanElement::effort(int c) const
{
  return _cell[c].answer.effort;
}

void MeanElement::begin_step(const State& state, double dt)
{
  Element::begin_step(state, dt);
  for (Cell& cell : _cell)
    cell.guess = std::numeric_limits<double>::quiet_NaN();
  if (_fluid and _options.element == scene::Element::mini)
    begin_bubbles(state);
  for (int c = 0; _flow and c < _domain.num_owned_cells; ++c)
  {
    const auto [G, K] = moduli(state, c, dt);
    _flow->compliance[c] = 1 / (K + 4 * G / 3);
  }
}

/// Strain and pressure of a cell; what is wrong with it, or null.
const char* MeanElement::strain_cell(const State& state, int c,
                                     std::span<const double> z)
{
  Cell& cell = _cell[c];
  double w[11] = {}, x[9] = {};
  std::array<double, 6> end;
  cell.p = 0;
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[c][v];
    for (int d = 0; d < 2; ++d)
    {
      w[3 * v + d] = z[3 * n + d];
      x[3 * v + d] = state.x[2 * n + d] + 0.5 * z[3 * n + d];
      end[2 * v + d] = state.x[2 * n + d] + z[3 * n + d];
    }
    cell.p += z[3 * n + 2] / 3;
  }
  mid_gradient<1>(_axisymmetric, w, x, cell.G.data());
  cell.motion = motion(cell.G);
  _volume[c] = mesh::triangle_volume(end, _axisymmetric);
  const bool sound = _volume[c] > 0 and std::isfinite(cell.motion.ln_J)
                     and std::isfinite(cell.p);
  return sound ? nullptr : "the cell would invert";
}

int MeanElement::evaluate(const State& state, std::span<const double> z,
                          const Constants& constants, std::string& why)
{
  if (not _bubble.empty() and not _placed)
    place_bubbles(state, constants);
  const auto kind = tangent_kind();
  std::vector<double> turned(_num_history);
  const auto answer = [&](const auto& medium, int c)
  {
    Cell& cell = _cell[c];
    const Motion& m = cell.motion;
    const auto at = static_cast<std::size_t>(_num_history) * c;
    const auto q = std::span(_history).subspan(at, _num_history);
    std::copy_n(state.history.begin() + at, _num_history, turned.begin());
    turn_history(turned, m.cosine, m.sine);
    const material::Point start{
        rotate(Voigt(state.s.data() + 4 * c), m.cosine, m.sine),
        driven_pressure(state, c), turned};
    const double p_w = pore_pressure(c); // 0 but where it flows
    if (material::drive(medium(p_w), start, m.de, cell.p - p_w, constants.dt,
                        cell.guess, kind, q, cell.answer)
        != Outcome::ok)
      return "the law asks for a smaller step";
    turn_history(q, m.cosine, m.sine);
    cell.guess = cell.answer.theta;
    // not by p: with friction a lower pressure flows more, which leads Newton
    // away; steps fail from the first one on
    cell.answer.dflow_dp = 0;
    if (not _options.plastic_bubble)
    {
      cell.answer.flow = 0;
      cell.answer.dflow_de.setZero();
    }
    cell.s = rotate(cell.answer.s, m.cosine, m.sine);
    return static_cast<const char*>(nullptr);
  };
  return with_medium(
      [&](const auto& medium)
      {
        for (int c = 0; c < _domain.num_owned_cells; ++c)
        {
          const char* trouble = strain_cell(state, c, z);
          if (not trouble)
            trouble = answer(medium, c);
          if (trouble)
          {
            why = trouble;
            return c;
          }
        }
        return -1;
      });
}

void MeanElement::gather(const State& state, int c, std::span<const double> z,
                         CellInput& in, double* x) const
{
  const Cell& cell = _cell[c];
  gather_nodes(state, c, z, in.w, x);
  std::fill_n(in.w_n, 11, 0.0);
  for (int v = 0; v < 3; ++v)
    in.w_n[3 * v + 2] = state.p[_domain.cells[c][v]];
  Gradient::Map(in.s) = expand(cell.s);
  in.theta = cell.answer.theta;
  in.ln_J = cell.motion.ln_J;
  in.mu = _G[c];
  in.rho = end_density(state, c);
  in.lam = cell.answer.flow;
  if (_newmark)
    gather_newmark(state, c, in.newmark);
  gather_bubble(state, c, in);
}

void MeanElement::add_tangent(int c, CellInput& in) const
{
  const Cell& cell = _cell[c];
  const CellTangent t = tangent(cell.G, cell.motion, cell.answer, cell.s,
                                cell.p, _options.geometric_stiffness);
  Eigen::Map<Eigen::Matrix<double, 5, 5, Eigen::RowMajor>>(in.ds_dh) = t.ds_dh;
  Gradient::Map(in.ds_dp) = t.ds_dp;
  Gradient::Map(in.dtheta_dh) = t.dtheta_dh;
  in.dtheta_dp = cell.answer.dtheta_dp;
  Gradient::Map(in.dlam_dh) = t.dflow_dh;
  in.dlam_dp = cell.answer.dflow_dp;
}

std::array<double, 6> MeanElement::forces(const State& state, int c,
                                          std::span<const double> z,
                                          const Constants& constants) const
{
  CellInput in;
  double x[9], R[11] = {};
  gather(state, c, z, in, x);
  _R(R, in, constants, x);
  if (not _bubble.empty())
  {
    double R11[11] = {}, B[22] = {};
    _R(R11, in, constants, x);
    _B(B, in, constants, x);
    if (_newmark)
    {
      _inertia.R(R11, in, constants, x);
      _inertia.B(B, in, constants, x);
    }
    const Condensation K(B[18], B[19], B[20], B[21]);
    const auto [b0, b1] = K.solve(R11[9], R11[10]);
    for (int i : {0, 1, 3, 4, 6, 7})
      R[i] -= B[2 * i] * b0 + B[2 * i + 1] * b1;
  }
  if (constants.b > 0)
    _inertia.R_damping(R, in, constants, x);
  return {R[0], R[1], R[3], R[4], R[6], R[7]};
}

void MeanElement::full(const State& state, int c, std::span<const double> z,
                       const Constants& constants, std::span<double> R11,
                       std::span<double> J121) const
{
  CellInput in;
  double x[9];
  gather(state, c, z, in, x);
  add_tangent(c, in);
  std::ranges::fill(R11, 0.0);
  std::ranges::fill(J121, 0.0);
  _R(R11, in, constants, x);
  _J(J121, in, constants, x);
  if (_newmark)
  {
    _inertia.R(R11, in, constants, x);
    _inertia.J(J121, in, constants, x);
  }
}

void MeanElement::residual(const State& state, int c, std::span<const double> z,
                           const Constants& constants, double* R)
{
  CellInput in;
  double x[9], R11[11] = {}, B[22] = {};
  const bool constant_strain =
      _options.element == scene::Element::constant_strain;
  gather(state, c, z, in, x);
  if (constant_strain)
    use_cell_pressure(c, in);
  _R(R11, in, constants, x);
  if (_newmark)
    _inertia.R(R11, in, constants, x);
  if (constants.b > 0)
    _inertia.R_damping(R11, in, constants, x);
  std::copy_n(R11, 9, R);
  if (constant_strain)
    project_pressure(c, in, R, nullptr);
  if (_options.element != scene::Element::mini)
    return;
  _B(B, in, constants, x);
  if (_newmark)
    _inertia.B(B, in, constants, x);
  const Condensation K(B[18], B[19], B[20], B[21]);
  const auto [b0, b1] = K.solve(R11[9], R11[10]);
  for (int i = 0; i < 9; ++i)
    R[i] -= B[2 * i] * b0 + B[2 * i + 1] * b1;
}

void MeanElement::jacobian(const State& state, int c, std::span<const double> z,
                           const Constants& constants, double* J)
{
  CellInput in;
  double x[9], A[121] = {};
  const bool constant_strain =
      _options.element == scene::Element::constant_strain;
  gather(state, c, z, in, x);
  add_tangent(c, in);
  if (constant_strain)
    use_cell_pressure(c, in);
  _J(A, in, constants, x);
  if (_newmark)
    _inertia.J(A, in, constants, x);
  if (constants.b > 0)
    _inertia.J_damping(A, in, constants, x);
  for (int i = 0; i < 9; ++i)
    std::copy_n(A + 11 * i, 9, J + 9 * i);
  if (constant_strain)
    project_pressure(c, in, nullptr, J);
  if (_options.element != scene::Element::mini)
    return;
  const Condensation K(A[9 * 11 + 9], A[9 * 11 + 10], A[10 * 11 + 9],
                       A[10 * 11 + 10]);
  for (int i = 0; _flow and i < 9; ++i)
    for (int b = 0; b < 2; ++b)
      _flow->carried[2 * i + b] =
          A[11 * i + 9] * K.inverse[b] + A[11 * i + 10] * K.inverse[2 + b];
  for (int j = 0; j < 9; ++j)
  {
    const auto [b0, b1] = K.solve(A[9 * 11 + j], A[10 * 11 + j]);
    for (int i = 0; i < 9; ++i)
      J[9 * i + j] -= A[11 * i + 9] * b0 + A[11 * i + 10] * b1;
  }
}

/// Displacement only: the cell's own pressure, from its volume, replaces the
/// mean of the nodal ones.
void MeanElement::use_cell_pressure(int c, CellInput& in) const
{
  const double K = -1 / _cell[c].answer.dtheta_dp;
  const double excess = _cell[c].p - cell_pressure(c);
  for (int i : {0, 3, 4})
  {
    in.s[i] += excess;
    in.ds_dp[i] += 1;
    for (int j : {0, 3, 4})
      in.ds_dh[5 * i + j] += K;
  }
}

/// Nodal pressure is then a lumped projection, for output alone.
void MeanElement::project_pressure(int c, const CellInput& in, double* R,
                                   double* J) const
{
  const double mass = -_cell[c].answer.dtheta_dp * _volume[c] / 3;
  for (int i : {2, 5, 8})
  {
    if (R)
      R[i] = mass * (in.w[i] - cell_pressure(c));
    for (int j = 0; J and j < 9; ++j)
      if (j % 3 == 2)
        J[9 * i + j] = j == i ? mass : 0;
      else // the row was that of theta - ln J; it is now that of ln J
        J[9 * i + j] = -J[9 * i + j];
  }
}

double MeanElement::cell_pressure(int c) const
{
  const Cell& cell = _cell[c];
  if (_options.element != scene::Element::constant_strain)
    return cell.p;
  // theta is linear in p for the laws that this comparison is made with
  return cell.p
         + (cell.motion.ln_J - cell.answer.theta) / cell.answer.dtheta_dp;
}

void MeanElement::accept_stress(State& state) const
{
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    Voigt::Map(state.s.data() + 4 * c) = _cell[c].s;
    state.P[c] = cell_pressure(c);
  }
}
} // namespace mmale::lagrangian
