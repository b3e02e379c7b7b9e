// SPDX-License-Identifier: LGPL-3.0-or-later
// Mixed control against elastic solutions by hand, and its manners where a
// law or a target does not follow.
#include "support.h"

#include <catch2/catch_approx.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>

using namespace mmale::element;
using namespace mmale::element::test;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace
{
std::string elastic_path(const std::string& path)
{
  return elastic + isotropic_start + "[[path]]\nsteps = 4\n" + path;
}
constexpr double G = 4e6, K = 2e7 / 3;
} // namespace

TEST_CASE("oedometric: M = K + 4G/3 along the axis, whichever is given",
          "[element]")
{
  const auto drive = {"eps_a = 0.01", "sigma_a = 220e3"};
  for (const char* target : drive)
  {
    INFO(target);
    const End end =
        run(elastic_path(std::string("kind = \"oedometric\"\n") + target));
    CHECK(end.sigma_a() == Approx(100e3 + 12e6 * 0.01));
    CHECK(end.sigma_r() == Approx(100e3 + 4e6 * 0.01));
    CHECK(end.sigma_t() == Approx(end.sigma_r()));
    CHECK(end.eps_a() == Approx(0.01));
    CHECK(end.eps_r() == 0);
  }
}

TEST_CASE("triaxial, drained: E along the axis, nu across, whichever is given",
          "[element]")
{
  for (const char* target : {"eps_a = 0.01", "sigma_a = 200e3", "q = 100e3"})
  {
    INFO(target);
    const End end =
        run(elastic_path(std::string("kind = \"triaxial\"\n") + target));
    CHECK(end.q() == Approx(1e7 * 0.01));
    CHECK(end.sigma_r() == Approx(100e3));
    CHECK(end.eps_a() == Approx(0.01));
    CHECK(end.eps_r() == Approx(-0.25 * 0.01));
    CHECK(end.state.pore_pressure == 0);
  }
}

TEST_CASE("triaxial at constant mean pressure: no volume strain, 3 G",
          "[element]")
{
  const End end = run(elastic_path("kind = \"triaxial\"\nhold = \"p\"\n"
                                   "q = 90e3"));
  CHECK(end.p() == Approx(100e3));
  CHECK(end.q() == Approx(90e3));
  CHECK(end.sigma_r() == Approx(70e3));
  CHECK(end.sigma_t() == Approx(70e3));
  CHECK(end.eps_a() == Approx(90e3 / (3 * G)));
  CHECK(std::abs(end.eps_v()) < 1e-12);
}

TEST_CASE("triaxial, undrained: q = 3 G eps_a, p' stays, the water takes q/3",
          "[element]")
{
  for (const char* target : {"eps_a = 0.01", "q = 120e3"})
  {
    INFO(target);
    const End end = run(elastic_path(
        std::string("kind = \"triaxial\"\ndrainage = \"undrained\"\n")
        + target));
    CHECK(end.q() == Approx(3 * G * 0.01));
    CHECK(end.p() == Approx(100e3));
    CHECK(end.state.pore_pressure == Approx(40e3));
    CHECK(end.eps_a() == Approx(0.01));
    CHECK(std::abs(end.eps_v()) < 1e-15);
  }
}

TEST_CASE("isotropic: p = K eps_v, and an uneven state becomes even",
          "[element]")
{
  for (const char* target : {"pressure = 300e3", "eps_v = 0.03"})
  {
    INFO(target);
    const End end =
        run(elastic_path(std::string("kind = \"isotropic\"\n") + target));
    CHECK(end.p() == Approx(300e3));
    CHECK(end.eps_v() == Approx(0.03));
    CHECK(end.eps_a() == Approx(0.01));
  }
  const Test k0 = make(elastic
                       + "[initial]\nsigma_a = 200e3\nk0 = 0.4\n"
                         "[[path]]\nkind = \"isotropic\"\npressure = 90e3");
  const State start = initial_state(k0, mmale::material::make_law(k0.material));
  CHECK(start.stress == Voigt(-80e3, -200e3, -80e3, 0));
  const End end = run(k0, [](const End&, int) {});
  CHECK(end.sigma_a() == Approx(90e3));
  CHECK(end.sigma_r() == Approx(90e3));
  CHECK(end.eps_a() - end.eps_r() == Approx(-120e3 / (2 * G)));
}

