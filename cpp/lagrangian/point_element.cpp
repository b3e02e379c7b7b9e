// SPDX-License-Identifier: LGPL-3.0-or-later
#include "point_element.h"

#include "inertia.h"
#include "mesh/corners.h"
#include "points.h"
#include <algorithm>
#include <limits>

namespace mmale::lagrangian
{
namespace
{
/// FFCx's names of the forms for n points.
template <int n>
struct Forms;

template <>
struct Forms<3>
{
  static const ufcx_form& R(bool axi)
  {
    return axi ? *form_points_R_3_axi : *form_points_R_3_plane;
  }
  static const ufcx_form& J(bool axi)
  {
    return axi ? *form_points_J_3_axi : *form_points_J_3_plane;
  }
};

template <>
struct Forms<6>
{
  static const ufcx_form& R(bool axi)
  {
    return axi ? *form_points_R_6_axi : *form_points_R_6_plane;
  }
  static const ufcx_form& J(bool axi)
  {
    return axi ? *form_points_J_6_axi : *form_points_J_6_plane;
  }
};
} // namespace

template <int n>
PointElement<n>::PointElement(const mesh::Domain& domain,
                              std::span<const material::AnyLaw> laws,
                              scene::Symmetry symmetry,
                              const scene::Solver& options,
                              const std::optional<scene::Water>& water)
    : Element(domain, laws, symmetry, options, water, n),
      _R(Forms<n>::R(_axisymmetric), IntegralKind::cell),
      _J(Forms<n>::J(_axisymmetric), IntegralKind::cell),
      _R_damping(_axisymmetric ? *form_inertia_R_damping_axi
                               : *form_inertia_R_damping_plane,
                 IntegralKind::cell),
      _J_damping(_axisymmetric ? *form_inertia_J_damping_axi
                               : *form_inertia_J_damping_plane,
                 IntegralKind::cell),
      _cell(domain.num_owned_cells)
{
}

template <int n>
material::Effort PointElement<n>::effort(int c) const
{
  material::Effort sum;
  for (const Point& point : _cell[c].point)
    sum += point.answer.effort;
  return sum;
}

template <int n>
void PointElement<n>::begin_step(const State& state, double dt)
{
  Element::begin_step(state, dt);
  for (Cell& cell : _cell)
  {
    for (Point& point : cell.point)
      point.guess = std::numeric_limits<double>::quiet_NaN();
    std::ranges::fill(cell.bubble, 0.0);
    cell.has_blocks = false;
  }
}

template <int n>
void PointElement<n>::begin_iteration(std::span<const double> z)
{
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    Cell& cell = _cell[c];
    std::ranges::copy(cell.bubble, cell.bubble_k);
    std::ranges::copy(cell.force, cell.force_k);
    cell.z_k = nodal(c, z);
  }
}

template <int n>
auto PointElement<n>::nodal(int c, std::span<const double> z) const -> Numbers9
{
  Numbers9 out;
  for (int i = 0; i < 9; ++i)
    out[i] = z[3 * _domain.cells[c][i / 3] + i % 3];
  return out;
}

template <int n>
void PointElement<n>::foresee_bubble(Cell& cell, const Numbers9& z) const
{
  double r[2] = {cell.force_k[0], cell.force_k[1]};
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < 9; ++i)
      r[d] += cell.K_bn[d][i] * (z[i] - cell.z_k[i]);
  const auto [b0, b1] = cell.K_bb.solve(r[0], r[1]);
  cell.bubble[0] = cell.bubble_k[0] - b0;
  cell.bubble[1] = cell.bubble_k[1] - b1;
}

/// Strains of the points of a cell; what is wrong with it, or null.
template <int n>
const char* PointElement<n>::strain_cell(const State& state, int c,
                                         std::span<const double> z)
{
  Cell& cell = _cell[c];
  double w[11], x[9], mid[9], G[5 * n];
  gather_nodes(state, c, z, w, x);
  std::array<double, 6> start, end;
  for (int v = 0; v < 3; ++v)
  {
    for (int d = 0; d < 2; ++d)
    {
      start[2 * v + d] = state.x[2 * _domain.cells[c][v] + d];
      end[2 * v + d] = x[3 * v + d];
      mid[3 * v + d] = start[2 * v + d] + 0.5 * w[3 * v + d];
    }
    mid[3 * v + 2] = 0;
  }
  _volume[c] = mesh::triangle_volume(end, _axisymmetric);
  cell.ln_J =
      std::log(_volume[c] / mesh::triangle_volume(start, _axisymmetric));
  std::ranges::copy(cell.bubble, w + 9);
  mid_gradient<n>(_axisymmetric, w, mid, G);
  for (int q = 0; q < n; ++q)
  {
    Point& point = cell.point[q];
    point.G = Gradient(G + 5 * q);
    point.motion = motion(point.G);
    point.p = 0;
    for (int v = 0; v < 3; ++v)
      point.p += points<n>()[q][v] * w[3 * v + 2];
    if (not std::isfinite(point.motion.ln_J) or not std::isfinite(point.p))
      return "the cell would invert";
  }
  return _volume[c] > 0 ? nullptr : "the cell would invert";
}

