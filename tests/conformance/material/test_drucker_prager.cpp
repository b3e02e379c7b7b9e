// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cones.h"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

using namespace mmale;
using namespace mmale::material;
using namespace mmale::test;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace
{
DruckerPrager law(std::string cone = "compression", double friction = phi,
                  double dilation = psi, double cohesion = c,
                  double tension = not_given)
{
  return {.E = E,
          .nu = nu,
          .cohesion = cohesion,
          .friction_deg = friction,
          .dilation_deg = dilation,
          .density = 1600,
          .tensile_strength = tension,
          .cone = std::move(cone)};
}

/// Mohr-Coulomb's excess, of which the cones are to be circles.
double hexagon(const Voigt& sigma)
{
  const auto v = principal(sigma);
  return (v[0] - v[2]) + (v[0] + v[2]) * sine(phi) - 2 * c * cosine(phi);
}

std::vector<DruckerPrager> kinds()
{
  return {law(),
          law("extension", phi, phi),
          law("plane_strain", phi, 0, 0),
          law("inscribed", 38, 12, c, 0.4 * c),
          law("compression", 25, 0, c, 0),
          law("plane_strain", 0, 0),
          law("compression", 0, 0, c, 0.7 * c)};
}
} // namespace

TEST_CASE("Drucker-Prager: the outer and the inner cone meet Mohr-Coulomb in "
          "the triaxial test",
          "[conformance][material]")
{
  const double sign = GENERATE(-1.0, 1.0);
  const int steps = GENERATE(1, 40);
  const double lateral = 1.3e5;
  const DruckerPrager l = law(sign < 0 ? "compression" : "extension");
  Body b = body(-lateral * Voigt(1, 1, 1, 0));
  for (int k = 0; k < steps; ++k)
    triaxial_step(l, b, sign * 0.05 / steps, lateral);
  const double N = flow_number(phi);
  CHECK(-b.sigma()[1]
        == Approx(sign < 0 ? lateral * N + 2 * c * std::sqrt(N)
                           : (lateral - 2 * c * std::sqrt(N)) / N)
               .epsilon(1e-10));
  const double across = triaxial_step(l, b, sign * 1e-3, lateral);
  CHECK((sign * 1e-3 + 2 * across) / 1e-3
        == Approx(2 * sine(psi) / (1 + sign * sine(psi))).epsilon(1e-6));
}

TEST_CASE("Drucker-Prager: the plane-strain cone meets Mohr-Coulomb at "
          "failure in plane strain, whatever the dilation",
          "[conformance][material]")
{
  const double dilation = GENERATE(0.0, psi, phi);
  const double lateral = GENERATE(1e4, 1e5);
  const DruckerPrager l = law("plane_strain", phi, dilation);
  const Voigt cell(-lateral, -lateral, -lateral, 0);
  Body b = body(cell);
  for (int k = 0; k < 400; ++k) // s_zz comes to where it flows no more
    mixed_step(l, b, Voigt(0, -1e-3, 0, 0), {0}, cell);
  const double N = flow_number(phi);
  CHECK(-b.sigma()[1]
        == Approx(lateral * N + 2 * c * std::sqrt(N)).epsilon(1e-8));
  Voigt strain;
  mixed_step(l, b, Voigt(0, -1e-3, 0, 0), {0}, cell, &strain);
  CHECK(strain.head<2>().sum() / (strain[0] - strain[1])
        == Approx(sine(dilation)).epsilon(1e-6).margin(1e-12));
  // the others do not: outside and inside of it
  for (const auto& [cone, outside] :
       {std::pair("compression", true), std::pair("inscribed", false)})
  {
    Body other = body(cell);
    for (int k = 0; k < 400; ++k)
      mixed_step(law(cone, phi, 0), other, Voigt(0, -1e-3, 0, 0), {0}, cell);
    CHECK((-other.sigma()[1] > lateral * N + 2 * c * std::sqrt(N) * 1.01)
          == outside);
  }
}

TEST_CASE("Drucker-Prager: the inscribed cone touches Mohr-Coulomb's planes "
          "from inside, the outer one its edges from outside",
          "[conformance][material]")
{
  double inscribed = -1e300, compression = 1e300, extension_low = 1e300;
  for (int k = 0; k < 3600; ++k)
  {
    const double lode = k * std::numbers::pi / 1800, p = 5e4;
    const auto on = [&](const DruckerPrager& l)
    {
      const auto [alpha, beta, strength, floor] = l.numbers();
      const double r = 2 / std::numbers::sqrt3 * (alpha * p + strength);
      const auto s = [&](double at) { return r * std::cos(lode + at) - p; };
      return hexagon(
          {s(0), s(2 * std::numbers::pi / 3), s(-2 * std::numbers::pi / 3), 0});
    };
    inscribed = std::max(inscribed, on(law("inscribed")));
    compression = std::min(compression, on(law("compression")));
    extension_low = std::min(extension_low, on(law("extension")));
  }
  // within the grid of Lode angles, (pi / 1800)^2 / 2 of the stress
  CHECK(std::abs(inscribed) < 2e-6 * 5e4);
  CHECK(std::abs(compression) < 1e-10 * 5e4);
  CHECK(extension_low < -1e3);
}

