// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element.h"

#include "balance.h"
#include <algorithm>

namespace mmale::lagrangian
{
namespace
{
/// Schur complement of the bubble: what is left in the nodal block.
struct Condensation
{
  double inverse[4]; // of K_bb

  explicit Condensation(double a, double b, double c, double d)
  {
    const double det = 1 / (a * d - b * c);
    inverse[0] = d * det;
    inverse[1] = -b * det;
    inverse[2] = -c * det;
    inverse[3] = a * det;
  }
  /// K_bb^-1 (r0, r1)
  std::array<double, 2> solve(double r0, double r1) const
  {
    return {inverse[0] * r0 + inverse[1] * r1,
            inverse[2] * r0 + inverse[3] * r1};
  }
};
} // namespace

double cell_volume(const mesh::Domain& domain, std::span<const double> x,
                   int cell, bool axisymmetric)
{
  const auto [i, j, k] = domain.cells[cell];
  const double area =
      0.5
      * ((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
         - (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1]));
  return axisymmetric ? area * (x[2 * i] + x[2 * j] + x[2 * k]) / 3 : area;
}

Element::Element(const mesh::Domain& domain, const material::AnyLaw& law,
                 scene::Symmetry symmetry, const scene::Solver& options)
    : _domain(domain), _law(law),
      _axisymmetric(symmetry == scene::Symmetry::axisymmetric),
      _options(options),
      _R(_axisymmetric ? *form_balance_R_axi : *form_balance_R_plane,
         IntegralKind::cell),
      _J(_axisymmetric ? *form_balance_J_axi : *form_balance_J_plane,
         IntegralKind::cell),
      _B(_axisymmetric ? *form_balance_B_axi : *form_balance_B_plane,
         IntegralKind::cell),
      _cell(domain.num_owned_cells), _volume(domain.num_owned_cells),
      _num_history(std::visit([](const auto& l)
                              { return static_cast<int>(l.history.size()); },
                              law))
{
  _history.resize(static_cast<std::size_t>(_num_history)
                  * domain.num_owned_cells);
}

double Element::shear_modulus() const
{
  return std::visit([](const auto& l) { return l.shear_modulus(); }, _law);
}

bool Element::symmetric() const
{
  if (_options.element == scene::Element::constant_strain)
    return false; // its nodal pressure only listens
  // the bubble's plastic flow enters the volume equation alone
  return std::visit(
      [this](const auto& l)
      { return l.symmetric and not(l.yields and _options.plastic_bubble); },
      _law);
}

double Element::density() const
{
  return std::visit([](const auto& l) { return l.density; }, _law);
}

double Element::force_squared(const State& state, int c) const
{
  const double s = material::norm(Voigt(state.s.data() + 4 * c));
  const double side = std::pow(_volume[c], _axisymmetric ? 2. / 3 : 0.5);
  return (s * s + state.P[c] * state.P[c]) * side * side;
}

double Element::strain_squared(int c) const
{
  const Cell& cell = _cell[c];
  return cell.motion.de.squaredNorm() + cell.motion.ln_J * cell.motion.ln_J
         + cell.answer.theta * cell.answer.theta;
}

int Element::evaluate(const State& state, std::span<const double> z,
                      std::string& why)
{
  const auto kind = _options.tangent == scene::Tangent::consistent
                        ? material::TangentKind::consistent
                        : material::TangentKind::continuum;
  std::ranges::copy(std::span(state.history).first(_history.size()),
                    _history.begin());
  return std::visit(
      [&](const auto& law)
      {
        for (int c = 0; c < _domain.num_owned_cells; ++c)
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
          mid_gradient(_axisymmetric, w, x, cell.G.data());
          cell.motion = motion(cell.G);
          const double area = 0.5
                              * ((end[2] - end[0]) * (end[5] - end[1])
                                 - (end[4] - end[0]) * (end[3] - end[1]));
          _volume[c] =
              _axisymmetric ? area * (end[0] + end[2] + end[4]) / 3 : area;
          if (not(area > 0) or not std::isfinite(cell.motion.ln_J)
              or not std::isfinite(cell.p))
          {
            why = "the cell would invert";
            return c;
          }
          const Motion& m = cell.motion;
          const material::Increment step{
              rotate(Voigt(state.s.data() + 4 * c), m.cosine, m.sine), m.de,
              state.P[c], cell.p};
          if (law.update(
                  step, kind,
                  std::span(_history).subspan(
                      static_cast<std::size_t>(_num_history) * c, _num_history),
                  cell.answer)
              != Outcome::ok)
          {
            why = "the law asks for a smaller step";
            return c;
          }
          if (not _options.plastic_bubble)
          {
            cell.answer.flow = cell.answer.dflow_dp = 0;
            cell.answer.dflow_de.setZero();
          }
          cell.s = rotate(cell.answer.s, m.cosine, m.sine);
        }
        return -1;
      },
      _law);
}

