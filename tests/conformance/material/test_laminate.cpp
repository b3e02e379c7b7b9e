// SPDX-License-Identifier: LGPL-3.0-or-later
// Layers of two materials, against the exact moduli of laminates: where each
// closure stands.
#include "cells.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>

using namespace mmale::material;
using namespace mmale::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace
{
/// Shear and bulk modulus of two layers [Pa], and the part of the first.
struct Layers
{
  double G1, K1, G2, K2, f;

  double mean(double a, double b) const { return f * a + (1 - f) * b; }
  double series(double a, double b) const { return 1 / mean(1 / a, 1 / b); }
  double M1() const { return K1 + 4 * G1 / 3; }
  double M2() const { return K2 + 4 * G2 / 3; }

  /// Uniaxial strain across the layers: in series.
  double normal() const { return series(M1(), M2()); }
  /// Along them (Backus 1962): the stress across is the same in both and the
  /// strain across is 0 in the mean.
  double along() const
  {
    const double l1 = K1 - 2 * G1 / 3, l2 = K2 - 2 * G2 / 3;
    const double coupled = mean(l1 / M1(), l2 / M2());
    return mean(M1() - l1 * l1 / M1(), M2() - l2 * l2 / M2())
           + coupled * coupled * normal();
  }
  double reuss() const { return series(K1, K2) + 4 * series(G1, G2) / 3; }
  double voigt() const { return mean(M1(), M2()); }
  /// One pressure, one deviatoric strain.
  double equal_pressure() const
  {
    return series(K1, K2) + 4 * mean(G1, G2) / 3;
  }

  std::vector<Part> parts(double p = 0) const
  {
    return {part(elastic_of(G1, K1), f, p), part(elastic_of(G2, K2), 1 - f, p)};
  }
};

/// Along an angle from x, a strain of one component.
Voigt uniaxial(double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, 0, 2 * c * s};
}
double along(const Voigt& stress, double angle)
{
  const Voigt e = uniaxial(angle);
  return stress.dot(e); // engineering shear counts the shear stress twice
}

/// Stress over strain in uniaxial strain of 1e-9, layers' normal at `normal`.
double modulus(const AnyClosure& closure, const std::vector<Part>& parts,
               double normal, double load)
{
  constexpr double strain = 1e-9; // volumes at start and end: the same to 1e-9
  const Voigt one(1, 1, 1, 0);
  const Answer a = ask_volume(
      closure, parts,
      {.de = strain * (uniaxial(load) - one / 3), .interface = between(normal)},
      strain);
  // the mean's stress; its pressure is the shares', weighted
  double p = 0, sum = 0;
  for (const Share& share : a.shares)
  {
    p += share.fraction * share.p;
    sum += share.fraction;
  }
  return along(a.mixed.mean.s - p / sum * one, load) / strain;
}
constexpr double right_angle = 1.5707963267948966;
} // namespace

TEST_CASE("laminate: steel and water, across and along", "[closure][laminate]")
{
  const double f = GENERATE(0.1, 0.5, 0.9), angle = GENERATE(0.0, 0.6);
  // water of 1 mPa s in steps of 1 s: G = 1e-3 Pa
  const Layers layers{79.23e9, 171.67e9, 1e-3, 2.2e9, f};
  std::vector<Part> parts = layers.parts();
  parts[1] = part(liquid(2.2e9), 1 - f);
  const double across = modulus(Laminate{}, parts, angle, angle);
  const double beside = modulus(Laminate{}, parts, angle, angle + right_angle);
  CHECK_THAT(across, WithinRel(layers.normal(), 1e-7));
  CHECK_THAT(beside, WithinRel(layers.along(), 1e-7));
  // the bounds of any mixture; water's shear stiffness is none
  for (const double m : {across, beside})
  {
    CHECK(m >= layers.reuss());
    CHECK(m <= layers.voigt());
  }
  // the others do not see the layers
  for (const double load : {angle, angle + right_angle})
  {
    CHECK_THAT(modulus(EqualPressure{}, parts, angle, load),
               WithinRel(layers.equal_pressure(), 1e-7));
    CHECK_THAT(modulus(EqualStrain{}, parts, angle, load),
               WithinRel(layers.voigt(), 1e-7));
  }
}

TEST_CASE("laminate: where steel and sand stick", "[closure][laminate]")
{
  // sand of oedometric modulus 90 MPa, nu = 0.3: exact 0.18 GPa, equal
  // pressure 53 GPa, equal strain 139 GPa
  const double E = 0.09e9 * 1.3 * 0.4 / 0.7;
  const std::vector<Part> parts{part(elastic(2.06e11, 0.3), 0.5),
                                part(elastic(E, 0.3), 0.5)};
  const Layers layers{2.06e11 / 2.6, 2.06e11 / 1.2, E / 2.6, E / 1.2, 0.5};
  const double exact = modulus(Laminate{}, parts, 0, 0);
  const double stuck = modulus(EqualPressure{}, parts, 0, 0);
  CHECK_THAT(exact, WithinRel(layers.normal(), 1e-6));
  CHECK_THAT(exact, WithinAbs(0.18e9, 0.005e9));
  CHECK_THAT(stuck, WithinRel(layers.equal_pressure(), 1e-7));
  CHECK_THAT(stuck, WithinAbs(53e9, 0.5e9));
  CHECK_THAT(modulus(EqualStrain{}, parts, 0, 0),
             WithinRel(layers.voigt(), 1e-7));
}

