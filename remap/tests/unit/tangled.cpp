// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Where smoothing fails: the naive way beside ours.

#include "remap/smoothing/smooth.h"
#include "remap/smoothing/untangle.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// Boundary nodes fixed, others free.
std::vector<Kind> inner_free(const Mesh& mesh)
{
  std::vector<Kind> out(mesh.num_nodes(), Kind::free);
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (mesh.on_boundary(f))
      for (std::int32_t i : mesh.facet(f))
        out[i] = Kind::fixed;
  return out;
}

/// Over a steep hill: the domain is not convex.
meshes::Data over_hill(int n)
{
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  for (std::size_t i = 0; i < data.x.size(); i += 2)
  {
    const double s = (data.x[i] - 0.5) / 0.12;
    const double foot = 0.7 * std::exp(-s * s);
    data.x[i + 1] = foot + data.x[i + 1] * (1 - foot);
  }
  return data;
}

double worst(const Mesh& mesh, std::span<const double> x)
{
  return worst_quality(mesh, x, Measure::radius_ratio, {}, {});
}

/// Every node to the mean of its neighbours, unasked.
void plain_laplace(const Mesh& mesh, std::span<const Kind> kinds,
                   std::span<double> x, int sweeps)
{
  for (int k = 0; k < sweeps; ++k)
    for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
      if (kinds[i] == Kind::free)
      {
        Point sum{};
        for (std::int32_t j : mesh.node_nodes()[i])
          sum = sum + point(x, j);
        const double count = static_cast<double>(mesh.node_nodes()[i].size());
        x[2 * i] = sum.x / count;
        x[2 * i + 1] = sum.y / count;
      }
}
} // namespace

TEST_CASE("plain averaging inverts cells of a domain that is not convex",
          "[smoothing][limits]")
{
  const meshes::Data data = over_hill(20);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  REQUIRE(worst(mesh, data.x) > 0);
  auto x = data.x;
  plain_laplace(mesh, kinds, x, 50);
  CHECK(worst(mesh, x) < -0.1);
}

TEMPLATE_LIST_TEST_CASE("ours does not, and makes them better",
                        "[smoothing][limits]", Smoothers)
{
  const meshes::Data data = over_hill(20);
  const Mesh mesh = data.mesh();
  const auto kinds = inner_free(mesh);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  auto x = data.x;
  Smoothing smoothing(mesh, {.smoother = TestType{}, .sweeps = 50}, {});
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds}, {}) == Outcome::ok);
  CHECK(worst(mesh, x) >= worst(mesh, data.x));
  CHECK(x != data.x);
}
