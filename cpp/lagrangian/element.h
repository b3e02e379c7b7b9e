// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel.h"
#include "medium.h"
#include "mesh/domain.h"
#include "newmark.h"
#include "pore_pressure.h"
#include "scene/scene.h"
#include "state.h"
#include <memory>
#include <optional>

/// The condensed MINI element (METHOD.md, 1 Lagrangian step).
namespace mmale::lagrangian
{
using material::Outcome;

/// A cell's row of the pore pressure.
struct FlowRow
{
  std::array<double, 3>
      R;                 ///< volume that is missing at a node [m3/m or m3/rad]
  double size_squared;   ///< of the flows that it is a sum of
  double digits_squared; ///< of their last digits, over epsilon
};

/// Whose moduli: of the medium as a slow step meets it (undrained: with its
/// water), of the skeleton alone, or with water that has no time to flow.
enum class Meets
{
  slow_step,
  skeleton,
  wave
};

/// Blocks of the pore pressure in a cell's tangent, row-major.
struct FlowTangent
{
  std::array<double, 27> momentum;        ///< rows of u and p, shape (9, 3)
  std::array<double, 27> by_nodes;        ///< of the flow, by u and p: (3, 9)
  std::array<double, 9> by_pore_pressure; ///< (3, 3)
};

/// Evaluates cells: strain, law, kernels, condensation of the bubble. What a
/// stress layout is; one class a layout.
class Element
{
public:
  virtual ~Element() = default;

  /// Inertia in the steps to come, or none; kept by reference.
  void set_newmark(const Newmark* newmark) { _newmark = newmark; }

  /// Water that flows, or none; kept by reference.
  void set_pore_pressure(const PorePressure* nodes) { _seepage = nodes; }

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

  /// Row of the pore pressure of a cell after `evaluate`; with seepage alone.
  virtual FlowRow flow(const State& state, int cell, std::span<const double> z,
                       const Constants& c);

  /// Blocks of the pore pressure, of the cell of the last `jacobian`.
  virtual FlowTangent flow_tangent(const State& state, int cell,
                                   std::span<const double> z,
                                   const Constants& c);

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
  virtual void accept(State& state, std::span<const double> z, double dt);

  /// Mass of the water that owned cells have gained in the last step, by flow
  /// [kg/m or kg/rad].
  double water_gained() const { return _water_gained; }

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
  virtual bool symmetric() const;

  /// Has no material's deviator a memory?
  bool fluid() const;

  /// Has a law a zero-stress floor? Then it is counted where it acts.
  bool has_floor() const;

  int num_points() const { return _num_points; }
  int num_history() const { return _num_history; } ///< of a point

  /// Numbers of a point at the start of a run, and its density [kg/m3].
  /// @param[in] p_w pore pressure, if there is water [Pa]
  double begin(const material::Start& start, double p_w,
               std::span<double> q) const
  {
    return medium().begin(start, p_w, q);
  }

  /// Does the law know its void ratio?
  bool has_void_ratio() const { return medium().void_ratio() >= 0; }

  /// Logarithm of a cell's density over the one that goes with its void
  /// ratios: theta and ln J differ cell by cell, and this is their sum [-].
  double grain_gap(const State& state, int cell) const;

  /// Moduli of a cell as it is: means over its points [Pa].
  virtual material::Moduli moduli(const State& state, int cell, double dt,
                                  Meets what = Meets::slow_step) const;

  /// Is there anything but void in a cell, of this rank or a ghost?
  virtual bool present(const State&, int) const { return true; }
  /// Can it bear a pressure?
  virtual bool bears(const State&, int) const { return true; }

  /// What the law's last answer took in a cell.
  virtual material::Effort effort(int cell) const = 0;

protected:
  Element(const mesh::Domain& domain, std::span<const material::AnyLaw> laws,
          scene::Symmetry symmetry, const scene::Solver& options,
          const std::optional<scene::Water>& water, int points);

  /// Write deviators and pressures of the owned cells.
  virtual void accept_stress(State& state) const = 0;

  /// What dynamics offers to the forms of a cell.
  void gather_newmark(const State& state, int cell, NewmarkInput& in) const;

  /// Unknowns and end geometry of a cell, the bubble left at zero.
  void gather_nodes(const State& state, int cell, std::span<const double> z,
                    double* w, double* x) const;

  material::TangentKind tangent_kind() const;

  /// Density of a cell in the trial state: its solids stay, and its water too
  /// if it does not flow [kg/m3].
  double end_density(const State& state, int cell) const;

  /// Mean of the nodes' trial pore pressure [Pa]; 0 without seepage.
  double pore_pressure(int cell) const;

  /// A point of the state, all points counted through.
  material::Point point(const State& state, int q) const;

  /// The material, where there is one.
  const Medium& medium() const { return _media.front(); }

  const mesh::Domain& _domain;
  std::vector<Medium> _media; ///< of the materials
  bool _axisymmetric;
  scene::Solver _options;
  double _water_gained = 0;
  const PorePressure* _seepage = nullptr; ///< with water that flows
  int _num_points, _num_history;          ///< the most of any material
  const Newmark* _newmark = nullptr;
  std::vector<double> _volume, _history; ///< of the trial state
  std::vector<double> _G; ///< shear modulus of a cell in this step [Pa]
};

/// The element of the scene's layout, or that of several materials.
/// @throws std::runtime_error when a form asks for what is not offered
std::unique_ptr<Element>
make_element(const mesh::Domain& domain, std::span<const material::AnyLaw> laws,
             scene::Symmetry symmetry, const scene::Solver& options,
             const std::optional<scene::Water>& water = std::nullopt);

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
