// SPDX-License-Identifier: LGPL-3.0-or-later
// Hochstetten sand through the driver against values of an independent
// integration of von Wolffersdorff's and Niemunis & Herle's equations.
#include "support.h"

#include <catch2/catch_approx.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <format>

using namespace mmale::element;
using namespace mmale::element::test;
using Catch::Approx;

namespace
{
/// What is known where the axial strain is eps_a [kPa].
struct Known
{
  double eps_a, p, q, void_ratio;
};

/// Hold a triaxial test against them; so many steps to 1e-3 of axial strain.
void hold(const std::string& grains, const std::string& drainage, long fine,
          double tolerance, double digits, const std::vector<Known>& values)
{
  INFO("intergranular strain " << grains << ", " << drainage);
  const auto step_at = [fine](double eps_a)
  { return std::lround(1000 * eps_a) * fine; };
  const Test test =
      make(hochstetten(grains, 0.70, tolerance) + isotropic_start
           + std::format("[[path]]\nkind = \"triaxial\"\ndrainage = \"{}\"\n"
                         "eps_a = {}\nsteps = {}",
                         drainage, values.back().eps_a,
                         step_at(values.back().eps_a)));
  std::size_t next = 0;
  const End end =
      run(test,
          [&](const End& at, int step)
          {
            if (step != step_at(values[next].eps_a))
              return;
            const Known& k = values[next++];
            INFO("eps_a " << k.eps_a);
            CHECK(at.q() == Approx(1e3 * k.q).epsilon(digits));
            if (not std::isnan(k.p))
              CHECK(at.p() == Approx(1e3 * k.p).epsilon(digits));
            CHECK(at.state.history[0] == Approx(k.void_ratio).epsilon(digits));
          });
  CHECK(end.completed);
  CHECK(next == values.size());
}
} // namespace

TEST_CASE("sand: drained triaxial compression", "[element][sand]")
{
  // A step is a straight line of strain, and the radial strain bends: error of
  // the second order in the steps beside that of the law's sub-steps.
  struct Way
  {
    long fine;
    double tolerance, digits;
  };
  const auto [fine, tolerance, digits] =
      GENERATE(Way{40, 1e-8, 2e-5}, Way{4, 1e-4, 1e-3});
  hold("off", "drained", fine, tolerance, digits,
       {{.001, NAN, 15.345009, .69841796},
        {.005, NAN, 70.640829, .69344325},
        {.010, NAN, 127.422907, .68945487},
        {.020, NAN, 210.795205, .68608855},
        {.050, NAN, 320.481634, .69262319},
        {.100, NAN, 328.392124, .71610341},
        {.200, NAN, 288.280757, .75213671},
        {.500, NAN, 251.301054, .79649087}});
  hold("on", "drained", fine, tolerance, digits,
       {{.001, NAN, 53.785871, .69927089},
        {.005, NAN, 102.488147, .69543158},
        {.010, NAN, 152.128209, .69235729},
        {.020, NAN, 225.120406, .69003313},
        {.050, NAN, 319.186999, .69728428},
        {.100, NAN, 323.441622, .71988973},
        {.200, NAN, 286.055943, .75431360},
        {.500, NAN, 250.899757, .79708539}});
}

TEST_CASE("sand: a path whose strain bends converges with the square of the "
          "step",
          "[element][sand]")
{
  const auto error = [](int steps)
  {
    const End end =
        run(hochstetten("on", 0.70, 1e-9) + isotropic_start
            + std::format("[[path]]\nkind = \"triaxial\"\neps_a = 0.001\n"
                          "steps = {}",
                          steps));
    return std::abs(end.q() / 53785.871 - 1);
  };
  const double coarse = error(8), fine = error(16), finest = error(32);
  CHECK(std::log2(fine / finest) == Approx(2).margin(0.2));
  CHECK(finest < 4e-5);
  CHECK(coarse < 1e-3);
}

