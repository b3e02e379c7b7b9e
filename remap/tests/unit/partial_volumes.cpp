// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/domain/partial_volumes.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Domain with_holes(Ring outer, std::vector<Ring> holes)
{
  holes.push_back(std::move(outer));
  return Domain(std::move(holes));
}

Ring box(double x0, double y0, double x1, double y1)
{
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Moments sum(std::span<const Moments> parts)
{
  Moments out;
  for (const Moments& m : parts)
    out += m;
  return out;
}

/// Cells shaken by up to a quarter of a square.
meshes::Data shaken(int n, unsigned seed, double x0 = 0)
{
  meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed, x0);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-0.25 / n, 0.25 / n);
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i)
      for (int k = 0; k < 2; ++k)
        data.x[static_cast<std::size_t>(2 * (j * (n + 1) + i) + k)] +=
            move(random);
  return data;
}

Triangle place(const meshes::Data& mesh, std::size_t c)
{
  return {point(mesh.x, mesh.cells[3 * c]),
          point(mesh.x, mesh.cells[3 * c + 1]),
          point(mesh.x, mesh.cells[3 * c + 2])};
}

/// A star with so many rays between two radii, at random.
Ring star(std::mt19937& random, Point centre, double least, double most,
          int points)
{
  std::uniform_real_distribution<double> radius(least, most), part(0.1, 0.9);
  Ring out;
  for (int i = 0; i < points; ++i)
  {
    const double a = 2 * pi * (i + part(random)) / points;
    out.push_back(centre + radius(random) * Point{std::cos(a), std::sin(a)});
  }
  return out;
}
} // namespace

TEST_CASE("partial volumes: parts of the cells add up to the domain",
          "[domain]")
{
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  const meshes::Data mesh = shaken(24, seed, 0.5);
  std::mt19937 random(seed);
  const Point centre{1, 0.5};
  const Domain domain = with_holes(star(random, centre, 0.25, 0.5, 60),
                                   {star(random, centre, 0.05, 0.2, 12)});
  const auto check = [&]<Geometry G>()
  {
    const PartialVolumes laid = partial_volumes<G>(domain, mesh.cells, mesh.x);
    const Moments parts = sum(laid.parts), all = domain.moments<G>();
    CHECK(std::abs(parts.v / all.v - 1) < 1e-14);
    CHECK(std::abs(parts.x / all.x - 1) < 1e-14);
    CHECK(std::abs(parts.y / all.y - 1) < 1e-14);
    CHECK(laid.mixed.size() > 200);
    CHECK(laid.full > 100);
  };
  check.operator()<Geometry::plane>();
  check.operator()<Geometry::axisymmetric>();
}

TEST_CASE("partial volumes: a half-plane has the clipped triangle's moments",
          "[domain]")
{
  const meshes::Data mesh = shaken(9, 7);
  const HalfPlane half = HalfPlane::left_of({0.2, 0}, {0.7, 1});
  const Domain domain = Domain::half_plane(half, {-1, -1}, {2, 2});
  const auto check = [&]<Geometry G>()
  {
    const auto laid = partial_volumes<G>(domain, mesh.cells, mesh.x);
    double worst = 0;
    for (std::size_t c = 0; c < laid.parts.size(); ++c)
    {
      const Moments exact = clipped<G>(place(mesh, c), half);
      worst = std::max({worst, std::abs(laid.parts[c].v - exact.v),
                        std::abs(laid.parts[c].x - exact.x),
                        std::abs(laid.parts[c].y - exact.y)});
    }
    // crossings found twice on an edge of length 3, in a cell of size 0.15
    CHECK(worst < 16 * eps * 3 * 0.15);
  };
  check.operator()<Geometry::plane>();
  check.operator()<Geometry::axisymmetric>();
}

