// SPDX-License-Identifier: LGPL-3.0-or-later
#include "hypoplastic_integration.h"

#include "runge_kutta.h"
#include <type_traits>

namespace mmale::material::hypoplasticity
{
namespace
{
/// How the intergranular strain goes through a sub-step.
enum class Phase
{
  turning, ///< h : D <= 0, so h = h0 + D t, exactly
  growing, ///< by the same formulas as the stress
  aligned  ///< so close to R D/|D| that the rest decays, in closed form
};

/// h(t) and its derivative by D where both are known.
class Known
{
public:
  Phase phase = Phase::turning;

  void start(Phase to, double t, const Tensor<4>& h, const Tensor2<4>& h_D)
  {
    phase = to;
    _t = t;
    _h = h;
    _h_D = h_D;
  }

  Tensor<4> h(const Sand& c, const Tensor<4>& D, double size, double t) const
  {
    if (phase == Phase::turning)
      return _h + (t - _t) * D;
    const Decay d(*this, c, D, size, t);
    return d.along * d.n + d.across * _h;
  }

  Tensor2<4> h_D(const Sand& c, const Tensor<4>& D, double size, double t) const
  {
    if (phase == Phase::turning)
      return _h_D + (t - _t) * Tensor2<4>::Identity();
    const Decay d(*this, c, D, size, t);
    const Tensor2<4> by_n =
        (Tensor2<4>::Identity() - d.n * d.n.transpose()) / size;
    const double lapse = (t - _t) / c.R;
    const Tensor<4> by_across = (-lapse * d.across) * d.n;
    const Tensor<4> by_part = by_n * _h + _h_D.transpose() * d.n;
    const Tensor<4> by_along =
        (d.slow - d.across) * by_part
        + (d.part - c.R) * (-c.beta_R * lapse * d.slow) * d.n
        - d.part * by_across;
    return d.along * by_n + d.n * by_along.transpose() + d.across * _h_D
           + _h * by_across.transpose();
  }

private:
  double _t = 0;
  Tensor<4> _h;
  Tensor2<4> _h_D;

  /// What is left of the distance to R D/|D|: along D it decays with beta_R,
  /// across with 1, over strains of R. An error of second order.
  struct Decay
  {
    Tensor<4> n;
    double slow, across, part, along;

    Decay(const Known& k, const Sand& c, const Tensor<4>& D, double size,
          double t)
        : n(D / size)
    {
      const double lapse = size * (t - k._t) / c.R;
      slow = std::exp(-c.beta_R * lapse);
      across = std::exp(-lapse);
      part = n.dot(k._h);
      along = c.R + slow * (part - c.R) - across * part;
    }
  };
};

/// One path.
template <bool with_grains, class Scheme>
class Path
{
public:
  Path(const Sand& sand, const Task& task, Track& track)
      : _c(sand), _task(task), _y(track), _size(task.D.norm()), _t(task.begin)
  {
    // an error in h is one of second order where the closed form takes over
    _near = std::min(3e-5, 0.3 * std::sqrt(task.tolerance)) * sand.R;
    _share = std::pow(10 * task.tolerance, 1.0 / Scheme::order);
  }

  Outcome run();

private:
  using RateHere = Rate<4, with_grains>;
  static constexpr int n = Scheme::stages;

  const Sand& _c;
  const Task& _task;
  Track& _y;
  double _size, _t;
  double _near;  ///< distance from R D/|D| that counts as aligned
  double _share; ///< relative change that a sub-step may make, about
  Known _known;
  double _until = 1; ///< end of the phase

  // stages of a sub-step
  double _time[n];
  Tensor<4> _T[n], _h[n];
  RateHere _rate[n];

  // Sub-steps aim at an error of 0.6; to repeat one makes the answer jump, so
  // that is for errors that do harm.
  static constexpr double most_error = 4;

  bool growing() const
  {
    return with_grains and _known.phase == Phase::growing;
  }
  void evaluate(int i)
  {
    _rate[i].evaluate(_c, _T[i], void_ratio(_task, _time[i]), _h[i], _task.D,
                      _size, _known.phase != Phase::turning);
  }
  void begin_stages()
  {
    _time[0] = _t;
    _T[0] = _y.T;
    if constexpr (with_grains)
      _h[0] = _y.h;
    evaluate(0);
  }

