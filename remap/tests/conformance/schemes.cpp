// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What every transport scheme owes, in plane and axisymmetry, over cells and
// over dual volumes, on random meshes with random moves.

#include "remap/remap.h"
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
constexpr int n = 12;
constexpr double h = 1.0 / n;

/// A random mesh on the unit square and a random move; both over cells and
/// nodes.
struct Case
{
  Geometry geometry;
  Diagonal diagonal;
  unsigned seed;
  double by; ///< largest shift of a node, in parts of h
  bool moving_boundary = false;

  /// Largest shift that inverts nothing, whatever the diagonals.
  [[nodiscard]] double shift(double part) const
  {
    return part * h * (diagonal == Diagonal::four ? 0.5 : 1.0);
  }
  meshes::Data data = meshes::rectangle(n, n, diagonal);
  Mesh mesh = data.mesh();
  std::vector<double> from = meshes::shaken(data.x, shift(0.2), seed);
  std::vector<double> to = target();

  [[nodiscard]] std::vector<double> target() const
  {
    std::vector<double> out = meshes::shaken(data.x, shift(by), seed + 1000);
    if (moving_boundary)
      for (std::size_t i = 0; i < out.size(); i += 2)
        out[i] *= 1.01, out[i + 1] *= 0.995;
    return out;
  }

  [[nodiscard]] std::size_t size(bool dual) const
  {
    return dual ? mesh.num_nodes() : mesh.num_cells();
  }

  void volumes(bool dual, std::span<const double> x, std::vector<double>& v,
               std::vector<double>& c) const
  {
    v.resize(size(dual));
    c.resize(2 * size(dual));
    if (dual)
      dual_volumes(mesh, geometry, x, v, c);
    else
      cell_volumes(mesh, geometry, x, v, c);
  }

  /// Remap one field; returns the report of the remapper.
  Report run(bool dual, Scheme scheme, std::vector<double>& u, int components,
             int group, Ledger& ledger, double max_loss = 0.5) const
  {
    Remapper remapper(mesh,
                      {.geometry = geometry,
                       .scheme = scheme,
                       .nodal_scheme = scheme,
                       .max_loss = max_loss,
                       .boundaries = std::vector(4, Boundary::free_surface),
                       .cell_components = components,
                       .nodal_components = components});
    const Field field{.values = u, .components = components, .group = group};
    const std::span<const Field> one(&field, 1), none;
    REQUIRE(remapper.remap(from, to, dual ? none : one, dual ? one : none, {},
                           ledger)
            == Outcome::ok);
    return remapper.report();
  }
};

std::vector<double> random_field(std::size_t size, unsigned seed, double lo,
                                 double hi)
{
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> draw(lo, hi);
  std::vector<double> u(size);
  std::generate(u.begin(), u.end(), [&] { return draw(engine); });
  return u;
}

double integral(const std::vector<double>& v, const std::vector<double>& u)
{
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    sum += v[i] * u[i];
  return sum;
}

Case draw_case(double by, bool moving_boundary = false)
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto diagonal =
      GENERATE(Diagonal::right, Diagonal::crossed, Diagonal::four);
  const auto seed = GENERATE(1u, 2u, 3u);
  return {geometry, diagonal, seed, by, moving_boundary};
}
} // namespace

TEMPLATE_LIST_TEST_CASE("scheme: a uniform field stays uniform",
                        "[conformance]", Schemes)
{
  const Case k = draw_case(0.2, GENERATE(false, true));
  const bool dual = GENERATE(false, true);
  INFO("seed " << k.seed);
  std::vector<double> u(k.size(dual), 3.7);
  Ledger ledger;
  k.run(dual, TestType{}, u, 1, 1, ledger);
  for (double one : u)
    CHECK(one == Approx(3.7).epsilon(2e-14)); // some ten sums a volume
}

