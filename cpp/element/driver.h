// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/control.h"
#include "material/library.h"
#include <string>
#include <vector>

/// One material point along the paths of an element test (METHOD.md, element
/// tests).
namespace mmale::element
{
/// The state at the start: stress and what the law begins with.
/// @throws std::invalid_argument as make_law
State initial_state(const Test& test, const material::AnyLaw& law);

/// What a step took.
struct StepLog
{
  int iterations = 0; ///< of Newton, those of failed parts too
  int parts = 0;      ///< the step was done in
  int rejected = 0;   ///< parts that failed and were halved
  material::Effort effort = {};
  std::string cause = {}; ///< why a part failed, the last time
};

/// One path, step by step.
class Driver
{
public:
  /// @param law, path, state must outlive the driver; the state advances
  Driver(const material::AnyLaw& law, const Path& path, const Solver& solver,
         State& state);

  int steps() const { return _steps; }

  /// Where the path is after so many steps.
  Progress progress(int step) const;

  /// The next step, in parts where Newton or the law asks for them.
  ///
  /// @return reduce_step when a part of 2^-16 of a step failed; the state is
  ///         then where the last good part left it
  material::Outcome advance(StepLog& log);

private:
  /// Strain increment [-] and change of pore pressure, scaled to strain.
  using Unknowns = Eigen::Vector<double, 5>;

  struct Trial
  {
    State end;
    Unknowns residual;                   ///< in strain
    Eigen::Matrix<double, 5, 5> tangent; ///< of the residual
    double size;                         ///< of the numbers in it
  };

  material::Outcome part(const Progress& to, Unknowns& guess, State& end,
                         StepLog& log) const;
  material::Outcome evaluate(const Progress& to, const Unknowns& x,
                             Trial& trial, StepLog& log) const;
  Unknowns elastic_guess(const Progress& to) const;
  double allowed(const Trial& trial) const;
  material::Moduli moduli(const Progress& to) const;
  bool reverses(int step) const;

  const material::AnyLaw& _law;
  const Path& _path;
  const Solver& _solver;
  State& _state;
  Voigt _strain_at_start;
  Control _control;
  std::vector<material::HistoryField> _fields;
  double _stiffness = 0; ///< P wave modulus at the start of the part [Pa]
  double _time_at_start = 0;
  int _steps = 0, _step = 0;
  Progress _done;
  Unknowns _last = Unknowns::Zero(); ///< answer of the last part
  double _last_share = 0;            ///< its share of a step; 0: none
};
} // namespace mmale::element
