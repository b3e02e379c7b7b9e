// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/archive.h"
#include "output/fields.h"
#include "output/ledger.h"
#include "output/probe.h"
#include "simulation.h"
#include <string>
#include <vector>

namespace mmale
{
/// What a run is watched by: the columns of curves.csv, the conservation
/// ledger, the fields. All calls are collective.
class Monitor
{
public:
  explicit Monitor(Simulation& sim);

  /// Names of the columns.
  const std::vector<std::string>& names() const { return _names; }

  /// Add up the displacements of an accepted step.
  void after_step(double dt);

  /// A row of values, the same on all ranks.
  std::vector<double> row(double step, const StepLog& log);

  /// Conserved quantities from the start until now.
  output::Ledger ledger() const;

  /// Fields as they stand; spans live until the next call.
  std::vector<output::NamedField> fields();

  /// What was added up so far; the state has been kept before. Collective.
  void keep(output::Archive& archive);

private:
  struct Column
  {
    scene::Curve curve;
    int boundary = -1; ///< index, or
    int point = -1;    ///< index into _points
    double divide_by = 1;
  };
  double value(const Column& c) const;
  double tracer(const scene::Curve& c) const;
  double energy(const std::string& quantity) const;
  double stress(int point, const std::string& component,
                std::span<const double> all) const;
  std::vector<double> sample(std::span<const double> nodal, int size) const;
  std::vector<double> cell_mean(std::span<const double> v,
                                std::size_t size) const;
  std::vector<double> cell_stress() const;
  std::vector<double> effective_stress() const;
  std::vector<double> water(std::size_t number) const;
  std::vector<double> pore_pressure() const;
  std::vector<double> corner_mean(std::span<const double> cells) const;
  bool has_void_ratio() const;
  std::vector<double> grain_gap() const;
  void add_material_fields(std::vector<output::NamedField>& out);
  double covered_length(int boundary, const std::string& material) const;
  std::array<double, 2> amount(std::int32_t material) const;
  void add_water_fields(std::vector<output::NamedField>& out);
  double boundary_mean(int boundary, std::span<const double> nodal, int size,
                       int component) const;
  double largest_place(int boundary, int direction) const;
  double breadth(const scene::Curve& c) const;
  double volume() const;
  double integral(std::span<const double> density) const;

  Simulation& _sim;
  output::Probe _probe;
  std::vector<std::string> _names;
  std::vector<Column> _columns;
  std::vector<int>
      _watched; ///< boundaries with conditions in some stage, or a curve
  std::vector<scene::Point> _points, _displacement;
  std::vector<output::Spot> _spots;
  std::vector<std::array<double, 2>> _moved; ///< of each boundary, mean
  std::vector<std::array<double, 2>> _reactions;
  std::vector<double> _discharge; ///< of each boundary, with seepage
  output::Ledger _start;
  double _volume = 0;              ///< at the end of the last step
  double _seeped = 0;              ///< mass of water that flowed in
  double _lagrangian_volume = 0;   ///< change by the material's own motion
  std::vector<double> _derived[4]; ///< von Mises, stress, history, grain gap
  std::vector<std::vector<double>> _of_materials;
  std::vector<double> _of_water[4]; ///< p_w, porosity, effective stress and
                                    ///< pressure
};
} // namespace mmale
