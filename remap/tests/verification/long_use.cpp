// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What a million remaps leave of mass, of a constant and of bounds, on the
// smallest mesh where all of them can fail: inner nodes, a jump, moves beyond
// one sub-cycle. In CI one in a hundred of them.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>

using namespace remap;
using meshes::Diagonal;

namespace
{
constexpr int n = 4;

/// Ends of a long run to and fro between two shaken meshes.
struct Drift
{
  double mass = 0;     ///< relative
  double constant = 0; ///< farthest from 1 of a field that was 1
  double beyond = 0;   ///< farthest out of [1, 2] of a jump, at any time
  int cycles = 0;      ///< sub-cycles of the last remap
};

Drift run(int remaps, const Scheme& scheme)
{
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto a = meshes::shaken(data.x, 0.3 / n, 1);
  const auto b = meshes::shaken(data.x, 0.3 / n, 2);
  // Two fields in one sweep: a constant and a jump.
  std::vector<double> one(mesh.num_cells(), 1.0), jump(mesh.num_cells());
  std::vector<double> v(mesh.num_cells());
  cell_volumes(mesh, Geometry::plane, a, v);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    jump[c] = data.x[2 * mesh.cell(c)[0]] < 0.4 ? 1 : 2;
  const auto mass = [&]
  {
    double sum = 0;
    for (std::size_t c = 0; c < v.size(); ++c)
      sum += v[c] * jump[c];
    return sum;
  };
  const double before = mass();
  Remapper remapper(
      mesh, {.scheme = scheme, .boundaries = std::vector(4, Boundary::closed)});
  const std::array fields = {Field{.values = one}, Field{.values = jump}};
  Ledger ledger;
  Drift out;
  for (int k = 0; k < remaps; ++k)
  {
    REQUIRE(remapper.remap(k % 2 ? b : a, k % 2 ? a : b, fields, {}, {}, ledger)
            == Outcome::ok);
    const auto [lowest, highest] =
        std::minmax_element(jump.begin(), jump.end());
    out.beyond = std::max({out.beyond, 1 - *lowest, *highest - 2});
  }
  out.cycles = remapper.report().cycles;
  out.mass = std::abs(mass() - before) / before;
  for (const double value : one)
    out.constant = std::max(out.constant, std::abs(value - 1));
  return out;
}

/// Bounds on what round-off may do: it adds up like a random walk.
void hold(const Drift& drift, int remaps)
{
  const double walk = std::sqrt(4.0 * remaps);
  CHECK(drift.cycles > 1);
  CHECK(drift.mass < 1e-15 * walk);
  CHECK(drift.constant < 1e-15 * walk);
  CHECK(drift.beyond < 1e-15 * walk);
}
} // namespace

TEST_CASE("long use: ten thousand remaps keep mass, constant and bounds",
          "[verification]")
{
  hold(run(10000, scheme::LimitedLinear{}), 10000);
  // Without a limiter the first remaps leave the bounds already.
  CHECK(run(100, scheme::Linear{}).beyond > 0.02);
}

TEST_CASE("long use: a million remaps keep mass, constant and bounds",
          "[verification][slow]")
{
  hold(run(1000000, scheme::LimitedLinear{}), 1000000);
}
