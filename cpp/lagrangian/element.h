// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel.h"
#include "kinematics.h"
#include "material/library.h"
#include "mesh/domain.h"
#include "newmark.h"
#include "scene/scene.h"
#include "state.h"
#include <memory>

/// The condensed MINI element (METHOD.md, 1 Lagrangian step).
namespace mmale::lagrangian
{
using material::Outcome;

/// Evaluates cells: strain, law, kernels, condensation of the bubble. What a
/// stress layout is; one class a layout.
class Element
{
public:
  virtual ~Element() = default;

  /// Inertia in the steps to come, or none; kept by reference.
  void set_newmark(const Newmark* newmark) { _newmark = newmark; }

  /// A Newton run begins: nothing is left of the last one.
  virtual void begin_step(const State& state, double dt);

  /// A Newton iteration begins at the unknowns last evaluated.
  virtual void begin_iteration(std::span<const double>) {}

  /// Answers of the law for all owned cells at a trial state.
  ///
  /// @param[in] state at the start of the step
  /// @param[in] z     trial unknowns (ux, uy, p), shape (nodes, 3), ghosts too
  /// @return local index of a cell where it failed, or -1; `why` tells
  virtual int evaluate(const State& state, std::span<const double> z,
                       const Constants& c, std::string& why) = 0;

  /// Residual of a cell after `evaluate`, nodal order [ux uy p] x 3.
  virtual void residual(const State& state, int cell, std::span<const double> z,
                        const Constants& c, double* R) = 0;

  /// Tangent of a cell after `evaluate`, row-major (9, 9).
  virtual void jacobian(const State& state, int cell, std::span<const double> z,
                        const Constants& c, double* J) = 0;

  /// Nodal forces of the stresses, gravity and damping after `evaluate`, the
  /// bubble's share left out; (x, y) of three vertices.
  virtual std::array<double, 6> forces(const State& state, int cell,
                                       std::span<const double> z,
                                       const Constants& c) const = 0;

  /// Uncondensed tangent and residual, MINI order; for tests.
  virtual void full(const State& state, int cell, std::span<const double> z,
                    const Constants& c, std::span<double> R11,
                    std::span<double> J121) const = 0;

  /// State at the end of the step, ghosts filled. Collective.
  void accept(State& state, std::span<const double> z, double dt);

  /// Volume of the cell in the trial state, per unit thickness or radian.
  double volume(int cell) const { return _volume[cell]; }

  /// Logarithmic volume strain of the cell's nodes [-].
  virtual double ln_J(int cell) const = 0;

  /// Squares of (P - p) and of (theta - ln J), means over the cell's points.
  virtual std::array<double, 2> mismatch_squared(const State& state,
                                                 int cell) const = 0;

  /// Square of the step's strain, a measure for the volume equation [-].
  virtual double strain_squared(int cell) const = 0;

  /// Square of a nodal force from the stress at the start of the step, the
  /// measure for the forces left over [N2/m2 or N2/rad2].
  double force_squared(const State& state, int cell) const;

  /// Whether the tangent is symmetric but for the geometry's share, which is of
  /// the order of the step's strain and of stress over stiffness.
  bool symmetric() const;

  bool fluid() const { return _fluid; } ///< its deviator has no memory
  int num_points() const { return _num_points; }
  int num_history() const { return _num_history; } ///< of a point
  double density() const;

  /// Moduli of a cell as it is: means over its points [Pa].
  material::Moduli moduli(const State& state, int cell, double dt) const;

  /// What the laws' last answers took, of the owned cells.
  virtual material::Effort effort() const = 0;

protected:
  Element(const mesh::Domain& domain, const material::AnyLaw& law,
          scene::Symmetry symmetry, const scene::Solver& options, int points);

  /// Write deviators and pressures of the owned cells.
  virtual void accept_stress(State& state) const = 0;

  /// What dynamics offers to the forms of a cell.
  void gather_newmark(const State& state, int cell, NewmarkInput& in) const;

  /// Unknowns and end geometry of a cell, the bubble left at zero.
  void gather_nodes(const State& state, int cell, std::span<const double> z,
                    double* w, double* x) const;

  material::TangentKind tangent_kind() const;

  /// A point of the state, all points counted through.
  material::Point point(const State& state, int q) const;

  /// Turn the tensors in the history of a point by the half step's rotation.
  void turn_history(std::span<double> q, double cosine, double sine) const;

  const mesh::Domain& _domain;
  const material::AnyLaw& _law;
  bool _axisymmetric;
  scene::Solver _options;
  bool _fluid; ///< its deviator has no memory
  int _num_points, _num_history;
  std::vector<int> _tensors; ///< where in the history one begins
  const Newmark* _newmark = nullptr;
  std::vector<double> _volume, _history; ///< of the trial state
  std::vector<double> _G; ///< shear modulus of a cell in this step [Pa]
};

/// The element of the scene's layout.
/// @throws std::runtime_error when a form asks for what is not offered
std::unique_ptr<Element> make_element(const mesh::Domain& domain,
                                      const material::AnyLaw& law,
                                      scene::Symmetry symmetry,
                                      const scene::Solver& options);

/// Schur complement of the bubble: what is left in the nodal block.
struct Condensation
{
  double inverse[4]; // of K_bb

  Condensation() = default;
  Condensation(double a, double b, double c, double d)
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
} // namespace mmale::lagrangian
