// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/closure.h"
#include "states.h"

/// Mixed cells for the tests of closures.
namespace mmale::test
{
/// A material of a cell and its state at the start.
struct Part
{
  AnyLaw law;
  double fraction;
  State start = {};
  std::optional<Water> water = {};
};

inline AnyLaw elastic(double E, double nu)
{
  return Elastic{E, nu, 1e3};
}
/// Elastic, by its shear and bulk modulus.
inline AnyLaw elastic_of(double G, double K)
{
  return Elastic{9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G),
                 1e3};
}
inline AnyLaw liquid(double K, double viscosity = 1e-3)
{
  return Newtonian{viscosity, K, 1e3};
}
inline AnyLaw steel(double yield_stress = 3e8)
{
  return J2{2.06e11, 0.3, yield_stress, 4e9, 7.8e3};
}

/// Under pressure [Pa], without shear stress.
inline Part part(AnyLaw law, double fraction, double p = 0)
{
  Part out{std::move(law), fraction, {}, {}};
  out.start = begin(out.law, {.p = p});
  return out;
}

/// What a closure made of a cell.
struct Answer
{
  Outcome outcome = Outcome::reduce_step;
  Mixed mixed = {};
  std::vector<Share> shares = {};
  std::vector<std::vector<double>> q = {}; ///< histories at the end
};

/// What is asked.
struct Question
{
  Voigt de = Voigt::Zero();
  double p = 0, dt = 1;
  Interface interface = {};
  TangentKind kind = TangentKind::consistent;
};

/// Shares of the parts, which must outlive them, with room for histories.
inline Answer shares(const std::vector<Part>& parts)
{
  Answer out;
  for (const Part& part : parts)
    out.q.push_back(part.start.q);
  for (std::size_t k = 0; k < parts.size(); ++k)
    out.shares.push_back({.law = &parts[k].law,
                          .fraction = parts[k].fraction,
                          .start = parts[k].start.point(),
                          .q = out.q[k],
                          .water = parts[k].water ? &*parts[k].water : nullptr,
                          .answer = {}});
  return out;
}

inline Answer ask(const AnyClosure& closure, const std::vector<Part>& parts,
                  const Question& ask)
{
  Answer out = shares(parts);
  out.outcome = std::visit(
      [&](const auto& c)
      {
        return c(out.shares, ask.de, ask.p, ask.dt, ask.kind, ask.interface,
                 out.mixed);
      },
      closure);
  return out;
}

/// The answer at the pressure for which the cell's shares take a volume strain.
inline Answer ask_volume(const AnyClosure& closure,
                         const std::vector<Part>& parts, Question question,
                         double theta)
{
  Answer out;
  for (int i = 0; i < 100; ++i)
  {
    out = ask(closure, parts, question);
    REQUIRE(out.outcome == Outcome::ok);
    const double step =
        (theta - out.mixed.mean.theta) / out.mixed.mean.dtheta_dp;
    if (not(std::abs(step) > 1e-15 * std::abs(question.p)))
      break;
    question.p += step;
  }
  return out;
}

/// Between the first two parts, its normal at an angle to x.
inline Interface between(double angle, int first = 0, int second = 1)
{
  return {{std::cos(angle), std::sin(angle)}, 1, first, second};
}

inline std::vector<AnyClosure> closures()
{
  std::vector<AnyClosure> all;
  for (const std::string& name : closure_names())
    all.push_back(make_closure(name));
  return all;
}
inline std::string name(const AnyClosure& closure)
{
  return std::visit([](const auto& c) { return std::string(c.name); }, closure);
}
} // namespace mmale::test
