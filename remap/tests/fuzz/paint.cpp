// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Painting random coats over random meshes, held to inclusion and exclusion of
// convex polygons in long double, and to coats that were merged by hand. A
// failure names the number that makes it again.

#include "remap/domain/paint.h"
#include "remap/domain/partial_volumes.h"
#include "remap/geometry/position.h"
#include "remap/tests/fuzz/domains.h"

#include <algorithm>
#include <array>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

using namespace remap;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Area and first moments with more digits than the code under test has.
struct Exact
{
  long double v = 0, x = 0, y = 0;

  Exact& add(long double sign, const Exact& b)
  {
    v += sign * b.v, x += sign * b.x, y += sign * b.y;
    return *this;
  }
};

/// A convex polygon, counter-clockwise, in long double.
using Corners = std::vector<std::array<long double, 2>>;

Corners corners(std::span<const Point> ring)
{
  Corners out;
  for (const Point p : ring)
    out.push_back({p.x, p.y});
  return out;
}

/// What of p lies to the left of the way from a to b.
Corners left_of(const Corners& p, std::array<long double, 2> a,
                std::array<long double, 2> b)
{
  Corners out;
  const auto depth = [&](const auto& q)
  { return (b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0]); };
  for (std::size_t i = 0; i < p.size(); ++i)
  {
    const auto &q = p[i], &r = p[(i + 1) % p.size()];
    const long double d = depth(q), e = depth(r);
    if (d >= 0)
      out.push_back(q);
    if ((d > 0 and e < 0) or (d < 0 and e > 0))
      out.push_back({q[0] + d / (d - e) * (r[0] - q[0]),
                     q[1] + d / (d - e) * (r[1] - q[1])});
  }
  return out;
}

Corners common(Corners p, const Corners& q)
{
  for (std::size_t i = 0; i < q.size(); ++i)
    p = left_of(p, q[i], q[(i + 1) % q.size()]);
  return p;
}

