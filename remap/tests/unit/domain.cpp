// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/domain/domain.h"
#include "remap/domain/orientation.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

Ring box(double x0, double y0, double x1, double y1)
{
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Ring reversed(Ring ring)
{
  std::ranges::reverse(ring);
  return ring;
}

double area(const Domain& domain)
{
  return domain.moments<Geometry::plane>().v;
}

std::string fault(std::vector<Ring> rings)
{
  const Shape shape{std::move(rings), FillRule::evenodd};
  const auto faults = Domain::faults({&shape, 1});
  return faults.empty() ? "" : faults.front().what;
}
} // namespace

TEST_CASE("orientation: exact where doubles have lost all digits", "[domain]")
{
  using orientation::side;
  CHECK(side({0, 0}, {1, 0}, {0.5, 1e-300}) == 1);
  CHECK(side({0, 0}, {1, 1}, {0.5, 0.5}) == 0);
  // One last bit off a line far from the origin, at all places of a lattice:
  // the naive determinant gets 3 of 4 of them wrong.
  int naive = 0;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j)
    {
      const Point p{0.5 + i * eps, 0.5 + j * eps};
      const Point a{12, 12}, b{24, 24};
      const int expected = (j > i) - (j < i);
      CHECK(side(a, b, p) == expected);
      const double det = twice_area(a, b, p);
      naive += ((det > 0) - (det < 0)) != expected;
    }
  CHECK(naive > 100);
}

TEST_CASE("domain: rings turn as they should, however they were given",
          "[domain]")
{
  for (const bool outer : {false, true})
    for (const bool hole : {false, true})
    {
      const Ring a = box(0, 0, 4, 4), b = box(1, 1, 2, 3);
      const Domain d({hole ? reversed(b) : b, outer ? reversed(a) : a});
      REQUIRE(d.rings().size() == 2);
      CHECK(area(d) == Approx(14).epsilon(2 * eps));
      CHECK(d.holds({3, 3}));
      CHECK(not d.holds({1.5, 2}));
      CHECK(not d.holds({5, 2}));
      CHECK(d.low() == Point{0, 0});
      CHECK(d.high() == Point{4, 4});
    }
}

TEST_CASE("domain: rings in rings, by both rules", "[domain]")
{
  const std::vector<Ring> nested = {box(0, 0, 8, 8), box(1, 1, 7, 7),
                                    box(2, 2, 6, 6), box(3, 3, 5, 5)};
  CHECK(area(Domain(nested)) == Approx(64 - 36 + 16 - 4));
  CHECK(area(Domain(nested, FillRule::nonzero)) == Approx(64));
  // The third ring the other way around, 1 + 1 − 1: the same; two of them
  // make a hole in the middle.
  CHECK(area(Domain({nested[0], nested[1], reversed(nested[2]), nested[3]},
                    FillRule::nonzero))
        == Approx(64));
  CHECK(area(Domain(
            {nested[0], nested[1], reversed(nested[2]), reversed(nested[3])},
            FillRule::nonzero))
        == Approx(64 - 4));
  // Shapes are filled each for itself: the second one covers the first's hole.
  const Shape shapes[] = {{{nested[0], nested[1]}, FillRule::evenodd},
                          {{reversed(nested[2])}, FillRule::nonzero}};
  CHECK(area(Domain(shapes)) == Approx(64 - 36 + 16));
  const Shape covered[] = {{{nested[1], nested[2]}, FillRule::evenodd},
                           {{nested[0]}, FillRule::nonzero}};
  CHECK(Domain(covered).rings().size() == 1);
  CHECK(area(Domain(covered)) == Approx(64));
}

TEST_CASE("domain: rings may touch in points", "[domain]")
{
  // A hole with all its corners on the outer ring, on edges and vertices.
  const Domain d({box(0, 0, 2, 2), {{1, 0}, {2, 2}, {0, 1}}});
  // less the triangle (1, 0) (2, 2) (0, 1): 3/2
  CHECK(area(d) == Approx(4 - 1.5));
  CHECK(not d.holds({1, 1}));
  // Two squares on one corner, in one ring that goes through it twice.
  const Domain two = Domain::polygon(
      {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}});
  CHECK(area(two) == Approx(2));
  // A ring that touches itself from within: the inner loop is a hole.
  const Domain loop = Domain::polygon(
      {{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 2}, {2, 1}});
  CHECK(area(loop) == Approx(16 - 1.5));
}

