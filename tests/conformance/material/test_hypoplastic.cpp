// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Hypoplastic sand against reference values: rates at general states, computed
// by an independent program and confirmed by the xMat library (TU Hamburg).
// Printed digits are the tolerance.

#include "sand.h"

#include "material/hypoplastic_rate.h"
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <numbers>

using namespace mmale;
using namespace mmale::material;
using Catch::Matchers::WithinAbs;
using mmale::test::sand;

namespace
{
constexpr double kPa = 1e3;
constexpr double root2 = std::numbers::sqrt2;

using Tensor6 = hypoplasticity::Tensor<6>;

/// From components 11 22 33 12 23 13.
Tensor6 mandel(const Tensor6& t)
{
  Tensor6 out = t;
  out.tail<3>() *= root2;
  return out;
}

Tensor6 six(double a, double b, double c, double d, double e, double f)
{
  return Tensor6{{a, b, c, d, e, f}};
}

/// Components as printed, half a unit of the last digit off at most.
void check(const Tensor6& mandel, const Tensor6& printed, double unit)
{
  for (int i = 0; i < 6; ++i)
  {
    INFO("component " << i);
    CHECK_THAT(mandel[i] / (i < 3 ? 1 : root2),
               WithinAbs(printed[i], 0.51 * unit));
  }
}
} // namespace

TEST_CASE("hypoplastic: rates at a general state, all six components",
          "[conformance][material][hypoplastic]")
{
  Hypoplastic law = sand("karlsruhe_fine_alt", 0.8, true);
  law.phi_c_deg = 0.5777 * 180 / std::numbers::pi;
  law.m_R = 2.2;
  law.m_T = 1.1;
  law.chi = 5.5;
  const Tensor6 T = mandel(1e3 * six(-100, -250, -250, 50, 10, 0));
  const Tensor6 D = six(-0.05, 0.015, 0.015, 0, 0, 0);

  SECTION("without intergranular strain, and the factors")
  {
    law.intergranular_strain = "off";
    const auto c = law.constants();
    hypoplasticity::Rate<6, false> rate;
    rate.evaluate(c, T, 0.8, Tensor6::Zero(), D, D.norm(), true);
    check(
        rate.stress / kPa,
        six(-960.937338, 3292.458288, 3292.458288, -893.961854, -178.792371, 0),
        1e-6);
    CHECK_THAT(c.a, WithinAbs(2.7517036184, 0.51e-10));
    CHECK_THAT(rate.lode.F, WithinAbs(0.7160931964, 0.51e-10));
    CHECK_THAT(std::sqrt(3 * rate.lode.q), WithinAbs(0.4102844542, 0.51e-10));
    CHECK_THAT(-std::sqrt(6) * rate.lode.cubic / std::pow(rate.lode.q, 1.5),
               WithinAbs(0.9342491044, 0.51e-10));
    CHECK_THAT(rate.factor.f_d, WithinAbs(0.9155816224, 0.51e-10));
    CHECK_THAT(rate.factor.f_s / kPa,
               WithinAbs(11622.22325680 * 1.5798687687, 2e-6));
  }
  SECTION("intergranular strain zero")
  {
    hypoplasticity::Rate<6, true> rate;
    rate.evaluate(law.constants(), T, 0.8, Tensor6::Zero(), D, D.norm(), true);
    check(
        rate.stress / kPa,
        six(-2114.062143, 2161.384636, 2161.384636, -272.708213, -54.541643, 0),
        1e-6);
    CHECK(rate.grains.rate == D);
  }
  SECTION("intergranular strain of a general direction")
  {
    const Tensor6 h = mandel(six(-6e-5, 3e-5, 1e-5, 1e-5, 0, 0));
    hypoplasticity::Rate<6, true> rate;
    rate.evaluate(law.constants(), T, 0.8, h, D, D.norm(), true);
    check(
        rate.stress / kPa,
        six(-1962.127982, 2296.786953, 2301.605416, -353.394536, -70.197061, 0),
        1e-6);
    check(rate.grains.rate,
          six(-6.62149547e-3, -6.68925226e-3, 7.77024925e-3, -7.22975075e-3, 0,
              0),
          1e-11);
  }
}

TEST_CASE("hypoplastic: stiffness at an axial state",
          "[conformance][material][hypoplastic]")
{
  Hypoplastic law = sand("hochstetten", 0.70, false);
  const auto c = law.constants();
  const hypoplasticity::Tensor<4> T(-80e3, -200e3, -80e3, 0);
  hypoplasticity::Rate<4, false> rate;
  rate.evaluate(c, T, 0.70, T, hypoplasticity::Tensor<4>::Zero(), 0, true);
  const auto L = (rate.stiffest(c) / kPa).eval();
  CHECK_THAT(c.a, WithinAbs(2.7607190781, 0.51e-10));
  CHECK_THAT(rate.lode.F, WithinAbs(1, 1e-14));
  CHECK_THAT(rate.factor.f_s / kPa / (rate.Th.squaredNorm()),
             WithinAbs(14418.86547362, 0.51e-8));
  CHECK_THAT(rate.factor.f_d, WithinAbs(0.8921280680, 0.51e-10));
  CHECK_THAT(L(1, 1), WithinAbs(48336.887094, 0.51e-6));
  CHECK_THAT(L(1, 0), WithinAbs(13567.208648, 0.51e-6));
  CHECK_THAT(L(0, 0), WithinAbs(19845.748933, 0.51e-6));
  CHECK_THAT(L(0, 2), WithinAbs(5426.883459, 0.51e-6));
  // f_d N is what the rate for D = 0 and |D| = 1 leaves
  rate.evaluate(c, T, 0.70, T, hypoplasticity::Tensor<4>::Zero(), 1, true);
  CHECK_THAT(rate.stress[0] / kPa, WithinAbs(3945.826637, 0.51e-6));
  CHECK_THAT(rate.stress[1] / kPa, WithinAbs(27620.786459, 0.51e-6));
}