  /// Which phase of intergranular strain comes next, and until when.
  void enter();
  /// Size of a sub-step that h allows where it begins to turn or to grow.
  double reach() const
  {
    return 1.3 * _share * std::max(_y.h.norm(), _c.core * _c.R) / _size;
  }
  double first_size();
  double stable() const;
  double attempt(double dt, Tensor<4>& T, Tensor<4>& h);
  void carry_slopes(double dt);
  bool hold_in_range(const Tensor<4>& Td);
  void begin_slopes();
  void rate_slopes();
};

template <bool with_grains, class Scheme>
void Path<with_grains, Scheme>::enter()
{
  _until = 1;
  if constexpr (with_grains)
  {
    const Tensor<4>& D = _task.D;
    const double along = _y.h.dot(D);
    const double turned = _t - along / (_size * _size); // when h : D = 0
    Phase phase = Phase::growing;
    if (turned > _t + 1e-12) // less is round-off: it has turned
    {
      phase = Phase::turning;
      _until = std::min(1.0, turned);
    }
    else if ((_y.h - (_c.R / _size) * D).norm() < _near)
      phase = Phase::aligned;
    _known.start(phase, _t, _y.h, _y.h_D);
  }
}

/// From the rates at the start: about what the tolerance allows.
template <bool with_grains, class Scheme>
double Path<with_grains, Scheme>::first_size()
{
  double dt = std::min(1.0, _share * _T[0].norm() / _rate[0].stress.norm());
  if constexpr (with_grains)
    if (_known.phase != Phase::aligned)
      dt = std::min(dt, reach());
  return dt;
}

/// Sub-steps for which the formulas are stable while h grows; where the closed
/// form takes over they set out from the same size, lest the answer jump.
template <bool with_grains, class Scheme>
double Path<with_grains, Scheme>::stable() const
{
  const double most = 2 * _c.R / _size;
  if (growing())
    return most;
  const double off = (_y.h - (_c.R / _size) * _task.D).norm();
  return most * _near / std::max(off, 1e-12 * _near);
}

/// A sub-step.
/// @param[out] T, h at its end
/// @return its error over the one allowed
template <bool with_grains, class Scheme>
double Path<with_grains, Scheme>::attempt(double dt, Tensor<4>& T, Tensor<4>& h)
{
  for (int i = 1; i < n; ++i)
  {
    _time[i] = _t + Scheme::c[i] * dt;
    _T[i] = _y.T;
    for (int j = 0; j < i; ++j)
      _T[i] += (dt * Scheme::a[i - 1][j]) * _rate[j].stress;
    if constexpr (with_grains)
    {
      if (growing())
      {
        _h[i] = _y.h;
        for (int j = 0; j < i; ++j)
          _h[i] += (dt * Scheme::a[i - 1][j]) * _rate[j].grains.rate;
      }
      else
        _h[i] = _known.h(_c, _task.D, _size, _time[i]);
    }
    evaluate(i);
  }
  Tensor<4> miss = Tensor<4>::Zero();
  T = _y.T;
  for (int i = 0; i < n; ++i)
  {
    T += (dt * Scheme::b[i]) * _rate[i].stress;
    miss += (dt * Scheme::error[i]) * _rate[i].stress;
  }
  double error = miss.squaredNorm() / T.squaredNorm();
  if constexpr (with_grains)
  {
    if (growing())
    {
      miss.setZero();
      h = _y.h;
      for (int i = 0; i < n; ++i)
      {
        h += (dt * Scheme::b[i]) * _rate[i].grains.rate;
        miss += (dt * Scheme::error[i]) * _rate[i].grains.rate;
      }
      error += miss.squaredNorm() / (_c.R * _c.R);
    }
    else
      h = _known.h(_c, _task.D, _size, _t + dt);
  }
  return trace<4>(T) < 0 ? std::sqrt(error) / _task.tolerance : NAN;
}

/// The same sub-step once more, for the derivatives.
template <bool with_grains, class Scheme>
void Path<with_grains, Scheme>::carry_slopes(double dt)
{
  const Tensor<4> one = unit<4>();
  Slopes<4> s;
  Tensor2<4> T_D[n], h_D[n];
  bool open = false;
  for (int i = 0; i < n; ++i)
  {
    open = open or _rate[i].landing > 0;
    if (Scheme::carries and i == n - 1 and not open)
      break; // its weight is 0
    Tensor2<4> T_here = _y.T_D, h_here = _y.h_D;
    for (int j = 0; j < i; ++j)
      if (Scheme::a[i - 1][j] != 0)
        T_here += (dt * Scheme::a[i - 1][j]) * T_D[j];
    _rate[i].slopes(_c, _T[i], _task.D, _size, s);
    T_D[i].noalias() = s.by_T * T_here;
    T_D[i] += s.by_D;
    T_D[i].template leftCols<3>().colwise() +=
        ((1 + void_ratio(_task, _time[i])) * _time[i]) * s.by_e;
    if constexpr (with_grains)
    {
      if (growing())
      {
        for (int j = 0; j < i; ++j)
          if (Scheme::a[i - 1][j] != 0)
            h_here += (dt * Scheme::a[i - 1][j]) * h_D[j];
        h_D[i].noalias() = s.h_by_h * h_here;
        h_D[i] += s.h_by_D;
      }
      else if (i > 0)
        h_here = _known.h_D(_c, _task.D, _size, _time[i]);
      T_D[i].noalias() += s.by_h * h_here;
    }
    if (_rate[i].landing > 0)
    {
      const double p = _rate[i].p;
      const double x = std::clamp(2 - p / _c.floor, 0.0, 1.0);
      const double by_p = x < 1 ? -2 * x / _c.floor : 0;
      const Tensor<4> p_D =
          -T_here.template topRows<3>().colwise().sum().transpose() / 3;
      _y.opened_D += (dt * Scheme::b[i])
                     * (_rate[i].landing * one + _task.theta * by_p * p_D);
    }
  }
  for (int i = 0; i < n; ++i)
    if (Scheme::b[i] != 0)
    {
      _y.T_D += (dt * Scheme::b[i]) * T_D[i];
      if (growing())
        _y.h_D += (dt * Scheme::b[i]) * h_D[i];
    }
  if (with_grains and not growing())
    _y.h_D = _known.h_D(_c, _task.D, _size, _t + dt);
}

/// Cut what has left its range.
/// @return true if something had
template <bool with_grains, class Scheme>
bool Path<with_grains, Scheme>::hold_in_range(const Tensor<4>& Td)
{
  bool cut = false;
  const Tensor<4> Td2 = squared(Td);
  const double q = Td.squaredNorm(), cubic = Td.dot(Td2);
  const double share = share_in_cone(_c.cone, q, cubic);
  if (share < 1)
  {
    cut = true;
    const double tr = trace<4>(_y.T), I = _c.cone, A = I / 6 - 0.5;
    const double k2 = share * share, k3 = k2 * share;
    if (_task.kind == TangentKind::consistent)
    {
      const double by_share = 2 * share * q * A - k2 * cubic * I;
      const Tensor<4> by_Td =
          (-1 / by_share) * (2 * k2 * A * Td - k3 * I * Td2);
      const Eigen::RowVector4d tr_D = _y.T_D.topRows<3>().colwise().sum();
      const Tensor2<4> Td_D = (_y.T_D - (_y.T / tr) * tr_D) / tr;
      const Eigen::RowVector4d share_D = by_Td.transpose() * Td_D;
      _y.T_D = (share * tr) * Td_D + Td * (tr * share_D + share * tr_D)
               + (unit<4>() / 3) * tr_D;
    }
    _y.T = tr * (share * Td + unit<4>() / 3);
  }
  if constexpr (with_grains)
  {
    const double size = _y.h.norm();
    if (size > _c.R)
    {
      const Tensor<4> hd = _y.h / size;
      if (_task.kind == TangentKind::consistent)
        _y.h_D = (_c.R / size) * (_y.h_D - hd * (hd.transpose() * _y.h_D));
      _y.h = _c.R * hd;
      cut = cut or growing();
    }
  }
  return cut;
}

/// Derivatives that the time to begin brings.
template <bool with_grains, class Scheme>
void Path<with_grains, Scheme>::begin_slopes()
{
  const Eigen::RowVector4d begin_D = _task.begin_D * unit<4>().transpose();
  _y.T_D = -_rate[0].stress * begin_D;
  if constexpr (with_grains)
  {
    _y.h_D = -_rate[0].grains.rate * begin_D;
    _known.start(_known.phase, _t, _y.h, _y.h_D);
  }
  _y.opened_D = (-_rate[0].landing * _task.theta) * begin_D.transpose();
}

/// Derivatives other than true ones, from the rates at hand.
template <bool with_grains, class Scheme>
void Path<with_grains, Scheme>::rate_slopes()
{
  Slopes<4> s;
  _rate[0].slopes(_c, _T[0], _task.D, _size, s);
  _y.T_D = _task.kind == TangentKind::robust ? _rate[0].stiffest(_c) : s.by_D;
  _y.opened_D = _rate[0].landing * unit<4>();
}

template <bool with_grains, class Scheme>
Outcome Path<with_grains, Scheme>::run()
{
  const bool slopes = _task.kind == TangentKind::consistent;
  if (_size > 0)
    enter();
  begin_stages();
  if (_task.kind == TangentKind::robust or not(_size > 0))
    rate_slopes();
  if (not(_size > 0))
    return Outcome::ok;
  if (slopes and _task.begin > 0)
    begin_slopes();
  double dt = first_size();
  bool clipped = _rate[0].factor.clipped, landed = _rate[0].landing > 0;
  while (_t < 1)
  {
    if constexpr (with_grains)
      if (_known.phase != Phase::turning)
        dt = std::min(dt, stable());
    const double left = _until - _t;
    const bool last = not(dt < left * (1 - 1e-12));
    const double step = last ? left : dt;
    Tensor<4> T, h;
    const double error = attempt(step, T, h);
    if (not(error <= most_error))
    {
      dt = step
           * std::min(0.5, std::isnan(error)
                               ? 0.25
                               : runge_kutta::resize(error, Scheme::order));
      ++_y.effort.rejected;
      if (not(dt > 1e-13) or _y.effort.rejected > _task.max_substeps)
        return Outcome::reduce_step;
      continue;
    }
    if (++_y.effort.substeps > _task.max_substeps)
      return Outcome::reduce_step;
    if (slopes)
      carry_slopes(step);
    for (int i = 0; i < n; ++i)
      if (_rate[i].landing > 0)
      {
        landed = true;
        _y.opened += step * Scheme::b[i] * _rate[i].landing * _task.theta;
      }
    _t = last ? _until : _t + step;
    _y.T = T;
    if constexpr (with_grains)
      _y.h = h;
    const double next = step * runge_kutta::resize(error, Scheme::order);
    dt = last ? std::max(dt, next) : next;

    const double tr = trace<4>(T);
    bool changed = hold_in_range(T / tr - unit<4>() / 3);
    clipped = clipped or changed or _rate[n - 1].factor.clipped;
    if constexpr (with_grains)
    {
      const Phase before = _known.phase;
      if (before == Phase::growing or not(_t < _until))
        enter();
      changed = changed or _known.phase != before;
      if (_known.phase == Phase::growing and before == Phase::turning)
        dt = std::min(dt, reach());
    }
    if (Scheme::carries and not changed)
    {
      _time[0] = _t;
      _T[0] = _y.T;
      _h[0] = _y.h;
      _rate[0] = _rate[n - 1];
    }
    else if (_t < 1 or _task.kind == TangentKind::continuum)
      begin_stages();
  }
  _y.effort.apex += landed;
  _y.effort.clipped += clipped;
  if (_task.kind == TangentKind::continuum)
    rate_slopes();
  return Outcome::ok;
}
} // namespace

double share_in_cone(double I, double q, double cubic)
{
  // (I1 I2 - I I3)/I1^3 with share times the deviator: below 0 inside
  const double A = I / 6 - 0.5;
  const auto f = [&](double k)
  { return 1.0 / 3 - I / 27 + k * k * (q * A - k * cubic * I / 3); };
  // first rise only: beyond it two or three stresses are tensile
  double high = 1;
  if (cubic > 0)
    high = std::min(1.0, 2 * q * A / (cubic * I));
  if (not(f(high) > 0))
    return high;
  double low = 0;
  while (true)
  {
    const double middle = 0.5 * (low + high);
    if (not(middle > low and middle < high))
      return low;
    (f(middle) > 0 ? high : low) = middle;
  }
}

Outcome integrate(const Sand& sand, const Task& task, Track& track)
{
  const auto with = [&]<class Scheme>(Scheme)
  {
    return task.grains ? Path<true, Scheme>(sand, task, track).run()
                       : Path<false, Scheme>(sand, task, track).run();
  };
  using namespace runge_kutta;
  if (task.scheme == Heun::name)
    return with(Heun{});
  if (task.scheme == Kutta::name)
    return with(Kutta{});
  if (task.scheme == DormandPrince::name)
    return with(DormandPrince{});
  return with(BogackiShampine{});
}
} // namespace mmale::material::hypoplasticity