/// Strains and answers of a cell for the bubble as it is; what is wrong, or
/// null.
template <int n>
const char* PointElement<n>::answer(const State& state, int c,
                                    std::span<const double> z, double dt)
{
  if (const char* trouble = strain_cell(state, c, z))
    return trouble;
  const auto kind = tangent_kind();
  std::vector<double> turned(_num_history);
  const auto update = [&](const auto& answers)
  {
    for (int q = n * c; q < n * (c + 1); ++q)
    {
      Point& point = _cell[c].point[q - n * c];
      const Motion& m = point.motion;
      const auto at = static_cast<std::size_t>(_num_history) * q;
      const auto history = std::span(_history).subspan(at, _num_history);
      std::copy_n(state.history.begin() + at, _num_history, turned.begin());
      medium().turn(turned, m.cosine, m.sine);
      const material::Point start{
          rotate(Voigt(state.s.data() + 4 * q), m.cosine, m.sine), state.P[q],
          turned};
      if (material::drive(answers(0), start, m.de, point.p, dt, point.guess,
                          kind, history, point.answer)
          != Outcome::ok)
        return "the law asks for a smaller step";
      medium().turn(history, m.cosine, m.sine);
      point.guess = point.answer.theta;
      point.s = rotate(point.answer.s, m.cosine, m.sine);
    }
    return static_cast<const char*>(nullptr);
  };
  return medium().with(update);
}

/// The bubble's own equation, by Newton; what is wrong, or null.
template <int n>
const char* PointElement<n>::balance_bubble(const State& state, int c,
                                            std::span<const double> z,
                                            const Constants& constants)
{
  Cell& cell = _cell[c];
  for (int it = 0; it < max_bubble_iterations; ++it)
  {
    if (const char* trouble = answer(state, c, z, constants.dt))
      return trouble;
    PointInput<n> in;
    double x[9], R[11] = {}, A[121];
    gather(state, c, z, in, x);
    _R(R, in, constants, x);
    std::copy_n(R + 9, 2, cell.force);
    if (R[9] * R[9] + R[10] * R[10]
        <= bubble_tolerance * bubble_tolerance * size_squared(c))
      return nullptr;
    tangent_of(state, c, z, constants, A);
    keep_blocks(cell, A);
    const auto [b0, b1] = cell.K_bb.solve(R[9], R[10]);
    cell.bubble[0] -= b0;
    cell.bubble[1] -= b1;
  }
  return "the bubble of a cell finds no balance";
}

template <int n>
int PointElement<n>::evaluate(const State& state, std::span<const double> z,
                              const Constants& constants, std::string& why)
{
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    if (_cell[c].has_blocks)
      foresee_bubble(_cell[c], nodal(c, z));
    if (const char* trouble = balance_bubble(state, c, z, constants))
    {
      why = trouble;
      return c;
    }
  }
  return -1;
}

template <int n>
void PointElement<n>::gather(const State& state, int c,
                             std::span<const double> z, PointInput<n>& in,
                             double* x) const
{
  const Cell& cell = _cell[c];
  gather_nodes(state, c, z, in.w, x);
  std::ranges::copy(cell.bubble, in.w + 9);
  for (int q = 0; q < n; ++q)
  {
    const Point& point = cell.point[q];
    Gradient::Map(in.s + 5 * q) = expand(point.s);
    in.excess[q] = point.answer.theta - point.motion.ln_J;
  }
  in.mu = _G[c];
  in.rho = end_density(state, c);
  if (_newmark)
    gather_newmark(state, c, in.newmark);
}

template <int n>
void PointElement<n>::add_tangent(int c, PointInput<n>& in) const
{
  for (int q = 0; q < n; ++q)
  {
    const Point& point = _cell[c].point[q];
    const CellTangent t = tangent(point.G, point.motion, point.answer, point.s,
                                  point.p, _options.geometric_stiffness);
    Eigen::Map<Eigen::Matrix<double, 5, 5, Eigen::RowMajor>>(
        in.ds_dh + 25 * q) = t.ds_dh;
    Gradient::Map(in.ds_dp + 5 * q) = t.ds_dp;
    Gradient::Map(in.dtheta_dh + 5 * q) = t.dtheta_dh;
    in.dtheta_dp[q] = point.answer.dtheta_dp;
  }
}