void Element::gather(const State& state, int c, std::span<const double> z,
                     CellInput& in, double* x) const
{
  const Cell& cell = _cell[c];
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[c][v];
    for (int d = 0; d < 2; ++d)
    {
      in.w[3 * v + d] = z[3 * n + d];
      in.w_n[3 * v + d] = 0;
      x[3 * v + d] = state.x[2 * n + d] + z[3 * n + d];
    }
    in.w[3 * v + 2] = z[3 * n + 2];
    in.w_n[3 * v + 2] = state.p[n];
    x[3 * v + 2] = 0;
  }
  in.w[9] = in.w[10] = in.w_n[9] = in.w_n[10] = 0;
  Gradient::Map(in.s) = expand(cell.s);
  in.theta = cell.answer.theta;
  in.ln_J = cell.motion.ln_J;
  in.mu = shear_modulus();
  in.lam = cell.answer.flow;
  in.rho = state.density[c] * std::exp(-cell.motion.ln_J);
}

void Element::add_tangent(int c, CellInput& in) const
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

void Element::full(const State& state, int c, std::span<const double> z,
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
}

void Element::residual(const State& state, int c, std::span<const double> z,
                       const Constants& constants, double* R) const
{
  CellInput in;
  double x[9], R11[11] = {}, B[22] = {};
  const bool constant_strain =
      _options.element == scene::Element::constant_strain;
  gather(state, c, z, in, x);
  if (constant_strain)
    use_cell_pressure(c, in);
  _R(R11, in, constants, x);
  std::copy_n(R11, 9, R);
  if (constant_strain)
    project_pressure(c, in, R, nullptr);
  if (_options.element != scene::Element::mini)
    return;
  _B(B, in, constants, x);
  const Condensation K(B[18], B[19], B[20], B[21]);
  const auto [b0, b1] = K.solve(R11[9], R11[10]);
  for (int i = 0; i < 9; ++i)
    R[i] -= B[2 * i] * b0 + B[2 * i + 1] * b1;
}

void Element::jacobian(const State& state, int c, std::span<const double> z,
                       const Constants& constants, double* J) const
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
  for (int i = 0; i < 9; ++i)
    std::copy_n(A + 11 * i, 9, J + 9 * i);
  if (constant_strain)
    project_pressure(c, in, nullptr, J);
  if (_options.element != scene::Element::mini)
    return;
  const Condensation K(A[9 * 11 + 9], A[9 * 11 + 10], A[10 * 11 + 9],
                       A[10 * 11 + 10]);
  for (int j = 0; j < 9; ++j)
  {
    const auto [b0, b1] = K.solve(A[9 * 11 + j], A[10 * 11 + j]);
    for (int i = 0; i < 9; ++i)
      J[9 * i + j] -= A[11 * i + 9] * b0 + A[11 * i + 10] * b1;
  }
}

/// Displacement only: the cell's own pressure, from its volume, replaces the
/// mean of the nodal ones.
void Element::use_cell_pressure(int c, CellInput& in) const
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
void Element::project_pressure(int c, const CellInput& in, double* R,
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

double Element::cell_pressure(int c) const
{
  const Cell& cell = _cell[c];
  if (_options.element != scene::Element::constant_strain)
    return cell.p;
  // theta is linear in p for the laws that this comparison is made with
  return cell.p
         + (cell.motion.ln_J - cell.answer.theta) / cell.answer.dtheta_dp;
}

void Element::accept(State& state, std::span<const double> z, double dt) const
{
  const int owned = _domain.num_owned_cells;
  for (int c = 0; c < owned; ++c)
  {
    const Cell& cell = _cell[c];
    Voigt::Map(state.s.data() + 4 * c) = cell.s;
    state.P[c] = cell_pressure(c);
    state.density[c] *= std::exp(-cell.motion.ln_J);
  }
  std::ranges::copy(_history, state.history.begin());
  for (int n = 0; n < _domain.num_nodes(); ++n)
  {
    for (int d = 0; d < 2; ++d)
    {
      state.x[2 * n + d] += z[3 * n + d];
      state.v[2 * n + d] = z[3 * n + d] / dt;
    }
    state.p[n] = z[3 * n + 2];
  }
  _domain.cell_halo->update(state.s, 4);
  _domain.cell_halo->update(state.P, 1);
  _domain.cell_halo->update(state.density, 1);
  if (_num_history > 0)
    _domain.cell_halo->update(state.history, _num_history);
}
} // namespace mmale::lagrangian
