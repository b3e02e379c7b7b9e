// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mesh/grid.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <map>
#include <set>

using namespace mmale;
using Catch::Approx;
using mesh::Grid;

namespace
{
scene::Mesh rectangle(int nx, int ny)
{
  scene::Mesh m;
  m.shape = "rectangle";
  m.width = 2;
  m.height = 1.5;
  m.origin = {-0.5, 1};
  m.cells = {nx, ny};
  return m;
}

double area(const Grid& g, std::size_t cell)
{
  const auto x = [&](int v, int d)
  { return g.x[2 * g.cells[3 * cell + v] + d]; };
  return 0.5
         * ((x(1, 0) - x(0, 0)) * (x(2, 1) - x(0, 1))
            - (x(2, 0) - x(0, 0)) * (x(1, 1) - x(0, 1)));
}

double total_area(const Grid& g)
{
  double sum = 0;
  for (std::size_t c = 0; c < g.cells.size() / 3; ++c)
    sum += area(g, c);
  return sum;
}

/// Slopes of the inner diagonals of unit squares, by the lower left corner.
std::map<std::array<int, 2>, int> diagonals(const Grid& g)
{
  std::map<std::array<int, 2>, int> out;
  for (std::size_t c = 0; c < g.cells.size() / 3; ++c)
    for (int k = 0; k < 3; ++k)
    {
      const auto a = g.cells[3 * c + k], b = g.cells[3 * c + (k + 1) % 3];
      const double dx = g.x[2 * b] - g.x[2 * a],
                   dy = g.x[2 * b + 1] - g.x[2 * a + 1];
      if (std::abs(dx * dy) > 0.5)
        out[{static_cast<int>(std::min(g.x[2 * a], g.x[2 * b])),
             static_cast<int>(std::min(g.x[2 * a + 1], g.x[2 * b + 1]))}] =
            dx * dy > 0 ? 1 : -1;
    }
  return out;
}
} // namespace

TEST_CASE("a graded line fills its length, finest at its point and growing "
          "away from it",
          "[unit][mesh]")
{
  const double length = 1.5, size = 0.1, finest = 0.0125, growth = 1.15;
  const double towards = GENERATE(0.0, 0.5, 0.83, 1.5);
  const double radius = GENERATE(0.0, 0.06);
  INFO("towards " << towards << ", radius " << radius);
  const auto line =
      mesh::graded_line(length, size, towards, finest, growth, radius);
  CHECK(line.front() == 0);
  CHECK(line.back() == length);
  const auto at = std::ranges::find(line, towards);
  REQUIRE(at != line.end());

  std::vector<double> edges;
  for (std::size_t i = 1; i < line.size(); ++i)
    edges.push_back(line[i] - line[i - 1]);
  const auto point = at - line.begin(); // edges point - 1 and point meet there
  constexpr double round_off = 1e-12;
  for (std::ptrdiff_t i = point + 1; i < std::ssize(edges); ++i)
  {
    CHECK(edges[i] >= edges[i - 1] - round_off);
    CHECK(edges[i] <= growth * edges[i - 1] + round_off);
  }
  for (std::ptrdiff_t i = 0; i + 1 < point; ++i)
  {
    CHECK(edges[i] >= edges[i + 1] - round_off);
    CHECK(edges[i] <= growth * edges[i + 1] + round_off);
  }
  CHECK(*std::ranges::max_element(edges) <= size + round_off);
  // scaled down to fit, by less than one edge over each side
  for (const auto beside : {point - 1, point})
    if (beside >= 0 and beside < std::ssize(edges))
    {
      CHECK(edges[beside] <= finest * (1 + round_off));
      const double span = beside < point ? towards : length - towards;
      CHECK(edges[beside] >= finest * (1 - size / (span + size)));
    }
  if (radius > 0 and point < std::ssize(edges))
    for (auto i = point; line[i] - towards < 0.9 * radius; ++i)
      CHECK(edges[i] == Approx(edges[point])); // an even zone
}

TEST_CASE("every cell of a grid is counter-clockwise and all fill the "
          "rectangle",
          "[unit][mesh]")
{
  auto m = rectangle(7, 5);
  m.diagonal = GENERATE(scene::Diagonal::right, scene::Diagonal::left,
                        scene::Diagonal::alternating);
  m.distortion = GENERATE(0.0, 0.2, 0.399);
  const Grid g = mesh::make_grid(m);
  REQUIRE(g.cells.size() == 3 * 2 * 7 * 5);
  REQUIRE(g.x.size() == 2 * 8 * 6);
  for (std::size_t c = 0; c < g.cells.size() / 3; ++c)
    CHECK(area(g, c) > 0);
  CHECK(total_area(g) == Approx(3).epsilon(1e-13));
}

