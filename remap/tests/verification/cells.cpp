// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Where methods fail, by the shape of cells and of swept regions: flat and
// leaning cells, cells that are nearly empty, regions that cross themselves.
// The naive way beside ours.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
constexpr int n = 10;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Means of f over the cells, exact for linear f.
template <class F>
std::vector<double> at_centroids(const Mesh& mesh, std::span<const double> x,
                                 F&& f)
{
  std::vector<double> u(mesh.num_cells());
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Triple& v = mesh.cell(c);
    u[c] = f(1.0 / 3 * (point(x, v[0]) + point(x, v[1]) + point(x, v[2])));
  }
  return u;
}

double total(const Mesh& mesh, std::span<const double> x,
             std::span<const double> u)
{
  std::vector<double> v(u.size());
  cell_volumes(mesh, Geometry::plane, x, v);
  double sum = 0;
  for (std::size_t c = 0; c < u.size(); ++c)
    sum += v[c] * u[c];
  return sum;
}

double farthest(std::span<const double> a, std::span<const double> b)
{
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

/// Outcome and range of one remap; u in and out.
struct Ran
{
  Outcome outcome;
  int cycles;
  double lowest, highest;
};

Ran remap_once(const Mesh& mesh, std::span<const double> from,
               std::span<const double> to, std::vector<double>& u,
               const Scheme& scheme, double max_loss = 0.5)
{
  Remapper remapper(mesh, {.scheme = scheme,
                           .max_loss = max_loss,
                           .boundaries = std::vector(4, Boundary::closed)});
  // One that gives way at smooth extrema is told the range.
  static constexpr double least = 0, most = 1;
  const bool range = scheme.index() == Scheme(scheme::SmoothExtrema{}).index();
  const std::span<const double> none;
  const Field field{.values = u,
                    .least = range ? std::span(&least, 1) : none,
                    .most = range ? std::span(&most, 1) : none};
  Ledger ledger;
  const Outcome outcome = remapper.remap(from, to, {&field, 1}, {}, {}, ledger);
  return {outcome, remapper.report().cycles,
          *std::min_element(u.begin(), u.end()),
          *std::max_element(u.begin(), u.end())};
}
} // namespace

TEST_CASE("cells: flat and leaning cells keep a linear field", "[verification]")
{
  const double flat = GENERATE(1.0, 1e-1, 1e-2, 1e-3, 1e-4);
  const double lean = GENERATE(0.0, 0.7, 3.0);
  CAPTURE(flat, lean);
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  // Flattened, then sheared: neighbours stand nearly on one line.
  const auto squeezed = [&](std::vector<double> x)
  {
    for (std::size_t i = 0; i < x.size(); i += 2)
    {
      x[i + 1] *= flat;
      x[i] += lean * x[i + 1];
    }
    return x;
  };
  const auto from = squeezed(meshes::shaken(data.x, 0.15 / n, 1));
  const auto to = squeezed(meshes::shaken(data.x, 0.15 / n, 2));
  // As steep across the flat cells as along them.
  const auto f = [flat](Point p) { return 1 + 0.5 * p.x - p.y / flat; };
  const auto exact = at_centroids(mesh, to, f);

  auto u = at_centroids(mesh, from, f);
  REQUIRE(remap_once(mesh, from, to, u, scheme::Linear{}).outcome
          == Outcome::ok);
  // A gradient's round-off grows with the aspect ratio.
  CHECK(farthest(u, exact) < 1e-14 / flat);

  // The naive way: no gradient at all.
  auto mean = at_centroids(mesh, from, f);
  REQUIRE(remap_once(mesh, from, to, mean, scheme::DonorCell{}).outcome
          == Outcome::ok);
  CHECK(farthest(mean, exact) > 1e-3);
}

TEMPLATE_LIST_TEST_CASE("cells: flat cells keep the bounds of a jump",
                        "[verification]", Schemes)
{
  const double flat = GENERATE(1.0, 1e-2, 1e-4);
  CAPTURE(flat);
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  auto from = meshes::shaken(data.x, 0.2 / n, 1);
  auto to = meshes::shaken(data.x, 0.2 / n, 2);
  for (auto* x : {&from, &to})
    for (std::size_t i = 1; i < x->size(); i += 2)
      (*x)[i] *= flat;
  auto u = at_centroids(mesh, from, [flat](Point p)
                        { return p.x + p.y / flat < 1 ? 0.0 : 1.0; });
  const double before = total(mesh, from, u);
  double lowest = 0, highest = 1;
  for (int k = 0; k < 20; ++k)
  {
    const Ran r =
        remap_once(mesh, k % 2 ? to : from, k % 2 ? from : to, u, TestType{});
    REQUIRE(r.outcome == Outcome::ok);
    lowest = std::min(lowest, r.lowest);
    highest = std::max(highest, r.highest);
  }
  CHECK(total(mesh, from, u) == Approx(before).epsilon(1e-13));
  if (TestType::bounded)
  {
    CHECK(lowest > -1e-12);
    CHECK(highest < 1 + 1e-12);
  }
  else
    CHECK(std::max(-lowest, highest - 1) > 0.01);
}

namespace
{
/// One inner node moved until the smallest cell around it has this part of its
/// volume, aside by half a square as well, so that its cells lose more than
/// they have.
std::vector<double> pinched(const meshes::Data& data, double part)
{
  auto x = data.x;
  constexpr int middle = n / 2 * (n + 1) + n / 2;
  x[2 * middle] += 0.4 / n;
  x[2 * middle + 1] += (1 - part) / n;
  return x;
}
} // namespace

