// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Cyclic remap: 80 remaps of 4050 triangles that end where they began, beside
// what Portage leaves on 4096 quadrilaterals with its exact intersection and
// its Barth-Jespersen limiter.

#include "remap/tests/cyclic.h"

#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <limits>

using namespace remap;
using cyclic::Cycle;
using cyclic::Function;
using cyclic::Path;

namespace
{
constexpr int squares = 45, steps = 80;

/// Relative L1 errors of Portage (d1f27b6, with wonton c3e50a6 and r3d
/// c633d1d), measured: rows sine, peak, shock; columns tensor, smooth, random.
constexpr double portage[3][3] = {{4.10e-3, 1.64e-3, 4.37e-3},
                                  {1.08e-1, 7.30e-2, 8.90e-2},
                                  {3.79e-2, 1.76e-2, 3.06e-2}};

double anchor(Function f, Path m)
{
  return portage[static_cast<int>(f)][static_cast<int>(m)];
}

const Cycle& cycle()
{
  static const Cycle once = Cycle::squares(squares);
  return once;
}

cyclic::Result run(const Scheme& scheme, Path m, Function f,
                   double max_loss = 0.999, Method method = Method::swept)
{
  return cycle().run(m, f, steps,
                     {.method = method, .scheme = scheme, .max_loss = max_loss},
                     scheme.index() == Scheme(scheme::SmoothExtrema{}).index());
}
} // namespace

TEST_CASE("cyclic: means of the functions add up to their integrals",
          "[verification]")
{
  // 1 + sine; cone of height 1 on a step of height 1, radius 1/4, 0.001
  // outside; width 0.6 − 0.3 y below the line.
  constexpr double pi = std::numbers::pi;
  constexpr double exact[3] = {1, pi / 12 + 0.001 * (1 - pi / 16), 0.45};
  // The peak's step is cut by parts of a cell: 1 in 24 of h.
  constexpr double slack[3] = {1e-9, 1e-4, 1e-14};
  std::vector<double> v(cycle().mesh.num_cells());
  cell_volumes(cycle().mesh, Geometry::plane, cycle().data.x, v);
  for (Function f : cyclic::functions)
  {
    const auto u = cyclic::means(cycle().mesh, cycle().data.x, f);
    double sum = 0;
    for (std::size_t c = 0; c < u.size(); ++c)
      sum += v[c] * u[c];
    INFO(cyclic::name(f));
    CHECK(std::abs(sum - exact[static_cast<int>(f)])
          < slack[static_cast<int>(f)]);
  }
}

TEST_CASE("cyclic: errors are at most Portage's", "[verification]")
{
  const auto path = GENERATE(from_range(cyclic::paths));
  const auto function = GENERATE(from_range(cyclic::functions));
  INFO(cyclic::name(function) << " on " << cyclic::name(path));
  // On tensor nodes move by more than a cell: the overlay goes in one step as
  // theirs does; some four sub-cycles of swept regions smear a jump a little
  // more.
  const bool far = path == Path::tensor;
  const auto r = run(scheme::LimitedLinear{}, path, function, 0.999,
                     far ? Method::overlay : Method::swept);
  REQUIRE(r.outcome == Outcome::ok);
  CHECK(r.error <= anchor(function, path));
  if (far)
    CHECK(run(scheme::LimitedLinear{}, path, function).error
          <= 1.2 * anchor(function, path));
  CHECK(std::abs(r.mass_error) < 1e-13);
  const auto [least, most] = cyclic::range(function);
  // Round-off of some 300 sub-cycles.
  CHECK(r.lowest >= least - 1e-13);
  CHECK(r.highest <= most + 1e-13);
}

TEMPLATE_LIST_TEST_CASE("cyclic: bounds and mass, every scheme",
                        "[verification]", Schemes)
{
  // Tensor moves nodes by more than a cell: sub-cycling must save it.
  const auto r = run(TestType{}, Path::tensor, Function::shock);
  REQUIRE(r.outcome == Outcome::ok);
  CHECK(r.cycles > 2 * steps);
  CHECK(std::abs(r.mass_error) < 1e-13);
  if (TestType::bounded)
  {
    CHECK(r.lowest >= -1e-13);
    CHECK(r.highest <= 1 + 1e-13);
  }
  else
  {
    CHECK(r.lowest < -0.02);
    CHECK(r.highest > 1.02);
  }
}

TEST_CASE("cyclic: bounds cost a smooth field little", "[verification]")
{
  // Portage's limiter multiplies the error of the sine on tensor by 4.8.
  const auto free = run(scheme::Linear{}, Path::tensor, Function::sine);
  const auto bounded =
      run(scheme::LimitedLinear{}, Path::tensor, Function::sine);
  const auto smooth =
      run(scheme::SmoothExtrema{}, Path::tensor, Function::sine);
  CHECK(bounded.error < 2 * free.error);
  CHECK(smooth.error < bounded.error);
  CHECK(smooth.error < 1.6 * free.error);
}

TEST_CASE("cyclic: swept volumes beyond a cell blow up, sub-cycles save them",
          "[verification]")
{
  const auto wild = run(scheme::LimitedLinear{}, Path::tensor, Function::shock,
                        std::numeric_limits<double>::max());
  const auto tame = run(scheme::LimitedLinear{}, Path::tensor, Function::shock);
  REQUIRE(tame.outcome == Outcome::ok);
  CHECK((wild.outcome != Outcome::ok or wild.highest > 1e3));
  CHECK(wild.cycles <= steps);
  CHECK(tame.error < 0.1);
}