TEMPLATE_LIST_TEST_CASE("scheme: mass and momentum are kept, or booked",
                        "[conformance]", Schemes)
{
  const Case k = draw_case(0.2, GENERATE(false, true));
  const bool dual = GENERATE(false, true);
  INFO("seed " << k.seed);
  auto u = random_field(3 * k.size(dual), k.seed, 1, 2);
  const auto u0 = u;
  Ledger ledger;
  k.run(dual, TestType{}, u, 3, 1, ledger);
  std::vector<double> v0, v1, c;
  k.volumes(dual, k.from, v0, c);
  k.volumes(dual, k.to, v1, c);
  const auto& book = dual ? ledger.nodes : ledger.cells;
  REQUIRE(book.size() == 3);
  for (int j = 0; j < 3; ++j)
  {
    double before = 0, after = 0;
    for (std::size_t i = 0; i < v0.size(); ++i)
    {
      before += v0[i] * u0[3 * i + j];
      after += v1[i] * u[3 * i + j];
    }
    CHECK(std::abs(after - before - net(book[j])) < 1e-13 * before);
    CHECK((std::abs(net(book[j])) > 1e-4) == k.moving_boundary);
  }
  const Exchange& volume = dual ? ledger.node_volume : ledger.cell_volume;
  const std::vector<double> ones(v0.size(), 1.0);
  CHECK(std::abs(integral(v1, ones) - integral(v0, ones) - net(volume))
        < 1e-13);
}

TEMPLATE_LIST_TEST_CASE("scheme: linear fields are exact without a limiter",
                        "[conformance]", Schemes)
{
  if constexpr (TestType::linear and not TestType::bounded)
  {
    const Case k = draw_case(0.2);
    const bool dual = GENERATE(false, true);
    INFO("seed " << k.seed);
    const auto f = [](double x, double y) { return 2 + 3 * x - 5 * y; };
    std::vector<double> v, c;
    k.volumes(dual, k.from, v, c);
    std::vector<double> u(k.size(dual));
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = f(c[2 * i], c[2 * i + 1]);
    Ledger ledger;
    k.run(dual, TestType{}, u, 1, 1, ledger);
    k.volumes(dual, k.to, v, c);
    for (std::size_t i = 0; i < u.size(); ++i)
      CHECK(u[i] == Approx(f(c[2 * i], c[2 * i + 1])).margin(2e-13));
  }
}

