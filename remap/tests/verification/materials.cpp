// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials over many remaps: bodies stay together where transport without
// interfaces disperses them, swept beside overlaid; the longest runs; vanishing
// fractions; and what must not matter: the numbers of materials, and interfaces
// between things that are alike.

#include "remap/tests/materials.h"

#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <iostream>

using namespace remap;

namespace
{
/// A body with twelve sides; part 0 is inside.
Partition body(double radius = 0.25)
{
  Partition out;
  for (int k = 0; k < 12; ++k)
  {
    const double a = 2 * std::numbers::pi * (k + 0.3) / 12;
    const Point d = {std::cos(a), std::sin(a)};
    out.add({HalfPlane{d, Point{0.51, 0.507} + radius * d},
             static_cast<std::int8_t>(k < 11 ? k + 1 : ~0), ~1});
  }
  return out;
}
const std::vector<int> two = {0, 1};

/// What is left of the body after so many remaps to meshes shaken at random.
struct Left
{
  double error = 0; ///< Σ |f − exact| · volume over the body's volume
  double mixed = 0; ///< cells that hold more than 1e-3 of both, over exactly so
};

enum class Way_of
{
  swept,
  overlay,
  donor_cell,     ///< fractions as a field, without interfaces
  limited_linear, ///< the same
};

Left shake(Way_of way, int n, int remaps)
{
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  auto m = filled::fill(mesh, Geometry::plane, data.x, body(), two, 2);
  const auto exact = m;
  const bool interfaces = way == Way_of::swept or way == Way_of::overlay;
  Options options{.method =
                      way == Way_of::overlay ? Method::overlay : Method::swept};
  if (way == Way_of::donor_cell)
    options.scheme = scheme::DonorCell{};
  if (interfaces)
    options.materials.number = 2;
  Remapper remapper(mesh, options);
  std::vector<double> f(mesh.num_cells()), v(mesh.num_cells());
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    f[c] = exact.fraction(c, 0);
  const Field field{.values = f};
  Ledger ledger;
  auto x = data.x;
  for (int k = 1; k <= remaps; ++k)
  {
    const auto y =
        k < remaps ? meshes::shaken(data.x, 0.25 / n, unsigned(k)) : data.x;
    Fields fields;
    if (interfaces)
      fields.materials = &m;
    else
      fields.cells = {&field, 1};
    REQUIRE(remapper.remap(x, y, fields, {}, ledger) == Outcome::ok);
    x = y;
  }
  cell_volumes(mesh, Geometry::plane, x, v);
  Left out;
  double whole = 0, before = 0, after = 0;
  const auto both = [](double g) { return g > 1e-3 and g < 1 - 1e-3; };
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const double g = exact.fraction(c, 0);
    const double now = interfaces ? m.fraction(c, 0) : f[c];
    out.error += v[c] * std::abs(now - g);
    whole += v[c] * g;
    before += both(g) ? 1 : 0;
    after += both(now) ? 1 : 0;
  }
  out.error /= whole;
  out.mixed = after / before;
  return out;
}
} // namespace

TEST_CASE("materials: a body stays together, without interfaces it disperses",
          "[remap][materials]")
{
  const int n = 24, remaps = 40;
  const Left swept = shake(Way_of::swept, n, remaps);
  const Left overlay = shake(Way_of::overlay, n, remaps);
  const Left donor = shake(Way_of::donor_cell, n, remaps);
  const Left linear = shake(Way_of::limited_linear, n, remaps);
  std::cout << "after " << remaps << " remaps: error of the body and mixed "
            << "cells: swept " << swept.error << ' ' << swept.mixed
            << ", overlay " << overlay.error << ' ' << overlay.mixed
            << ", donor cell " << donor.error << ' ' << donor.mixed
            << ", limited linear " << linear.error << ' ' << linear.mixed
            << '\n';
  CHECK(swept.mixed < 1.5);
  CHECK(overlay.mixed < 1.2);
  CHECK(donor.mixed > 5);
  CHECK(swept.error < 0.1 * donor.error);
  CHECK(overlay.error < 0.05 * donor.error);
  CHECK(swept.error < 0.5 * linear.error);
}

