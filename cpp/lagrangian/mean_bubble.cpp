// SPDX-License-Identifier: LGPL-3.0-or-later
// The bubble of layout `mean`, and what is a fluid's own (METHOD.md, Fluids).
#include "mean_element.h"

#include "balance.h"
#include "mesh/corners.h"
#include <algorithm>
#include <cmath>

namespace mmale::lagrangian
{
namespace
{
/// Shear modulus that a bubble needs to withstand a gradient of p that turns
/// with it, over grad p times the size of the cell. Twice it changes the period
/// of sloshing by 1e-4 on 16 cells, half of it still holds.
constexpr double against_gradient = 1;

/// grad p and, from it, the sum over corners of |grad l|^2.
struct Slopes
{
  std::array<double, 2> p{0, 0};
  double corners = 0;
};

Slopes slopes(const mesh::Domain& domain, const State& state, int c)
{
  const auto& n = domain.cells[c];
  const double twice_area = 2 * mesh::cell_volume(domain, state.x, c, false);
  Slopes out;
  for (int v = 0; v < 3; ++v)
  {
    const int a = n[(v + 1) % 3], b = n[(v + 2) % 3];
    const double x = (state.x[2 * a + 1] - state.x[2 * b + 1]) / twice_area;
    const double y = (state.x[2 * b] - state.x[2 * a]) / twice_area;
    out.p[0] += x * state.p[n[v]];
    out.p[1] += y * state.p[n[v]];
    out.corners += x * x + y * y;
  }
  return out;
}
} // namespace

/// What holds the bubbles of a fluid and what they weigh in the step to come.
/// Collective.
///
/// The density is that of the nodes around, as their masses have it: cells
/// change their volumes in patterns that no node sees, and a bubble must not
/// take them for light and heavy water.
void MeanElement::begin_bubbles(const State& state)
{
  _placed = false;
  _bubble.resize(_domain.num_owned_cells);
  const auto mass = mesh::lump(_domain, state.x, state.density, _axisymmetric);
  const auto volume = mesh::lump(_domain, state.x, {}, _axisymmetric);
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const Slopes s = slopes(_domain, state, c);
    Bubble& bubble = _bubble[c];
    bubble.u_n = {0, 0};
    bubble.grad = s.p;
    bubble.mu = _G[c]
                + against_gradient * std::hypot(s.p[0], s.p[1]) * 2
                      / std::sqrt(s.corners);
    bubble.rho = 0;
    for (int n : _domain.cells[c])
      bubble.rho += mass[n] / volume[n] / 3;
  }
}

/// Where the forces at the start hold the bubbles of a fluid. What viscosity
/// holds does not remember: it moves at a velocity, against the total forces.
void MeanElement::place_bubbles(const State& state, const Constants& end)
{
  Constants start = end;
  std::copy_n(end.g_n, 2, start.g);
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    CellInput in{};
    double x[9] = {}, R[11] = {}, B[22] = {};
    for (int v = 0; v < 3; ++v)
    {
      const int n = _domain.cells[c][v];
      std::copy_n(state.x.begin() + 2 * n, 2, x + 3 * v);
      in.w[3 * v + 2] = state.p[n];
    }
    hold_bubble(c, in);
    _R(R, in, start, x);
    _B(B, in, start, x);
    const double elastic = B[18] + B[21];
    double inertia = 0;
    if (_newmark)
    {
      in.to_end = 1;
      for (int i = 0; i < 6; ++i)
        in.newmark.a_0[i] =
            _newmark->by_forces(state, 2 * _domain.cells[c][i / 2] + i % 2);
      _inertia.R(R, in, start, x);
      _inertia.B(B, in, start, x);
      inertia = B[18] + B[21] - elastic;
    }
    const Bubble& held = _bubble[c];
    const double viscous = elastic * _G[c] / held.mu;
    const double remembered = 1 - viscous / (elastic + inertia);
    const Condensation K(B[18], B[19], B[20], B[21]);
    const auto [b0, b1] = K.solve(R[9], R[10]);
    _bubble[c].u_n = {-remembered * b0, -remembered * b1};
  }
  _placed = true;
}

/// What the forms take of a fluid's bubble.
void MeanElement::hold_bubble(int c, CellInput& in) const
{
  const Bubble& bubble = _bubble[c];
  in.memory = 0;
  in.mu_b = bubble.mu;
  in.rho_b = bubble.rho;
  std::ranges::copy(bubble.u_n, in.u_n);
  std::ranges::copy(bubble.grad, in.grad_p);
}

void MeanElement::gather_bubble(const State& state, int c, CellInput& in) const
{
  in.to_end = 1;
  if (_bubble.empty())
  {
    in.memory = 1;
    in.mu_b = in.mu;
    in.rho_b = in.rho;
    std::fill_n(in.u_n, 2, 0.0);
    std::fill_n(in.grad_p, 2, 0.0);
    return;
  }
  hold_bubble(c, in);
  if (not _newmark or _newmark->weight() == 1)
    return;
  // of m a = -(1 + alpha) f + alpha f_n the forces of the end alone, -f / m
  const double weight = _newmark->weight();
  in.to_end = 1 / weight;
  for (int i = 0; i < 6; ++i)
    in.newmark.a_0[i] +=
        (weight - 1)
        * _newmark->by_forces(state, 2 * _domain.cells[c][i / 2] + i % 2);
}
} // namespace mmale::lagrangian
