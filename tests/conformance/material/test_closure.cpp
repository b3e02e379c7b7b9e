// SPDX-License-Identifier: LGPL-3.0-or-later
// What every closure of material::AnyClosure must hold, and the check values
// of the mixture with constant moduli.
#include "cells.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <atomic>
#include <cstdlib>
#include <new>

using namespace mmale::material;
using namespace mmale::test;
using Catch::Approx;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace
{
std::atomic<long> allocations = 0;

auto any_closure()
{
  return GENERATE(from_range(closures()));
}

/// Numbers of an answer, and their derivatives by six columns: de, p.
struct Table
{
  Eigen::Vector<double, 6> value; ///< s, theta, flow
  Eigen::Matrix<double, 6, 5> slope;

  explicit Table(const Driven& a)
  {
    value << a.s, a.theta, a.flow;
    slope << a.ds_de, a.ds_dp, a.dtheta_de.transpose(), a.dtheta_dp,
        a.dflow_de.transpose(), a.dflow_dp;
  }
  /// Each number over what it is of: stress, strain, plastic flow.
  Table scaled(double stress, double strain) const
  {
    Table out = *this;
    const Eigen::Vector<double, 6> rows{1 / stress, 1 / stress, 1 / stress,
                                        1 / stress, 1 / strain, 1};
    Eigen::Vector<double, 5> columns;
    columns << Voigt::Constant(strain), stress;
    out.value = rows.asDiagonal() * value;
    out.slope = rows.asDiagonal() * slope * columns.asDiagonal();
    return out;
  }
};
} // namespace

void* operator new(std::size_t size)
{
  ++allocations;
  if (void* room = std::malloc(size))
    return room;
  throw std::bad_alloc();
}
void operator delete(void* room) noexcept
{
  std::free(room);
}
void operator delete(void* room, std::size_t) noexcept
{
  std::free(room);
}

TEST_CASE("closure: volumes of two constant moduli under one pressure",
          "[conformance][closure]")
{
  // water beside a suspension of grains, and their states after a compression
  // to J: computed apart, by hand from sum f0 exp(-dp/K) = J
  struct Row
  {
    double J, p, f1, f2;
  };
  const auto row = GENERATE(Row{0.99, 3.576021e7, 0.2981444703, 0.7018555297},
                            Row{0.999, 3.557273e6, 0.2998151245, 0.7001848755},
                            Row{0.95, 1.831204e8, 0.2905684600, 0.7094315400});
  const std::vector<Part> parts{part(liquid(2.2e9), 0.3),
                                part(liquid(4.830446450e9), 0.7)};
  const Answer a = ask_volume(EqualPressure{}, parts, {}, std::log(row.J));
  CHECK_THAT(a.shares[0].p, WithinRel(row.p, 2e-7)); // seven digits
  CHECK_THAT(a.shares[0].weight, WithinAbs(row.f1, 5.1e-11));
  CHECK_THAT(a.shares[1].weight, WithinAbs(row.f2, 5.1e-11));
  CHECK_THAT(a.mixed.volume, WithinRel(row.J, 1e-14));
}

TEST_CASE("closure: modulus and change of fractions at the start",
          "[conformance][closure]")
{
  const std::vector<Part> parts{part(liquid(2.2e9), 0.3),
                                part(liquid(4.830446450e9), 0.7)};
  const Answer a = ask(EqualPressure{}, parts, {});
  const Driven& mean = a.mixed.mean;
  CHECK_THAT(-1 / mean.dtheta_dp, WithinRel(3.555204424e9, 1e-9));
  CHECK_THAT(moduli(a.shares, 1).K, WithinRel(3.555204424e9, 1e-9));
  // Kapila: df1 = f1 f2 (K2 - K1) / (f1 K2 + f2 K1) d theta
  const Driven& water = a.shares[0].answer;
  CHECK_THAT(0.3 * (water.dtheta_dp / mean.dtheta_dp - 1),
             WithinAbs(0.1848006033, 5e-11));
}

TEST_CASE("closure: compressed and let go, materials have their volumes again",
          "[conformance][closure]")
{
  const double K1 = 2.2e9, K2 = 4.830446450e9, f = 0.3;
  std::vector<Part> parts{part(liquid(K1), f), part(liquid(K2), 1 - f)};
  double rate = f; // forward Euler of the rate equation, for comparison
  constexpr int steps = 20;
  for (int k = 0; k < 2 * steps; ++k)
  {
    const double theta = (k < steps ? 1 : -1) * std::log(0.95) / steps;
    const Answer a = ask_volume(EqualPressure{}, parts,
                                {.p = parts[0].start.p}, theta);
    for (int i = 0; i < 2; ++i)
    {
      parts[i].fraction = a.shares[i].weight;
      parts[i].start.p = a.shares[i].p;
    }
    rate += rate * (1 - rate) * (K2 - K1) / (rate * K2 + (1 - rate) * K1)
            * theta;
  }
  CHECK_THAT(parts[0].fraction, WithinAbs(f, 1e-14));
  CHECK(std::abs(rate - f) > 1e-6); // and creates volume in each cycle
}

TEST_CASE("closure: three parts of one material are the material",
          "[conformance][closure]")
{
  const AnyClosure closure = any_closure();
  const Sample sample = GENERATE_REF(from_range(samples));
  INFO(name(closure) << " of " << sample.law());
  const AnyLaw law = make_law(sample.material);
  if (std::holds_alternative<Void>(law))
    SKIP("void has no share");
  Random random(11);
  for (int trial = 0; trial < 50; ++trial)
  {
    const State start = random_state(law, sample, random);
    const Moduli m = mmale::test::moduli(law, start, sample);
    const Voigt de = random.deviator(sample.strain, 2);
    const double range = m.K * sample.theta;
    const double p = start.p + range * random.unit();
    Driven alone;
    std::vector<double> q = start.q;
    REQUIRE(std::visit(
                [&](const auto& l)
                {
                  return drive(l, start.point(), de, p, sample.dt,
                               std::nan(""), TangentKind::consistent, q, alone);
                },
                law)
            == Outcome::ok);
    const Answer a = ask(closure,
                         {{law, 0.2, start}, {law, 0.5, start},
                          {law, 0.25, start}},
                         {.de = de,
                          .p = p,
                          .dt = sample.dt,
                          .interface = between(3 * random.unit(), 1, 2)});
    REQUIRE(a.outcome == Outcome::ok);
    const double stress = std::abs(p) + norm(start.s) + std::abs(start.p)
                          + 2 * m.G * sample.strain;
    const double strain =
        sample.strain + sample.theta + std::abs(alone.theta);
    // derivatives by many sub-steps have as many times more round-off
    const double digits = alone.effort.substeps > 0 ? 1e-12 : 1e-13;
    const Table one = Table(alone).scaled(stress, strain);
    const Table all = Table(a.mixed.mean).scaled(stress, strain);
    CHECK((all.value - one.value).norm() < 1e-13);
    CHECK((all.slope - one.slope).norm() < digits * one.slope.norm());
    CHECK_THAT(a.mixed.volume, WithinRel(0.95 * std::exp(alone.theta), 1e-14));
    for (const Share& share : a.shares)
    {
      CHECK_THAT(share.answer.theta, WithinAbs(alone.theta, 1e-13 * strain));
      for (std::size_t i = 0; i < q.size(); ++i)
        CHECK_THAT(share.q[i], WithinRel(q[i], 1e-12)
                                   or WithinAbs(q[i], 1e-12 * strain));
    }
  }
}