namespace
{
/// Back and forth between two meshes.
void back_and_forth(int remaps)
{
  const int n = 6;
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto y = meshes::shaken(data.x, 0.2 / n, 5);
  const std::vector<double> angles = {0.4, 2.3, 4.4};
  const std::vector<int> three = {0, 1, 2};
  auto m = filled::fill(mesh, Geometry::plane, data.x,
                        filled::sectors({0.47, 0.53}, angles), three, 3);
  auto u = filled::values(mesh, Geometry::plane, data.x, m, [](Point p, int k)
                          { return std::pow(10.0, k) * (1 + p.x); });
  const auto volumes = filled::integrals(mesh, Geometry::plane, data.x, m);
  const auto sums = filled::integrals(mesh, Geometry::plane, data.x, m, u);
  Remapper remapper(mesh, {.materials = {.number = 3}});
  const MaterialField field{.values = u};
  Ledger ledger;
  for (int k = 0; k < remaps; ++k)
    REQUIRE(remapper.remap(k % 2 == 0 ? data.x : y, k % 2 == 0 ? y : data.x,
                           {.materials = &m, .of_materials = {&field, 1}}, {},
                           ledger)
            == Outcome::ok);
  const auto now = filled::integrals(mesh, Geometry::plane, data.x, m);
  const auto sums_now = filled::integrals(mesh, Geometry::plane, data.x, m, u);
  for (std::size_t k = 0; k < 3; ++k)
  {
    // Round-off at random grows as the root of their number; this bound would
    // let it be 1e-15 each.
    CHECK(std::abs(now[k] / volumes[k] - 1) < 1e-13 + 1e-15 * remaps);
    CHECK(std::abs(sums_now[k] / sums[k] - 1) < 1e-13 + 1e-15 * remaps);
  }
  CHECK(filled::unsound(m) < 1e-14);
  filled::each_slot(mesh, Geometry::plane, data.x, m,
                    [&](std::int32_t s, int k, double, Point)
                    {
                      const double unit = std::pow(10.0, k);
                      CHECK((u[s] > unit and u[s] < 2 * unit));
                    });
}
} // namespace