TEST_CASE("Drucker-Prager: a gap opens at the tip and closes again",
          "[conformance][material]")
{
  const double cut = GENERATE(not_given, 1.5e3);
  const DruckerPrager l = law("compression", phi, psi, c, cut);
  const double floor = -std::min(cut, c * cosine(phi) / sine(phi));
  Body b;
  const double contact = open_gap(l, floor, b);
  advance(l, b, -(0.02 + contact) / 3 * Voigt(1, 1, 1, 0));
  CHECK(b.p == Approx(2e4).epsilon(1e-9));
  CHECK(b.s.norm() < 1e-9);
}

TEST_CASE("Drucker-Prager: random steps end on the cone, lose work and fall "
          "in p",
          "[conformance][material]")
{
  Random random(31);
  for (const DruckerPrager& l : kinds())
  {
    INFO("friction " << l.friction_deg << ", cut-off " << l.tensile_strength);
    const auto cone = l.numbers();
    int tip = 0, plain = 0;
    double worst = 0, least_work = 0, most_stiff = -1e300;
    for (int trial = 0; trial < 4000; ++trial)
    {
      Body b = admissible(l, random);
      const bool gap_before = b.p < cone.floor;
      const Voigt before = b.sigma();
      const Voigt strain = compliance(
          E, nu, random_stress(random, c * std::pow(10, 2 * random.unit())));
      const Response r = advance(l, b, strain);
      const double size = before.norm() + 2 * G * strain.norm();
      most_stiff = std::max(most_stiff, r.dp_dtheta);
      const double radius = norm(b.s) / std::numbers::sqrt2;
      worst = std::max(
          worst,
          (radius
           - std::max(cone.alpha * std::max(b.p, cone.floor) + cone.k, 0.0))
              / size);
      tip += r.effort.apex;
      plain += not r.effort.apex and r.dp_de.norm() > 0;
      if (not gap_before and not r.effort.apex)
        least_work = std::min(
            least_work,
            work(b.sigma(), strain - compliance(E, nu, b.sigma() - before))
                / (size * strain.norm()));
    }
    CHECK(worst < 1e-14);
    CHECK(least_work > -1e-12);
    CHECK(most_stiff < 0);
    CHECK((std::isinf(cone.floor) or tip > 100));
    CHECK((l.dilation_deg == 0 or plain > 100));
  }
}

TEST_CASE("Drucker-Prager: with associated flow the answer is the nearest "
          "admissible stress",
          "[conformance][material]")
{
  const double cut = GENERATE(not_given, 0.5 * c);
  const DruckerPrager l = law("inscribed", phi, phi, c, cut);
  check_nearest(l, l.numbers().floor, 32);
}

TEST_CASE("Drucker-Prager: the tangent is the derivative, on the cone, at the "
          "cut-off and at the tip",
          "[conformance][material]")
{
  check_tangent(kinds(), 33);
}

TEST_CASE("Drucker-Prager: steps are of first order where the stress turns",
          "[conformance][material]")
{
  check_first_order(law(), 2e-2);
}

TEST_CASE("naive: a return along the cone alone turns the stress round beyond "
          "the tip",
          "[conformance][material]")
{
  // the multiplier of the cone from a trial far in tension is larger than the
  // deviator: what is left points the other way, outside the nappe
  const DruckerPrager l = law();
  const auto [alpha, beta, k, floor] = l.numbers();
  const double p = 5 * floor, r = 0.3 * c;
  const double slip = (r - alpha * p - k) / (G + alpha * beta * K);
  const double r_naive = r - G * slip;
  CHECK(r_naive < 0);
  CHECK(std::abs(r_naive) > alpha * (p + K * beta * slip) + k + c);

  Body b;
  advance(
      l, b,
      compliance(E, nu, Voigt(-p, -p, -p, r))); // sqrt(J2) is the shear stress
  CHECK(b.s.norm() < 1e-12 * c);
  CHECK(b.p < floor);
  CHECK(b.p > 1.01 * floor);
}

TEST_CASE("laws with friction name what does not fit",
          "[conformance][material]")
{
  const auto first = [](const auto& l)
  {
    const auto all = l.complaints();
    REQUIRE(all.size() == 1);
    return all[0];
  };
  CHECK(law().complaints().empty());
  CHECK_THAT(first(law("egg")), ContainsSubstring("egg"));
  CHECK_THAT(first(law("inscribed", 20, 21)),
             ContainsSubstring("dilation_deg = 21"));
  CHECK_THAT(first(law("inscribed", 30, 0, c, 2 * c)),
             ContainsSubstring("tensile_strength"));
  CHECK_THAT(first(law("inscribed", 0, 0, 0)),
             ContainsSubstring("no strength"));
  const MohrCoulomb mc{.E = E,
                       .nu = nu,
                       .cohesion = c,
                       .friction_deg = 30,
                       .dilation_deg = 0,
                       .density = 1600,
                       .tensile_strength = 2 * c};
  CHECK_THAT(first(mc), ContainsSubstring("tensile_strength"));
}
