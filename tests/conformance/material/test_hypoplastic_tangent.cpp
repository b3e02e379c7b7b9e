// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Derivatives of the sub-stepped update of hypoplastic sand, at states that
// random paths lead to: loose and dense, at kilopascals and at the apex.

#include "samples.h"
#include "sand.h"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>

using namespace mmale;
using namespace mmale::material;
using mmale::test::Element;
using mmale::test::Random;
using mmale::test::sand;

namespace
{
const Voigt one(1, 1, 1, 0);

/// Somewhere a few random steps from an isotropic state.
Element wandered(Random& random, bool grains, double p, double tolerance)
{
  const double e = 0.78 + 0.2 * random.unit();
  Element element(sand("hochstetten", e, grains, tolerance), p);
  for (int k = 0; k < 5; ++k)
    element.strain(random.deviator(3e-4, 2) + 5e-5 * random.unit() * one);
  return element;
}

/// Stress after a strain.
Voigt after(const Element& element, const Voigt& strain)
{
  std::vector<double> q;
  Response a;
  REQUIRE(element.answer(strain, q, a) == Outcome::ok);
  return a.s - a.p * one;
}
} // namespace

TEST_CASE("hypoplastic: the consistent tangent is the derivative of the update",
          "[conformance][material][hypoplastic]")
{
  const bool grains = GENERATE(false, true);
  const double p = GENERATE(100.0, 1e3, 1e5, 1e7);
  const std::string scheme = GENERATE("heun", "rkf23", "bs32", "dp54");
  const double strain = 3e-4;
  INFO(grains << " " << p << " Pa, " << scheme);
  Random random(1);
  double worst = 0, continuum = 0;
  for (int trial = 0; trial < 20; ++trial)
  {
    Element element = wandered(random, grains, p, 1e-6);
    element.law.integrator = scheme;
    element.law.tolerance = scheme == "heun" ? 1e-6 : 1e-10;
    const Voigt step =
        random.deviator(strain, 2) + 0.2 * strain * random.unit() * one;
    const Voigt d =
        random.deviator(strain, 2) + 0.3 * strain * random.unit() * one;
    std::vector<double> q;
    Response a, b;
    REQUIRE(element.answer(step, q, a) == Outcome::ok);
    CHECK(a.dp_dtheta < 0);
    constexpr double h = 1e-3;
    const Voigt slope =
        (after(element, step + h * d) - after(element, step - h * d)) / (2 * h);
    const double size = element.law.moduli({a.s, a.p, q}, 1).K * strain;
    const Voigt miss = slope - test::stiffness(a) * d;
    worst = std::max(worst, miss.norm() / size);

    element.kind = TangentKind::continuum;
    REQUIRE(element.answer(step, q, b) == Outcome::ok);
    CHECK((b.s - a.s).norm() == 0);
    const Voigt other = slope - test::stiffness(b) * d;
    continuum = std::max(continuum, other.norm() / size);
  }
  // Central differences over a thousandth of the step: some 1e-6 of truncation,
  // and what the sequence of sub-steps adds. Near the floor the rates have a
  // kink, where the pressure begins to fall.
  CHECK(worst < (p < 1e3 ? 3e-3 : 5e-5));
  CHECK(continuum > 0.02);
}
