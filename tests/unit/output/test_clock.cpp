// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/clock.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>

using namespace mmale::output;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace
{
void sleep_ms(int n)
{
  std::this_thread::sleep_for(std::chrono::milliseconds(n));
}
} // namespace

TEST_CASE("clock: a step's time holds that of the steps nested in it")
{
  Clock clock;
  {
    const auto step = clock.scope("1 lagrangian");
    for (int i = 0; i < 3; ++i)
    {
      const auto part = clock.scope("1a law and assembly");
      sleep_ms(10);
    }
    sleep_ms(10);
  }
  const double wall = clock.wall();
  const std::vector<Timing> t = clock.timings(1000);
  REQUIRE(t.size() == 2);
  CHECK(t[0].name == "1 lagrangian");
  CHECK(t[0].calls == 1);
  CHECK(t[1].calls == 3);
  // A sleep may last longer than asked, never shorter.
  CHECK(t[1].seconds >= 0.030);
  CHECK(t[0].seconds >= t[1].seconds + 0.010);
  CHECK(t[0].seconds <= wall);
  CHECK(t[1].cells_per_second <= 3000 / 0.030);
  CHECK(t[1].cells_per_second >= 3000 / wall);
}

TEST_CASE("clock: a step that calls itself is not timed twice")
{
  Clock clock;
  {
    const auto outer = clock.scope("3 transport");
    const auto inner = clock.scope("3 transport");
    sleep_ms(20);
  }
  const double wall = clock.wall();
  const std::vector<Timing> t = clock.timings(1);
  REQUIRE(t.size() == 1);
  CHECK(t[0].calls == 2);
  CHECK(t[0].seconds >= 0.020);
  CHECK(t[0].seconds <= wall);
}

TEST_CASE("clock: a step left by a throw is stopped")
{
  Clock clock;
  try
  {
    const auto step = clock.scope("2 smooth");
    throw std::runtime_error("");
  }
  catch (const std::runtime_error&)
  {
  }
  const double before = clock.timings(1)[0].seconds;
  sleep_ms(20);
  CHECK(clock.timings(1)[0].seconds == before);
}

TEST_CASE("clock: the slowest rank's seconds count")
{
  Clock clock;
  {
    const auto step = clock.scope("5 output");
  }
  // Stands for a rank that took 3 s of 4 s with the same one timer.
  int call = 0;
  const auto t = clock.timings(10,
                               [&](std::span<double> x)
                               {
                                 if (call++ == 0)
                                 {
                                   REQUIRE(x.size() == 3);
                                   CHECK(x[0] == 1);
                                   CHECK(x[1] == -1);
                                   x[2] = std::max(x[2], 4.0);
                                 }
                                 else
                                   x[0] = std::max(x[0], 3.0);
                               });
  CHECK(t[0].seconds == 3.0);
  CHECK(t[0].share == Approx(0.75));
  CHECK_THROWS_WITH(clock.timings(10, [](std::span<double> x)
                                  { x[0] = std::max(x[0], 2.0); }),
                    ContainsSubstring("different steps"));
}

TEST_CASE("clock: a scope costs next to nothing")
{
  Clock clock;
  for (const char* name :
       {"1 lagrangian", "1a law and assembly", "1b factorise and solve",
        "2 smooth", "3 transport", "4 admissible"})
    const auto step = clock.scope(name);
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i)
    const auto step = clock.scope("5 output");
  const double each = clock.wall() / n;
  INFO(each * 1e9 << " ns");
  // Two looks at the steady clock are 50 ns; 20 times that leaves room for
  // sanitizers and a busy machine and still finds an allocation or a lock.
  CHECK(each < 1e-6);
}

TEST_CASE("clock: the table adds up to the whole run")
{
  const std::vector<Timing> t = {{.name = "1 lagrangian",
                                  .seconds = 6,
                                  .share = 0.6,
                                  .calls = 2,
                                  .cells_per_second = 5},
                                 {.name = "1a law and assembly",
                                  .seconds = 4,
                                  .share = 0.4,
                                  .calls = 20,
                                  .cells_per_second = 7},
                                 {.name = "3 transport",
                                  .seconds = 1,
                                  .share = 0.1,
                                  .calls = 2,
                                  .cells_per_second = 9}};
  const std::string text = table(t, 10.0);
  CHECK_THAT(text, ContainsSubstring("  1a law and assembly"));
  // 10 - 6 - 1: the part 1a is inside 1.
  CHECK_THAT(text, ContainsSubstring("other                               3.000"
                                     "   30.0 %"));
}

TEST_CASE("clock: a resumed run counts on from what was timed before")
{
  Clock clock;
  {
    const auto step = clock.scope("2 smooth");
  }
  const std::vector<Timing> before = {
      {.name = "1 lagrangian", .seconds = 100, .calls = 7},
      {.name = "2 smooth", .seconds = 50, .calls = 3}};
  clock.add(before, 200);
  const auto t = clock.timings(1);
  REQUIRE(t.size() == 2);
  CHECK(t[0].calls == 7);
  CHECK(t[1].calls == 4);
  // the empty scope adds next to nothing
  CHECK(t[0].seconds == Approx(100));
  CHECK(t[1].seconds == Approx(50).epsilon(1e-3));
  CHECK(clock.wall() == Approx(200).epsilon(1e-2));
}
