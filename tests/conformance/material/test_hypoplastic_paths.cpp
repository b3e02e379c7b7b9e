// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Element tests of Hochstetten sand from 100 kPa, e = 0.70, against reference
// values by an independent program. Those with intergranular strain bend
// without bound where it is zero; there its last digits are not sure (an
// integration at 1e-13, split at that point, gives 679.6376878 and 370.4463079
// for the oedometer's unloading, printed as 679.6383 and 370.4465), so they are
// checked to 2e-6. The others: to the last digit printed.

#include "sand.h"

#include <algorithm>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <string>

using namespace mmale;
using namespace mmale::material;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using mmale::test::Element;
using mmale::test::sand;

namespace
{
constexpr double kPa = 1e3;

struct Row
{
  double strain;        ///< axial compression, logarithmic [-]
  double first, second; ///< as the path says [kPa]
};

struct Path
{
  std::string name;
  bool grains;
  std::vector<Row> rows;
};

const std::vector<Path> oedometer{{"oedometer",
                                   false,
                                   {{0.001, 116.369024, 101.409084},
                                    {0.005, 193.977952, 122.073940},
                                    {0.010, 328.407218, 174.096306},
                                    {0.020, 773.055921, 366.902060},
                                    {0.0195, 670.245163, 336.925531}}},
                                  {"oedometer",
                                   true,
                                   {{1e-4, 115.068526, 106.830258},
                                    {0.001, 190.590786, 136.856735},
                                    {0.005, 294.274585, 171.738868},
                                    {0.010, 466.463022, 241.419230},
                                    {0.020, 1007.591627, 478.520786},
                                    {0.0195, 679.638345, 370.446542}}}};

const std::vector<Path> undrained{{"undrained",
                                   false,
                                   {{0.001, 86.748714, 18.941495},
                                    {0.005, 62.212797, 51.139040},
                                    {0.010, 56.938740, 67.172939},
                                    {0.020, 67.648581, 96.182156},
                                    {0.050, 147.924502, 220.249503},
                                    {0.100, 362.824505, 526.859443}}},
                                  {"undrained",
                                   true,
                                   {{0.001, 98.705531, 50.043028},
                                    {0.005, 80.140672, 75.387036},
                                    {0.010, 76.563150, 92.882631},
                                    {0.020, 89.626191, 126.838262},
                                    {0.050, 179.068579, 264.996229},
                                    {0.100, 406.348173, 587.723432}}}};

/// Deviator of stress and void ratio; with intergranular strain the deviator
/// where it is printed to 8 digits.
const std::vector<Path> drained{{"drained",
                                 false,
                                 {{0.001, 15.345009, 0.69841796},
                                  {0.005, 70.640829, 0.69344325},
                                  {0.010, 127.422907, 0.68945487},
                                  {0.020, 210.795205, 0.68608855},
                                  {0.050, 320.481634, 0.69262319},
                                  {0.100, 328.392124, 0.71610341}}},
                                {"drained",
                                 true,
                                 {{0.001, 53.785871, 0.69927089},
                                  {0.005, 102.488147, 0.69543158},
                                  {0.010, 152.128209, 0.69235729},
                                  {0.020, 225.120406, 0.69003313},
                                  {0.050, 319.186999, 0.69728428},
                                  {0.100, 323.441622, 0.71988973}}}};

void strain_to(Element& e, const Path& path, double& before, double to)
{
  const double d = to - before;
  before = to;
  if (path.name == "oedometer")
    e.strain({0, -d, 0, 0});
  else
    e.strain({d / 2, -d, d / 2, 0});
}

std::pair<double, double> values(const Element& e, const Path& path)
{
  if (path.name == "oedometer")
    return {-e.sigma[1] / kPa, -e.sigma[0] / kPa};
  return {e.p() / kPa, e.deviator() / kPa};
}

/// Strain-driven paths, each row one call of the law.
void check(const Path& path, double law_tolerance, double relative,
           double absolute)
{
  Element e(sand("hochstetten", 0.70, path.grains, law_tolerance), 100 * kPa);
  double at = 0;
  for (const Row& row : path.rows)
  {
    INFO(path.name << ", intergranular strain " << path.grains << ", "
                   << row.strain);
    strain_to(e, path, at, row.strain);
    const auto [first, second] = values(e, path);
    CHECK_THAT(first, WithinAbs(row.first, absolute + relative * row.first));
    CHECK_THAT(second, WithinAbs(row.second, absolute + relative * row.second));
  }
}

/// Drained triaxial compression in steps so small that the radial stress is
/// held within them too, up to an error of second order.
std::vector<std::pair<double, double>> compress(const Path& path, double step,
                                                double law_tolerance)
{
  Hypoplastic law = sand("hochstetten", 0.70, path.grains, law_tolerance);
  if (law_tolerance < 1e-8)
    law.integrator = "dp54";
  Element e(law, 100 * kPa);
  std::vector<std::pair<double, double>> out;
  double from = 0;
  for (const Row& row : path.rows)
  {
    const bool first = from == 0 and path.grains; // the start bends: graded
    const auto n = static_cast<int>(std::lround((row.strain - from) / step))
                   * (first ? 4 : 1);
    double at = 0;
    for (int i = 1; i <= n; ++i)
    {
      const double to = std::pow(double(i) / n, first ? 3 : 1);
      e.triaxial((at - to) * (row.strain - from), -100 * kPa);
      at = to;
    }
    from = row.strain;
    out.emplace_back(e.deviator() / kPa, e.q[0]);
  }
  return out;
}
} // namespace