TEST_CASE("partial volumes: a torus about the axis after Pappus", "[domain]")
{
  // V = 2π² R r², here per radian π R r²; ∫x dV = π r² (R² + r²/4).
  const double R = 0.6, r = 0.25, tolerance = 1e-6;
  const Domain domain = Domain::circle({R, 0.5}, r, tolerance);
  CHECK(domain.moments<Geometry::plane>().v
        == Approx(pi * r * r).epsilon(100 * eps));
  const meshes::Data mesh = shaken(16, 3);
  const auto laid =
      partial_volumes<Geometry::axisymmetric>(domain, mesh.cells, mesh.x);
  const Moments m = sum(laid.parts);
  CHECK(m.v == Approx(pi * R * r * r).epsilon(1e-13));
  // the polygon's second moment is off by its tolerance times r³ at most
  CHECK(m.x == Approx(pi * r * r * (R * R + r * r / 4)).margin(tolerance));
  CHECK(m.y == Approx(0.5 * m.v).epsilon(1e-13));
}

TEST_CASE("partial volumes: a domain within one cell", "[domain]")
{
  const std::vector<double> x = {0, 0, 4, 0, 0, 4};
  const bool turned = GENERATE(false, true);
  const std::vector<std::int32_t> cell =
      turned ? std::vector<std::int32_t>{0, 2, 1}
             : std::vector<std::int32_t>{0, 1, 2};
  const Domain domain =
      with_holes(box(0.5, 0.5, 1.5, 1.5), {box(0.75, 0.75, 1, 1.25)});
  DomainPieces pieces;
  const auto laid = partial_volumes<Geometry::plane>(domain, cell, x, &pieces);
  REQUIRE(laid.mixed.size() == 1);
  CHECK(laid.full == 0);
  CHECK(laid.parts[0].v == Approx(1 - 0.125).epsilon(4 * eps));
  CHECK(laid.parts[0].x == Approx(1 - 0.125 * 0.875).epsilon(4 * eps));
  CHECK(laid.parts[0].y == Approx(1 - 0.125).epsilon(4 * eps));
  // left and right of the hole, above it and below
  CHECK(pieces.size() == 4);
}

