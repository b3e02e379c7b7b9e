// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "conditions.h"
#include "kernel.h"
#include "newmark.h"
#include <functional>

namespace mmale::lagrangian
{
/// Forces on boundary facets in a step: tractions, pressures, and the dashpots
/// of absorbing boundaries. Adds to residual and tangent of the nodes.
class Loads
{
public:
  Loads(const mesh::Domain& domain, scene::Symmetry symmetry);

  /// Impedances of a cell [Pa s/m]: along the normal, across.
  using Impedance = std::function<std::array<double, 2>(int)>;

  /// Loads of a step. Facets of cells that belong to other ranks are left out.
  /// @param[in] newmark   of the step, or none; kept by reference
  /// @param[in] impedance asked for at absorbing boundaries
  void begin_step(std::vector<Load> loads, const Newmark* newmark,
                  const Impedance& impedance);

  /// Add to the residual; shape (nodes, 3), ghosts are the caller's to send.
  void add_residual(const State& state, std::span<const double> z,
                    std::span<double> force) const;

  /// Add to the tangent of a cell, row-major (9, 9).
  void add_jacobian(const State& state, int cell, std::span<const double> z,
                    double* J) const;

private:
  struct Loaded
  {
    mesh::Facet facet;
    Constants constants;
    bool dashpots;
  };
  void gather(const State& state, int cell, std::span<const double> z,
              CellInput& in, double* x) const;

  const mesh::Domain& _domain;
  Kernel _R, _J, _R_dashpots, _J_dashpots;
  const Newmark* _newmark = nullptr;
  std::vector<Loaded> _facets; ///< ascending by cell
};
} // namespace mmale::lagrangian
