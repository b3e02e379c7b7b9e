// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/scene.h"
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

using mmale::scene::TimeSeries;

TEST_CASE("time series: a constant holds at any time", "[scene]")
{
  const TimeSeries series = {{}, {3.5}};
  for (double t : {-1.0, 0.0, 7.0})
    CHECK(series(t) == 3.5);
  CHECK(series.integral(4) == 14.0);
  CHECK(series.integral(0) == 0.0);
}

TEST_CASE("time series: linear between its times, held outside", "[scene]")
{
  const TimeSeries series = {{1, 3, 4}, {10, 20, -4}};
  CHECK(series(0) == 10);
  CHECK(series(1) == 10);
  CHECK(series(1.5) == 12.5);
  CHECK(series(3) == 20);
  CHECK(series(3.25) == 14);
  CHECK(series(4) == -4);
  CHECK(series(9) == -4);
}

TEST_CASE("time series: one pair of numbers is a constant", "[scene]")
{
  const TimeSeries series = {{2}, {7}};
  CHECK(series(0) == 7);
  CHECK(series(5) == 7);
  CHECK(series.integral(3) == 21);
}

TEST_CASE("time series: the integral is the area under the line", "[scene]")
{
  // Areas by hand: 10 to t = 1; a trapezoid of mean 15 and length 2; one of
  // mean 8 and length 1; then -4 a second.
  const TimeSeries series = {{1, 3, 4}, {10, 20, -4}};
  CHECK(series.integral(0.5) == 5);
  CHECK(series.integral(1) == 10);
  CHECK(series.integral(2) == 22.5); // mean of 10 and 15 over 1 s
  CHECK(series.integral(3) == 40);
  CHECK(series.integral(3.5) == 47); // mean of 20 and 8 over 0.5 s
  CHECK(series.integral(4) == 48);
  CHECK(series.integral(6) == 40);
}

TEST_CASE("time series: a ramp that starts at 0 has no plateau before it",
          "[scene]")
{
  const TimeSeries series = {{0, 2}, {0, 6}};
  CHECK(series(1) == 3);
  CHECK(series.integral(2) == 6);
  CHECK(series.integral(3) == 12);
}

TEST_CASE("time series: a sine about a mean, and its exact integral", "[scene]")
{
  const TimeSeries series = {.time = {},
                             .value = {3},
                             .amplitude = 2,
                             .frequency = 0.25,
                             .phase_deg = 90}; // 3 + 2 cos(pi t / 2)
  CHECK(std::abs(series(0) - 5) < 1e-15);
  CHECK(std::abs(series(1) - 3) < 1e-15);
  CHECK(std::abs(series(2) - 1) < 1e-15);
  CHECK(series.integral(0) == 0);
  const double area = 4 / std::numbers::pi; // of a quarter of the wave
  CHECK(std::abs(series.integral(1) - (3 + area)) < 1e-14);
  CHECK(std::abs(series.integral(2) - 6) < 1e-14);
  CHECK(std::abs(series.integral(4) - 12) < 1e-14);
  CHECK(std::abs(series.integral(1e-9) / 5e-9 - 1) < 1e-15);
}