TEST_CASE("partial volumes: domains whose edges are the mesh's", "[domain]")
{
  const meshes::Data mesh = meshes::rectangle(8, 8, meshes::Diagonal::crossed);
  SECTION("a block of squares has no mixed cell")
  {
    const auto laid = partial_volumes<Geometry::plane>(
        Domain::rectangle({0.25, 0.25}, {0.75, 0.625}), mesh.cells, mesh.x);
    CHECK(laid.mixed.empty());
    CHECK(laid.full == 2 * 4 * 3);
    CHECK(sum(laid.parts).v == Approx(0.5 * 0.375).epsilon(eps));
  }
  SECTION("a single cell")
  {
    for (std::size_t c = 0; c < 20; ++c)
    {
      const Triangle t = place(mesh, c);
      const auto laid = partial_volumes<Geometry::plane>(
          Domain::polygon({t[0], t[1], t[2]}), mesh.cells, mesh.x);
      CHECK(laid.mixed.empty());
      CHECK(laid.full == 1);
      CHECK(laid.parts[c].v == Approx(1. / 128).epsilon(2 * eps));
    }
  }
  SECTION("edges through vertices, across the squares")
  {
    // A diamond between the middles of the sides: half of the square.
    const auto laid = partial_volumes<Geometry::plane>(
        Domain::polygon({{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}), mesh.cells,
        mesh.x);
    for (const Moments& m : laid.parts)
    {
      const double share = 128 * m.v; // of a cell: none, half or all
      CHECK(std::abs(share - std::round(2 * share) / 2) < 8 * eps);
    }
    CHECK(sum(laid.parts).v == Approx(0.5).epsilon(2 * eps));
  }
  SECTION("the mesh's own outline, and one far around it")
  {
    for (const double far : {0.0, 3.0})
    {
      const auto laid = partial_volumes<Geometry::plane>(
          Domain::rectangle({-far, -far}, {1 + far, 1 + far}), mesh.cells,
          mesh.x);
      CHECK(laid.mixed.empty());
      CHECK(laid.full == 128);
    }
  }
  SECTION("the whole mesh in a hole")
  {
    const auto laid = partial_volumes<Geometry::plane>(
        with_holes(box(-2, -2, 3, 3), {box(-1, -1, 2, 2)}), mesh.cells, mesh.x);
    CHECK(laid.mixed.empty());
    CHECK(laid.full == 0);
    CHECK(sum(laid.parts).v == 0);
  }
}

TEST_CASE("partial volumes: a hole that touches a cell's edge and corner",
          "[domain]")
{
  // The cell (0,0) (1,0) (0,1); the hole stands on its lower edge, and its
  // corner (0.5, 0.5) on the slanted one.
  const std::vector<double> x = {0, 0, 1, 0, 0, 1, 1, 1};
  const std::vector<std::int32_t> cells = {0, 1, 2, 1, 3, 2};
  const auto laid = partial_volumes<Geometry::plane>(
      with_holes(box(-1, -1, 2, 2), {{{0.25, 0}, {0.5, 0}, {0.5, 0.5}}}), cells,
      x);
  CHECK(laid.parts[0].v == Approx(0.5 - 0.0625).epsilon(2 * eps));
  CHECK(laid.parts[1].v == 0.5);
  CHECK(laid.mixed == std::vector<std::int32_t>{0});
}

TEST_CASE("partial volumes: a thread of 1e-7 of a cell", "[domain]")
{
  const meshes::Data mesh = shaken(10, 5);
  const double width = 1e-8;
  // A slanted strip: parts of it are exact to round-off of a cell.
  const Domain domain = Domain::polygon(
      {{0.1, 0.2}, {0.9, 0.7}, {0.9, 0.7 + width}, {0.1, 0.2 + width}});
  const auto laid =
      partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x);
  CHECK(laid.mixed.size() > 10);
  CHECK(laid.full == 0);
  CHECK(std::abs(sum(laid.parts).v - 0.8 * width)
        < 4 * eps * static_cast<double>(laid.mixed.size()));
  for (const std::int32_t c : laid.mixed)
  {
    // The centroid stays on the thread where there is enough of it.
    const Moments& m = laid.parts[static_cast<std::size_t>(c)];
    if (m.v < 1e-3 * 0.1 * width)
      continue;
    const Point g = m.centroid();
    CHECK(std::abs(g.y - (0.2 + 0.625 * (g.x - 0.1))) < 1e-4);
  }
}

TEST_CASE("partial volumes: what lies outside of the mesh is what is missing",
          "[domain]")
{
  const meshes::Data mesh = shaken(12, 11);
  const Domain domain =
      with_holes(box(0.5, 0.25, 1.5, 0.75), {box(0.9, 0.4, 1.2, 0.6)});
  const auto laid =
      partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x);
  CHECK(sum(laid.parts).v == Approx(0.25 - 0.1 * 0.2).epsilon(8 * eps));
  CHECK(domain.moments<Geometry::plane>().v == Approx(0.5 - 0.06));
}

