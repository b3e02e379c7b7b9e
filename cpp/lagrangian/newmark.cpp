// SPDX-License-Identifier: LGPL-3.0-or-later
#include "newmark.h"

#include "mesh/corners.h"
#include <cmath>

namespace mmale::lagrangian
{
Newmark::Newmark(const mesh::Domain& domain, scene::Symmetry symmetry,
                 const scene::Dynamics& scheme)
    : a_0(2 * domain.num_nodes(), 0), v_0(2 * domain.num_nodes(), 0),
      r_0(scheme.damping_stiffness > 0 ? domain.num_nodes() : 0, 0),
      _domain(domain), _axisymmetric(symmetry == scene::Symmetry::axisymmetric),
      _scheme(scheme), _held(a_0.size(), false)
{
}

void Newmark::begin_step(const State& state, double dt)
{
  const double beta = _scheme.beta, gamma = _scheme.gamma;
  _dt = dt;
  _mass = mesh::lump(_domain, state.x, state.density, _axisymmetric);
  c_a = is_explicit() ? 0 : 1 / (beta * dt * dt);
  c_v = is_explicit() ? 0 : gamma / (beta * dt);
  set_lines(state);
  // no rate yet: the first step takes its mean, lest a wrong start swings on
  const bool known = r_0.empty() or not std::isnan(state.p_rate[0]);
  c_r = 1 / ((known ? gamma : 1) * dt);
  for (std::size_t n = 0; n < r_0.size(); ++n)
    r_0[n] =
        -c_r * state.p[n] - (known ? (1 / gamma - 1) * state.p_rate[n] : 0);
}

void Newmark::set_lines(const State& state)
{
  const double beta = _scheme.beta, gamma = _scheme.gamma, dt = _dt;
  _held.assign(a_0.size(), false);
  for (std::size_t i = 0; i < a_0.size(); ++i)
  {
    const double v = state.v[i], a = state.a[i];
    // explicit: what is known before balance gives the acceleration
    a_0[i] = is_explicit() ? a : -v / (beta * dt) - a * (0.5 / beta - 1);
    v_0[i] = is_explicit()
                 ? v + (1 - gamma) * dt * a
                 : v * (1 - gamma / beta) + a * dt * (1 - 0.5 * gamma / beta);
  }
}

void Newmark::freeze(const State& state)
{
  _mass = mesh::lump(_domain, state.x, state.density, _axisymmetric);
  c_a = c_v = c_r = 0;
  a_0 = state.a;
  v_0 = state.v;
  for (std::size_t n = 0; n < r_0.size(); ++n)
    r_0[n] = std::isnan(state.p_rate[n]) ? 0 : state.p_rate[n];
}

double Newmark::foreseen(const State& state, int i) const
{
  return _dt * state.v[i] + 0.5 * _dt * _dt * state.a[i];
}

void Newmark::hold(const State& state, std::span<const int> holder,
                   std::span<const double> increment)
{
  for (int n = 0; n < _domain.num_nodes(); ++n)
    for (int d = 0; d < 2; ++d)
      if (const int z = 3 * n + d, i = 2 * n + d; holder[z] >= 0)
      {
        const double v = increment[z] / _dt;
        v_0[i] = v - c_v * increment[z];
        a_0[i] = (v - state.v[i]) / _dt - c_a * increment[z];
        _held[i] = true;
      }
}

void Newmark::finish(State& state, std::span<const double> z,
                     std::span<const double> explicit_a) const
{
  for (int n = 0; n < _domain.num_nodes(); ++n)
  {
    for (int d = 0; d < 2; ++d)
    {
      const int i = 2 * n + d;
      const double u = z[3 * n + d];
      state.a[i] = is_explicit() ? explicit_a[i] : a(i, u);
      state.v[i] = v(i, u);
      if (is_explicit() and not _held[i])
        state.v[i] += _scheme.gamma * _dt * explicit_a[i];
    }
    if (not r_0.empty())
      state.p_rate[n] = r_0[n] + c_r * z[3 * n + 2];
  }
}
} // namespace mmale::lagrangian