TEST_CASE("cells: a cell that is nearly emptied, and filled again",
          "[verification]")
{
  const double part = GENERATE(1e-2, 1e-6, 1e-10);
  const double max_loss = GENERATE(0.5, 0.999);
  CAPTURE(part, max_loss);
  const meshes::Data plain = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = plain.mesh();
  const auto to = pinched(plain, part);
  auto u = at_centroids(mesh, plain.x,
                        [](Point p) { return p.y < 0.55 ? 1.0 : 0.0; });
  const double before = total(mesh, plain.x, u);
  const Ran away =
      remap_once(mesh, plain.x, to, u, scheme::LimitedLinear{}, max_loss);
  REQUIRE(away.outcome == Outcome::ok);
  CAPTURE(away.cycles);
  CHECK(away.lowest > -1e-12);
  CHECK(away.highest < 1 + 1e-12);
  CHECK(total(mesh, to, u) == Approx(before).epsilon(1e-13));
  const Ran home =
      remap_once(mesh, to, plain.x, u, scheme::LimitedLinear{}, max_loss);
  CAPTURE(home.cycles);
  REQUIRE(home.outcome == Outcome::ok);
  CHECK(home.lowest > -1e-12);
  CHECK(home.highest < 1 + 1e-12);
  CHECK(total(mesh, plain.x, u) == Approx(before).epsilon(1e-13));
}

TEST_CASE("cells: a cell that would be emptied is told, nothing is lost",
          "[verification]")
{
  const double part = GENERATE(0.0, -1e-10, -0.5);
  CAPTURE(part);
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto to = pinched(data, part);
  auto u = at_centroids(mesh, data.x, [](Point p) { return 1 + p.x; });
  const auto start = u;
  CHECK(remap_once(mesh, data.x, to, u, scheme::LimitedLinear{}).outcome
        == Outcome::inverted_target);
  CHECK(u == start);
}

TEST_CASE("cells: a facet that turns exchanges what its net volume hides",
          "[verification]")
{
  // A jump stands on the line x = 1/2, all facets of the line carry it. One of
  // them turns about its middle: it sweeps two triangles of opposite signs.
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::right);
  const Mesh mesh = data.mesh();
  constexpr double h = 1.0 / n, shift = 0.3 * h;
  constexpr int low = 4 * (n + 1) + n / 2, high = low + n + 1;
  auto to = data.x;
  to[2 * low] += shift;
  to[2 * high] -= shift;
  std::int32_t left = -1;
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (const auto [p, q] = mesh.facet(f);
        std::minmax(p, q) == std::minmax<std::int32_t>(low, high))
    {
      const auto [a, b] = mesh.facet_cells(f);
      const auto x_of = [&](std::int32_t c)
      {
        double sum = 0;
        for (std::int32_t node : mesh.cell(c))
          sum += data.x[2 * node];
        return sum;
      };
      left = x_of(a) < x_of(b) ? a : b;
    }
  REQUIRE(left >= 0);
  auto u =
      at_centroids(mesh, data.x, [](Point p) { return p.x < 0.5 ? 1.0 : 0.0; });
  REQUIRE(remap_once(mesh, data.x, to, u, scheme::DonorCell{}, infinite).outcome
          == Outcome::ok);
  // Its third vertex is beside `high`: beyond x = 1/2 the new cell has a
  // triangle with half the facet and, at the level of `low`, less than shift.
  std::vector<double> v(mesh.num_cells());
  cell_volumes(mesh, Geometry::plane, to, v);
  // Its part beyond the line, cut off by hand: the vertex at `low` stands
  // `shift` beyond, the other two before it.
  const Triple& nodes = mesh.cell(left);
  double out = v[left];
  for (std::int32_t node : nodes)
    if (node != low)
      out *= shift / (shift + 0.5 - to[2 * node]);
  CHECK(u[left] == Approx((v[left] - out) / v[left]).epsilon(1e-12));

  // The naive way books the net volume of the facet, which is nothing.
  const Moments net =
      swept<Geometry::plane>({point(data.x, low), point(data.x, high),
                              point(to, low), point(to, high)});
  CHECK(std::abs(net.v) < 1e-16);
  CHECK(out > 0.05 * v[left]);
}

TEST_CASE("cells: facets that turn keep a linear field", "[verification]")
{
  // Each node of a line of facets goes the other way than its neighbours, so
  // that all of them cross themselves.
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  auto to = data.x;
  for (std::size_t i = 0; i < to.size(); i += 2)
    if (not meshes::on_outline({to[i], to[i + 1]}))
    {
      const auto k = static_cast<int>(i / 2);
      const double sign = (k % (n + 1) + k / (n + 1)) % 2 ? 1 : -1;
      to[i] += 0.2 / n * sign;
      to[i + 1] -= 0.15 / n * sign;
    }
  const auto f = [](Point p) { return 2 + p.x - 3 * p.y; };
  auto u = at_centroids(mesh, data.x, f);
  REQUIRE(remap_once(mesh, data.x, to, u, scheme::Linear{}, infinite).outcome
          == Outcome::ok);
  CHECK(farthest(u, at_centroids(mesh, to, f)) < 1e-13);
  // One donor for the whole region, at its centroid, is no longer in it.
  bool outside = false;
  for (std::int32_t i = 0; i < mesh.num_facets(); ++i)
  {
    const auto [p, q] = mesh.facet(i);
    const Moments all = swept<Geometry::plane>(
        {point(data.x, p), point(data.x, q), point(to, p), point(to, q)});
    if (all.v == 0)
      continue;
    const Point d = all.centroid() - middle(point(data.x, p), point(data.x, q));
    outside = outside or dot(d, d) > 4.0 / (n * n);
  }
  CHECK(outside);
}