template <int n>
void PointElement<n>::tangent_of(const State& state, int c,
                                 std::span<const double> z,
                                 const Constants& constants, double* A) const
{
  PointInput<n> in;
  double x[9];
  const std::span<double> A121(A, 121);
  gather(state, c, z, in, x);
  add_tangent(c, in);
  std::fill_n(A, 121, 0.0);
  _J(A121, in, constants, x);
  if (constants.b > 0)
    _J_damping(A121, in, constants, x);
}

template <int n>
void PointElement<n>::keep_blocks(Cell& cell, const double* A)
{
  cell.K_bb = Condensation(A[9 * 11 + 9], A[9 * 11 + 10], A[10 * 11 + 9],
                           A[10 * 11 + 10]);
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < 9; ++i)
      cell.K_bn[d][i] = A[(9 + d) * 11 + i];
  cell.has_blocks = true;
}

/// Uncondensed residual, MINI order.
template <int n>
std::array<double, 11>
PointElement<n>::residual_of(const State& state, int c,
                             std::span<const double> z,
                             const Constants& constants) const
{
  PointInput<n> in;
  double x[9];
  std::array<double, 11> R{};
  gather(state, c, z, in, x);
  _R(R, in, constants, x);
  if (constants.b > 0)
    _R_damping(R, in, constants, x);
  return R;
}

template <int n>
void PointElement<n>::residual(const State& state, int c,
                               std::span<const double> z,
                               const Constants& constants, double* R)
{
  std::copy_n(residual_of(state, c, z, constants).begin(), 9, R);
}

template <int n>
void PointElement<n>::jacobian(const State& state, int c,
                               std::span<const double> z,
                               const Constants& constants, double* J)
{
  double A[121];
  tangent_of(state, c, z, constants, A);
  Cell& cell = _cell[c];
  keep_blocks(cell, A);
  for (int j = 0; j < 9; ++j)
  {
    const auto [b0, b1] = cell.K_bb.solve(cell.K_bn[0][j], cell.K_bn[1][j]);
    for (int i = 0; i < 9; ++i)
      J[9 * i + j] = A[11 * i + j] - A[11 * i + 9] * b0 - A[11 * i + 10] * b1;
  }
}

template <int n>
std::array<double, 6> PointElement<n>::forces(const State& state, int c,
                                              std::span<const double> z,
                                              const Constants& constants) const
{
  const auto R = residual_of(state, c, z, constants);
  return {R[0], R[1], R[3], R[4], R[6], R[7]};
}

template <int n>
void PointElement<n>::full(const State& state, int c, std::span<const double> z,
                           const Constants& constants, std::span<double> R11,
                           std::span<double> J121) const
{
  PointInput<n> in;
  double x[9];
  gather(state, c, z, in, x);
  std::ranges::fill(R11, 0.0);
  _R(R11, in, constants, x);
  tangent_of(state, c, z, constants, J121.data());
}

template <int n>
std::array<double, 2> PointElement<n>::mismatch_squared(const State& state,
                                                        int c) const
{
  double out[2] = {0, 0};
  for (int q = 0; q < n; ++q)
  {
    double p = 0;
    for (int v = 0; v < 3; ++v)
      p += points<n>()[q][v] * state.p[_domain.cells[c][v]];
    const Point& point = _cell[c].point[q];
    const double d = point.answer.theta - point.motion.ln_J;
    out[0] += std::pow(state.P[n * c + q] - p, 2) / n;
    out[1] += d * d / n;
  }
  return {out[0], out[1]};
}

template <int n>
double PointElement<n>::strain_squared(int c) const
{
  double sum = 0;
  for (const Point& point : _cell[c].point)
    sum +=
        (point.motion.de.squaredNorm() + point.motion.ln_J * point.motion.ln_J
         + point.answer.theta * point.answer.theta)
        / n;
  return sum;
}

/// Square of a force of the cell's own size.
template <int n>
double PointElement<n>::size_squared(int c) const
{
  double sum = std::pow(1e-12 * _G[c], 2);
  for (const Point& point : _cell[c].point)
    sum += (std::pow(material::norm(point.s), 2) + point.p * point.p) / n;
  const double side = std::pow(_volume[c], _axisymmetric ? 2. / 3 : 0.5);
  return sum * side * side;
}

template <int n>
void PointElement<n>::accept_stress(State& state) const
{
  for (int c = 0; c < _domain.num_owned_cells; ++c)
    for (int q = 0; q < n; ++q)
    {
      const std::size_t at = static_cast<std::size_t>(n) * c + q;
      Voigt::Map(state.s.data() + 4 * at) = _cell[c].point[q].s;
      state.P[at] = _cell[c].point[q].p;
    }
}

template class PointElement<3>;
template class PointElement<6>;
} // namespace mmale::lagrangian
