// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel.h"
#include "kinematics.h"
#include "material/library.h"
#include "mesh/domain.h"
#include "scene/scene.h"
#include "state.h"
#include <cstdint>

/// The condensed MINI element with one stress state a cell (METHOD.md, 2).
namespace mmale::lagrangian
{
using material::Outcome;

/// Evaluates cells: strain, law, kernels, condensation of the bubble.
///
/// The bubble is linear in the residual, so it is eliminated exactly and has
/// no state: for a residual the two bubble columns are enough.
class Element
{
public:
  /// @throws std::runtime_error when a form asks for what is not offered
  Element(const mesh::Domain& domain, const material::AnyLaw& law,
          scene::Symmetry symmetry, const scene::Solver& options);

  /// Answers of the law for all owned cells at a trial state.
  ///
  /// @param[in] state at the start of the step
  /// @param[in] z     trial unknowns (ux, uy, p), shape (nodes, 3), ghosts too
  /// @return local index of a cell where it failed, or -1; `why` tells
  int evaluate(const State& state, std::span<const double> z, std::string& why);

  /// Residual of a cell after `evaluate`, nodal order [ux uy p] x 3.
  void residual(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* R) const;

  /// Tangent of a cell after `evaluate`, row-major (9, 9).
  void jacobian(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* J) const;

  /// Uncondensed tangent and residual, MINI order; for tests.
  void full(const State& state, int cell, std::span<const double> z,
            const Constants& c, std::span<double> R11,
            std::span<double> J121) const;

  /// State at the end of the step, ghosts filled. Collective.
  void accept(State& state, std::span<const double> z, double dt) const;

  /// Volume of the cell in the trial state, per unit thickness or radian.
  double volume(int cell) const { return _volume[cell]; }
  double ln_J(int cell) const { return _cell[cell].motion.ln_J; }
  double theta(int cell) const { return _cell[cell].answer.theta; }
  /// Square of a nodal force from the stress at the start of the step, the
  /// measure for the forces left over [N²/m² or N²/rad²].
  double force_squared(const State& state, int cell) const;
  /// Square of the step's strain, a measure for the volume equation [-].
  double strain_squared(int cell) const;

  /// Whether the tangent is symmetric but for the geometry's share, which is of
  /// the order of the step's strain and of stress over stiffness.
  bool symmetric() const;

  int num_history() const { return _num_history; }
  double shear_modulus() const;
  double density() const;

private:
  struct Cell
  {
    Gradient G;
    Motion motion;
    material::Response answer;
    Voigt s;  ///< deviator at the end, turned
    double p; ///< mean pressure at the end
  };
  void gather(const State& state, int cell, std::span<const double> z,
              CellInput& in, double* x) const;
  void add_tangent(int cell, CellInput& in) const;
  void use_cell_pressure(int cell, CellInput& in) const;
  void project_pressure(int cell, const CellInput& in, double* R,
                        double* J) const;
  double cell_pressure(int cell) const;

  const mesh::Domain& _domain;
  const material::AnyLaw& _law;
  bool _axisymmetric;
  scene::Solver _options;
  Kernel _R, _J, _B;
  std::vector<Cell> _cell;
  std::vector<double> _volume, _history;
  int _num_history;
};

/// Volume of a triangle per unit thickness, or per radian about x = 0.
double cell_volume(const mesh::Domain& domain, std::span<const double> x,
                   int cell, bool axisymmetric);
} // namespace mmale::lagrangian