TEST_CASE(
    "simple shear turns the material: G sin(gamma) and G (1 - cos(gamma))",
    "[element]")
{
  // Jaumann's rate with constant G in closed form; p' of 1 GPa takes it along
  const auto error = [](int steps)
  {
    const End end = run(elastic + isotropic_start
                        + "[[path]]\nkind = \"simple_shear\"\n"
                          "drainage = \"undrained\"\ngamma = 1.2\nsteps = "
                        + std::to_string(steps));
    CHECK(std::abs(end.eps_a()) < 1e-15);
    const double bent = G * (1 - std::cos(1.2));
    return std::max({std::abs(end.tau() - G * std::sin(1.2)),
                     std::abs(end.sigma_a() - 100e3 - bent),
                     std::abs(end.sigma_r() - 100e3 + bent)})
           / G;
  };
  const double coarse = error(20), fine = error(40);
  CHECK(fine < 1e-4);
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.05));
  // the same shear without a turn is a straight line
  const End straight =
      run(elastic + isotropic_start
          + "[[path]]\nkind = \"free\"\neps_a = 0\neps_r = 0\neps_t = 0\n"
            "gamma = 1.2");
  CHECK(straight.tau() == Approx(1.2 * G));
}

TEST_CASE("simple shear by stress finds the strain that goes with it",
          "[element]")
{
  const End end = run(elastic + isotropic_start
                      + "[[path]]\nkind = \"simple_shear\"\n"
                        "drainage = \"undrained\"\nsteps = 200\ntau = "
                      + std::to_string(G * std::sin(0.5)));
  CHECK(end.gamma() == Approx(0.5).epsilon(1e-5));
  // drained, the normal stress stays and the height changes
  const End drained = run(elastic + isotropic_start
                          + "[[path]]\nkind = \"simple_shear\"\n"
                            "gamma = 0.1\nsteps = 50");
  CHECK(drained.sigma_a() == Approx(100e3));
  CHECK(drained.eps_a() < 0);
}

TEST_CASE("free: strains and stresses mixed, effective and total", "[element]")
{
  const std::string plane = "kind = \"free\"\nsigma_a = 180e3\neps_r = 0\n"
                            "sigma_t = 100e3\ntau = 8e3\n";
  const End end = run(elastic_path(plane));
  // one strain held: E / (1 - nu^2) along the axis
  CHECK(end.eps_a() == Approx(80e3 * (1 - 0.0625) / 1e7));
  CHECK(end.sigma_r() == Approx(100e3 + 0.25 * 80e3));
  CHECK(end.gamma() == Approx(8e3 / G));
  const End wet = run(elastic_path(
      "kind = \"free\"\ndrainage = \"undrained\"\nsigma_a = 220e3\n"
      "sigma_r = 100e3\nsigma_t = 100e3\ngamma = 0.0\n"));
  CHECK(wet.eps_a() == Approx(120e3 / (3 * G)));
  CHECK(wet.p() == Approx(100e3));
  CHECK(wet.sigma_a() + wet.state.pore_pressure == Approx(220e3));
}

TEST_CASE("cycles: amplitudes about the start, reversals at ends of steps",
          "[element]")
{
  const Test test = make(elastic + isotropic_start
                         + "[[path]]\nkind = \"oedometric\"\neps_a = 0.01\n"
                           "[[path]]\nkind = \"oedometric\"\neps_a = 0.002\n"
                           "cycles = 1.25\nsteps = 8\nduration = 5");
  std::vector<double> strains, times;
  run(test,
      [&](const End& end, int)
      {
        strains.push_back(end.eps_a());
        times.push_back(end.state.time);
      });
  REQUIRE(strains.size() == 110);
  const std::vector<double> wave = {.011, .012, .011, .010, .009,
                                    .008, .009, .010, .011, .012};
  for (std::size_t i = 0; i < 10; ++i)
    CHECK(strains[100 + i] == Approx(wave[i]).epsilon(1e-12));
  CHECK(times.back() == Approx(6));
}

