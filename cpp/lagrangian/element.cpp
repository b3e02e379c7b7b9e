// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element.h"

#include "effective.h"
#include "mean_element.h"
#include "mesh/corners.h"
#include "mixed_element.h"
#include "point_element.h"
#include <algorithm>
#include <stdexcept>

namespace mmale::lagrangian
{
Element::Element(const mesh::Domain& domain,
                 std::span<const material::AnyLaw> laws,
                 scene::Symmetry symmetry, const scene::Solver& options,
                 const std::optional<scene::Water>& water, int points)
    : _domain(domain), _axisymmetric(symmetry == scene::Symmetry::axisymmetric),
      _options(options), _num_points(points), _num_history(0),
      _volume(domain.num_owned_cells), _G(domain.num_owned_cells)
{
  for (const material::AnyLaw& law : laws)
  {
    _media.emplace_back(law, water);
    _num_history = std::max(_num_history, _media.back().num_history());
  }
  _history.resize(static_cast<std::size_t>(_num_history) * points
                  * domain.num_owned_cells);
}

bool Element::fluid() const
{
  return std::ranges::all_of(_media, &Medium::fluid);
}

void Element::begin_step(const State& state, double dt)
{
  for (int c = 0; c < _domain.num_owned_cells; ++c)
    _G[c] = moduli(state, c, dt).G;
}

material::Moduli Element::moduli(const State& state, int c, double dt,
                                 Meets what) const
{
  material::Moduli mean{0, 0};
  medium().with(
      [&](const auto& answers)
      {
        for (int q = c * _num_points; q < (c + 1) * _num_points; ++q)
        {
          const material::Point at = point(state, q);
          const auto [G, K] = answers(0).moduli(at, dt);
          mean.G += G / _num_points;
          mean.K += K / _num_points;
          const auto& water = medium().water();
          const bool has = water and not medium().flows(); // water, in K
          const bool wants =
              water
              and (what == Meets::wave or (has and what == Meets::slow_step));
          if (has != wants)
            mean.K += (wants ? 1 : -1)
                      / water->compressibility(material::pores(at.q))
                      / _num_points;
        }
      });
  return mean;
}

bool Element::has_floor() const
{
  return std::ranges::any_of(_media, &Medium::has_floor);
}

double Element::grain_gap(const State& state, int c) const
{
  double density = 0;
  std::vector<double> q(_num_history);
  for (int i = c * _num_points; i < (c + 1) * _num_points; ++i)
    density +=
        begin({.void_ratio = point(state, i).q[medium().void_ratio()]}, 0, q)
        / _num_points;
  return std::log(state.density[c] / density);
}

double Element::end_density(const State& state, int c) const
{
  const double shrunk = std::exp(-ln_J(c));
  if (not medium().flows())
    return state.density[c] * shrunk;
  const double rho_f = medium().water_density();
  double water[2] = {0, 0}; // at start and end
  for (int q = c * _num_points; q < (c + 1) * _num_points; ++q)
  {
    const auto at = static_cast<std::size_t>(_num_history) * q;
    const std::span<const double> end(_history);
    water[0] += rho_f * material::pores(point(state, q).q).n / _num_points;
    water[1] +=
        rho_f * material::pores(end.subspan(at, _num_history)).n / _num_points;
  }
  return (state.density[c] - water[0]) * shrunk + water[1];
}

double Element::pore_pressure(int c) const
{
  if (not _seepage)
    return 0;
  const auto [i, j, k] = _domain.cells[c];
  const auto p_w = _seepage->trial();
  return (p_w[i] + p_w[j] + p_w[k]) / 3;
}

FlowRow Element::flow(const State&, int, std::span<const double>,
                      const Constants&)
{
  throw std::logic_error("this layout has no seepage");
}

FlowTangent Element::flow_tangent(const State&, int, std::span<const double>,
                                  const Constants&)
{
  throw std::logic_error("this layout has no seepage");
}

material::Point Element::point(const State& state, int q) const
{
  const auto history =
      std::span(state.history)
          .subspan(static_cast<std::size_t>(_num_history) * q, _num_history);
  return {Voigt(state.s.data() + 4 * q),
          medium().driven_pressure(state.P[q], history), history};
}

material::TangentKind Element::tangent_kind() const
{
  switch (_options.tangent)
  {
  case scene::Tangent::continuum:
    return material::TangentKind::continuum;
  case scene::Tangent::robust:
    return material::TangentKind::robust;
  default:
    return material::TangentKind::consistent;
  }
}

bool Element::symmetric() const
{
  if (_options.element == scene::Element::constant_strain)
    return false; // its nodal pressure only listens
  if (medium().flows())
    return false; // the row of the flow
  // layout mean: the plastic bubble enters the volume equation alone, and the
  // nodes' acceleration only the bubble's
  const bool flows =
      _options.layout == scene::Layout::mean and _options.plastic_bubble;
  const auto symmetric = [flows](const Medium& m)
  {
    return std::visit([flows](const auto& l)
                      { return l.symmetric and not(l.yields and flows); },
                      m.law());
  };
  return not _newmark and std::ranges::all_of(_media, symmetric);
}

double Element::force_squared(const State& state, int c) const
{
  double sum = 0;
  for (int q = c * _num_points; q < (c + 1) * _num_points; ++q)
  {
    const double s = material::norm(Voigt(state.s.data() + 4 * q));
    sum += (s * s + state.P[q] * state.P[q]) / _num_points;
  }
  const double side = std::pow(_volume[c], _axisymmetric ? 2. / 3 : 0.5);
  return sum * side * side;
}

void Element::gather_nodes(const State& state, int c, std::span<const double> z,
                           double* w, double* x) const
{
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[c][v];
    for (int d = 0; d < 2; ++d)
    {
      w[3 * v + d] = z[3 * n + d];
      x[3 * v + d] = state.x[2 * n + d] + z[3 * n + d];
    }
    w[3 * v + 2] = z[3 * n + 2];
    x[3 * v + 2] = 0;
  }
  w[9] = w[10] = 0;
}

