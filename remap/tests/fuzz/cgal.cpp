// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Clipping and overlay against CGAL's exact kernel (headers under LGPL).
// Without sanitizers: the kernel changes the rounding mode and does not suit
// them. A failure names the number that makes the pair or the meshes again.

#include "remap/tests/fuzz/meshes.h"
#include "remap/tests/fuzz/pairs.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Intersections_2/Triangle_2_Triangle_2.h>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <map>

using namespace remap;

namespace
{
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
constexpr double eps = std::numeric_limits<double>::epsilon();

Kernel::Point_2 exact(Point p)
{
  return {p.x, p.y};
}

/// How far an area is from the exact one of the overlap.
double error(const Triangle& a, const Triangle& b, double area)
{
  const Kernel::Triangle_2 s(exact(a[0]), exact(a[1]), exact(a[2]));
  const Kernel::Triangle_2 t(exact(b[0]), exact(b[1]), exact(b[2]));
  Kernel::FT sum = 0;
  if (not s.is_degenerate() and not t.is_degenerate())
    if (const auto common = CGAL::intersection(s, t))
    {
      if (const auto* one = std::get_if<Kernel::Triangle_2>(&*common))
        sum = CGAL::abs(one->area());
      if (const auto* p = std::get_if<std::vector<Kernel::Point_2>>(&*common))
        for (std::size_t k = 2; k < p->size(); ++k)
          sum += CGAL::abs(CGAL::area((*p)[0], (*p)[k - 1], (*p)[k]));
    }
  return std::abs(CGAL::to_double(CGAL::exact(sum - area)));
}

double extent(const Triangle& a, const Triangle& b)
{
  double size = 0;
  for (const Triangle& s : {a, b})
    for (const Triangle& t : {a, b})
      for (const Point& p : s)
        for (const Point& q : t)
          size = std::max({size, std::abs(p.x - q.x), std::abs(p.y - q.y)});
  return size;
}

void check_pairs(std::uint64_t first, std::uint64_t count)
{
  for (std::uint64_t k = 0; k < count; ++k)
  {
    const fuzz::Pair p = fuzz::pair(first + k);
    const double size = extent(p.a, p.b);
    const double v = overlap<Geometry::plane>(p.a, p.b).v;
    if (not(error(p.a, p.b, v) <= 4 * eps * size * size))
    {
      INFO("pair " << p.seed << " (" << fuzz::kinds[p.kind] << ")");
      INFO("ours " << v << " off by " << error(p.a, p.b, v));
      CHECK(false);
    }
  }
  SUCCEED();
}

/// Every pair of cells, whether the overlay found it or not.
void check_meshes(std::uint64_t seed)
{
  const fuzz::Move m(seed);
  INFO("meshes " << seed << " (" << m.what() << ")");
  Overlay overlay(m.mesh);
  REQUIRE(overlay.intersect<Geometry::plane>(m.from, m.to, m.touched())
          == Outcome::ok);
  std::map<std::pair<std::int32_t, std::int32_t>, double> found;
  for (const auto& p : overlay.pieces())
    if (p.from >= 0 and p.to >= 0)
      found[{p.from, p.to}] += p.volume;
  for (std::int32_t c : m.touched())
    found[{c, c}] = overlay.rest(c).volume;
  double worst = 0;
  for (std::int32_t c : m.touched())
    for (std::int32_t d : m.touched())
    {
      const Triangle a = m.place(m.from, c), b = m.place(m.to, d);
      const auto it = found.find({c, d});
      const double size = extent(a, b);
      worst = std::max(worst, error(a, b, it == found.end() ? 0 : it->second)
                                  / (eps * size * size));
    }
  CHECK(worst < 4);
}
} // namespace

TEST_CASE("clipping: as CGAL's exact kernel on 10 000 pairs", "[fuzz]")
{
  check_pairs(0, 10'000);
}

TEST_CASE("clipping: as CGAL's exact kernel on 1 000 000 pairs", "[fuzz][slow]")
{
  check_pairs(2'000'000, 1'000'000);
}

TEST_CASE("overlay: every pair of cells as CGAL's exact kernel", "[fuzz]")
{
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    check_meshes(seed);
}

TEST_CASE("overlay: every pair of cells as CGAL's exact kernel, 500 meshes",
          "[fuzz][slow]")
{
  for (std::uint64_t seed = 1000; seed < 1500; ++seed)
    check_meshes(seed);
}
