// SPDX-License-Identifier: LGPL-3.0-or-later
#include "paths.h"

#include <catch2/catch_approx.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using namespace mmale::material;
using namespace mmale::test;
using Catch::Approx;

namespace
{
constexpr double eta = 0.7, K = 2.2e9;
const Newtonian water{.viscosity = eta, .bulk_modulus = K, .density = 1000};

HerschelBulkley grout(double exponent, double tau_y = 11)
{
  return {.yield_stress = tau_y,
          .consistency = 0.45,
          .exponent = exponent,
          .regularisation = 1e-2,
          .bulk_modulus = K,
          .density = 1800};
}
} // namespace

TEST_CASE("Newtonian: stress is viscosity times rate, whatever was before",
          "[conformance][material]")
{
  const double dt = GENERATE(1e-3, 2.5);
  Body b = body({-3e3, 1e3, 0, 700});
  const double p = b.p;
  advance(water, b, Voigt(0, 0, 0, 0.3), dt);
  CHECK(b.s[3] == Approx(eta * 0.3 / dt).epsilon(1e-14));
  CHECK(b.s.head<3>().norm() == 0);
  CHECK(b.p == p);
  // lengthening at constant volume: 2 eta times the rate
  advance(water, b, Voigt(0.02, -0.02, 0, 0), dt);
  CHECK(b.s[0] == Approx(2 * eta * 0.02 / dt).epsilon(1e-14));
  // pressure remembers the volume
  advance(water, b, Voigt(1e-6, 1e-6, 1e-6, 0), dt);
  CHECK(b.p == Approx(p - K * 3e-6).epsilon(1e-12));
}

TEST_CASE("a fluid's deviator stays in a step without time",
          "[conformance][material]")
{
  const Body start = body({-3e3, 1e3, 0, 700});
  Body b = start;
  advance(water, b, Voigt(1e-3, 0, 0, 1e-3), 0);
  CHECK((b.s - start.s).norm() == 0);
  Body g = start;
  g.q = {0.0};
  advance(grout(1), g, Voigt(1e-3, 0, 0, 1e-3), 0);
  CHECK((g.s - start.s).norm() == 0);
  CHECK(water.moduli({}, 0).G > 0);
  CHECK(grout(1).moduli({g.s, g.p, g.q}, 0).G > 0);
}

TEST_CASE("Herschel-Bulkley: the flow curve, exact above the regularisation",
          "[conformance][material]")
{
  const double exponent = GENERATE(1.0, 0.6, 1.4);
  const double rate = GENERATE(0.011, 1.0, 37.0);
  const double dt = 0.04;
  const HerschelBulkley l = grout(exponent);
  const double tau = 11 + 0.45 * std::pow(rate, exponent);
  Body b{.q = {0.0}};
  advance(l, b, Voigt(0, 0, 0, rate * dt), dt);
  CHECK(b.s[3] == Approx(tau).epsilon(1e-13));
  CHECK(b.q[0] == Approx(rate).epsilon(1e-13));
  CHECK(l.moduli({b.s, b.p, b.q}, dt).G
        == Approx(tau / rate / dt).epsilon(1e-13));
  // in planar extension the rate is twice that of length
  advance(l, b, Voigt(-0.5, 0.5, 0, 0) * rate * dt, dt);
  CHECK(b.s[1] == Approx(tau).epsilon(1e-13));
  // and in extension along an axis sqrt(3) times
  advance(l, b, Voigt(-0.5, 1, -0.5, 0) * rate * dt / std::sqrt(3), dt);
  CHECK(b.s[1] == Approx(2 * tau / std::sqrt(3)).epsilon(1e-13));
}

TEST_CASE("Herschel-Bulkley: below the regularisation it creeps in proportion",
          "[conformance][material]")
{
  const HerschelBulkley l = grout(0.6);
  const double tau = 11 + 0.45 * std::pow(1e-2, 0.6);
  const double share = GENERATE(0.0, 1e-6, 0.5, 1.0);
  Body b{.q = {5.0}};
  advance(l, b, Voigt(0, 0, 0, share * 1e-2), 1);
  CHECK(b.s[3] == Approx(share * tau).epsilon(1e-13));
}

TEST_CASE("Herschel-Bulkley without yield stress and with exponent 1 is "
          "Newtonian",
          "[conformance][material]")
{
  Random random(41);
  const Newtonian plain{.viscosity = 0.45, .bulk_modulus = K, .density = 1800};
  for (int trial = 0; trial < 100; ++trial)
  {
    Body a{.q = {0.0}}, b;
    const Voigt strain = random.deviator(std::pow(10, 3 * random.unit()), 2);
    advance(grout(1, 0), a, strain, 0.1);
    advance(plain, b, strain, 0.1);
    CHECK((a.sigma() - b.sigma()).norm() < 1e-14 * b.s.norm());
  }
}

TEST_CASE("Herschel-Bulkley: the tangent is the derivative on both branches",
          "[conformance][material]")
{
  const double exponent = GENERATE(1.0, 0.6, 1.4);
  const HerschelBulkley l = grout(exponent);
  Random random(42);
  constexpr double dt = 0.02, h = 1e-5;
  for (int trial = 0; trial < 300; ++trial)
  {
    const double size = 1e-2 * dt * std::pow(10, 1.5 * random.unit());
    const Voigt strain = random.deviator(size, 2);
    const Voigt d = random.deviator(size, 2);
    const Body b{.q = {0.0}};
    const auto at = [&](double x)
    { return answer(l, b, strain + x * d, dt).s; };
    const Voigt low = at(-h), mid = at(0), high = at(h);
    if ((high - 2 * mid + low).norm() > 1e-3 * h * mid.norm())
      continue; // the kink within h
    const Voigt exact = answer(l, b, strain, dt).ds_de * d;
    CHECK(((high - low) / (2 * h) - exact).norm() < 1e-6 * mid.norm());
  }
}

TEST_CASE("rigid is elastic of equal moduli, void next to nothing",
          "[conformance][material]")
{
  const Rigid steel{.stiffness = 3e11, .density = 7800};
  Body b;
  advance(steel, b, Voigt(2e-6, 0, 0, 1e-6));
  // G = K: s_xx = 2 G 2/3 e, p = -K e
  CHECK(b.sigma()[0] == Approx(3e11 * 2e-6 * (4.0 / 3 + 1)).epsilon(1e-14));
  CHECK(b.s[3] == Approx(3e11 * 1e-6).epsilon(1e-14));

  const Void nothing;
  Body v = body({-3e3, 1e3, 0, 700});
  CHECK(nothing.admit(v.s, v.p, v.q) == 1);
  CHECK(v.s.norm() == 0);
  v.p = 0;
  advance(nothing, v, Voigt(0.3, 0.2, 0.1, 0.5));
  CHECK(v.s.norm() == 0);
  CHECK(v.p == Approx(-0.6));
}