TEST_CASE("hypoplastic: oedometer and undrained triaxial compression, to the "
          "reference's digits",
          "[conformance][material][hypoplastic]")
{
  for (const auto& paths : {oedometer, undrained})
    for (const Path& path : paths)
      check(path, 1e-11, path.grains ? 2e-6 : 0, 0.6e-6);
}

TEST_CASE("hypoplastic: the default tolerance keeps these paths within 1e-3",
          "[conformance][material][hypoplastic]")
{
  for (const auto& paths : {oedometer, undrained})
    for (const Path& path : paths)
      check(path, Hypoplastic{}.tolerance, 1e-3, 0);
  for (const Path& path : drained)
  {
    const auto found = compress(path, 2.5e-4, Hypoplastic{}.tolerance);
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK_THAT(found[i].first, WithinRel(path.rows[i].first, 1e-3));
  }
}

TEST_CASE("hypoplastic: drained triaxial compression, to the reference's "
          "digits",
          "[conformance][material][hypoplastic]")
{
  for (const Path& path : drained)
  {
    const auto coarse = compress(path, 2e-4, 1e-10),
               fine = compress(path, 1e-4, 1e-10);
    for (std::size_t i = 0; i < fine.size(); ++i)
    {
      INFO("intergranular strain " << path.grains << ", "
                                   << path.rows[i].strain);
      const double q = (4 * fine[i].first - coarse[i].first) / 3;
      const double e = (4 * fine[i].second - coarse[i].second) / 3;
      CHECK_THAT(q,
                 WithinAbs(path.rows[i].first, path.grains ? 2e-6 * q : 1e-6));
      CHECK_THAT(e, WithinAbs(path.rows[i].second, 2e-8));
    }
  }
}