TEST_CASE("domain: faults are found and named", "[domain]")
{
  CHECK(fault({}) == "there are no rings");
  CHECK(fault({{{0, 0}, {1, 0}}})
        == "has 2 points; a ring needs 3 that differ");
  CHECK(fault({{{0, 0}, {1, 0}, {1, 0}, {0, 0}}})
        == "has 2 points; a ring needs 3 that differ");
  CHECK(fault({{{0, 0}, {1, 0}, {1, std::nan("")}}})
        == "a coordinate is not finite");
  CHECK(fault({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}})
        == "the ring crosses itself near (1, 1)");
  CHECK(fault({box(0, 0, 2, 2), box(1, 1, 3, 3)})
        == "crosses ring 1 near (2, 1)");
  // Edges one upon the other: from the same side, and as neighbours.
  CHECK(
      fault({box(0, 0, 2, 2), box(1, 0, 2, 1)}).starts_with("lies on an edge"));
  CHECK(
      fault({box(0, 0, 2, 2), box(2, 1, 3, 3)}).starts_with("lies on an edge"));
  CHECK(
      fault({box(0, 0, 2, 2), box(0, 0, 2, 2)}).starts_with("lies on an edge"));
  // There and back again.
  CHECK(fault({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}})
            .starts_with("the ring lies on an edge of itself"));
  CHECK(fault({{{0, 0}, {1, 1}, {2, 2}}})
            .starts_with("the ring lies on an edge of itself"));
  // Two triangles tip to tip, in one ring that crosses itself at a vertex.
  CHECK(fault({{{0, 0}, {1, 1}, {2, 2}, {2, 0}, {1, 1}, {0, 2}}})
            .starts_with("the ring crosses itself near (1, 1)"));
  // Through a vertex in the middle of an edge.
  CHECK(fault({box(0, 0, 2, 2), {{1, 1}, {2, 1}, {3, 1.5}, {1, 1.5}}})
            .starts_with("crosses ring"));
  // The vertex meant is the given one, repeated points counted.
  const Shape shape{{box(5, 5, 6, 6), {{0, 2}, {0, 2}, {0, 0}, {2, 2}, {2, 0}}},
                    FillRule::evenodd};
  const auto faults = Domain::faults({&shape, 1});
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].ring == 1);
  CHECK(faults[0].vertex == 2);
  CHECK_THROWS_AS(Domain(shape.rings), std::invalid_argument);
}

TEST_CASE("domain: one last bit tells touching from crossing", "[domain]")
{
  // The tip of a triangle on the slanted side of a box, and one bit through it.
  const Ring slanted = {{0, 0}, {3, 0.3}, {3, 3}, {0, 3}};
  const Ring tip = {{1.5, 0.15}, {2, -1}, {1, -1}};
  const double y = 0.15;
  // 0.1 · 1.5 is not 0.15 in doubles; which side it is on is for the exact
  // predicate to say, and its neighbours in y are on different sides.
  const int at = orientation::side(slanted[0], slanted[1], {1.5, y});
  int crossing = 0;
  for (int k = -2; k <= 2; ++k)
  {
    Ring moved = tip;
    for (int i = 0; i < std::abs(k); ++i)
      moved[0].y = std::nextafter(moved[0].y, k > 0 ? 1.0 : -1.0);
    const int here = orientation::side(slanted[0], slanted[1], moved[0]);
    CHECK(here >= (k > 0 ? at : -1));
    CHECK(fault({slanted, moved}).empty() == (here <= 0));
    crossing += here > 0;
  }
  CHECK(crossing > 0);
  CHECK(crossing < 5);
}

TEST_CASE("domain: discs keep their area and stay within the tolerance",
          "[domain]")
{
  for (const double tolerance : {1e-1, 1e-3, 1e-6})
  {
    const double r = 2;
    const Domain d = Domain::circle({3, -1}, r, tolerance);
    CHECK(area(d) == Approx(std::numbers::pi * r * r).epsilon(1e-13));
    const auto ring = d.rings()[0];
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Point a = ring[i], b = ring[(i + 1) % ring.size()];
      for (const Point p : {a, middle(a, b)})
        CHECK(std::abs(std::hypot(p.x - 3, p.y + 1) - r) < tolerance);
    }
  }
  CHECK_THROWS_AS(Domain::circle({}, 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(Domain::circle({}, 1, std::nan("")), std::invalid_argument);
}

TEST_CASE("domain: half-planes are cut to their box", "[domain]")
{
  const auto below = [](double d)
  { return Domain::half_plane(HalfPlane::below({0, 1}, d), {0, 0}, {2, 1}); };
  CHECK(area(below(0.25)) == Approx(0.5));
  CHECK(area(below(5)) == Approx(2));
  CHECK(below(-1).rings().empty());
  CHECK(below(0).rings().empty());
}
