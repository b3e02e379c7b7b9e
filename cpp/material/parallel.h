// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "closure.h"

/// Materials of a cell that have one strain (METHOD.md, Closure of mixed
/// cells): the part that the closures have in common.
namespace mmale::material
{
/// Call `f` with what a share's law is, with water in its pores if there is
/// any.
inline auto with_medium(const Share& share, auto&& f)
{
  return std::visit(
      [&]<class L>(const L& law)
      {
        if (share.water)
          return f(Undrained<L>{law, *share.water});
        return f(law);
      },
      *share.law);
}

/// Volumes at the end, from the volume strains in the shares' answers.
/// @return false if they are none
bool fill(std::span<Share> shares, Mixed& mixed);

/// Shares side by side in one strain: to `drive` a law like any other. The
/// fractions are those of the start, for they stay.
class Parallel
{
public:
  enum class Of
  {
    all,
    one,   ///< only the share `which`
    others ///< all but it
  };

  explicit Parallel(std::span<Share> shares, Of of = Of::all, int which = -1)
      : _shares(shares), _of(of), _which(which)
  {
    for (std::size_t k = 0; k < shares.size(); ++k)
      if (has(k))
      {
        _fraction += shares[k].fraction;
        ++_count;
      }
  }

  double fraction() const { return _fraction; }

  /// A start that has the pressure of the mean, and in its deviator the size of
  /// all stresses, which the digits of the pressure depend on.
  Point start() const
  {
    Point mean;
    double size = 0;
    each(
        [&](const Share& share, double part)
        {
          mean.p += part * share.start.p;
          size += part * (std::abs(share.start.p) + norm(share.start.s));
        });
    mean.s[0] = size;
    return mean;
  }

  Moduli moduli(const Point&, double dt) const
  {
    Moduli mean{0, 0};
    each(
        [&](const Share& share, double part)
        {
          const auto [G, K] = with_medium(
              share, [&](const auto& m) { return m.moduli(share.start, dt); });
          mean.G += part * G;
          mean.K += part * K;
        });
    return mean;
  }

  /// Deviator that the start leaves at the end of a step without strain.
  Voigt kept() const
  {
    Voigt s = Voigt::Zero();
    each(
        [&](const Share& share, double part)
        {
          if (not std::visit([](const auto& law) { return law.fluid; },
                             *share.law))
            s += part * share.start.s;
        });
    return s;
  }

  Outcome update(const Point&, const Strain& step, TangentKind kind,
                 std::span<double>, Response& mean) const
  {
    mean = {};
    for (std::size_t k = 0; k < _shares.size(); ++k)
      if (has(k))
      {
        Share& share = _shares[k];
        std::ranges::copy(share.start.q, share.q.begin());
        Response r;
        const Outcome outcome = with_medium(
            share, [&](const auto& m)
            { return m.update(share.start, step, kind, share.q, r); });
        if (outcome != Outcome::ok or not(r.dp_dtheta < 0))
        {
          refused = static_cast<int>(k);
          return Outcome::reduce_step;
        }
        share.p = r.p;
        share.answer.s = r.s;
        share.answer.theta = step.theta;
        share.answer.flow = r.flow;
        share.answer.effort = r.effort;
        turn_derivatives(r, share.answer);
        add(part(share), r, mean);
      }
    return Outcome::ok;
  }

  mutable int refused = -1; ///< which share, at the last update that was

private:
  bool has(std::size_t k) const
  {
    const bool is = static_cast<int>(k) == _which;
    return _of == Of::all or is == (_of == Of::one);
  }
  double part(const Share& share) const
  {
    // empty shares alone are all alike
    return _fraction > 0 ? share.fraction / _fraction : 1.0 / _count;
  }
  void each(auto&& f) const
  {
    for (std::size_t k = 0; k < _shares.size(); ++k)
      if (has(k))
        f(_shares[k], part(_shares[k]));
  }

  static void add(double part, const Response& r, Response& mean)
  {
    mean.s += part * r.s;
    mean.p += part * r.p;
    mean.flow += part * r.flow;
    mean.ds_de += part * r.ds_de;
    mean.ds_dtheta += part * r.ds_dtheta;
    mean.dp_de += part * r.dp_de;
    mean.dp_dtheta += part * r.dp_dtheta;
    mean.dflow_de += part * r.dflow_de;
    mean.dflow_dtheta += part * r.dflow_dtheta;
    mean.effort += r.effort;
  }

  std::span<Share> _shares;
  Of _of;
  int _which;
  double _fraction = 0;
  int _count = 0;
};
} // namespace mmale::material