TEST_CASE("sand: undrained triaxial compression", "[element][sand]")
{
  const auto [tolerance, digits] =
      GENERATE(std::pair(1e-8, 3e-7), std::pair(1e-4, 1e-3));
  hold("off", "undrained", 1, tolerance, digits,
       {{.001, 86.748714, 18.941495, .7},
        {.005, 62.212797, 51.139040, .7},
        {.010, 56.938740, 67.172939, .7},
        {.020, 67.648581, 96.182156, .7},
        {.050, 147.924502, 220.249503, .7},
        {.100, 362.824505, 526.859443, .7}});
  hold("on", "undrained", 1, tolerance, digits,
       {{.001, 98.705530, 50.043028, .7},
        {.005, 80.140672, 75.387036, .7},
        {.010, 76.563150, 92.882631, .7},
        {.020, 89.626191, 126.838262, .7},
        {.050, 179.068579, 264.996229, .7},
        {.100, 406.348173, 587.723432, .7}});
}

TEST_CASE("sand: isotropic compression from e_i stays on Bauer's curve",
          "[element][sand]")
{
  const double e_i = 1.05 * std::exp(-std::pow(300e3 / 1e9, 0.25));
  Test test = make(hochstetten("off", 0.70, 1e-10) + isotropic_start
                   + "[[path]]\nkind = \"isotropic\"\n"
                     "pressure = 334787.62056\nsteps = 20");
  test.initial.void_ratio = e_i; // all of its digits
  const End end = run(test, [](const End&, int) {});
  CHECK(end.state.history[0] == Approx(0.8787705769).epsilon(1e-9));
}

TEST_CASE("sand: undrained cycles of strain, pressure and deviator at each "
          "reversal",
          "[element][sand]")
{
  const auto [tolerance, digits] =
      GENERATE(std::pair(1e-8, 0.0), std::pair(1e-4, 1e-3));
  const std::vector<std::pair<double, double>> known = {
      {102.0828, 40.9419}, {90.8573, -18.6319}, {86.3832, 34.6713},
      {77.0031, -17.7583}, {72.6815, 29.2407},  {64.8647, -16.5404},
      {60.7938, 24.6961},  {54.2892, -15.1197}, {50.5337, 20.8736},
      {45.1306, -13.6032}, {41.7282, 17.6426}};
  std::size_t next = 0;
  run(make(hochstetten("on", 0.70, tolerance) + isotropic_start
           + "[[path]]\nkind = \"triaxial\"\ndrainage = \"undrained\"\n"
             "eps_a = 5e-4\ncycles = 5.25\nsteps = 40"),
      [&](const End& at, int step)
      {
        if (step % 20 != 10)
          return;
        const auto [p, q] = known.at(next++);
        INFO("reversal " << next);
        CHECK(at.p() == Approx(1e3 * p).epsilon(digits).margin(0.1));
        CHECK(at.q() == Approx(1e3 * q).epsilon(digits).margin(0.1));
      });
  CHECK(next == known.size());
}

TEST_CASE("sand: undrained cycles of stress, to the butterfly",
          "[element][sand]")
{
  const std::vector<double> p = {87.7013, 50.2490, 12.5710, 12.4844};
  const std::vector<double> eps_a = {-7.005e-4, -1.7003e-3, -2.2992e-2,
                                     -4.1146e-2, -5.9240e-2};
  std::size_t next = 0;
  run(make(hochstetten("on", 0.70, 1e-7) + isotropic_start
           + "[[path]]\nkind = \"triaxial\"\ndrainage = \"undrained\"\n"
             "q = 30e3\ncycles = 5\nsteps = 80"),
      [&](const End& at, int step)
      {
        if (step % 80 != 0)
          return;
        INFO("cycle " << next + 1);
        if (next < p.size())
          CHECK(at.p() == Approx(1e3 * p[next]).epsilon(1e-5));
        // as many digits as are given
        CHECK(at.eps_a() == Approx(eps_a[next]).epsilon(5e-5));
        ++next;
      });
  CHECK(next == 5);
}

TEST_CASE("sand: one step to 2 % of undrained shear is cut where Newton fails",
          "[element][sand]")
{
  const std::string text = hochstetten("on", 0.70, 1e-6) + isotropic_start
                           + "[[path]]\nkind = \"triaxial\"\n"
                             "drainage = \"undrained\"\neps_a = 0.02\n"
                             "steps = ";
  const End one = run(text + "1");
  CHECK(one.completed);
  CHECK(one.q() == Approx(126838.262).epsilon(0.1));
}
