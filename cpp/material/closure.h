// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once
#include "drive.h"
#include "library.h"
#include <variant>
namespace mmale::material
{
struct Share
{
  const AnyLaw* law;
  double fraction;
  Point start;
  std::span<double> q;
  Driven answer;
  double guess;
};
struct Interface
{
  double normal[2] = {1, 0};
  double area = 0;
  int first = 0, second = 1;
};
struct Mixed
{
  Driven mean;
};
struct EqualPressure
{
  static constexpr std::string_view name = "equal_pressure";
  Outcome operator()(std::span<Share> shares, const Voigt& de, double p,
                     double dt, TangentKind kind, const Interface&,
                     Mixed& m) const
  {
    double whole = 0, sum = 0;
    m.mean = {};
    for (Share& s : shares)
    {
      const Outcome o = std::visit(
          [&](const auto& law)
          {
            return drive(law, s.start, de, p, dt, s.guess, kind, s.q, s.answer);
          },
          *s.law);
      if (o != Outcome::ok)
        return o;
      s.guess = s.answer.theta;
      whole += s.fraction;
      sum += s.fraction * std::exp(s.answer.theta);
    }
    Driven& a = m.mean;
    a.theta = std::log(sum / whole);
    for (const Share& s : shares)
    {
      const double f = s.fraction * std::exp(s.answer.theta) / sum;
      a.dtheta_de += f * s.answer.dtheta_de;
      a.dtheta_dp += f * s.answer.dtheta_dp;
    }
    for (const Share& s : shares)
    {
      const Driven& b = s.answer;
      const double f = s.fraction * std::exp(b.theta) / sum;
      a.s += f * b.s;
      a.flow += f * b.flow;
      const Voigt df_de = f * (b.dtheta_de - a.dtheta_de);
      const double df_dp = f * (b.dtheta_dp - a.dtheta_dp);
      a.ds_de += f * b.ds_de + b.s * df_de.transpose();
      a.ds_dp += f * b.ds_dp + b.s * df_dp;
      a.dflow_de += f * b.dflow_de + b.flow * df_de;
      a.effort += b.effort;
    }
    return Outcome::ok;
  }
};
using AnyClosure = std::variant<EqualPressure>;
inline std::vector<std::string> closures() { return {"equal_pressure"}; }
} // namespace mmale::material
