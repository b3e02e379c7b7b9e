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
/// Somewhere a few random steps from an isotropic state.
Element wandered(Random& random, bool grains, double p, double tolerance)
{
  const double e = 0.78 + 0.2 * random.unit();
  Element element(sand("hochstetten", e, grains, tolerance), p);
  for (int k = 0; k < 5; ++k)
    element.strain(random.deviator(3e-4, 2)
                   + 5e-5 * random.unit() * Voigt(1, 1, 1, 0));
  return element;
}

/// Stress and flow after a strain, over sizes.
Eigen::Vector<double, 5> after(const Element& element, const Voigt& strain)
{
  std::vector<double> q;
  Response a;
  REQUIRE(element.answer(strain, q, a) == Outcome::ok);
  Eigen::Vector<double, 5> out;
  out << a.s - a.p * Voigt(1, 1, 1, 0), a.flow;
  return out;
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
  double worst = 0;
  int kinks = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial)
  {
    Element element = wandered(random, grains, p, 1e-6);
    element.law.integrator = scheme;
    element.law.tolerance = scheme == "heun" ? 1e-7 : 1e-10;
    const Voigt step = random.deviator(strain, 2)
                       + 0.2 * strain * random.unit() * Voigt(1, 1, 1, 0);
    const Voigt d = random.deviator(strain, 2)
                    + 0.3 * strain * random.unit() * Voigt(1, 1, 1, 0);
    std::vector<double> q;
    Response a;
    REQUIRE(element.answer(step, q, a) == Outcome::ok);
    Eigen::Vector<double, 5> exact;
    const double theta = d.head<3>().sum();
    const Voigt dd = d - theta / 3 * Voigt(1, 1, 1, 0);
    exact << test::stiffness(a) * d,
        a.dflow_de.dot(dd) + a.dflow_dtheta * theta;
    CHECK(a.dp_dtheta < 0);
    constexpr double h = 1e-3;
    const Eigen::Vector<double, 5> right = after(element, step + h * d),
                                   left = after(element, step - h * d),
                                   centre = after(element, step);
    const Eigen::Vector<double, 5> slope = (right - left) / (2 * h);
    const auto m = element.law.moduli({a.s, a.p, q}, 1);
    const double size = m.K * strain;
    Eigen::Vector<double, 5> miss = slope - exact,
                             bend = (right - 2 * centre + left) / h;
    miss.head<4>() /= size;
    bend.head<4>() /= size;
    if (miss.norm() > 1e-5)
      WARN(trial << " " << miss.transpose() << " | " << bend.norm());
    worst = std::max(worst, miss.norm());
  }
  CHECK(worst < 1e-4);
}