TEST_CASE("partial volumes: pieces fill the parts, cell by cell", "[domain]")
{
  const unsigned seed = GENERATE(5u, 6u);
  std::mt19937 random(seed);
  // Cells wide enough for several spikes of the stars and for the hole.
  const meshes::Data mesh = shaken(4, seed);
  const Point centre{0.5, 0.5};
  const Domain domain = with_holes(star(random, centre, 0.2, 0.6, 80),
                                   {star(random, centre, 0.02, 0.18, 30)});
  DomainPieces pieces;
  const auto laid =
      partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x, &pieces);
  CHECK(std::ranges::is_sorted(pieces.cells));
  std::vector<Moments> found(laid.parts.size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const auto p = pieces[i];
    REQUIRE((p.size() == 3 or p.size() == 4));
    for (std::size_t k = 0; k < p.size(); ++k)
      CHECK(twice_area(p[k], p[(k + 1) % p.size()], p[(k + 2) % p.size()])
            > -4 * eps);
    for (std::size_t k = 1; k + 1 < p.size(); ++k)
      found[static_cast<std::size_t>(pieces.cells[i])] +=
          triangle<Geometry::plane>(p[0], p[k], p[k + 1]);
  }
  for (std::size_t c = 0; c < found.size(); ++c)
  {
    CHECK(std::abs(found[c].v - laid.parts[c].v) < 64 * eps);
    CHECK(std::abs(found[c].x - laid.parts[c].x) < 64 * eps);
    CHECK(std::abs(found[c].y - laid.parts[c].y) < 64 * eps);
  }
}

TEST_CASE("partial volumes: far from the origin no digit is lost", "[domain]")
{
  // Everything on a lattice of 2^-16, so that a way of 2^20 is exact.
  const double unit = std::exp2(-16), away = std::exp2(20);
  const auto snap = [unit](double x) { return unit * std::round(x / unit); };
  meshes::Data mesh = shaken(10, 4);
  std::mt19937 random(3);
  Ring ring = star(random, {0.5, 0.5}, 0.2, 0.5, 40);
  for (double& x : mesh.x)
    x = snap(x);
  for (Point& p : ring)
    p = {snap(p.x), snap(p.y)};
  const auto near = partial_volumes<Geometry::plane>(Domain::polygon(ring),
                                                     mesh.cells, mesh.x);
  for (double& x : mesh.x)
    x += away;
  for (Point& p : ring)
    p = p + Point{away, away};
  const Domain domain = Domain::polygon(ring);
  const auto far = partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x);
  double worst = 0;
  for (std::size_t c = 0; c < near.parts.size(); ++c)
    worst = std::max(worst, std::abs(near.parts[c].v - far.parts[c].v));
  CHECK(worst < 16 * eps * 0.1);
  CHECK(near.mixed == far.mixed);
  // The same sum with the coordinates as they are has no digits left.
  double naive = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    naive += cross(ring[i], ring[(i + 1) % ring.size()]) / 2;
  CHECK(std::abs(naive / domain.moments<Geometry::plane>().v - 1) > 1e-6);
}

TEST_CASE("partial volumes: no cells, and no domain", "[domain]")
{
  const meshes::Data mesh = meshes::rectangle(2, 2, meshes::Diagonal::right);
  CHECK(partial_volumes<Geometry::plane>(Domain::rectangle({0, 0}, {1, 1}), {},
                                         {})
            .parts.empty());
  const auto laid =
      partial_volumes<Geometry::plane>(Domain(), mesh.cells, mesh.x);
  CHECK(laid.parts.size() == 8);
  CHECK(sum(laid.parts).v == 0);
  CHECK(laid.mixed.empty());
}

TEST_CASE("partial volumes: any part of the cells has the same parts",
          "[domain]")
{
  // As ranks have them: to round-off, whichever boxes they make of theirs.
  const meshes::Data mesh = shaken(20, 2);
  std::mt19937 random(9);
  const Domain domain = Domain::polygon(star(random, {0.5, 0.5}, 0.2, 0.5, 90));
  const auto all = partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x);
  std::vector<std::int32_t> mixed;
  for (std::size_t from = 0; from < 800; from += 80)
  {
    const auto some = partial_volumes<Geometry::plane>(
        domain, std::span(mesh.cells).subspan(3 * from, 240), mesh.x);
    for (std::size_t c = 0; c < 80; ++c)
      CHECK(std::abs(some.parts[c].v - all.parts[from + c].v) < 4 * eps * 0.1);
    for (const std::int32_t c : some.mixed)
      mixed.push_back(c + static_cast<std::int32_t>(from));
  }
  CHECK(mixed == all.mixed);
}
