// SPDX-License-Identifier: LGPL-3.0-or-later
#include "samples.h"

#include "material/drive.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>
#include <numbers>

using namespace mmale;
using namespace mmale::material;
using Catch::Approx;
using mmale::test::Random;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

constexpr double E = 2.1e11, nu = 0.29, yield = 3e8, hardening = 4e9;
constexpr double G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));

struct State
{
  Voigt s = Voigt::Zero();
  double p = 0;
  double plastic_strain = 0;
};

J2 law(double H = hardening)
{
  return {
      .E = E, .nu = nu, .yield_stress = yield, .hardening = H, .density = 7800};
}

/// A step to the pressure p.
Driven advance(const J2& law, State& point, const Voigt& de, double p)
{
  Driven a;
  const double before = point.plastic_strain;
  REQUIRE(drive(law, {point.s, point.p, std::span(&before, 1)}, de, p, 1,
                std::nan(""), TangentKind::consistent,
                std::span(&point.plastic_strain, 1), a)
          == Outcome::ok);
  point.s = a.s;
  point.p = p;
  return a;
}
} // namespace

TEST_CASE("J2 in pure shear follows its two straight lines",
          "[conformance][material]")
{
  // tau = G gamma up to yield / sqrt(3), then d tau / d gamma = G_t with
  // 1 / G_t = 1 / G + 3 / H; the plastic part of gamma is sqrt(3) times the
  // equivalent plastic strain. The path is straight, so that any number of
  // steps gives the same.
  const int steps = GENERATE(1, 7, 100);
  const double gamma = GENERATE(1e-3, 3.7e-3, 2e-2);
  State point;
  for (int k = 0; k < steps; ++k)
    advance(law(), point, {0, 0, 0, gamma / steps}, 0);
  const double tau_y = yield / std::numbers::sqrt3;
  const double elastic = std::min(gamma, tau_y / G);
  const double tau = G * elastic + (gamma - elastic) / (1 / G + 3 / hardening);
  CHECK(point.s[3] == Approx(tau).epsilon(1e-13));
  CHECK(point.s.head<3>().norm() == 0);
  CHECK(point.plastic_strain
        == Approx((gamma - tau / G) / std::numbers::sqrt3).margin(1e-16));
}

TEST_CASE("J2 in uniaxial stress yields at its yield stress and hardens by "
          "its modulus",
          "[conformance][material]")
{
  // deviator of a bar: s = (2, -1, -1) q / 3; eps_q = q / 3 G + plastic strain
  const int steps = GENERATE(1, 50);
  const double sign = GENERATE(1.0, -1.0);
  const double strain = 6.3e-3; // deviatoric strain along the bar
  State point;
  for (int k = 0; k < steps; ++k)
    advance(law(), point, sign * strain / steps * Voigt(1, -0.5, -0.5, 0), 0);
  const double plastic = (3 * G * strain - yield) / (3 * G + hardening);
  const double q = yield + hardening * plastic;
  CHECK(point.plastic_strain == Approx(plastic).epsilon(1e-13));
  CHECK(point.s[0] == Approx(sign * 2 * q / 3).epsilon(1e-13));
  CHECK(point.s[1] == Approx(-sign * q / 3).epsilon(1e-13));
  CHECK(point.s[2] == Approx(-sign * q / 3).epsilon(1e-13));
}

