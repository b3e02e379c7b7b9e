// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "samples.h"
#include <catch2/catch_test_macros.hpp>

/// States that paths of strain lead a material to, for the conformance tests.
namespace mmale::test
{
using namespace material;

/// A point of a material: its state at the start of a step.
struct State
{
  Voigt s = Voigt::Zero();
  double p = 0;
  std::vector<double> q = {};

  Point point() const { return {s, p, q}; }
};

inline State begin(const AnyLaw& law, const Sample& sample)
{
  State start{.p = sample.p, .q = std::vector<double>(num_history(law), 0.0)};
  std::visit([&](const auto& l) { l.begin({.p = sample.p}, start.q); }, law);
  return start;
}

inline Moduli moduli(const AnyLaw& law, const State& start,
                     const Sample& sample)
{
  return std::visit([&](const auto& l)
                    { return l.moduli(start.point(), sample.dt); }, law);
}

inline Response update(const AnyLaw& law, const Sample& sample,
                       const State& start, const Voigt& de, double theta,
                       std::vector<double>& q,
                       TangentKind kind = TangentKind::consistent)
{
  Response answer;
  q = start.q;
  const Outcome outcome = std::visit(
      [&](const auto& l)
      {
        return l.update(start.point(), {de, theta, sample.dt}, kind, q, answer);
      },
      law);
  REQUIRE(outcome == Outcome::ok);
  return answer;
}

inline Response update(const AnyLaw& law, const Sample& sample,
                       const State& start, const Voigt& de, double theta)
{
  std::vector<double> q;
  return update(law, sample, start, de, theta, q);
}

inline void advance(const AnyLaw& law, const Sample& sample, State& state,
                    const Voigt& de, double theta)
{
  std::vector<double> q;
  const Response a = update(law, sample, state, de, theta, q);
  state = {a.s, a.p, q};
}

/// A state that a random path of a few steps has led to.
inline State random_state(const AnyLaw& law, const Sample& sample,
                          Random& random)
{
  State state = begin(law, sample);
  for (int k = 0; k < 4; ++k)
    advance(law, sample, state, random.deviator(0.7 * sample.strain, 2),
            sample.theta * random.unit());
  return state;
}
} // namespace mmale::test
