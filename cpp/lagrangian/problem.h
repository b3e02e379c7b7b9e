// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "contact.h"
#include "element.h"
#include "loads.h"
#include "output/clock.h"
#include <array>
#include <dolfinx/la/Vector.h>
#include <memory>
#include <petscsnes.h>
#include <string>

namespace mmale::output
{
class Archive;
}

/// Equilibrium at the end of a step, by PETSc SNES (METHOD.md, step 1).
namespace mmale::lagrangian
{
/// Why a step failed, the same on all ranks.
struct Failure
{
  std::string cause;
  std::int64_t cell = -1;               ///< number in the grid
  std::array<double, 2> place = {0, 0}; ///< its centre [m]
};

/// How Newton went.
struct NewtonLog
{
  int iterations = 0;
  std::vector<double> residuals; ///< relative, one an iteration
  Failure failure;               ///< when it did not converge
};

/// Unknowns and equations are scaled so that both have order one: displacement
/// in metres, pressure in G / l, forces in G, volumes in l, with the shear
/// modulus G and l the root of the mean cell area.
class Problem
{
public:
  Problem(const mesh::Domain& domain, std::span<const material::AnyLaw> laws,
          scene::Symmetry symmetry, const scene::Solver& options,
          const std::optional<scene::Water>& water, output::Clock& clock);
  ~Problem();
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  /// Boundary conditions, inertia and scales of the stage to come. Collective.
  void set_stage(const scene::Stage& stage, const State& state);

  /// What the state needs in a stage that begins now: a dynamic one starts with
  /// the accelerations of balance, at rest after a static one. Collective.
  void begin_stage(State& state);

  /// Forces and accelerations of a dynamic stage anew, from the state as it is:
  /// after a remap. Collective.
  /// @param[in] t from the start of the stage [s]
  void rebalance(State& state, double t);

  /// The body was under the stage's gravity before the stage began.
  void rest_under_gravity() { _gravity = _conditions->gravity(0); }

  /// Largest force on a node that is free to move, were the body at rest when
  /// the stage begins, over its weight; without gravity over the norm of the
  /// cells' own forces. Collective.
  /// @param[in] dt of the step that the laws are asked for [s]
  double imbalance(const State& state, double dt);

  /// Kinetic energy, if the state's velocity is one [J/m or J/rad]. Collective.
  double kinetic_energy(const State& state) const;

  /// Find the end of a step; `state` is advanced only when this succeeds.
  /// Collective.
  ///
  /// @param[in] t0,t1 step, counted from the start of the stage [s]
  [[nodiscard]] bool solve(State& state, double t0, double t1, NewtonLog& log);

  /// Force of each named boundary on the body, (x, y); per unit thickness, or
  /// of the whole circumference [N/m or N]. Of the last solve. Collective.
  const std::vector<std::array<double, 2>>& reactions() const
  {
    return _reactions;
  }

  /// Water that left through each named boundary in the last step, over its
  /// length; none without seepage. Collective.
  std::vector<double> discharge() const;

  /// RMS over the cells of (P - p) and of (theta - ln J). Collective.
  std::array<double, 2> mismatch(const State& state) const;

  /// 1 for nodes that walls hold, shape (nodes), ghosts too; empty without
  /// walls.
  std::vector<std::uint8_t> at_wall() const { return _contact->at_wall(); }

  /// Displacement increments of the last step, shape (nodes, 2), ghosts too
  /// [m].
  std::span<const double> motion() const { return _motion; }

  const Element& element() const { return *_element; }

  /// Mean moduli of all cells [Pa]. Collective.
  material::Moduli moduli(const State& state, double dt,
                          Meets what = Meets::slow_step) const;

  /// What the laws took in the last step. Collective.
  material::Effort effort() const;