void Element::gather_newmark(const State& state, int c, NewmarkInput& in) const
{
  for (int v = 0; v < 3; ++v)
  {
    const int n = _domain.cells[c][v];
    for (int d = 0; d < 2; ++d)
    {
      in.a_0[2 * v + d] = _newmark->a_0[2 * n + d];
      in.a_n[2 * v + d] = state.a[2 * n + d];
      in.v_0[2 * v + d] = _newmark->v_0[2 * n + d];
    }
    in.r_0[v] = _newmark->r_0.empty() ? 0 : _newmark->r_0[n];
  }
}

void Element::accept(State& state, std::span<const double> z, double dt)
{
  accept_stress(state);
  _water_gained = 0;
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const double before = state.density[c];
    state.density[c] = end_density(state, c);
    if (medium().flows())
      _water_gained +=
          state.density[c] * _volume[c]
          - before * mesh::cell_volume(_domain, state.x, c, _axisymmetric);
    if (not state.apex.empty())
      state.apex[c] += effort(c).apex > 0;
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
  // with several materials rows of parts follow
  const auto update = [this](std::vector<double>& field, int width)
  {
    const auto rows = static_cast<std::size_t>(_domain.num_cells());
    _domain.cell_halo->update(std::span(field).first(rows * width), width);
  };
  update(state.s, 4 * _num_points);
  update(state.P, _num_points);
  update(state.density, 1);
  if (not state.apex.empty())
    update(state.apex, 1);
  if (_num_history > 0)
    update(state.history, _num_history * _num_points);
}

std::unique_ptr<Element> make_element(const mesh::Domain& domain,
                                      std::span<const material::AnyLaw> laws,
                                      scene::Symmetry symmetry,
                                      const scene::Solver& options,
                                      const std::optional<scene::Water>& water)
{
  if (laws.size() > 1)
    return std::make_unique<MixedElement>(domain, laws, symmetry, options);
  if (options.layout == scene::Layout::mean)
    return std::make_unique<MeanElement>(domain, laws, symmetry, options,
                                         water);
  if (options.points == 3)
    return std::make_unique<PointElement<3>>(domain, laws, symmetry, options,
                                             water);
  return std::make_unique<PointElement<6>>(domain, laws, symmetry, options,
                                           water);
}
} // namespace mmale::lagrangian