TEST_CASE("distortion moves inner nodes only, by no more than its share",
          "[unit][mesh]")
{
  auto m = rectangle(8, 6);
  const Grid even = mesh::make_grid(m);
  m.distortion = 0.3;
  const Grid g = mesh::make_grid(m);
  double largest = 0;
  for (std::size_t n = 0; n < g.x.size() / 2; ++n)
  {
    const double x = even.x[2 * n], y = even.x[2 * n + 1];
    const bool inner =
        x > -0.5 + 1e-9 and x < 1.5 - 1e-9 and y > 1 + 1e-9 and y < 2.5 - 1e-9;
    const double dx = std::abs(g.x[2 * n] - x),
                 dy = std::abs(g.x[2 * n + 1] - y);
    CHECK(dx <= 0.3 * 0.25 * (1 + 1e-12));
    CHECK(dy <= 0.3 * 0.25 * (1 + 1e-12));
    if (not inner)
      CHECK(dx + dy == 0);
    largest = std::max({largest, dx, dy});
  }
  CHECK(largest > 0.2 * 0.25);        // it does distort
  CHECK(mesh::make_grid(m).x == g.x); // and always alike
}

TEST_CASE("diagonals run as the scene says", "[unit][mesh]")
{
  scene::Mesh m = rectangle(4, 3);
  m.origin = {0, 0};
  m.width = 4;
  m.height = 3;
  for (const auto& [at, slope] : diagonals(mesh::make_grid(m)))
    CHECK(slope == 1);
  m.diagonal = scene::Diagonal::left;
  for (const auto& [at, slope] : diagonals(mesh::make_grid(m)))
    CHECK(slope == -1);
  m.diagonal = scene::Diagonal::alternating;
  const auto mixed = diagonals(mesh::make_grid(m));
  CHECK(mixed.size() == 12);
  for (const auto& [at, slope] : mixed)
    CHECK(slope == ((at[0] + at[1]) % 2 == 0 ? 1 : -1));
}

TEST_CASE("boundary edges close around the body, which lies on their left",
          "[unit][mesh]")
{
  auto m = rectangle(5, 4);
  m.diagonal = scene::Diagonal::alternating;
  const Grid g = mesh::make_grid(m);
  CHECK(g.edges.size() == 2 * (5 + 4));
  std::map<std::int64_t, std::int64_t> next;
  std::set<std::array<std::int64_t, 2>> of_cells;
  for (std::size_t c = 0; c < g.cells.size() / 3; ++c)
    for (int k = 0; k < 3; ++k)
      of_cells.insert({g.cells[3 * c + k], g.cells[3 * c + (k + 1) % 3]});
  for (const auto& [a, b, side] : g.edges)
  {
    next[a] = b;
    CHECK(of_cells.contains({a, b}));       // its cell goes the same way
    CHECK_FALSE(of_cells.contains({b, a})); // and there is no other
    const double x = (g.x[2 * a] + g.x[2 * b]) / 2,
                 y = (g.x[2 * a + 1] + g.x[2 * b + 1]) / 2;
    const double distance[] = {y - 1, 1.5 - x, 2.5 - y, x + 0.5};
    CHECK(std::abs(distance[side]) < 1e-14); // bottom, right, top, left
  }
  std::int64_t at = g.edges[0][0];
  std::size_t around = 0;
  do
  {
    at = next.at(at);
    ++around;
  } while (at != g.edges[0][0] and around < 100);
  CHECK(around == g.edges.size());
}

TEST_CASE("a quadrilateral is filled between its corners", "[unit][mesh]")
{
  scene::Mesh m;
  m.shape = "quadrilateral";
  m.corners = {{{0, 0}, {48, 44}, {48, 60}, {0, 44}}}; // Cook's membrane
  m.cells = {6, 4};
  const Grid g = mesh::make_grid(m);
  CHECK(total_area(g) == Approx(48 * (44 + 16) / 2.0).epsilon(1e-14));
  const auto has = [&g](double x, double y)
  {
    for (std::size_t n = 0; n < g.x.size() / 2; ++n)
      if (std::hypot(g.x[2 * n] - x, g.x[2 * n + 1] - y) < 1e-12)
        return true;
    return false;
  };
  CHECK(has(48, 52)); // the middle of the right side
  CHECK(has(24, 37)); // and of the whole
}

TEST_CASE("size and grading give the number of cells", "[unit][mesh]")
{
  auto m = rectangle(0, 0);
  m.size = 0.1;
  CHECK(mesh::make_grid(m).cells.size() == 3 * 2 * 20 * 15);
  m.grading = scene::Grading{.towards = {0.5, 2.5}, .size = 0.02};
  const Grid g = mesh::make_grid(m);
  CHECK(g.cells.size() > 3 * 2 * 20 * 15);
  CHECK(total_area(g) == Approx(3).epsilon(1e-13));
  double nearest = 1;
  std::size_t corner = 0;
  for (std::size_t n = 0; n < g.x.size() / 2; ++n)
    if (std::hypot(g.x[2 * n] - 0.5, g.x[2 * n + 1] - 2.5) < 1e-12)
      corner = n;
  for (std::size_t n = 0; n < g.x.size() / 2; ++n)
    if (n != corner)
      nearest =
          std::min(nearest, std::hypot(g.x[2 * n] - 0.5, g.x[2 * n + 1] - 2.5));
  CHECK(corner > 0); // the point is a node
  CHECK(nearest <= 0.02 * (1 + 1e-12));
  CHECK(nearest > 0.018);
}