/// Per radian about the axis x = 0 if turned.
Exact moments(const Corners& p, bool turned)
{
  Exact out;
  for (std::size_t i = 1; i + 1 < p.size(); ++i)
  {
    const auto &a = p[0], &b = p[i], &c = p[i + 1];
    const long double area =
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    // Middles of the edges: exact for squares.
    for (const auto& [q, r] :
         {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
    {
      const long double x = (q[0] + r[0]) / 2, y = (q[1] + r[1]) / 2;
      const long double w = area / 3 * (turned ? x : 1.0L);
      out.v += w, out.x += w * x, out.y += w * y;
    }
  }
  return out;
}

/// Three convex coats over a mesh of the square from (0.5, 0) to (1.5, 1).
struct Laid
{
  meshes::Data mesh;
  std::vector<Ring> rings;
  int kind;

  explicit Laid(std::uint64_t seed) : kind(static_cast<int>(seed % 5))
  {
    std::mt19937 random(static_cast<unsigned>(seed));
    const int n = 1 + static_cast<int>(seed / 5 % 5);
    mesh = meshes::rectangle(n, n, meshes::Diagonal::crossed, 0.5);
    std::uniform_real_distribution<double> any(0, 1);
    if (kind != 3)
      for (int j = 1; j < n; ++j)
        for (int i = 1; i < n; ++i)
          for (int k = 0; k < 2; ++k)
            mesh.x[static_cast<std::size_t>(2 * (j * (n + 1) + i) + k)] +=
                (0.5 * any(random) - 0.25) / n;
    for (int k = 0; k < 3; ++k)
      rings.push_back(make(random, n));
  }

  [[nodiscard]] Triangle place(std::size_t c) const
  {
    return polygon::turned({point(mesh.x, mesh.cells[3 * c]),
                            point(mesh.x, mesh.cells[3 * c + 1]),
                            point(mesh.x, mesh.cells[3 * c + 2])});
  }

private:
  Ring make(std::mt19937& random, int n) const
  {
    std::uniform_real_distribution<double> any(0, 1);
    switch (kind)
    {
    case 0: // corners on a circle
    case 1: // of a size that needs the far corners
    {
      const double r = (kind == 0 ? 0.4 : 30) * (0.2 + any(random));
      const double a = 2 * std::numbers::pi * any(random);
      const Point c = kind == 0
                          ? Point{0.5 + any(random), any(random)}
                          : Point{1, 0.5} - r * Point{std::cos(a), std::sin(a)};
      const int m = 3 + static_cast<int>(9 * any(random));
      Ring out;
      for (int i = 0; i < m; ++i)
      {
        const double b = 2 * std::numbers::pi * (i + 0.8 * any(random)) / m;
        out.push_back(c + r * Point{std::cos(b), std::sin(b)});
      }
      return out;
    }
    case 2: // edges and corners of the others: on one lattice
    case 3: // and on the mesh's nodes and lines
    {
      std::uniform_int_distribution<int> step(0, kind == 2 ? 7 : n);
      const double h = 1.0 / (kind == 2 ? 7 : n);
      for (;;)
      {
        const auto at = [&]
        { return Point{0.5 + h * step(random), h * step(random)}; };
        const Point a = at(), b = at(), c = at();
        const double area = twice_area(a, b, c);
        if (std::abs(area) > 1e-3)
          return area > 0 ? Ring{a, b, c} : Ring{a, c, b};
      }
    }
    default: // threads
    {
      const Point a{0.5 + any(random), any(random)};
      const double angle = 2 * std::numbers::pi * any(random);
      const Point d = Point{std::cos(angle), std::sin(angle)};
      const Point w = 1e-6 * any(random) * Point{-d.y, d.x};
      return {a - d, a + d, a + d + w, a - d + w};
    }
    }
  }
};

/// What is seen of material k, 0 being under all coats: exact but for the last
/// digits of long double.
Exact seen(const Triangle& t, const std::vector<Corners>& coats, std::size_t k,
           bool turned)
{
  Corners own = corners(t);
  if (k > 0)
    own = common(own, coats[k - 1]);
  // Without the union of those above, by inclusion and exclusion.
  Exact out;
  const std::size_t above = coats.size() - k;
  for (std::size_t set = 0; set < std::size_t(1) << above; ++set)
  {
    Corners p = own;
    int sign = 1;
    for (std::size_t i = 0; i < above; ++i)
      if ((set >> i & 1) != 0)
      {
        p = common(p, coats[k + i]);
        sign = -sign;
      }
    out.add(sign, moments(p, turned));
  }
  return out;
}

Moments held(const Materials& m, std::int32_t c, int k, const Moments& all)
{
  if (m.pure(c) >= 0)
    return m.pure(c) == k ? all : Moments{};
  for (const Part& p : m.parts(m.row(c)))
    if (p.material == k)
    {
      const double v = p.fraction * all.v;
      return {v, v * p.centroid.x, v * p.centroid.y};
    }
  return {};
}

template <Geometry G>
void check(const Laid& laid)
{
  std::vector<Coat> coats = {{.domain = {}, .material = 0, .everywhere = true}};
  std::vector<Corners> convex;
  double size = 2;
  for (std::size_t k = 0; k < laid.rings.size(); ++k)
  {
    coats.push_back({Domain::polygon(laid.rings[k]), static_cast<int>(k) + 1});
    convex.push_back(corners(laid.rings[k]));
    for (const Point p : laid.rings[k])
      size = std::max({size, std::abs(p.x - 1), std::abs(p.y)});
  }
  const int num = static_cast<int>(coats.size());
  const Painting p = paint<G>(coats, laid.mesh.cells, laid.mesh.x, num);
  bool bare = not p.bare.empty() or not p.crowded.empty();
  double worst = 0, sums = 0;
  for (std::int32_t c = 0; c < p.materials.num_cells(); ++c)
  {
    const Triangle t = laid.place(static_cast<std::size_t>(c));
    const Moments all = triangle<G>(t[0], t[1], t[2]);
    double sum = 0;
    for (int k = 0; k < num; ++k)
    {
      const Exact exact = seen(t, convex, static_cast<std::size_t>(k),
                               G == Geometry::axisymmetric);
      const Moments found = held(p.materials, c, k, all);
      // Cells are of the size of their longest edge; coordinates up to 2.
      const double tolerance = 64 * eps * size * position::longest_edge(t);
      worst = std::max(
          {worst, static_cast<double>(std::abs(found.v - exact.v)) / tolerance,
           static_cast<double>(std::abs(found.x - exact.x)) / tolerance / 2,
           static_cast<double>(std::abs(found.y - exact.y)) / tolerance / 2});
      sum += p.materials.fraction(c, k);
    }
    sums = std::max(sums, std::abs(sum - 1));
  }
  CHECK(not bare);
  CHECK(worst < 1);
  CHECK(sums < 1e-14);
}

void run(std::uint64_t from, std::uint64_t to)
{
  for (std::uint64_t seed = from; seed < to; ++seed)
  {
    const Laid laid(seed);
    INFO("number " << seed << ", kind " << laid.kind);
    check<Geometry::plane>(laid);
    check<Geometry::axisymmetric>(laid);
  }
}
} // namespace

TEST_CASE("paint: as inclusion and exclusion on 400 sets of coats", "[fuzz]")
{
  run(0, 400);
}

TEST_CASE("paint: as inclusion and exclusion on 40 000 sets of coats",
          "[fuzz][slow]")
{
  run(400, 40400);
}

TEST_CASE("paint: a star in two coats is the star in one", "[fuzz]")
{
  // Cut through its centre from vertex to vertex; the second half also laid
  // over the first one with an overlap of some of its rays.
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    INFO("star " << seed);
    const fuzz::Laid laid(6 * seed); // a shaken mesh
    std::mt19937 random(seed);
    const Point centre{1, 0.5};
    const int n = 12 + static_cast<int>(seed % 20);
    const Ring star = fuzz::star(random, centre, 0.1, 0.5, n);
    const auto sector = [&](int from, int to)
    {
      Ring out = {centre};
      for (int i = from; i <= to; ++i)
        out.push_back(star[static_cast<std::size_t>(i % n)]);
      return Domain::polygon(out);
    };
    const auto painted = [&](std::vector<Coat> coats)
    {
      coats.insert(coats.begin(), {{}, 0, true});
      return paint<Geometry::plane>(coats, laid.mesh.cells, laid.mesh.x, 2);
    };
    const int half = n / 2;
    const Materials whole = painted({{Domain::polygon(star), 1}}).materials;
    const Materials parts =
        painted({{sector(0, half), 1}, {sector(half, n), 1}}).materials;
    const Materials overlap =
        painted({{sector(0, half + 2), 1}, {sector(half, n), 1}}).materials;
    const auto exact = partial_volumes<Geometry::plane>(
        Domain::polygon(star), laid.mesh.cells, laid.mesh.x);
    double worst = 0;
    for (std::int32_t c = 0; c < whole.num_cells(); ++c)
    {
      const Triangle t = laid.place(static_cast<std::size_t>(c));
      const double all = std::abs(twice_area(t[0], t[1], t[2])) / 2;
      const double share = exact.parts[static_cast<std::size_t>(c)].v / all;
      for (const Materials* m : {&whole, &parts, &overlap})
        worst = std::max(worst, std::abs(m->fraction(c, 1) - share));
    }
    CHECK(worst < 1e-13);
  }
}