TEST_CASE("laminate: sheared along the layers, the weaker one bears the stress",
          "[closure][laminate]")
{
  // J2 in shear yields at sigma_y / sqrt(3), which the clay reaches
  const double yield = 2e4, limit = yield / std::sqrt(3.0);
  const std::vector<Part> parts{part(steel(), 0.5),
                                part(J2{2.6e6, 0.3, yield, 0, 2e3}, 0.5)};
  const Question question{.de = Voigt(0, 0, 0, 0.1),
                          .interface = between(right_angle)};
  const Answer layers = ask(Laminate{}, parts, question);
  REQUIRE(layers.outcome == Outcome::ok);
  CHECK_THAT(layers.mixed.mean.s[3], WithinRel(limit, 1e-9));
  // with one strain for both the steel yields instead
  const Answer stuck = ask(EqualPressure{}, parts, question);
  CHECK(stuck.mixed.mean.s[3] > 0.4 * 3e8 / std::sqrt(3.0));
}

TEST_CASE("laminate: traction goes through, other stresses need not",
          "[closure][laminate]")
{
  Random random(21);
  const AnyLaw soil = make_law({.law = "mohr_coulomb",
                                .parameters = {{"E", 2e7},
                                               {"nu", 0.27},
                                               {"cohesion", 4e3},
                                               {"friction_deg", 31},
                                               {"dilation_deg", 9},
                                               {"density", 1.6e3}}});
  for (int trial = 0; trial < 100; ++trial)
  {
    std::vector<Part> parts{part(steel(2e5), 0.3, 2e4), part(soil, 0.5, 1e4),
                            part(liquid(1e8, 1e3), 0.2, 1e4)};
    const double angle = 3 * random.unit();
    const Answer a = ask(Laminate{}, parts,
                         {.de = random.deviator(2e-3, 2),
                          .p = 4e4,
                          .interface = between(angle)});
    REQUIRE(a.outcome == Outcome::ok);
    const auto traction = [&](const Voigt& s, double p)
    {
      const double x = std::cos(angle), y = std::sin(angle);
      return Eigen::Vector2d(x * (s[0] - p) + y * s[3],
                             x * s[3] + y * (s[1] - p));
    };
    const auto& [one, two, three] =
        std::tie(a.shares[0], a.shares[1], a.shares[2]);
    // two and three are one layer
    const Voigt s = (0.5 * two.answer.s + 0.2 * three.answer.s) / 0.7;
    const double p = (0.5 * two.p + 0.2 * three.p) / 0.7;
    const double size = norm(s) + p + norm(one.answer.s);
    CHECK((traction(one.answer.s, one.p) - traction(s, p)).norm()
          < 1e-10 * size);
    CHECK_THAT(0.3 * one.p + 0.7 * p, WithinRel(4e4, 1e-10));
    CHECK_THAT(two.answer.theta, WithinRel(three.answer.theta, 1e-12));
    CHECK_THAT(a.mixed.mean.theta,
               WithinAbs(std::log(0.3 * std::exp(one.answer.theta)
                                  + 0.7 * std::exp(two.answer.theta)),
                         1e-15));
  }
}

TEST_CASE("laminate: of elastic layers the tangent is symmetric",
          "[closure][laminate]")
{
  const Layers layers{3e6, 5e6, 2e4, 8e4, 0.3};
  const Answer a = ask(Laminate{}, layers.parts(), {.interface = between(0.6)});
  const Driven& m = a.mixed.mean;
  // de is a deviator: what is asked of its trace does not count
  const Voigt one(1, 1, 1, 0);
  const Voigt2 deviator = Voigt2::Identity() - one * one.transpose() / 3;
  const Voigt2 C = deviator * m.ds_de * deviator;
  CHECK((C - C.transpose()).norm() < 1e-12 * C.norm());
  // s and theta are the slopes of one potential by de and p
  CHECK((m.ds_dp - deviator * m.dtheta_de).norm() < 1e-12 * m.ds_dp.norm());
  CHECK(m.ds_dp.norm() > 0.1); // layers do mix p and the deviator
}

TEST_CASE("laminate: without an interface it is equal pressure",
          "[closure][laminate]")
{
  const Layers layers{3e6, 5e6, 2e4, 8e4, 0.3};
  const std::vector<Part> parts = layers.parts();
  const Question question{.de = {1e-3, -1e-3, 0, 2e-3}, .p = 1e3};
  const Answer a = ask(Laminate{}, parts, question);
  const Answer b = ask(EqualPressure{}, parts, question);
  CHECK(a.mixed.mean.s == b.mixed.mean.s);
  CHECK(a.mixed.mean.theta == b.mixed.mean.theta);
}
