// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/test.h"
#include "material/law.h"
#include <array>
#include <vector>

/// What a path prescribes, as five linear conditions on total stress, strain
/// and pore pressure (METHOD.md, element tests).
namespace mmale::element
{
using material::Voigt;
using material::Voigt2;

/// A sample at one time. Tension is positive, as inside of the solver.
struct State
{
  double time = 0;              ///< [s]
  Voigt stress = Voigt::Zero(); ///< effective, xx yy zz xy [Pa]
  Voigt strain = Voigt::Zero(); ///< since the test began, xy is gamma [-]
  double pore_pressure = 0;     ///< over that at the start [Pa]
  std::vector<double> history;  ///< the law's

  /// Effective stress less pore pressure [Pa].
  Voigt total() const;
};

/// a . total stress + b . strain since the path began + c * pore pressure.
struct Condition
{
  Voigt stress = Voigt::Zero();
  Voigt strain = Voigt::Zero();
  double pore_pressure = 0;
  double start = 0, target = 0;
  bool cycles = false; ///< target is an amplitude about start

  bool on_strain() const { return not strain.isZero(0); }
};

using Control = std::array<Condition, 5>;

/// The conditions of a path that begins in a state.
Control control_of(const Path& path, const State& start);

/// How far a path has come.
struct Progress
{
  double share = 0; ///< of the path
  double cycle = 0; ///< cycles done; 0 where it has none
};

/// Prescribed value of a condition.
double value(const Condition& condition, const Progress& progress);

/// Whether a path turns its material: true simple shear does, by half gamma.
bool turns(const Path& path);
} // namespace mmale::element
