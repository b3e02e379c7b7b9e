// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <algorithm>

/// Form P's way to ask a law: by the pressure instead of the volume strain.
///
/// The solver knows the deviatoric strain and, from the nodes, the pressure at
/// the end of a step; wanted is the volume strain for which the law has this
/// pressure. As p falls with theta at any state, there is one.
namespace mmale::material
{
/// The answer, with derivatives by `de` and by `p`.
struct Driven
{
  Voigt s = Voigt::Zero(); ///< deviator at the end [Pa]
  double theta = 0;        ///< volume strain that goes with `p` [-]
  double flow = 0;         ///< as in Response
  Voigt2 ds_de = Voigt2::Zero();
  Voigt ds_dp = Voigt::Zero();
  Voigt dtheta_de = Voigt::Zero();
  double dtheta_dp = 0;
  Voigt dflow_de = Voigt::Zero();
  double dflow_dp = 0;
  Effort effort;
};

/// A law may say `static constexpr bool linear_pressure = true`: p falls by
/// K theta, K that of `moduli`, whatever else happens. It is then asked once.
template <class L>
concept LinearPressure = requires { requires L::linear_pressure; };

/// From derivatives at fixed theta to those at fixed p.
inline void turn_derivatives(const Response& law, Driven& answer)
{
  const double slope = 1 / law.dp_dtheta;
  answer.dtheta_dp = slope;
  answer.dtheta_de = -slope * law.dp_de;
  answer.ds_dp = slope * law.ds_dtheta;
  answer.ds_de = law.ds_de + law.ds_dtheta * answer.dtheta_de.transpose();
  answer.dflow_dp = slope * law.dflow_dtheta;
  answer.dflow_de = law.dflow_de + law.dflow_dtheta * answer.dtheta_de;
}

/// A zero of a falling function, by Newton's method kept within bounds that
/// close in; where the slope is not the function's own, by secants.
class FallingRoot
{
public:
  explicit FallingRoot(double start) : _x(start) {}
  double x() const { return _x; }

  /// The function at x, and its slope there or something like it; moves x.
  void next(double value, double slope)
  {
    (value > 0 ? _low : _high) = _x;
    if (_steps++ > 1 and _x != _last_x and value != _last)
    {
      const double secant = (value - _last) / (_x - _last_x);
      if (secant < 0 and not(std::abs(value) < 0.2 * std::abs(_last)))
        slope = secant; // Newton is slow: not its slope
    }
    _last = value;
    _last_x = _x;
    _x -= value / slope;
    const double reach = std::max(1e-3, 4 * std::abs(_last_x));
    _x = std::clamp(_x, _last_x - reach, _last_x + reach);
    if (not(_x > _low and _x < _high))
      _x = 0.5 * (_low + _high);
  }

  /// The function cannot be had at x: halfway back to where it could.
  void retreat() { _x = 0.5 * (_x + _last_x); }

private:
  double _x, _last_x = 0, _last = 0;
  double _low = -scene::infinity, _high = scene::infinity;
  int _steps = 0;
};

/// What can be driven: a law, or one with water in its pores (`water.h`).
template <class L>
concept StrainDriven =
    requires(const L law, const Point& start, const Strain& step,
             TangentKind kind, std::span<double> q, Response& answer) {
      { law.update(start, step, kind, q, answer) } -> std::same_as<Outcome>;
      { law.moduli(start, step.dt) } -> std::same_as<Moduli>;
    };

/// Ask a law by pressure.
///
/// @param[in]     p     at the end of the step [Pa]
/// @param[in]     guess of theta, or NaN: from the moduli
/// @param[out]    q     history at the end
/// @param[out]    answer
/// @return reduce_step if the law asks for it, or has no such pressure
template <StrainDriven L>
Outcome drive(const L& law, const Point& start, const Voigt& de, double p,
              double dt, double guess, TangentKind kind, std::span<double> q,
              Driven& answer)
{
  constexpr int max_evaluations = LinearPressure<L> ? 1 : 40;
  const auto [G, K] = law.moduli(start, dt);
  // p has been summed from numbers of this size; without stress, as sand at a
  // free surface is, from those of the elastic trial
  const double tolerance =
      1e-13 * (std::abs(p) + std::abs(start.p) + norm(start.s))
      + 1e-15 * 2 * G * norm(de);
  if (LinearPressure<L> or std::isnan(guess))
    guess = -(p - start.p) / K;
  FallingRoot theta(guess);
  Response r;
  answer.effort = {};
  for (int i = 0; i < max_evaluations; ++i)
  {
    std::ranges::copy(start.q, q.begin());
    if (law.update(start, {de, theta.x(), dt}, kind, q, r) != Outcome::ok)
    {
      theta.retreat();
      continue;
    }
    answer.effort += r.effort;
    const double excess = r.p - p;
    // and a law for whole tensors adds de and theta up again
    const double digits =
        (std::abs(r.dp_dtheta) + K) * (std::abs(theta.x()) + de.norm()) * 2e-15;
    if (LinearPressure<L> or std::abs(excess) <= tolerance + digits)
    {
      if (not(r.dp_dtheta < 0)) // against the contract, as a umat may be
        return Outcome::reduce_step;
      answer.s = r.s;
      answer.theta = theta.x();
      answer.flow = r.flow;
      turn_derivatives(r, answer);
      if constexpr (not LinearPressure<L>) // the last digits
      {
        answer.theta -= excess * answer.dtheta_dp;
        answer.s -= excess * answer.ds_dp;
      }
      return Outcome::ok;
    }
    theta.next(excess, r.dp_dtheta);
  }
  return Outcome::reduce_step;
}
} // namespace mmale::material