TEMPLATE_LIST_TEST_CASE("scheme: bounded schemes keep the bounds of neighbours",
                        "[conformance]", Schemes)
{
  // One that gives way at smooth extrema keeps a range that it is given: below.
  if constexpr (TestType::bounded and not TestType::limiter::extends)
  {
    // Strong moves; a volume may lose nearly all of itself in one sub-cycle.
    const Case k = draw_case(0.3, GENERATE(false, true));
    const bool dual = GENERATE(false, true);
    const double max_loss = GENERATE(0.5, 0.999);
    INFO("seed " << k.seed << " dual " << dual << " loss " << max_loss);
    // Jumps from 0 to 1, and noise on top.
    auto u = random_field(k.size(dual), k.seed, -0.2, 1.2);
    for (double& one : u)
      one = std::clamp(one, 0.0, 1.0);
    const auto u0 = u;
    Ledger ledger;
    const Report report = k.run(dual, TestType{}, u, 1, 1, ledger, max_loss);
    const auto& near = dual ? k.mesh.node_nodes() : k.mesh.cell_cells();
    constexpr double round_off = 1e-14;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      double lo = u0[i], hi = u0[i];
      // One sub-cycle: donors are neighbours, and take from theirs.
      for (std::int32_t j : near[i])
        for (std::int32_t l : near[j])
        {
          lo = std::min({lo, u0[j], u0[l]});
          hi = std::max({hi, u0[j], u0[l]});
        }
      if (report.cycles > 1)
        lo = 0, hi = 1;
      CHECK(u[i] >= lo - round_off);
      CHECK(u[i] <= hi + round_off);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("scheme: a range is kept, and the integral with it",
                        "[conformance]", Schemes)
{
  // Bounded schemes keep it by themselves, the others by the last repair.
  const Case k = draw_case(0.3);
  const bool dual = GENERATE(false, true);
  INFO("seed " << k.seed << " dual " << dual);
  auto u = random_field(k.size(dual), k.seed, -0.2, 1.2);
  for (double& one : u)
    one = std::clamp(one, 0.0, 1.0);
  std::vector<double> before, after, c;
  k.volumes(dual, k.from, before, c);
  k.volumes(dual, k.to, after, c);
  const double mass = integral(before, u);
  Remapper remapper(k.mesh, {.geometry = k.geometry,
                             .scheme = TestType{},
                             .nodal_scheme = TestType{},
                             .boundaries = std::vector(4, Boundary::closed),
                             .nodal_components = 1});
  const double least = 0, most = 1;
  const Field field{.values = u, .least = {&least, 1}, .most = {&most, 1}};
  const std::span<const Field> one(&field, 1), none;
  Ledger ledger;
  REQUIRE(remapper.remap(k.from, k.to, dual ? none : one, dual ? one : none, {},
                         ledger)
          == Outcome::ok);
  for (double value : u)
  {
    CHECK(value >= -1e-14);
    CHECK(value <= 1 + 1e-14);
  }
  const auto& book = dual ? ledger.nodes : ledger.cells;
  CHECK(std::abs(integral(after, u) - mass - net(book[0])) < 1e-13);
  CHECK((remapper.report().repaired > 0) == not TestType::bounded);
  CHECK(remapper.report().unrepaired == 0);
}

TEMPLATE_LIST_TEST_CASE("scheme: no field minds which travel before it",
                        "[conformance]", Schemes)
{
  const Case k = draw_case(0.2);
  const std::size_t cells = k.size(false);
  const auto tensor = random_field(4 * cells, k.seed, 0, 1);
  const auto scalar = random_field(cells, k.seed + 1, 0, 1);
  const auto run =
      [&](std::vector<double>& t, std::vector<double>& s, bool tensor_first)
  {
    Remapper remapper(k.mesh, {.geometry = k.geometry,
                               .scheme = TestType{},
                               .boundaries = std::vector(4, Boundary::closed),
                               .cell_components = 4});
    const Field first{.values = t, .components = 4, .group = 4};
    const Field second{.values = s};
    const Field both[] = {tensor_first ? first : second,
                          tensor_first ? second : first};
    Ledger ledger;
    REQUIRE(remapper.remap(k.from, k.to, both, {}, {}, ledger) == Outcome::ok);
  };
  auto t1 = tensor, t2 = tensor, s1 = scalar, s2 = scalar;
  run(t1, s1, true);
  run(t2, s2, false);
  for (std::size_t i = 0; i < s1.size(); ++i)
    CHECK(s1[i] == Approx(s2[i]).margin(1e-13));
  for (std::size_t i = 0; i < t1.size(); ++i)
    CHECK(t1[i] == Approx(t2[i]).margin(1e-6));
}

TEMPLATE_LIST_TEST_CASE("scheme: a tensor is limited as one", "[conformance]",
                        Schemes)
{
  if constexpr (TestType::linear and TestType::bounded)
  {
    const Case k = draw_case(0.2);
    const bool dual = GENERATE(false, true);
    INFO("seed " << k.seed);
    // The third component is the sum of the others: limited as one it stays
    // so, each by itself it does not.
    auto u = random_field(3 * k.size(dual), k.seed, 0, 1);
    for (std::size_t i = 0; i < u.size(); i += 3)
      u[i + 2] = u[i] + u[i + 1];
    const auto largest_gap = [](const std::vector<double>& w)
    {
      double gap = 0;
      for (std::size_t i = 0; i < w.size(); i += 3)
        gap = std::max(gap, std::abs(w[i] + w[i + 1] - w[i + 2]));
      return gap;
    };
    auto apart = u;
    Ledger ledger, other;
    k.run(dual, TestType{}, u, 3, 3, ledger);
    k.run(dual, TestType{}, apart, 3, 1, other);
    CHECK(largest_gap(u) < 1e-13);
    CHECK(largest_gap(apart) > 1e-4);
  }
}

TEMPLATE_LIST_TEST_CASE("scheme: no component minds how many others there are",
                        "[conformance]", Schemes)
{
  const Case k = draw_case(0.2);
  const bool dual = GENERATE(false, true);
  const int components = GENERATE(2, 3, 4, 7);
  const auto alone = random_field(k.size(dual), k.seed, 0, 1);
  std::vector<double> many;
  for (double one : alone)
    for (int j = 0; j < components; ++j)
      many.push_back(one * (j + 1));
  auto u = alone;
  Ledger ledger, other;
  k.run(dual, TestType{}, u, 1, 1, ledger);
  k.run(dual, TestType{}, many, components, 1, other);
  for (std::size_t i = 0; i < u.size(); ++i)
    for (int j = 0; j < components; ++j)
      CHECK(many[components * i + j] == Approx(u[i] * (j + 1)).margin(1e-13));
}
