// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "scene/scene.h"
#include "state.h"
#include <span>
#include <vector>

/// Newmark's integration of motion over a step (METHOD.md, step 1d).
///
/// In: displacement increments; out: velocity and acceleration at the end. They
/// are lines in the increment u,
///
///     a = a_0 + c_a u,   v = v_0 + c_v u,   dp/dt = r_0 + c_r p,
///
/// so that forms and matrix see three slopes and nothing else. With beta = 0
/// the increment itself is known (the explicit scheme), and a comes from
/// balance. HHT weighs the forces at the two ends of the step.
/// @source Newmark, J. Eng. Mech. Div. ASCE 85 (1959); Hilber, Hughes & Taylor,
///         Earthq. Engng Struct. Dyn. 5 (1977)
namespace mmale::lagrangian
{
class Newmark
{
public:
  Newmark(const mesh::Domain& domain, scene::Symmetry symmetry,
          const scene::Dynamics& scheme);

  /// Masses and lines of a step; the state's mesh has its start geometry.
  /// Collective.
  void begin_step(const State& state, double dt);

  /// The lines of a step in which nothing is held.
  void set_lines(const State& state);

  /// Masses, and lines that stand still at the state. Collective.
  void freeze(const State& state);

  /// Held unknowns follow their motion, whose velocity is increment / dt.
  ///
  /// @param[in] holder    negative where free, shape (nodes, 3)
  /// @param[in] increment shape (nodes, 3) [m]
  void hold(const State& state, std::span<const int> holder,
            std::span<const double> increment);

  /// Mass of a node [kg/m or kg/rad].
  double mass(int node) const { return _mass[node]; }
  /// Acceleration at the end; unknown = 2 node + direction.
  double a(int unknown, double u) const { return a_0[unknown] + c_a * u; }
  /// Velocity at the end.
  double v(int unknown, double u) const { return v_0[unknown] + c_v * u; }
  /// Increment that the start's motion foresees; the explicit scheme's own.
  double foreseen(const State& state, int unknown) const;

  /// Acceleration that the forces at the start gave alone, without what HHT
  /// takes from before; of a held unknown its own.
  double by_forces(const State& state, int unknown) const
  {
    return _held[unknown] ? state.a[unknown]
                          : -state.force[unknown] / _mass[unknown / 2];
  }

  /// Explicit: the increment is `foreseen`.
  bool is_explicit() const { return _scheme.beta == 0; }
  /// Weight of the forces at the end of the step, 1 + alpha.
  double weight() const { return 1 + _scheme.alpha; }
  const scene::Dynamics& scheme() const { return _scheme; }

  /// Write velocity, acceleration and pressure rate of the end.
  ///
  /// @param[in] z        unknowns, shape (nodes, 3), ghosts too
  /// @param[in] explicit_a accelerations by balance, shape (nodes, 2), of the
  ///                       explicit scheme alone
  void finish(State& state, std::span<const double> z,
              std::span<const double> explicit_a) const;

  std::vector<double> a_0, v_0; ///< shape (nodes, 2) [m/s2], [m/s]
  std::vector<double> r_0;      ///< shape (nodes) [Pa/s]; with damping
  double c_a = 0;               ///< [1/s2]
  double c_v = 0;               ///< [1/s]
  double c_r = 0;               ///< [1/s]

private:
  const mesh::Domain& _domain;
  bool _axisymmetric;
  scene::Dynamics _scheme;
  double _dt = 0;
  std::vector<double> _mass;
  std::vector<bool> _held; ///< shape (nodes, 2)
};
} // namespace mmale::lagrangian
