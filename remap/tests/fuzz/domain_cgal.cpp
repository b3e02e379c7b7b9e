// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Domains over meshes against CGAL's exact Boolean operations, and domains
// cleaned by its arrangements. These headers are under the GPL: so is this
// program, and no other. Without sanitizers, which the kernel's change of
// rounding mode does not suit. A failure names the number that makes it again.

#include "remap/domain/cgal/clean.h"
#include "remap/domain/partial_volumes.h"
#include "remap/tests/fuzz/domains.h"
#include "remap/tests/fuzz/exact_domain.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

using namespace remap;
using Catch::Approx;

namespace
{
using exact_domain::exact;
using exact_domain::Kernel;
using exact_domain::Polygon;
using exact_domain::Set;
using Number = Kernel::FT;
using Holed = CGAL::Polygon_with_holes_2<Kernel>;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Volume and first moments, twice: in the plane and per radian.
struct Exact
{
  std::array<Number, 3> plane = {0, 0, 0}, turned = {0, 0, 0};

  void add(const Polygon& ring)
  {
    for (auto e = ring.edges_begin(); e != ring.edges_end(); ++e)
    {
      const Number ax = e->source().x(), ay = e->source().y(),
                   bx = e->target().x(), by = e->target().y();
      const Number w = ax * by - ay * bx;
      plane[0] += w / 2;
      plane[1] += w * (ax + bx) / 6;
      plane[2] += w * (ay + by) / 6;
      turned[0] += w * (ax + bx) / 6;
      turned[1] += w * (ax * ax + ax * bx + bx * bx) / 12;
      turned[2] += w * (ax * (2 * ay + by) + bx * (ay + 2 * by)) / 24;
    }
  }
  explicit Exact(const Set& set)
  {
    std::vector<Holed> parts;
    set.polygons_with_holes(std::back_inserter(parts));
    for (const Holed& part : parts)
    {
      add(part.outer_boundary());
      for (const Polygon& hole : part.holes())
        add(hole);
    }
  }
  /// Largest difference from moments that were found.
  static double off(const std::array<Number, 3>& exact, const Moments& m)
  {
    return std::max({std::abs(CGAL::to_double(CGAL::exact(exact[0] - m.v))),
                     std::abs(CGAL::to_double(CGAL::exact(exact[1] - m.x))),
                     std::abs(CGAL::to_double(CGAL::exact(exact[2] - m.y)))});
  }
};

/// Every cell; places are up to 2 from the origin, cells up to 0.5 wide.
void check(std::uint64_t seed)
{
  const fuzz::Laid laid(seed);
  INFO("domain " << seed << " (" << laid.what() << ")");
  const Set domain = exact(laid.domain);
  DomainPieces pieces;
  const auto plane = partial_volumes<Geometry::plane>(
      laid.domain, laid.mesh.cells, laid.mesh.x, &pieces);
  const auto turned = partial_volumes<Geometry::axisymmetric>(
      laid.domain, laid.mesh.cells, laid.mesh.x);
  const std::size_t cells = laid.mesh.cells.size() / 3;
  std::vector<double> filled(cells, 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 1; k + 1 < pieces[i].size(); ++k)
      filled[static_cast<std::size_t>(pieces.cells[i])] +=
          twice_area(pieces[i][0], pieces[i][k], pieces[i][k + 1]) / 2;
  double worst = 0;
  for (std::size_t c = 0; c < cells; ++c)
  {
    Polygon triangle;
    for (const Point p : laid.place(c))
      triangle.push_back({p.x, p.y});
    Set part = domain;
    part.intersection(triangle);
    const Exact exact(part);
    worst = std::max({worst, Exact::off(exact.plane, plane.parts[c]),
                      Exact::off(exact.turned, turned.parts[c]),
                      std::abs(filled[c] - plane.parts[c].v)});
  }
  // some eps of a place times a cell, for each edge of the outline in it
  CHECK(worst < 16 * eps * 2 * 0.5);
}

double area(const Domain& domain)
{
  return domain.moments<Geometry::plane>().v;
}

double area(const Set& set)
{
  return CGAL::to_double(CGAL::exact(Exact(set).plane[0]));
}
} // namespace

TEST_CASE("domains: as CGAL's exact Boolean operations, cell by cell", "[fuzz]")
{
  for (std::uint64_t seed = 0; seed < 24; ++seed)
    check(seed);
}

TEST_CASE("domains: as CGAL's exact Boolean operations, 2400 of them",
          "[fuzz][slow]")
{
  for (std::uint64_t seed = 1000; seed < 3400; ++seed)
    check(seed);
}