TEST_CASE("plastic flow by stress: hardening metal to its exact strain",
          "[element]")
{
  const std::string metal = "[material]\nlaw = \"j2\"\nE = 2e11\nnu = 0.3\n"
                            "yield_stress = 2e8\nhardening = 1e9\n"
                            "density = 0\n[initial]\npressure = 0.0\n";
  const End end = run(metal
                      + "[[path]]\nkind = \"triaxial\"\nq = 3e8\n"
                        "steps = 3");
  CHECK(end.eps_a() == Approx(3e8 / 2e11 + 1e8 / 1e9));
  CHECK(end.state.history[0] == Approx(0.1));
}

TEST_CASE("a stress beyond strength stops the test just short of it, and says "
          "so",
          "[element]")
{
  const End end = run("[material]\nlaw = \"j2\"\nE = 2e11\nnu = 0.3\n"
                      "yield_stress = 2e8\nhardening = 0\ndensity = 0\n"
                      "[initial]\npressure = 0.0\n"
                      "[[path]]\nkind = \"triaxial\"\nq = 3e8\nsteps = 3");
  CHECK(not end.completed);
  CHECK_THAT(end.log.cause, ContainsSubstring("beyond strength"));
  // a step is 1e8; what is left of it are parts of 2^-16
  CHECK(end.q() <= 2e8 * (1 + 1e-12));
  CHECK(end.q() > 2e8 - 2 * 1e8 / 65536);
}

TEST_CASE("a step that the law refuses is taken in parts", "[element]")
{
  const std::string law =
      "[material]\nlaw = \"umat\"\nstates = 0\n"
      "density = 0.0\nlibrary = \"" UMATS "capricious.so\"\n"
      "props = [4e6, 1, 1e-3]\n";
  const End end = run(law + isotropic_start
                      + "[[path]]\nkind = \"oedometric\"\neps_a = 0.01\n"
                        "steps = 1");
  CHECK(end.completed);
  // G = 4e6, lambda = G / 3
  CHECK(end.sigma_a() == Approx(100e3 + (8e6 + 4e6 / 3) * 0.01));
  CHECK(end.log.parts >= 10);
  CHECK(end.log.rejected > 0);
  CHECK(end.log.cause == "the law asks for a smaller step");
  // one that always refuses ends the test
  const End never = run(law.substr(0, law.find("props"))
                        + "props = [4e6, 1, 0]\n" + isotropic_start
                        + "[[path]]\nkind = \"oedometric\"\neps_a = 0.01\n");
  CHECK(not never.completed);
}

TEST_CASE("umat: von Mises in C takes the driver where our j2 takes it",
          "[element]")
{
  const std::string paths =
      isotropic_start
      + "[[path]]\nkind = \"triaxial\"\nq = 2.5e8\nsteps = 20\n"
        "[[path]]\nkind = \"simple_shear\"\ngamma = 0.02\ncycles = 1\n";
  const End ours = run("[material]\nlaw = \"j2\"\nE = 2e11\nnu = 0.3\n"
                       "yield_stress = 2e8\nhardening = 1e9\ndensity = 0\n"
                       + paths);
  const End theirs = run("[material]\nlaw = \"umat\"\nlibrary = \"" UMATS
                         "mises.so\"\nprops = [2e11, 0.3, 2e8, 1e9]\n"
                         "states = 1\ndensity = 0\n"
                         + paths);
  // Newton stops at 1e-9 of the stress in each of 120 steps
  CHECK((ours.state.stress - theirs.state.stress).norm() < 1e-6 * 2e8);
  CHECK((ours.state.strain - theirs.state.strain).norm() < 1e-8);
  CHECK(theirs.state.history[5] == Approx(ours.state.history[0]).epsilon(1e-8));
}
