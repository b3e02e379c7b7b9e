// SPDX-License-Identifier: LGPL-3.0-or-later
// Mixed cells at their limits: slivers, stiffness ratios, volumes that are
// none, void that opens and closes.
#include "cells.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>

using namespace mmale::material;
using namespace mmale::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace
{
bool finite(const Driven& a)
{
  return a.s.allFinite() and std::isfinite(a.theta) and std::isfinite(a.flow)
         and a.ds_de.allFinite() and a.ds_dp.allFinite()
         and a.dtheta_de.allFinite() and std::isfinite(a.dtheta_dp)
         and a.dflow_de.allFinite() and std::isfinite(a.dflow_dp);
}

const Voigt across(2.0 / 3, -1.0 / 3, -1.0 / 3, 0); ///< uniaxial strain in x

/// Pairs of materials, one of them down to 1e-12 of the cell, strains from 1e-6
/// to 1e-2, pressures from tension on.
void walk(const AnyClosure& closure, int trials)
{
  INFO(name(closure));
  Random random(31);
  const std::vector<AnyLaw> laws{
      steel(), liquid(2.2e9), J2{2.6e6, 0.3, 2e4, 0, 2e3},
      make_law({.law = "mohr_coulomb",
                .parameters = {{"E", 5e7},
                               {"nu", 0.2},
                               {"cohesion", 0},
                               {"friction_deg", 38},
                               {"dilation_deg", 0},
                               {"density", 1.6e3}}}),
      make_law({.law = "hypoplastic",
                .parameters = {{"grain_density", 2650}, {"void_ratio", 0.7}},
                .texts = {{"sand", "hochstetten"},
                          {"intergranular_strain", "on"}}})};
  int refused = 0, not_finite = 0, not_falling = 0, all = 0;
  for (std::size_t i = 0; i < laws.size(); ++i)
    for (std::size_t j = 0; j < laws.size(); ++j)
      for (int k = 0; k < trials; ++k)
      {
        const double f = std::pow(10, -6 * (1 + random.unit()));
        const std::vector<Part> parts{part(laws[i], 1 - f, 1e5),
                                      part(laws[j], f, 1e5)};
        const double size = std::pow(10, -4 + 2 * random.unit());
        const Question question{.de = random.deviator(size, 2),
                                .p = 1e5 * (1.5 + 2 * random.unit()),
                                .dt = 1e-3,
                                .interface = between(3 * random.unit())};
        const Answer a = ask(closure, parts, question);
        ++all;
        refused += a.outcome != Outcome::ok;
        if (a.outcome != Outcome::ok)
        {
          if (std::holds_alternative<EqualPressure>(closure))
          { // only where the material would not have it alone
            const auto which = static_cast<std::size_t>(a.mixed.refused);
            CHECK(ask(closure, {parts[which]}, question).outcome
                  == Outcome::reduce_step);
          }
          continue;
        }
        not_finite += not finite(a.mixed.mean);
        not_falling += not(a.mixed.mean.dtheta_dp < 0);
      }
  CHECK(not_finite == 0);
  CHECK(not_falling == 0);
  // The border of the laminate: a soft sliver between stiff layers has their
  // traction over its own stiffness as strain, more than sand lets itself be
  // asked in one step.
  INFO(refused << " of " << all);
  CHECK(refused <= all / (std::holds_alternative<Laminate>(closure) ? 10 : 50));
}
} // namespace

TEST_CASE("closure: slivers and stiffness ratios: always a number, and the "
          "other material alone in the limit",
          "[conformance][closure]")
{
  const AnyClosure closure = GENERATE(from_range(closures()));
  const double ratio = GENERATE(1.0, 1e2, 1e4, 1e6);
  const bool soft_sliver = GENERATE(true, false);
  const AnyLaw stiff = elastic(1e11, 0.3), soft = elastic(1e11 / ratio, 0.2);
  const AnyLaw& sliver = soft_sliver ? soft : stiff;
  const AnyLaw& body = soft_sliver ? stiff : soft;
  INFO(name(closure) << ", ratio " << ratio << ", soft sliver " << soft_sliver);
  const Question question{.de = -1e-4 * across,
                          .p = 1e-4 * (soft_sliver ? 1e11 : 1e11 / ratio),
                          .interface = between(0)};
  const Driven alone = ask(closure, {part(body, 1)}, question).mixed.mean;
  for (int k = 1; k <= 14; ++k)
  {
    const double f = std::pow(10, -k);
    const Answer a =
        ask(closure, {part(body, 1 - f), part(sliver, f)}, question);
    REQUIRE(a.outcome == Outcome::ok);
    CHECK(finite(a.mixed.mean));
    const double error = (a.mixed.mean.s - alone.s).norm() / alone.s.norm()
                         + std::abs(a.mixed.mean.theta / alone.theta - 1);
    INFO("f " << f);
    // a sliver counts by its fraction times the ratio, and no more
    CHECK(error <= 10 * f * ratio + 1e-9);
  }
}