TEST_CASE("cleaning: a pentagram by both rules", "[fuzz]")
{
  Ring star;
  for (int i = 0; i < 5; ++i)
  {
    const double a = std::numbers::pi * (0.5 + 0.8 * i);
    star.push_back({std::cos(a), std::sin(a)});
  }
  // Circumradius 1: the whole star, and the pentagon in it by φ² smaller than
  // the one of its tips.
  const double s = std::sin(std::numbers::pi / 5);
  const double phi = (1 + std::sqrt(5.)) / 2;
  const double tips = 2.5 * std::sin(0.4 * std::numbers::pi);
  const double middle = tips / std::pow(phi, 4);
  const double whole = 10 * 0.5 * s / (phi * phi);
  REQUIRE(not Domain::faults(std::vector{Shape{{star}, FillRule::evenodd}})
                  .empty());
  const Shape nonzero{{star}, FillRule::nonzero};
  const Shape evenodd{{star}, FillRule::evenodd};
  const Cleaned all = clean({&nonzero, 1}), odd = clean({&evenodd, 1});
  REQUIRE(all.faults.empty());
  REQUIRE(odd.faults.empty());
  CHECK(area(all.domain) == Approx(whole).epsilon(1e-14));
  CHECK(area(odd.domain) == Approx(whole - middle).epsilon(1e-14));
  CHECK(all.domain.holds({0, 0}));
  CHECK(not odd.domain.holds({0, 0}));
}

TEST_CASE("cleaning: stars on stars as CGAL's union and exclusive or", "[fuzz]")
{
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    INFO("stars " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    std::vector<Ring> rings;
    Set either, any;
    for (int i = 0; i < 4; ++i)
    {
      rings.push_back(
          fuzz::star(random, {place(random), place(random)}, 0.3, 1.5, 14));
      either.symmetric_difference(exact(rings.back()));
      any.join(exact(rings.back()));
    }
    const Shape odd{rings, FillRule::evenodd}, all{rings, FillRule::nonzero};
    const Cleaned a = clean({&odd, 1}), b = clean({&all, 1});
    REQUIRE(a.faults.empty());
    REQUIRE(b.faults.empty());
    CHECK(area(a.domain) == Approx(area(either)).epsilon(1e-14));
    CHECK(area(b.domain) == Approx(area(any)).epsilon(1e-14));
    // One shape each: the union, whatever the direction of each.
    std::vector<Shape> shapes;
    for (const Ring& ring : rings)
      shapes.push_back(
          {{seed % 2 == 0 ? ring : Ring(ring.rbegin(), ring.rend())},
           FillRule::nonzero});
    const Cleaned c = clean(shapes);
    REQUIRE(c.faults.empty());
    CHECK(area(c.domain) == Approx(area(any)).epsilon(1e-14));
  }
}

TEST_CASE("cleaning: rings on a lattice, with edges on edges", "[fuzz]")
{
  // Small integers: the area by counting the lattice's halves of squares is
  // exact; by even-odd a point is in as often as rings run around it.
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    INFO("lattice " << seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, 4);
    std::vector<Ring> rings;
    for (int i = 0; i < 5; ++i)
    {
      const double x = place(random), y = place(random);
      const double w = 1 + place(random), h = 1 + place(random);
      rings.push_back({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
    }
    int odd = 0, any = 0;
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j)
      {
        int times = 0;
        for (const Ring& r : rings)
          times += r[0].x < i + 0.5 and i + 0.5 < r[2].x and r[0].y < j + 0.5
                   and j + 0.5 < r[2].y;
        odd += times % 2;
        any += times > 0;
      }
    const Shape a{rings, FillRule::evenodd}, b{rings, FillRule::nonzero};
    const Cleaned all = clean({&b, 1});
    REQUIRE(all.faults.empty());
    CHECK(area(all.domain) == any);
    const Cleaned some = clean({&a, 1});
    if (odd == 0)
      CHECK(some.faults.at(0).what == "the rings fill nothing");
    else
    {
      REQUIRE(some.faults.empty());
      CHECK(area(some.domain) == odd);
    }
  }
}

TEST_CASE("cleaning: what cannot be cleaned is told", "[fuzz]")
{
  const Shape bad{{{{0, 0}, {1, 0}, {std::nan(""), 1}}}, FillRule::evenodd};
  CHECK(clean({&bad, 1}).faults.at(0).vertex == 2);
  CHECK(clean({}).faults.at(0).what == "the rings fill nothing");
  const Shape line{{{{0, 0}, {1, 0}, {2, 0}}}, FillRule::nonzero};
  CHECK(clean({&line, 1}).faults.at(0).what == "the rings fill nothing");
}
