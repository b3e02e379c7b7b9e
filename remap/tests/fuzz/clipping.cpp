// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Clipping on random and degenerate pairs, fit for sanitizers: parts = whole,
// and answers of exact arithmetic that were stored. A failure names the pair's
// number: fuzz::pair(number) is that pair.

#include "remap/tests/fuzz/pairs.h"

#include <algorithm>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

using namespace remap;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Side of the box around both triangles.
double extent(const fuzz::Pair& p)
{
  Point lo = p.a[0], hi = lo;
  for (const Triangle& t : {p.a, p.b})
    for (const Point& v : t)
    {
      lo = {std::min(lo.x, v.x), std::min(lo.y, v.y)};
      hi = {std::max(hi.x, v.x), std::max(hi.y, v.y)};
    }
  return std::max(hi.x - lo.x, hi.y - lo.y);
}

bool near(const Moments& a, const Moments& b, double tolerance)
{
  // Written so that NaN fails. Moments: coordinates are at most 3.
  return std::abs(a.v - b.v) <= tolerance
         and std::abs(a.x - b.x) <= 3 * tolerance
         and std::abs(a.y - b.y) <= 3 * tolerance;
}

/// What is left of a, and what falls off, when cut by the edges of b one after
/// the other.
template <Geometry G>
std::pair<Moments, Moments> cut_up(const Triangle& a, const Triangle& b)
{
  const Triangle s = polygon::turned(a), t = polygon::turned(b);
  Polygon<8> rest(s), in, out;
  Moments off;
  for (int k = 0; k < 3; ++k)
  {
    split(rest, HalfPlane::left_of(t[k], t[(k + 1) % 3]), in, out);
    off += moments<G>(out);
    rest = in;
  }
  return {moments<G>(rest), off};
}

template <Geometry G>
void check_parts(const fuzz::Pair& p)
{
  // Coordinates have errors of eps/2 of the extent, at most ten corners and
  // thrice as many products.
  const double size = extent(p);
  const double weight = G == Geometry::plane ? 1 : 3;
  const double tolerance = 16 * eps * weight * size * size;
  const auto whole = [](const Triangle& t)
  { return moments<G>(Polygon<3>(polygon::turned(t))); };
  const auto ab = overlap<G>(p.a, p.b), ba = overlap<G>(p.b, p.a);
  const auto [in, off] = cut_up<G>(p.a, p.b);
  const bool parts = near(in + off, whole(p.a), tolerance);
  const bool same = near(ab, in, tolerance) and near(ab, ba, tolerance);
  const bool inside = ab.v >= 0 and ab.v <= whole(p.a).v + tolerance
                      and ab.v <= whole(p.b).v + tolerance;
  if (not(parts and same and inside))
  {
    INFO("pair " << p.seed << " (" << fuzz::kinds[p.kind] << ")");
    INFO("tolerance " << tolerance << " overlap " << ab.v << " " << ba.v
                      << " cut " << in.v << " off " << off.v << " whole "
                      << whole(p.a).v << " " << whole(p.b).v);
    CHECK(parts);
    CHECK(same);
    CHECK(inside);
  }
}

/// Axisymmetric volumes are those of triangles beside the axis.
void check_pairs(std::uint64_t first, std::uint64_t count)
{
  for (std::uint64_t k = 0; k < count; ++k)
  {
    const fuzz::Pair p = fuzz::pair(first + k);
    check_parts<Geometry::plane>(p);
    const auto beside = [](const Triangle& t)
    {
      return std::all_of(t.begin(), t.end(), [](Point v) { return v.x >= 0; });
    };
    if (beside(p.a) and beside(p.b))
      check_parts<Geometry::axisymmetric>(p);
  }
  SUCCEED();
}
} // namespace

TEST_CASE("clipping: parts are the whole on 10 000 pairs", "[fuzz]")
{
  check_pairs(0, 10'000);
}

TEST_CASE("clipping: parts are the whole on 1 000 000 pairs", "[fuzz][slow]")
{
  check_pairs(1'000'000, 1'000'000);
}

TEST_CASE("clipping: 10 000 overlaps as exact arithmetic has them", "[fuzz]")
{
  std::ifstream file(REMAP_EXACT_OVERLAPS);
  REQUIRE(file);
  const auto number = [](const std::string& text)
  {
    const bool negative = text[0] == '-';
    const double v =
        std::strtod(("0x" + text.substr(negative)).c_str(), nullptr);
    return negative ? -v : v;
  };
  std::uint64_t n = 0, with_area = 0;
  double worst = 0;
  for (std::string line; std::getline(file, line); ++n)
  {
    std::istringstream in(line);
    std::string v, x, y;
    in >> v >> x >> y;
    const fuzz::Pair p = fuzz::pair(n);
    const Moments m = overlap<Geometry::plane>(p.a, p.b);
    const double size = extent(p);
    const double tolerance = 4 * eps * size * size;
    worst = std::max(worst, std::abs(m.v - number(v)) / (eps * size * size));
    with_area += number(v) > 0;
    bool good = std::abs(m.v - number(v)) <= tolerance;
    if (not x.empty())
      good = good and near(m, {number(v), number(x), number(y)}, tolerance);
    if (not good)
    {
      INFO("pair " << p.seed << " (" << fuzz::kinds[p.kind] << ")");
      CHECK(m.v == number(v));
    }
  }
  INFO("largest error in eps of the box around both: " << worst);
  CHECK(n == 10'000);
  CHECK(with_area > 5'000);
  CHECK(worst < 4);
}