TEST_CASE("materials: 1 000 remaps back and forth", "[remap][materials]")
{
  back_and_forth(1'000);
}

TEST_CASE("materials: 100 000 remaps back and forth",
          "[remap][materials][slow]")
{
  back_and_forth(100'000);
}

TEST_CASE("materials: vanishing fractions", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const double fraction = GENERATE(1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2);
  const double sliver = GENERATE(0.0, 1e-8, 1e-5);
  const int n = 10;
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto y = meshes::shaken(data.x, 0.2 / n, 5);
  // A little beyond a line of the mesh, at a slant of the same size.
  auto m = filled::fill(
      mesh, Geometry::plane, data.x,
      filled::line({0.3 * fraction, 1}, {0.5, 0.5 + 0.3 * fraction / n}), two,
      2, 1e-2 * fraction);
  auto u = filled::values(mesh, Geometry::plane, data.x, m, [](Point p, int k)
                          { return std::pow(1000.0, k) * (1 + p.x); });
  const auto volumes = filled::integrals(mesh, Geometry::plane, data.x, m);
  const auto sums = filled::integrals(mesh, Geometry::plane, data.x, m, u);
  Remapper remapper(
      mesh, {.method = method, .materials = {.number = 2, .sliver = sliver}});
  const MaterialField field{.values = u};
  Ledger ledger;
  for (int k = 0; k < 6; ++k)
    REQUIRE(remapper.remap(k % 2 == 0 ? data.x : y, k % 2 == 0 ? y : data.x,
                           {.materials = &m, .of_materials = {&field, 1}}, {},
                           ledger)
            == Outcome::ok);
  CHECK(filled::unsound(m) < 1e-14);
  const auto now = filled::integrals(mesh, Geometry::plane, data.x, m);
  const auto sums_now = filled::integrals(mesh, Geometry::plane, data.x, m, u);
  for (std::size_t k = 0; k < 2; ++k)
  {
    CHECK(std::abs(now[k] / volumes[k] - 1) < 1e-13);
    CHECK(std::abs(sums_now[k] / sums[k] - 1) < 1e-13);
  }
  filled::each_slot(
      mesh, Geometry::plane, data.x, m,
      [&](std::int32_t s, int k, double, Point)
      {
        const double unit = std::pow(1000.0, k);
        CHECK((u[s] > unit * (1 - 1e-9) and u[s] < 2 * unit * (1 + 1e-9)));
      });
}

TEST_CASE("materials: their numbers do not matter", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const int n = 10;
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto y = meshes::shaken(data.x, 0.2 / n, 5);
  // Strips and a T, which cuts can tell apart exactly. (Where four meet in a
  // point they cannot, and more than one answer is as good.)
  const std::vector<std::vector<int>> numbers = {{0, 1, 2, 3}, {2, 0, 3, 1}};
  Partition plane;
  plane.add({HalfPlane::below({0.3, 1}, 0.45), ~0, 1});
  plane.add({HalfPlane::below({0.3, 1}, 0.9), 2, ~3});
  plane.add({HalfPlane::below({1, -0.2}, 0.5), ~1, ~2});
  std::vector<Materials> m;
  std::vector<std::vector<double>> u;
  for (const auto& number : numbers)
  {
    m.push_back(filled::fill(mesh, Geometry::plane, data.x, plane, number, 4));
    const auto sector = [&](int k)
    { return std::find(number.begin(), number.end(), k) - number.begin(); };
    u.push_back(filled::values(
        mesh, Geometry::plane, data.x, m.back(), [&](Point p, int k)
        { return static_cast<double>(1 + sector(k)) + p.x * p.y; }));
    Remapper remapper(mesh, {.method = method, .materials = {.number = 4}});
    const MaterialField field{.values = u.back()};
    Ledger ledger;
    for (int k = 0; k < 4; ++k)
      REQUIRE(
          remapper.remap(k % 2 == 0 ? data.x : y, k % 2 == 0 ? y : data.x,
                         {.materials = &m.back(), .of_materials = {&field, 1}},
                         {}, ledger)
          == Outcome::ok);
  }
  double fractions = 0, values = 0;
  INFO((method == Method::swept ? "swept" : "overlay"));
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    for (std::size_t k = 0; k < 4; ++k)
    {
      fractions =
          std::max(fractions, std::abs(m[0].fraction(c, numbers[0][k])
                                       - m[1].fraction(c, numbers[1][k])));
      const auto s = m[0].slot(c, numbers[0][k]),
                 t = m[1].slot(c, numbers[1][k]);
      if (m[0].fraction(c, numbers[0][k]) > 1e-3)
        values = std::max(values, std::abs(u[0][s] - u[1][t]));
    }
  // Where three meet the search for the junction ends in several ways that are
  // as good in the cell, but go on differently beyond it, where facets sweep.
  const double slack = method == Method::swept ? 1e-3 : 1e-9;
  CHECK(fractions < slack);
  CHECK(values < slack);
}

TEST_CASE("materials: three that are alike are one", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const auto error = [&](std::span<const int> number)
  {
    const int n = 20;
    const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
    const Mesh mesh = data.mesh();
    const std::vector<double> angles = {0.4, 2.3, 4.4};
    auto m = filled::fill(mesh, Geometry::plane, data.x,
                          filled::sectors({0.47, 0.53}, angles), number, 3);
    const auto f = [](Point p, int)
    { return 2 + std::sin(3 * p.x) * std::cos(2 * p.y); };
    auto u = filled::values(mesh, Geometry::plane, data.x, m, f);
    Remapper remapper(mesh, {.method = method, .materials = {.number = 3}});
    const MaterialField field{.values = u};
    Ledger ledger;
    auto x = data.x;
    for (unsigned k = 1; k <= 10; ++k)
    {
      const auto y = k < 10 ? meshes::shaken(data.x, 0.2 / n, k) : data.x;
      REQUIRE(remapper.remap(x, y,
                             {.materials = &m, .of_materials = {&field, 1}}, {},
                             ledger)
              == Outcome::ok);
      x = y;
    }
    double out = 0;
    filled::each_slot(mesh, Geometry::plane, x, m,
                      [&](std::int32_t s, int k, double v, Point at)
                      { out += v * std::abs(u[s] - f(at, k)); });
    return out;
  };
  const std::vector<int> alike = {0, 1, 2}, one = {0, 0, 0};
  const double as_three = error(alike), as_one = error(one);
  INFO(as_three << " beside " << as_one);
  CHECK(as_three < 1.5 * as_one);
  CHECK(as_one < 1.5 * as_three);
}
