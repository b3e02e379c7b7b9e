// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "paths.h"

#include <catch2/catch_approx.hpp>
#include <cmath>
#include <numbers>
#include <vector>

/// What the two laws with friction are tested with alike.
namespace mmale::test
{
constexpr double E = 2e7, nu = 0.27, c = 4e3, phi = 31, psi = 9;
constexpr double G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));

inline double sine(double degrees)
{
  return std::sin(degrees * std::numbers::pi / 180);
}
inline double cosine(double degrees)
{
  return std::cos(degrees * std::numbers::pi / 180);
}
/// Ratio of principal stresses in a cohesionless soil that fails.
inline double flow_number(double degrees)
{
  return (1 + sine(degrees)) / (1 - sine(degrees));
}

inline Voigt random_stress(Random& random, double size)
{
  return random.deviator(size) + size * random.unit() * Voigt(1, 1, 1, 0);
}

/// A point somewhere within what the law bears.
template <class L>
Body admissible(const L& law, Random& random)
{
  Body b = body(random_stress(random, 3 * c));
  (void)law.admit(b.s, b.p, b.q);
  return b;
}

/// A point under 20 kPa is stretched until its grains part, and 0.02 further.
///
/// @param[in] floor pressure at which they part [Pa]
/// @return stretch to the floor [-]
template <class L>
double open_gap(const L& law, double floor, Body& b)
{
  using Catch::Approx;
  b = body(-2e4 * Voigt(1, 1, 1, 0));
  const double contact = (2e4 - floor) / K;
  const Response r = advance(law, b, (contact + 0.02) / 3 * Voigt(1, 1, 1, 0));
  CHECK(b.p
        == Approx(floor - material::Gap::gap_share * K * 0.02).epsilon(1e-12));
  CHECK(b.s.norm() < 1e-10 * c);
  CHECK(r.dp_dtheta == Approx(-material::Gap::gap_share * K));
  CHECK(r.effort.apex == 1);
  return contact;
}

/// With associated flow the answer is the nearest admissible stress in the norm
/// of elastic energy: none lies on the trial's side,
/// (trial - answer) : C^-1 : (tau - answer) <= 0 for all tau (maximum plastic
/// work).
///
/// @param[in] floor pressure at which grains part [Pa]
template <class L>
void check_nearest(const L& law, double floor, unsigned seed)
{
  Random random(seed);
  double worst = -1;
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Voigt far = random_stress(random, 10 * c);
    Body b = body(Voigt::Zero());
    if (advance(law, b, compliance(E, nu, far)).effort.apex)
      b.p = floor; // but for the gap
    const Voigt plastic = compliance(E, nu, far - b.sigma());
    for (int k = 0; k < 50; ++k)
    {
      Body tau = body(random_stress(random, 10 * c));
      tau.p = std::max(tau.p, floor);
      (void)law.admit(tau.s, tau.p, tau.q);
      worst = std::max(worst, work(tau.sigma() - b.sigma(), plastic)
                                  / (far.squaredNorm() / E));
    }
  }
  CHECK(worst < 1e-13);
}

/// The tangent is the derivative of the answer, but where a region's rim lies
/// within the difference.
template <class L>
void check_tangent(const std::vector<L>& laws, unsigned seed)
{
  Random random(seed);
  constexpr double h = 1e-5;
  constexpr int trials = 1500;
  for (const L& law : laws)
  {
    INFO("friction " << law.friction_deg << ", cut-off "
                     << law.tensile_strength);
    int kinks = 0;
    double worst = 0;
    for (int trial = 0; trial < trials; ++trial)
    {
      const Body b = admissible(law, random);
      const Voigt strain = compliance(E, nu, random_stress(random, 5 * c));
      const Voigt d = compliance(E, nu, random_stress(random, c));
      const auto at = [&](double x)
      {
        const Response r = answer(law, b, strain + x * d);
        return Voigt(r.s - r.p * Voigt(1, 1, 1, 0));
      };
      const Voigt low = at(-h), mid = at(0), high = at(h);
      if ((high - 2 * mid + low).norm() > 1e-3 * h * c)
      {
        ++kinks;
        continue;
      }
      const Voigt exact = stiffness(answer(law, b, strain)) * d;
      worst = std::max(worst, ((high - low) / (2 * h) - exact).norm() / c);
    }
    CHECK(worst < 1e-6); // round-off of 1e-15 of 5 c, over h
    CHECK(kinks < trials / 50);
  }
}

/// Along a path on which the stress turns, the error of steps falls with their
/// length.
///
/// @param[in] share error of 40 steps at most, of the stress [-]
template <class L>
void check_first_order(const L& law, double share)
{
  const auto end = [&law](int steps)
  {
    Body b = body({-4e4, -9e4, -5e4, 0});
    for (int k = 0; k < steps; ++k)
      advance(law, b, Voigt(1e-3, -3e-3, 0, 8e-3) / steps);
    return b.sigma();
  };
  const Voigt exact = end(20000);
  const double coarse = (end(20) - exact).norm(),
               fine = (end(40) - exact).norm();
  CAPTURE(coarse, fine);
  CHECK(fine < share * exact.norm());
  CHECK(std::log2(coarse / fine) == Catch::Approx(1).margin(0.1));
}
} // namespace mmale::test
