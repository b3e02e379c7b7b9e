// SPDX-License-Identifier: LGPL-3.0-or-later
// Pore water of a point: constituents, cavitation, and laws driven with it.
#include "material/water.h"

#include "material/drive.h"
#include "material/elastic.h"
#include "samples.h"
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>

using namespace mmale::material;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace
{
constexpr Water water{2.2e9, 36e9, -99e3};

/// Volumes of water and of grains, each by its own law, of a unit of medium.
std::array<double, 2> volumes(double n, double from, double to)
{
  // water by quadrature-free steps through cavitation: first to it, then on
  double ln = 0;
  const double low = std::min(from, to), high = std::max(from, to);
  if (low < water.p_c)
    ln -= (std::min(high, water.p_c) - low) / Water::K_c;
  if (high > water.p_c)
    ln -= (high - std::max(low, water.p_c)) / water.K_f;
  if (to < from)
    ln = -ln;
  return {n * std::exp(ln), (1 - n) * std::exp((from - to) / water.K_s)};
}

Driven ask(const auto& medium, const Point& start, const Voigt& de, double p,
           std::vector<double>& q)
{
  q.assign(start.q.begin(), start.q.end());
  Driven answer;
  REQUIRE(drive(medium, start, de, p, 1, std::nan(""), TangentKind::consistent,
                q, answer)
          == Outcome::ok);
  return answer;
}
} // namespace

TEST_CASE("water: water and grains share the volume as suspensions do",
          "[material][water]")
{
  // numbers of Wood's mixture, computed apart: n = 0.42, K = 2.2 and 36 GPa
  const Pores start{0, 0.42};
  CHECK_THAT(1 / water.compressibility(start), WithinRel(4.830446450e9, 1e-9));
  CHECK_THAT(water.swelling(start, 3.576021e7).n,
             WithinAbs(0.4162869521, 2e-9)); // dp has seven digits
}

TEST_CASE("water: without flow, grains and water keep their masses",
          "[material][water]")
{
  mmale::test::Random random(1);
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Pores start{1e5 * random.unit(), 0.5 + 0.45 * random.unit()};
    const double size = std::pow(10, -6 + 5.5 * std::abs(random.unit()));
    const double theta = size * random.unit();
    double slope = 0;
    const Pores end = water.undrained(start, theta, slope);
    INFO("p_w " << start.p_w << " n " << start.n << " theta " << theta);
    const auto [w, s] = volumes(start.n, start.p_w, end.p_w);
    // sums of numbers of order 1, and pressures of 1e5 over K_c
    CHECK_THAT(w + s, WithinRel(std::exp(theta), 1e-13));
    CHECK_THAT(end.n * std::exp(theta), WithinRel(w, 1e-11));
    CHECK(slope < 0);
    // back again: the pressure is a function of the volume
    const Pores back = water.undrained(end, -theta, slope);
    CHECK_THAT(back.n, WithinRel(start.n, 1e-11));
    CHECK_THAT(back.p_w, WithinAbs(start.p_w, 1e-2)); // eps K_f, ten times
    double dp[2];
    for (int i : {0, 1})
      dp[i] = water.undrained(start, theta + (i ? 1e-8 : -1e-8), slope).p_w;
    CHECK(dp[1] <= dp[0]);
  }
}

TEST_CASE("water: no strain, no change", "[material][water]")
{
  for (double p_w : {0.0, 1e5, -2e5})
  {
    double slope = 0;
    const Pores end = water.undrained({p_w, 0.37}, 0, slope);
    CHECK(end.p_w == p_w);
    CHECK(end.n == 0.37);
  }
}

TEST_CASE("water: cavitation bounds the suction; without it there is none",
          "[material][water]")
{
  const Pores start{0, 0.4};
  double slope = 0;
  // 1 % dilation: uncavitated water would pull with tens of MPa
  CHECK(-0.01 / water.compressibility(start) < -40e6);
  const Pores end = water.undrained(start, 0.01, slope);
  CHECK(end.p_w < water.p_c);
  // what the water has to grow by, times the stated modulus
  CHECK(end.p_w > water.p_c - Water::K_c * 0.011 / 0.4);
  CHECK(slope < 0);
  // closes again before the water carries anything
  const Pores closed = water.undrained(end, -0.01, slope);
  CHECK_THAT(closed.p_w, WithinAbs(0, 1e-3));
}

TEST_CASE("water: an elastic skeleton without flow answers with p' + p_w",
          "[material][water]")
{
  const Elastic law{1e7, 0.3, 1600};
  const Undrained<Elastic> medium{law, water};
  const double K = law.moduli({}, 1).K;
  mmale::test::Random random(2);
  for (int trial = 0; trial < 500; ++trial)
  {
    const double p0 = 2e5 * random.unit(), p_w = 1.5e5 * random.unit();
    const std::vector<double> q0{p_w, 0.5 + 0.3 * random.unit()};
    const Point start{.p = p0, .q = q0};
    const Voigt de = random.deviator(1e-3, 2);
    const double p = 3e5 * random.unit();
    std::vector<double> q;
    const Driven a = ask(medium, start, de, p, q);
    INFO("p0 " << p0 << " p_w " << p_w << " p " << p);
    const auto [w, s] = volumes(q0[1], p_w, q[0]);
    // `drive` stops within the round-off of an uncavitated trial
    CHECK_THAT(std::log(w + s), WithinAbs(a.theta, 1e-12));
    const double effective = p0 - p_w - K * a.theta;
    CHECK_THAT(effective + q[0], WithinAbs(p, 1e-6));
    // its slope, where cavitation is not within reach of the difference
    const double h = 10;
    std::vector<double> left, right;
    const double lower = ask(medium, start, de, p - h, left).theta;
    const double upper = ask(medium, start, de, p + h, right).theta;
    if ((left[0] < water.p_c) == (right[0] < water.p_c))
      // the difference of thetas of 1e-9 has seven digits
      CHECK_THAT((upper - lower) / (2 * h), WithinRel(a.dtheta_dp, 1e-5));
  }
}

TEST_CASE("water: with flow the law sees the effective pressure alone",
          "[material][water]")
{
  const Elastic law{1e7, 0.3, 1600};
  const std::vector<double> q0{4e4, 0.4};
  const Point start{.p = 6e4, .q = q0}; // of the skeleton
  const double p = 4e4, p_w = 9e4, K = law.moduli({}, 1).K;
  std::vector<double> q;
  const Driven a = ask(Seeping<Elastic>{law, water, p_w}, start,
                       Voigt(1e-3, -1e-3, 0, 0), p, q);
  CHECK_THAT(a.theta, WithinRel(2e4 / K, 1e-12));
  CHECK(q[0] == p_w);
  // the grains' volume is kept but for their own compression
  const double grains = 0.6 * std::exp(-5e4 / water.K_s);
  CHECK_THAT((1 - q[1]) * std::exp(a.theta), WithinRel(grains, 1e-14));
  // storage: what the water gives way by at the nodes
  const auto [stored, slope] = water.stored({4e4, 0.4}, p_w);
  CHECK_THAT(stored, WithinRel(5e4 * (0.4 / 2.2e9 + 0.6 / 36e9), 1e-12));
  CHECK_THAT(slope, WithinRel(0.4 / 2.2e9 + 0.6 / 36e9, 1e-12));
}
