// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/driver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace mmale::element
{
namespace
{
using material::Outcome;
using material::Response;

const Voigt one(1, 1, 1, 0);

double mean_pressure(const Voigt& stress)
{
  return -stress.head<3>().sum() / 3;
}

/// Stress by strain from the derivatives by deviator and volume strain.
Voigt2 stiffness(const Response& r)
{
  Voigt2 deviator = Voigt2::Identity();
  deviator.topLeftCorner<3, 3>().array() -= 1.0 / 3;
  const Voigt2 ds = r.ds_de * deviator + r.ds_dtheta * one.transpose();
  const Eigen::RowVector4d dp =
      r.dp_de.transpose() * deviator + r.dp_dtheta * one.transpose();
  return ds - one * dp;
}

/// R t R^T of a stress for R = [c s; -s c], with half the spin of a true
/// simple shear of `gamma`: Hughes-Winget's R½ = (I + r/2)/|I + r/2|.
Voigt half_turned(const Voigt& t, double gamma)
{
  const double angle = std::atan(gamma / 4);
  const double c = std::cos(2 * angle), s = std::sin(2 * angle);
  const double mean = (t[0] + t[1]) / 2, half = (t[0] - t[1]) / 2;
  return {mean + c * half + s * t[3], mean - c * half - s * t[3], t[2],
          c * t[3] - s * half};
}

/// Tensors in a history turn with the material.
void half_turn(const std::vector<material::HistoryField>& fields, double gamma,
               std::vector<double>& history)
{
  std::size_t at = 0;
  for (const material::HistoryField& field : fields)
  {
    if (field.size == 4)
    {
      Eigen::Map<Voigt> t(history.data() + at);
      t = half_turned(t, gamma);
    }
    at += static_cast<std::size_t>(field.size);
  }
}
} // namespace

State initial_state(const Test& test, const material::AnyLaw& law)
{
  const Initial& i = test.initial;
  State state;
  if (i.pressure)
    state.stress = -*i.pressure * one;
  else
  {
    const double radial = i.k0.value() * i.sigma_a.value();
    state.stress = Voigt(-radial, -*i.sigma_a, -radial, 0);
  }
  state.history.resize(static_cast<std::size_t>(material::num_history(law)));
  material::Start start{.p = mean_pressure(state.stress)};
  if (i.void_ratio)
    start.void_ratio = *i.void_ratio;
  std::visit([&](const auto& l) { l.begin(start, state.history); }, law);
  return state;
}

Driver::Driver(const material::AnyLaw& law, const Path& path,
               const Solver& solver, State& state)
    : _law(law), _path(path), _solver(solver), _state(state),
      _strain_at_start(state.strain), _control(control_of(path, state)),
      _fields(std::visit([](const auto& l) { return l.history(); }, law)),
      _time_at_start(state.time),
      _steps(path.cycles > 0
                 ? static_cast<int>(std::lround(path.cycles * path.steps))
                 : path.steps)
{
}

Progress Driver::progress(int step) const
{
  return {static_cast<double>(step) / _steps,
          _path.cycles > 0 ? static_cast<double>(step) / _path.steps : 0};
}

/// Residual and tangent of a trial; reduce_step if the law has no answer.
Outcome Driver::evaluate(const Progress& to, const Unknowns& x, Trial& trial,
                         StepLog& log) const
{
  const Voigt strain = x.head<4>();
  const double turn = turns(_path) ? strain[3] : 0;
  State& end = trial.end;
  end = _state;
  end.time = _time_at_start + to.share * _path.duration;
  half_turn(_fields, turn, end.history);
  // The law works in place on a copy of what it began with.
  const std::vector<double> began = end.history;
  const Voigt sigma = half_turned(_state.stress, turn);
  const material::Point start{.s = sigma + mean_pressure(sigma) * one,
                              .p = mean_pressure(sigma),
                              .q = began};
  material::Strain step{.theta = strain.head<3>().sum(),
                        .dt = end.time - _state.time};
  step.de = strain - step.theta / 3 * one;
  const auto kind = static_cast<material::TangentKind>(_solver.tangent);
  Response r;
  ++log.iterations;
  const Outcome outcome =
      std::visit([&](const auto& l)
                 { return l.update(start, step, kind, end.history, r); }, _law);
  if (outcome != Outcome::ok)
    return outcome;
  log.effort += r.effort;
  half_turn(_fields, turn, end.history);
  end.stress = half_turned(r.s - r.p * one, turn);
  end.strain = _state.strain + strain;
  end.pore_pressure = _state.pore_pressure + x[4] * _stiffness;
  if (not end.stress.allFinite())
    return Outcome::reduce_step;

  Voigt2 by_strain = stiffness(r);
  if (turns(_path)) // and the spin turns the stress
    by_strain.col(3) += Voigt(end.stress[3], -end.stress[3], 0,
                              (end.stress[1] - end.stress[0]) / 2);
  trial.tangent.setZero();
  trial.size =
      strain.norm() + (end.stress.norm() + _state.stress.norm()) / _stiffness;
  const Voigt total = end.total(), along = end.strain - _strain_at_start;
  for (int i = 0; i < 5; ++i)
  {
    const Condition& c = _control[static_cast<std::size_t>(i)];
    const double scale = c.on_strain() ? 1 : _stiffness;
    trial.residual[i] = (c.stress.dot(total) + c.strain.dot(along)
                         + c.pore_pressure * end.pore_pressure - value(c, to))
                        / scale;
    trial.tangent.row(i).head<4>() =
        (by_strain.transpose() * c.stress + c.strain).transpose() / scale;
    trial.tangent(i, 4) =
        (c.pore_pressure - c.stress.dot(one)) * _stiffness / scale;
  }
  return trial.residual.allFinite() and trial.tangent.allFinite()
             ? Outcome::ok
             : Outcome::reduce_step;
}

/// Those at the start of a part.
material::Moduli Driver::moduli(const Progress& to) const
{
  const double p = mean_pressure(_state.stress);
  const material::Point start{
      .s = _state.stress + p * one, .p = p, .q = _state.history};
  const double dt = _time_at_start + to.share * _path.duration - _state.time;
  return std::visit([&](const auto& l) { return l.moduli(start, dt); }, _law);
}

/// Does a step begin where the path turns round?
bool Driver::reverses(int step) const
{
  const int quarter = std::max(1, _path.steps / 4);
  return _path.cycles > 0 and step % quarter == 0 and step / quarter % 2 == 1;
}

/// Largest residual of a part that is solved.
double Driver::allowed(const Trial& trial) const
{
  return _solver.tolerance * trial.size;
}

/// What an elastic body would do: meets strains that are given exactly.
Driver::Unknowns Driver::elastic_guess(const Progress& to) const
{
  const auto [G, K] = moduli(to);
  Voigt2 C = material::shear_stiffness(G);
  C.topLeftCorner<3, 3>().array() += K - 2 * G / 3;
  Eigen::Matrix<double, 5, 5> A;
  Unknowns b;
  const Voigt total = _state.total(), along = _state.strain - _strain_at_start;
  for (int i = 0; i < 5; ++i)
  {
    const Condition& c = _control[static_cast<std::size_t>(i)];
    const double scale = c.on_strain() ? 1 : _stiffness;
    A.row(i).head<4>() = (C * c.stress + c.strain).transpose() / scale;
    A(i, 4) = (c.pore_pressure - c.stress.dot(one)) * _stiffness / scale;
    b[i] = (value(c, to) - c.stress.dot(total) - c.strain.dot(along)
            - c.pore_pressure * _state.pore_pressure)
           / scale;
  }
  return A.fullPivLu().solve(b);
}

/// Newton's method on one part of a step. A step of it that the law cannot
/// follow, or that makes matters worse, is halved.
Outcome Driver::part(const Progress& to, Unknowns& x, State& end,
                     StepLog& log) const
{
  constexpr int max_evaluations = 40, max_halvings = 6;
  Trial trial;
  if (evaluate(to, x, trial, log) != Outcome::ok)
  {
    log.cause = "the law asks for a smaller step";
    return Outcome::reduce_step;
  }
  for (int i = 0; i < max_evaluations; ++i)
  {
    if (trial.residual.lpNorm<Eigen::Infinity>() <= allowed(trial))
    {
      end = trial.end;
      return Outcome::ok;
    }
    const Unknowns way = -trial.tangent.fullPivLu().solve(trial.residual);
    const double before = trial.residual.norm();
    Trial next;
    double share = 1;
    bool better = false;
    for (int k = 0; k < max_halvings and not better; ++k, share /= 2)
    {
      const Unknowns there = x + share * way;
      better = there.allFinite()
               and evaluate(to, there, next, log) == Outcome::ok
               and next.residual.norm() < before;
      if (better)
        x = there;
    }
    if (not better)
      break;
    trial = next;
  }
  log.cause = "what is prescribed cannot be met (a stress beyond strength?)";
  return Outcome::reduce_step;
}

Outcome Driver::advance(StepLog& log)
{
  constexpr double floor = 1.0 / 65536;
  const Progress from = progress(_step), to = progress(_step + 1);
  double done = 0, size = 1;
  const auto between = [&](double s)
  {
    // its end is exactly that of the step, also after halvings
    return s >= 1 ? to
                  : Progress{from.share + s * (to.share - from.share),
                             from.cycle + s * (to.cycle - from.cycle)};
  };
  while (done < 1)
  {
    const Progress next = between(done + size);
    const auto [G, K] = moduli(next);
    _stiffness = K + 4 * G / 3;
    State end;
    Outcome outcome = Outcome::reduce_step;
    Unknowns x;
    // A path goes on as it went, but for its start and its reversals.
    const bool smooth = _last_share > 0 and not(done == 0 and reverses(_step));
    if (smooth)
    {
      x = _last * (size / _last_share);
      outcome = part(next, x, end, log);
    }
    if (outcome != Outcome::ok)
    {
      x = elastic_guess(next);
      outcome = part(next, x, end, log);
    }
    if (outcome == Outcome::ok)
    {
      _state = end;
      _last = x;
      _last_share = size;
      done += size;
      ++log.parts;
      size = std::min(2 * size, 1 - done);
      continue;
    }
    ++log.rejected;
    size /= 2;
    if (size < floor)
      return Outcome::reduce_step;
  }
  ++_step;
  return Outcome::ok;
}
} // namespace mmale::element
