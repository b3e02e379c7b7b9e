// SPDX-License-Identifier: LGPL-3.0-or-later
// What is watched where several materials share cells.
#include "monitor.h"

#include "mesh/corners.h"
#include <cmath>
#include <numbers>

namespace mmale
{
/// Calls visit(cell, slot, fraction) for all that a material has of the cells,
/// ghosts too.
void each_part(const bridge::Materials& materials, std::int32_t material,
               auto&& visit)
{
  for (std::int32_t c = 0; c < materials.num_cells(); ++c)
    if (const std::int32_t slot = materials.slot(c, material); slot >= 0)
      visit(c, slot, materials.fraction(c, material));
}

/// Fractions of the materials, and the numbers of their laws where they are.
void Monitor::add_material_fields(std::vector<output::NamedField>& out)
{
  using output::Location;
  const State& state = _sim.state;
  const std::size_t cells = _sim.domain.num_cells();
  const auto h =
      static_cast<std::size_t>(_sim.problem->element().num_history());
  _of_materials.clear();
  std::vector<std::string> names;
  const auto add = [&](std::string name, std::int32_t k, auto&& value)
  {
    auto& field = _of_materials.emplace_back(cells, 0);
    each_part(*state.materials, k,
              [&](std::int32_t c, std::int32_t slot, double fraction)
              { field[c] = value(slot, fraction); });
    names.push_back(std::move(name));
  };
  std::int32_t k = 0;
  for (const auto& [name, material] : _sim.scene.material)
  {
    add(name, k, [](std::int32_t, double fraction) { return fraction; });
    const auto numbers = material::history_names(_sim.laws[k]);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      add(name + "_" + numbers[i], k, [&](std::int32_t slot, double)
          { return state.history[h * slot + i]; });
    ++k;
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    out.push_back({names[i], Location::cell, 1, _of_materials[i], ""});
}

/// Length of a boundary with a material behind it, by the fractions of the
/// cells there [m]. Collective.
double Monitor::covered_length(int boundary, const std::string& material) const
{
  const auto& table = _sim.scene.material;
  const auto k = static_cast<std::int32_t>(
      std::distance(table.begin(), table.find(material)));
  const auto& x = _sim.state.x;
  double sum = 0;
  for (const mesh::Facet& f : _sim.domain.facets)
    if (f.boundary == boundary and f.cell < _sim.domain.num_owned_cells)
      sum +=
          std::hypot(x[2 * f.a] - x[2 * f.b], x[2 * f.a + 1] - x[2 * f.b + 1])
          * (_sim.state.materials ? _sim.state.materials->fraction(f.cell, k)
                                  : 1);
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, _sim.domain.comm);
  return sum;
}

/// Volume and mass of a material [m3/m, kg/m, or m3 and kg]. Collective.
std::array<double, 2> Monitor::amount(std::int32_t material) const
{
  const State& state = _sim.state;
  const bool axisymmetric =
      _sim.scene.symmetry == scene::Symmetry::axisymmetric;
  std::array<double, 2> sum{0, 0};
  each_part(*state.materials, material,
            [&](std::int32_t c, std::int32_t slot, double fraction)
            {
              if (c >= _sim.domain.num_owned_cells)
                return;
              const double V =
                  fraction
                  * mesh::cell_volume(_sim.domain, state.x, c, axisymmetric);
              sum[0] += V;
              sum[1] += V * state.density[slot];
            });
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 2, MPI_DOUBLE, MPI_SUM,
                _sim.domain.comm);
  for (double& total : sum)
    total *= axisymmetric ? 2 * std::numbers::pi : 1;
  return sum;
}
} // namespace mmale