TEST_CASE("J2 turns its stress towards the strain rate on the exact curve",
          "[conformance][material]")
{
  // Ideal plasticity, stress on the surface, constant strain rate at an angle
  // psi from it: d psi / d e = -(2 G / R) sin psi (Krieg & Krieg 1977), so
  // tan(psi / 2) falls exponentially. Radial return is of first order.
  const double radius = std::sqrt(2.0 / 3.0) * yield;
  const double path = 1.3 * radius / (2 * G);
  const Voigt along = Voigt(1, 0, -1, 0) / std::numbers::sqrt2;
  const Voigt across(0, 0, 0, 1 / std::numbers::sqrt2); // both of norm 1
  const double psi_0 = 1.4; // loading: below a right angle
  double errors[2];
  for (int level = 0; level < 2; ++level)
  {
    const int steps = 200 << level;
    State point{.s = radius
                     * (std::cos(psi_0) * along + std::sin(psi_0) * across)};
    for (int k = 0; k < steps; ++k)
      advance(law(0), point, path / steps * along, 0);
    const double psi =
        std::atan2(point.s[3] * std::numbers::sqrt2, point.s.dot(along));
    const double exact =
        2 * std::atan(std::tan(psi_0 / 2) * std::exp(-2 * G * path / radius));
    errors[level] = std::abs(psi - exact);
    CHECK(norm(point.s) == Approx(radius).epsilon(1e-14));
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[1] < 2e-3);
  CHECK(std::log2(errors[0] / errors[1]) == Approx(1).margin(0.05));
}

TEST_CASE("J2 never leaves its cylinder", "[conformance][material]")
{
  Random random(11);
  State point;
  double plastic = 0;
  for (int k = 0; k < 2000; ++k)
  {
    advance(law(), point, random.deviator(5e-3, 2), 1e8 * random.unit());
    const double radius =
        std::sqrt(2.0 / 3.0) * (yield + hardening * point.plastic_strain);
    CHECK(norm(point.s) <= radius * (1 + 4 * eps));
    CHECK(point.plastic_strain >= plastic);
    plastic = point.plastic_strain;
  }
  CHECK(plastic > 1);
}

TEST_CASE("J2's flow measures the plastic strain along the stress",
          "[conformance][material]")
{
  // flow = 2 G dLambda and d eps_plastic = dLambda s, so that
  // sqrt(2/3) |s| dLambda is the increment of the plastic strain
  Random random(12);
  State point;
  const double cap = J2::max_flow;
  for (int k = 0; k < 500; ++k)
  {
    const double before = point.plastic_strain;
    const double flow = advance(law(), point, random.deviator(4e-3, 2), 0).flow;
    const double expected = (point.plastic_strain - before) * 2 * G
                            / (std::sqrt(2.0 / 3.0) * norm(point.s));
    // the difference of two plastic strains of order 1 loses 13 digits of 16
    CHECK(flow == Approx(std::min(expected, cap)).margin(1e-10));
  }
}

TEST_CASE("a closed elastic cycle brings stress and pressure back",
          "[conformance][material]")
{
  Random random(13);
  const Voigt s_0 = random.deviator(0.2 * yield);
  State point{.s = s_0, .p = 1e7};
  Voigt there = Voigt::Zero();
  double volume = 0;
  for (int k = 0; k < 100; ++k)
  {
    const Voigt next = k == 99 ? Voigt(Voigt::Zero())
                               : random.deviator(0.3 * yield / (2 * G), 2);
    const double p = k == 99 ? 1e7 : 1e8 * random.unit();
    volume += advance(law(), point, next - there, p).theta;
    there = next;
  }
  // a hundred additions of numbers below the yield stress
  CHECK((point.s - s_0).norm() < 100 * eps * yield);
  CHECK(point.plastic_strain == 0);
  CHECK(std::abs(volume) < 100 * eps * 1e8 / K);
}

TEST_CASE("the volume strain of a law is its pressure over the bulk modulus",
          "[conformance][material]")
{
  State point{.p = -2e7};
  const double theta = advance(law(), point, {1e-3, -1e-3, 0, 0}, 5e7).theta;
  CHECK(theta == Approx(-7e7 * 3 * (1 - 2 * nu) / E).epsilon(1e-14));
  CHECK(law().moduli({}, 1).K == Approx(K).epsilon(1e-14));
  CHECK(law().moduli({}, 1).G == Approx(G).epsilon(1e-14));
}
