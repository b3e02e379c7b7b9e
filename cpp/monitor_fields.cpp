// SPDX-License-Identifier: LGPL-3.0-or-later
// The fields that a run writes.
#include "monitor.h"

#include "material/water.h"
#include "mesh/corners.h"
#include <cmath>

namespace mmale
{
/// A number of the water in the cells: 0 its pressure, 1 the porosity.
std::vector<double> Monitor::water(std::size_t number) const
{
  const std::size_t h = _sim.problem->element().num_history();
  const auto means = cell_mean(_sim.state.history, h);
  std::vector<double> out(means.size() / h);
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = means[h * c + h - 2 + number];
  return out;
}

/// Pore pressure of the nodes: an unknown, or the mean of the corners around
/// [Pa]. Collective.
std::vector<double> Monitor::pore_pressure() const
{
  const State& state = _sim.state;
  if (not state.p_w.empty())
    return state.p_w;
  return corner_mean(water(0));
}

/// Means of a cells' field over the corners around the nodes. Collective.
std::vector<double> Monitor::corner_mean(std::span<const double> cells) const
{
  const bool axisymmetric =
      _sim.scene.symmetry == scene::Symmetry::axisymmetric;
  const auto& x = _sim.state.x;
  auto out = mesh::lump(_sim.domain, x, cells, axisymmetric);
  const auto volume = mesh::lump(_sim.domain, x, {}, axisymmetric);
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] /= volume[n];
  return out;
}

bool Monitor::has_void_ratio() const
{
  return _sim.problem and _sim.problem->element().has_void_ratio();
}

/// Element::grain_gap of all cells, ghosts too.
std::vector<double> Monitor::grain_gap() const
{
  std::vector<double> out(_sim.domain.num_cells());
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = _sim.problem->element().grain_gap(_sim.state, static_cast<int>(c));
  return out;
}

/// Stress that the skeleton carries, shape (cells, 4) [Pa].
std::vector<double> Monitor::effective_stress() const
{
  auto stress = cell_stress();
  const auto p_w = water(0);
  for (std::size_t c = 0; c < p_w.size(); ++c)
    for (int i = 0; i < 3; ++i)
      stress[4 * c + i] += p_w[c];
  return stress;
}

void Monitor::add_water_fields(std::vector<output::NamedField>& out)
{
  using output::Location;
  auto& [p_w, porosity, effective, p] = _of_water;
  p_w = pore_pressure();
  porosity = water(1);
  effective = effective_stress();
  out.push_back({"pore_pressure", Location::nodal, 1, p_w, "Pa"});
  out.push_back({"porosity", Location::cell, 1, porosity, ""});
  p.resize(porosity.size());
  for (std::size_t c = 0; c < p.size(); ++c)
    p[c] =
        -(effective[4 * c] + effective[4 * c + 1] + effective[4 * c + 2]) / 3;
  out.push_back({"effective_stress", Location::cell, 4, effective, "Pa"});
  out.push_back({"effective_pressure", Location::cell, 1, p, "Pa"});
}

/// Means over the points of the cells; `size` numbers a point.
std::vector<double> Monitor::cell_mean(std::span<const double> v,
                                       std::size_t size) const
{
  const std::size_t points = _sim.state.points;
  // with several materials rows of parts follow
  v = v.first(size * points * _sim.domain.num_cells());
  std::vector<double> out(v.size() / points, 0);
  for (std::size_t i = 0; i < v.size(); ++i)
    out[i / (size * points) * size + i % size] += v[i] / points;
  return out;
}

/// Stress of the cells, xx yy zz xy, shape (cells, 4) [Pa].
std::vector<double> Monitor::cell_stress() const
{
  auto stress = cell_mean(_sim.state.s, 4);
  const auto P = cell_mean(_sim.state.P, 1);
  for (std::size_t c = 0; c < P.size(); ++c)
    for (int i = 0; i < 3; ++i)
      stress[4 * c + i] -= P[c];
  return stress;
}

std::vector<output::NamedField> Monitor::fields()
{
  using output::Location;
  const auto& state = _sim.state;
  std::vector<output::NamedField> out{
      {"velocity", Location::nodal, 2, state.v, "m/s"}};
  for (const auto& [name, values] : state.tracer)
    out.push_back({name, Location::cell, 1, values, ""});
  if (_sim.laws.empty())
    return out;
  const std::size_t cells = _sim.domain.num_cells();
  auto& [mises, stress, history, gap] = _derived;
  stress = cell_stress();
  mises.resize(cells);
  for (std::size_t c = 0; c < cells; ++c)
  {
    material::Voigt s(stress.data() + 4 * c);
    s.head<3>().array() -= s.head<3>().mean();
    mises[c] = std::sqrt(1.5) * material::norm(s);
  }
  out.push_back({"pressure", Location::nodal, 1, state.p, "Pa"});
  out.push_back({"von_mises", Location::cell, 1, mises, "Pa"});
  out.push_back({"stress", Location::cell, 4, stress, "Pa"});
  out.push_back({"density", Location::cell, 1,
                 std::span(state.density).first(cells), "kg/m3"});
  if (not state.apex.empty())
    out.push_back({"apex", Location::cell, 1, state.apex, ""});
  if (state.materials)
  {
    add_material_fields(out);
    return out;
  }
  // history numbers come apart, one field each
  const auto names =
      material::history_names(_sim.laws.front(), _sim.scene.water.has_value());
  const std::size_t h = names.size();
  const auto means = cell_mean(state.history, h);
  history.resize(h * cells);
  const std::size_t of_law = h - (_sim.scene.water ? 2 : 0);
  for (std::size_t k = 0; k < of_law; ++k)
  {
    for (std::size_t c = 0; c < cells; ++c)
      history[k * cells + c] = means[h * c + k];
    out.push_back({names[k], Location::cell, 1,
                   std::span(history).subspan(k * cells, cells), ""});
  }
  if (has_void_ratio())
  {
    gap = grain_gap();
    out.push_back({"grain_gap", Location::cell, 1, gap, ""});
  }
  if (_sim.scene.water)
    add_water_fields(out);
  return out;
}
} // namespace mmale