TEST_CASE("closure: where a film begins to count", "[conformance][closure]")
{
  // A film of fraction f halves the modulus of a laminate at f = M_film / M,
  // however thin that is; equal pressure feels its volume alone: K for M.
  const double ratio = GENERATE(1e2, 1e4, 1e6);
  const double f = 1 / ratio;
  const std::vector<Part> parts{part(elastic(1e11, 0.3), 1 - f),
                                part(elastic(1e11 / ratio, 0.3), f)};
  const double M = 1e11 * 0.7 / (1.3 * 0.4), K = 1e11 / 1.2;
  const auto modulus = [&](const AnyClosure& closure)
  {
    constexpr double strain = 1e-12; // of the film 1e-6
    const Answer a =
        ask_volume(closure, parts,
                   {.de = strain * across, .interface = between(0)}, strain);
    double p = 0;
    for (const Share& share : a.shares)
      p += share.fraction * share.p;
    return (a.mixed.mean.s[0] - p) / strain;
  };
  CHECK_THAT(modulus(Laminate{}), WithinRel(M / (2 - f), 1e-6));
  CHECK_THAT(modulus(EqualPressure{}),
             WithinRel(K / (2 - f) + (M - K) * (1 - f + f * f), 1e-6));
  CHECK_THAT(modulus(EqualStrain{}), WithinRel(M * (1 - f + f * f), 1e-6));
}

TEST_CASE("closure: yielding, sticking and flowing slivers in large steps",
          "[conformance][closure]")
{
  walk(GENERATE(from_range(closures())), 2);
}

TEST_CASE("closure: slivers in large steps, many times", "[closure][slow]")
{
  walk(GENERATE(from_range(closures())), 60);
}

TEST_CASE("closure: volumes that are none ask for a smaller step",
          "[conformance][closure]")
{
  const std::vector<Part> parts{part(steel(), 0.5), part(liquid(1e3), 0.5)};
  for (const AnyClosure& closure : closures())
    for (const double p : {-1e12, -1e7, 1e7, 1e12})
    {
      INFO(name(closure) << ", p " << p);
      const Answer a = ask(closure, parts, {.p = p, .interface = between(0.2)});
      CHECK((a.outcome == Outcome::reduce_step or finite(a.mixed.mean)));
    }
  // the liquid would swell e^1e4 times
  const Answer swollen = ask(EqualPressure{}, parts, {.p = -1e7});
  CHECK(swollen.outcome == Outcome::reduce_step);
  // or be pressed to nothing, which leaves the steel
  const Answer pressed = ask(EqualPressure{}, parts, {.p = 1e7});
  REQUIRE(pressed.outcome == Outcome::ok);
  CHECK(finite(pressed.mixed.mean));
  CHECK(pressed.shares[1].weight == 0);
  CHECK_THAT(pressed.mixed.volume,
             WithinRel(0.5 * std::exp(-1e7 / (2.06e11 / 1.2)), 1e-14));
}

TEST_CASE("closure: void closes on water under 3 bar", "[conformance][closure]")
{
  // unloaded it fills (1 - f) exp(p/K): 1.36e-4 of void is closed at J = 1
  const double f = GENERATE(1.0e-4, 1.3e-4, 1.4e-4, 2e-4);
  const double p = 3e5, K = 2.2e9;
  const std::vector<Part> parts{part(liquid(K), 1 - f, p)};
  Answer a = shares(parts);
  REQUIRE(
      open_volume(a.shares, Voigt::Zero(), 1, TangentKind::consistent, a.mixed)
      == Outcome::ok);
  CHECK_THAT(a.mixed.volume, WithinRel((1 - f) * std::exp(p / K), 1e-14));
  CHECK((a.mixed.volume < 1) == (f > 1.3635e-4));
  if (a.mixed.volume < 1)
    return;
  // a rule that opens each cell with any void would drop these to p = 0
  const Answer closed =
      ask_volume(EqualPressure{}, parts, {.p = p}, -std::log1p(-f));
  CHECK_THAT(closed.shares[0].p, WithinRel(p - K * -std::log1p(-f), 1e-9));
  CHECK(closed.shares[0].p > 1e4);
}

TEST_CASE("closure: sand between void and steel bears nothing when unloaded",
          "[conformance][closure]")
{
  const AnyLaw dry = make_law({.law = "mohr_coulomb",
                               .parameters = {{"E", 5e7},
                                              {"nu", 0.2},
                                              {"cohesion", 0},
                                              {"friction_deg", 38},
                                              {"dilation_deg", 0},
                                              {"density", 1.6e3}}});
  const AnyLaw hypoplastic = make_law(
      {.law = "hypoplastic",
       .parameters = {{"grain_density", 2650}, {"void_ratio", 0.7}},
       .texts = {{"sand", "hochstetten"}, {"intergranular_strain", "off"}}});
  const bool rate = GENERATE(false, true);
  const double none = rate ? 200 : 0; // hypoplastic sand: twice its p_min
  std::vector<Part> parts{part(rate ? hypoplastic : dry, 0.5, 1e4),
                          part(elastic(2.06e11, 0.3), 0.3, 1e4)};
  parts[0].start.s = Voigt(-2e3, 3e3, -1e3, 1e3);
  Answer a = shares(parts);
  REQUIRE(open_volume(a.shares, Voigt(1e-4, -1e-4, 0, 0), 1,
                      TangentKind::consistent, a.mixed, none)
          == Outcome::ok);
  CHECK(a.mixed.volume > 0.8);
  CHECK(a.mixed.volume < 0.81);
  // within a friction of 40 degrees
  CHECK(norm(a.shares[0].answer.s) <= 1.7 * none + 1e-9);
  CHECK_THAT(a.shares[1].answer.theta,
             WithinRel((1e4 - none) / (2.06e11 / 1.2), 1e-9));
}
