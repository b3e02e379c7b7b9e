// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Where methods fail, by the scheme: how far nodes may move, what a jump and a
// smooth extremum leave. Every scheme of the list, the naive way beside ours.

#include "remap/tests/cyclic.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr int squares = 20;
constexpr double infinite = std::numeric_limits<double>::infinity();

const cyclic::Cycle& cycle()
{
  static const auto once = cyclic::Cycle::squares(squares);
  return once;
}

/// Inner nodes in a wave of shear by so many squares.
std::vector<double> wave(double by)
{
  constexpr double pi = std::numbers::pi;
  std::vector<double> out = cycle().data.x;
  for (std::size_t i = 0; i < out.size(); i += 2)
    if (const Point p{out[i], out[i + 1]}; not meshes::on_outline(p))
      out[i] += by / squares * std::sin(pi * p.x) * std::sin(2 * pi * p.y);
  return out;
}

double mass(std::span<const double> u)
{
  std::vector<double> v(u.size());
  cell_volumes(cycle().mesh, Geometry::plane, cycle().data.x, v);
  double sum = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
    sum += v[c] * u[c];
  return sum;
}

/// What a field has gone through.
struct Trip
{
  Outcome outcome = Outcome::ok;
  int cycles = 0;
  double lowest = infinite, highest = -infinite; ///< at any time
  double mass_error = 0;                         ///< relative
};

/// So many times away and home; u in and out. Range [0, 1] where the scheme
/// needs it to keep its bounds.
Trip run(std::vector<double>& u, const Scheme& scheme, double by, int times,
         double max_loss = 0.5, bool in_range = true)
{
  Remapper remapper(cycle().mesh,
                    {.scheme = scheme,
                     .max_loss = max_loss,
                     .boundaries = std::vector(4, Boundary::closed)});
  const auto away = wave(by);
  const double zero = 0, one = 1;
  Field field{.values = u};
  if (in_range and scheme.index() == Scheme(scheme::SmoothExtrema{}).index())
    field.least = {&zero, 1}, field.most = {&one, 1};
  Ledger ledger;
  Trip out;
  const double before = mass(u);
  for (int k = 0; k < 2 * times and out.outcome == Outcome::ok; ++k)
  {
    const auto& home = cycle().data.x;
    out.outcome = remapper.remap(k % 2 ? away : home, k % 2 ? home : away,
                                 {&field, 1}, {}, {}, ledger);
    out.cycles += remapper.report().cycles;
    const auto [lowest, highest] = std::minmax_element(u.begin(), u.end());
    out.lowest = std::min(out.lowest, *lowest);
    out.highest = std::max(out.highest, *highest);
  }
  out.mass_error = std::abs(mass(u) - before) / before;
  return out;
}

std::vector<double> shock()
{
  return cyclic::means(cycle().mesh, cycle().data.x, cyclic::Function::shock);
}

/// Relative L1 error of the sine: two maxima, two minima.
double sine_error(const Scheme& scheme)
{
  auto u = cyclic::means(cycle().mesh, cycle().data.x, cyclic::Function::sine);
  const auto start = u;
  REQUIRE(run(u, scheme, 0.3, 20, 0.5, false).outcome == Outcome::ok);
  double error = 0, all = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
    error += std::abs(u[c] - start[c]), all += start[c];
  return error / all;
}
} // namespace

TEMPLATE_LIST_TEST_CASE("limiters: nodes may move by a tenth to three squares",
                        "[verification]", Schemes)
{
  const double by = GENERATE(0.1, 0.3, 1.0, 3.0);
  CAPTURE(by);
  auto u = shock();
  const Trip tame = run(u, TestType{}, by, 10);
  REQUIRE(tame.outcome == Outcome::ok);
  CHECK(tame.mass_error < 1e-13);
  CHECK(tame.cycles >= 20 * std::max(1.0, by));
  if (TestType::bounded)
  {
    CHECK(tame.lowest > -1e-13);
    CHECK(tame.highest < 1 + 1e-13);
  }
  // The naive way: one step, however far. Beyond a square it takes from volumes
  // more than they have.
  auto wild = shock();
  const Trip naive = run(wild, TestType{}, by, 10, infinite, false);
  REQUIRE(naive.outcome == Outcome::ok);
  CHECK(naive.cycles == 20);
  if (by >= 1)
    CHECK(std::max(naive.highest, -naive.lowest) > 1e3);
  else if (TestType::bounded)
    CHECK(naive.highest < 1 + 1e-13);
}

TEMPLATE_LIST_TEST_CASE("limiters: a shock", "[verification]", Schemes)
{
  auto u = shock();
  const auto start = u;
  const Trip trip = run(u, TestType{}, 0.3, 20);
  REQUIRE(trip.outcome == Outcome::ok);
  double error = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
    error += std::abs(u[c] - start[c]) / static_cast<double>(u.size());
  if (TestType::bounded)
  {
    CHECK(trip.lowest > -1e-13);
    CHECK(trip.highest < 1 + 1e-13);
  }
  else
    CHECK(std::max(-trip.lowest, trip.highest - 1) > 0.05);
  // Order 1 smears it most, whatever the limiter of order 2.
  auto smeared = shock();
  (void)run(smeared, scheme::DonorCell{}, 0.3, 20);
  double most = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
    most += std::abs(smeared[c] - start[c]) / static_cast<double>(u.size());
  if (TestType::linear)
    CHECK(error < 0.9 * most);
}

TEST_CASE("limiters: smooth extrema lose by the scheme", "[verification]")
{
  const double donor = sine_error(scheme::DonorCell{});
  const double minmod = sine_error(scheme::Minmod{});
  const double van_leer = sine_error(scheme::VanLeer{});
  const double venkatakrishnan = sine_error(scheme::Venkatakrishnan{});
  const double barth_jespersen = sine_error(scheme::BarthJespersen{});
  const double limited = sine_error(scheme::LimitedLinear{});
  const double smooth = sine_error(scheme::SmoothExtrema{});
  const double linear = sine_error(scheme::Linear{});
  CAPTURE(donor, minmod, van_leer, venkatakrishnan, barth_jespersen, limited,
          smooth, linear);
  CHECK(minmod < donor);
  CHECK(van_leer < minmod);
  CHECK(venkatakrishnan < van_leer);
  CHECK(limited < venkatakrishnan);
  CHECK(limited <= barth_jespersen);
  // What a limiter clips is what it costs beyond the scheme without one.
  CHECK(smooth < limited);
  CHECK(smooth < 1.2 * linear);
}
