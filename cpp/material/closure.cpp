// SPDX-License-Identifier: LGPL-3.0-or-later
#include "closure.h"

#include "parallel.h"

#include <cmath>
#include <optional>
#include <stdexcept>

namespace mmale::material
{
namespace
{
/// Call `f(C{})` for every closure of the list.
void for_each_closure(auto&& f)
{
  [&f]<class... C>(std::variant<C...>*)
  { (f(C{}), ...); }(static_cast<AnyClosure*>(nullptr));
}

double total(std::span<const Share> shares)
{
  double sum = 0;
  for (const Share& share : shares)
    sum += share.fraction;
  return sum;
}

/// Mean of the shares' answers, all asked at one `de` and `p`.
void average(std::span<const Share> shares, Driven& mean)
{
  const double theta = mean.theta;
  mean = {};
  mean.theta = theta;
  for (const Share& share : shares)
  {
    const Driven& a = share.answer;
    const double w = share.weight;
    mean.s += w * a.s;
    mean.flow += w * a.flow;
    mean.dtheta_de += w * a.dtheta_de;
    mean.dtheta_dp += w * a.dtheta_dp;
    mean.effort += a.effort;
  }
  // d sum(w x) = sum(w dx) + sum(w (x - mean) dtheta), with w of the end
  for (const Share& share : shares)
  {
    const Driven& a = share.answer;
    const double w = share.weight;
    const Voigt s = a.s - mean.s;
    const double flow = a.flow - mean.flow;
    mean.ds_de += w * (a.ds_de + s * a.dtheta_de.transpose());
    mean.ds_dp += w * (a.ds_dp + s * a.dtheta_dp);
    mean.dflow_de += w * (a.dflow_de + flow * a.dtheta_de);
    mean.dflow_dp += w * (a.dflow_dp + flow * a.dtheta_dp);
  }
}

} // namespace

bool fill(std::span<Share> shares, Mixed& mixed)
{
  const double sum = total(shares);
  double growth = 0; // small strains keep their digits
  for (const Share& share : shares)
    growth += share.fraction / sum * std::expm1(share.answer.theta);
  mixed.mean.theta = std::log1p(growth);
  mixed.volume = sum * (1 + growth);
  if (not(std::isfinite(mixed.mean.theta)))
    return false;
  for (Share& share : shares)
  {
    share.weight = share.fraction * std::exp(share.answer.theta) / mixed.volume;
    share.guess = share.answer.theta;
  }
  return true;
}

Outcome EqualPressure::operator()(std::span<Share> shares, const Voigt& de,
                                  double p, double dt, TangentKind kind,
                                  const Interface&, Mixed& mixed) const
{
  mixed.refused = -1;
  for (Share& share : shares)
  {
    const Outcome outcome =
        with_medium(share,
                    [&](const auto& medium)
                    {
                      return drive(medium, share.start, de, p, dt, share.guess,
                                   kind, share.q, share.answer);
                    });
    if (outcome != Outcome::ok)
    {
      mixed.refused = static_cast<int>(&share - shares.data());
      return outcome;
    }
    share.p = p;
  }
  if (not fill(shares, mixed))
    return Outcome::reduce_step;
  average(shares, mixed.mean);
  return Outcome::ok;
}

Outcome EqualStrain::operator()(std::span<Share> shares, const Voigt& de,
                                double p, double dt, TangentKind kind,
                                const Interface&, Mixed& mixed) const
{
  const Parallel all(shares);
  double guess = 0;
  for (const Share& share : shares)
    guess += share.guess / static_cast<double>(shares.size());
  const Outcome outcome =
      drive(all, all.start(), de, p, dt, guess, kind, {}, mixed.mean);
  mixed.refused = all.refused;
  if (outcome != Outcome::ok)
    return outcome;
  mixed.refused = -1;
  for (Share& share : shares)
    share.answer.theta = mixed.mean.theta; // with its last digits
  return fill(shares, mixed) ? Outcome::ok : Outcome::reduce_step;
}

AnyClosure make_closure(std::string_view name)
{
  std::optional<AnyClosure> made;
  for_each_closure(
      [&]<class C>(C closure)
      {
        if (C::name == name)
          made = closure;
      });
  if (not made)
    throw std::invalid_argument("no closure is called '" + std::string(name)
                                + "'");
  return *made;
}

std::vector<std::string> closure_names()
{
  std::vector<std::string> names;
  for_each_closure([&]<class C>(C) { names.emplace_back(C::name); });
  return names;
}

Outcome open_volume(std::span<Share> shares, const Voigt& de, double dt,
                    TangentKind kind, Mixed& mixed, double p)
{
  return EqualPressure{}(shares, de, p, dt, kind, {}, mixed);
}

Moduli moduli(std::span<const Share> shares, double dt)
{
  const double sum = total(shares);
  double G = 0, compliance = 0;
  for (const Share& share : shares)
  {
    const Moduli own = with_medium(share, [&](const auto& m)
                                   { return m.moduli(share.start, dt); });
    G += share.fraction / sum * own.G;
    compliance += share.fraction / sum / own.K;
  }
  return {G, 1 / compliance};
}
} // namespace mmale::material