  /// What steers the steps to come, besides the state; after `set_stage`.
  void keep(output::Archive& archive);

private:
  static PetscErrorCode function(SNES, Vec, Vec, void*);
  static PetscErrorCode jacobian(SNES, Vec, Mat, Mat, void*);
  static PetscErrorCode before_iteration(SNES, PetscInt);
  bool factor_serves(int iteration) const;
  static PetscErrorCode before_solve(KSP, Vec, Vec, void*);
  static PetscErrorCode after_solve(KSP, Vec, Vec, void*);
  static PetscErrorCode precheck(SNESLineSearch, Vec, Vec, PetscBool*, void*);
  static PetscErrorCode converged(SNES, PetscInt, PetscReal, PetscReal,
                                  PetscReal, SNESConvergedReason*, void*);
  /// An entry that a symmetric matrix lost with a held column.
  struct Lift
  {
    int row, column; ///< local unknowns, scaled
    double value;
  };
  void set_scales(const State& state, double dt);
  std::array<double, 2> impedance(int cell) const;
  void choose_solver();
  void scale(int cell, double* A);
  void add_flow(int cell, const double* A9, double* A12);
  void lift(Vec b);
  void create_matrix();
  void create_solver();
  void forget_factor();
  void unpack(Vec x);
  bool evaluate();
  void assemble_residual(double* r);
  void assemble_flow(double* size);
  bool settle_faces(NewtonLog& log);
  void add_inertia(std::span<double> force, double& size);
  std::vector<double> inner_forces();
  void begin_newmark(const State& state);
  void book_work(State& state, std::span<const double> inner);
  void finish_newmark(State& state);
  void agree_on_failure(int cell, const std::string& why);
  void name_worst(NewtonLog& log);
  int cell_at(int node) const;
  std::vector<std::array<double, 2>> sum_reactions() const;

  /// Where Newton starts from.
  enum class Start
  {
    guess, ///< the last step's motion, scaled
    rest   ///< no motion
  };
  /// Holder of what the explicit scheme has moved already.
  int by_scheme() const
  {
    return static_cast<int>(_domain.boundary_names.size());
  }
  /// Holder of what has only void around it.
  int by_void() const { return by_scheme() + 1; }
  /// Changes of the contact set in a step. Doubled: patience with flutter.
  static constexpr int max_contact_changes = 10;
  void prepare(const State& state, double t0, double t1);
  void hold();
  void find_void(const State& state);
  void hold_void();
  /// Has an unknown 0, 1 (motion) or 2 (pressure) of a node a meaning?
  bool bears(int node, int unknown) const
  {
    return _around.empty() or _around[2 * node + unknown / 2] != 0;
  }
  void start(Start from);
  bool newton(NewtonLog& log);
  bool equilibrium(Start from, NewtonLog& log);

  const mesh::Domain& _domain;
  scene::Symmetry _symmetry;
  scene::Solver _options;
  output::Clock& _clock;
  std::unique_ptr<Element> _element;
  Loads _loads;
  double _stress = 1; ///< scale: the cells' mean shear modulus [Pa]
  double _bulk = 1;   ///< their mean bulk modulus [Pa]
  double _length;     ///< scale [m]

  int _block = 3; ///< unknowns of a node in PETSc's vectors: ux, uy, p, and p_w
                  ///< with seepage; all else keeps p_w apart
  std::unique_ptr<PorePressure> _pore_pressure; ///< with seepage

  std::optional<Conditions> _conditions;
  std::optional<Contact> _contact;
  std::optional<Newmark> _newmark; ///< in dynamic stages
  std::vector<double> _total;      ///< force less inertia, owned, shape (n, 2)
  int _contact_changes = 0;        ///< in this step, of seepage faces too
  double _t0 = 0, _t1 = 0;         ///< of this step
  std::vector<int> _holder;        ///< owned and ghost unknowns
  std::vector<double> _increment;  ///< of held unknowns
  std::vector<double> _around; ///< is there more than void around a node, and
                               ///< what bears a pressure? Shape (n, 2); empty
                               ///< with one material
  std::vector<double> _motion; ///< last step's increment, (nodes, 2)
  std::vector<std::array<double, 2>> _reactions; ///< of the last solve
  double _guess_dt = 0; ///< its step; 0: no guess for the next
  Constants _constants;
  std::array<double, 2> _gravity = {0, 0}; ///< at the end of the last step

  const State* _state = nullptr;      ///< during a solve
  dolfinx::la::Vector<double> _z;     ///< unknowns with units
  dolfinx::la::Vector<double> _force; ///< residual with units
  std::vector<double> _coo;
  std::vector<Lift> _lift; ///< of the matrix in use
  double _norm_u = 0, _norm_p = 0, _norm_bc = 0,
         _norm_w = 0; ///< relative residuals
  Failure _failure;
  bool _failed = false;
  NewtonLog* _log = nullptr; ///< of the Newton run that goes on
  bool _held_anew = true;    ///< what is held differs from the matrix's
  std::unique_ptr<output::Clock::Scope> _solving; ///< while KSP works

  bool _symmetric = false; ///< the matrix, in this stage
  SNES _snes = nullptr;
  Mat _J = nullptr;
  Vec _x = nullptr, _r = nullptr;
  Vec _unlifted = nullptr; ///< right-hand side while KSP works
};
} // namespace mmale::lagrangian
