// SPDX-License-Identifier: LGPL-3.0-or-later
#include "step_control.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <random>

using namespace mmale;
using Catch::Approx;

namespace
{
scene::Stage stage(double duration, double step)
{
  scene::Stage s;
  s.duration = duration;
  s.step = step;
  return s;
}
constexpr int easy = 2, hard = 12, most = 15; // Newton iterations
} // namespace

TEST_CASE("equal steps end where the stage ends", "[unit][step_control]")
{
  const int n = GENERATE(1, 3, 7, 250, 1000);
  StepControl control(stage(0.25, 0.25 / n), {}, most);
  int steps = 0;
  while (not control.finished())
  {
    control.accepted(easy);
    ++steps;
  }
  CHECK(steps == n); // no crumb at the end
  CHECK(control.time() == 0.25);
}

TEST_CASE("a failed step is halved and tried from the same time",
          "[unit][step_control]")
{
  StepControl control(stage(1, 0.1), {}, most);
  control.accepted(hard);
  CHECK(control.next() == Approx(0.2));
  REQUIRE(control.failed());
  CHECK(control.time() == Approx(0.1));
  CHECK(control.next() == Approx(0.15));
  REQUIRE(control.failed());
  CHECK(control.next() == Approx(0.125));
}

TEST_CASE("below the floor it gives up", "[unit][step_control]")
{
  scene::Stage s = stage(1, 0.1);
  s.step_min = 0.02;
  StepControl control(s, {}, most);
  CHECK(control.failed());       // 0.05
  CHECK(control.failed());       // 0.025
  CHECK_FALSE(control.failed()); // 0.0125 is below

  StepControl standard(stage(1, 1.024), {}, most);
  CHECK(standard.floor() == Approx(0.001)); // a 1024th of the first step
  int halvings = 0;
  while (standard.failed())
    ++halvings;
  CHECK(halvings == 9); // of the whole stage, 1 s: 1 / 512 > 0.001 > 1 / 1024
}

TEST_CASE("easy steps grow by half up to the ceiling, hard ones do not",
          "[unit][step_control]")
{
  scene::Stage s = stage(100, 1);
  s.step_max = 3;
  StepControl control(s, {}, most);
  control.accepted(hard);
  CHECK(control.step() == 1);
  control.accepted(easy);
  CHECK(control.step() == 1.5);
  control.accepted(easy);
  CHECK(control.step() == 2.25);
  control.accepted(easy);
  CHECK(control.step() == 3);

  StepControl standard(stage(100, 1), {},
                       most); // its ceiling is the first step
  standard.accepted(easy);
  CHECK(standard.step() == 1);
  REQUIRE(standard.failed());
  standard.accepted(easy);
  CHECK(standard.step() == 0.75);
  standard.accepted(easy);
  CHECK(standard.step() == 1);
}

TEST_CASE("what is easy goes with the iterations that a step may take",
          "[unit][step_control]")
{
  // friction takes six at any step: steps once halved are to grow again
  const int allowed = GENERATE(15, 40);
  StepControl control(stage(100, 1), {}, allowed);
  REQUIRE(control.failed());
  control.accepted(6);
  CHECK(control.step() == (allowed == 15 ? 0.5 : 0.75));
}

TEST_CASE("marks are met exactly, whatever happens on the way",
          "[unit][step_control]")
{
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  const std::vector<double> marks{0.7, 0.123456789, 1.0 / 3, 0.70001};
  scene::Stage s = stage(1, 0.04);
  s.step_max = 0.2;
  StepControl control(s, marks, most);
  std::vector<double> times;
  while (not control.finished())
  {
    const double next = control.next();
    CHECK(next > control.time());
    // a step of 1e-5 cannot be halved above the floor of 4e-5: let only
    // larger ones fail
    if (random() % 4 == 0 and next - control.time() > 1e-3)
    {
      REQUIRE(control.failed());
      continue;
    }
    control.accepted(random() % 2 ? easy : hard);
    CHECK(control.time() == next);
    times.push_back(next);
    REQUIRE(times.size() < 1000);
  }
  for (double mark : marks)
    CHECK(std::ranges::find(times, mark) != times.end());
  CHECK(times.back() == 1);
}

TEST_CASE("what is left before a mark is shared, not left as a crumb",
          "[unit][step_control]")
{
  StepControl control(stage(1, 0.1), {0.12}, most);
  CHECK(control.next() == Approx(0.06)); // 0.12 is less than one and a half
  control.accepted(hard);
  CHECK(control.next() == 0.12);
}