TEST_CASE("hypoplastic: drained peak and large strain",
          "[conformance][material][hypoplastic]")
{
  struct Case
  {
    bool grains;
    double peak, at, q, e;
  };
  const auto c =
      GENERATE(Case{false, 335.31560, 0.07445, 251.301054, 0.79649087},
               Case{true, 330.60931, 0.07263, 250.899757, 0.79708539});
  Element e(sand("hochstetten", 0.70, c.grains, 1e-8), 100 * kPa);
  double peak = 0, at = 0, strain = 0;
  const auto push = [&](double to)
  {
    e.triaxial(strain - to, -100 * kPa);
    strain = to;
    if (e.deviator() > peak)
    {
      peak = e.deviator();
      at = to;
    }
  };
  for (int i = 1; i <= 100; ++i) // graded, where the stiffness falls
    push(2e-3 * std::pow(0.01 * i, 3));
  for (int i = 9; i <= 2000; ++i)
    push(2.5e-4 * i);
  // the radial stress is held at the ends of steps only: second order
  CHECK_THAT(peak / kPa, WithinRel(c.peak, 5e-6));
  CHECK_THAT(at, WithinAbs(c.at, 2.5e-4));
  CHECK_THAT(e.deviator() / kPa, WithinRel(c.q, 5e-6));
  CHECK_THAT(e.q[0], WithinAbs(c.e, 1e-6));
}

TEST_CASE("hypoplastic: undrained cycles of strain, p and q at the reversals",
          "[conformance][material][hypoplastic]")
{
  const double printed[][2] = {
      {102.0828, 40.9419}, {90.8573, -18.6319}, {86.3832, 34.6713},
      {77.0031, -17.7583}, {72.6815, 29.2407},  {64.8647, -16.5404},
      {60.7938, 24.6961},  {54.2892, -15.1197}, {50.5337, 20.8736},
      {45.1306, -13.6032}, {41.7282, 17.6426}};
  Element tight(sand("hochstetten", 0.70, true, 1e-10), 100 * kPa),
      loose(sand("hochstetten", 0.70, true, Hypoplastic{}.tolerance),
            100 * kPa);
  double at = 0, to = 5e-4;
  for (const auto& [p, q] : printed)
  {
    const double d = to - at;
    for (Element* e : {&tight, &loose})
      e->strain({d / 2, -d, d / 2, 0});
    at = to;
    to = -to;
    CHECK_THAT(tight.p() / kPa, WithinAbs(p, 1.5e-4)); // summed over cycles
    CHECK_THAT(tight.deviator() / kPa, WithinAbs(q, 1.5e-4));
    CHECK_THAT(loose.p() / kPa, WithinRel(p, 1e-3));
    CHECK_THAT(loose.deviator() / kPa, WithinRel(q, 1e-3));
  }
}

TEST_CASE("hypoplastic: undrained cycles of stress end in the butterfly",
          "[conformance][material][hypoplastic]")
{
  Element e(sand("hochstetten", 0.70, true, 1e-9), 100 * kPa);
  e.law.integrator = "dp54";
  double strain = 0;
  // strain until the deviator is q, in steps that do not pass a second root
  const auto load = [&](double q)
  {
    const double sign = q > e.deviator() ? 1 : -1;
    double d = 1e-5 * sign;
    while (true)
    {
      Element next = e;
      next.strain({d / 2, -d, d / 2, 0});
      if ((q - next.deviator()) * sign > 0)
      {
        e = next;
        strain += d;
        d = sign * std::min(2e-4, 2 * std::abs(d));
        continue;
      }
      double low = 0, high = d;
      for (int i = 0; i < 60; ++i)
      {
        const double middle = 0.5 * (low + high);
        next = e;
        next.strain({middle / 2, -middle, middle / 2, 0});
        ((q - next.deviator()) * sign > 0 ? low : high) = middle;
      }
      e = next;
      strain += high;
      return;
    }
  };
  const double p[] = {87.7013, 50.2490, 12.5710, 12.4844, 12.4844};
  const double axial[] = {7.005e-4, 1.7003e-3, 2.2992e-2, 4.1146e-2, 5.9240e-2};
  for (int cycle = 0; cycle < 5; ++cycle)
  {
    for (double q : {30 * kPa, -30 * kPa, 0.0})
      load(q);
    INFO("cycle " << cycle + 1);
    CHECK_THAT(e.p() / kPa, WithinAbs(p[cycle], 2e-3));
    CHECK_THAT(-strain, WithinRel(axial[cycle], 1e-3));
  }
}
