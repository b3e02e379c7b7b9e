// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/geometry/second_moments.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

Polygon<8> box(Point lo, Point hi)
{
  Polygon<8> p;
  for (Point v : {lo, Point{hi.x, lo.y}, hi, Point{lo.x, hi.y}})
    p.push(v);
  return p;
}

/// ∫ x^n dx.
double power(double a, double b, int n)
{
  return (std::pow(b, n + 1) - std::pow(a, n + 1)) / (n + 1);
}
} // namespace

TEST_CASE("second moments: a box, by hand", "[geometry]")
{
  const Point lo = {1, -1}, hi = {3, 0.5}, about = {1.25, 0.75};
  const Point a = lo - about, b = hi - about;
  const Polygon<8> p = box(lo, hi);
  const auto x = [&](int n) { return power(a.x, b.x, n); };
  const auto y = [&](int n) { return power(a.y, b.y, n); };
  const SecondMoments flat = second_moments<Geometry::plane>(p, about);
  CHECK(flat.xx == Approx(x(2) * y(0)).epsilon(20 * eps));
  CHECK(flat.xy == Approx(x(1) * y(1)).epsilon(20 * eps));
  CHECK(flat.yy == Approx(x(0) * y(2)).epsilon(20 * eps));
  const auto rx = [&](int n) { return about.x * x(n) + x(n + 1); };
  const SecondMoments round = second_moments<Geometry::axisymmetric>(p, about);
  CHECK(round.xx == Approx(rx(2) * y(0)).epsilon(20 * eps));
  CHECK(round.xy == Approx(rx(1) * y(1)).epsilon(20 * eps));
  CHECK(round.yy == Approx(rx(0) * y(2)).epsilon(20 * eps));
}

TEST_CASE("second moments: parts add up to the whole, about any point",
          "[geometry]")
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto somewhere = [&]
  { return Point{uniform(random), uniform(random)}; };
  for (int i = 0; i < 200; ++i)
  {
    const Triangle t = polygon::turned({somewhere(), somewhere(), somewhere()});
    const HalfPlane cut = HalfPlane::left_of(somewhere(), somewhere());
    Polygon<8> in, out;
    split(Polygon<3>(t), cut, in, out);
    const Point about = somewhere();
    const auto check = [&]<Geometry G>()
    {
      const Polygon<3> whole(t);
      SecondMoments sum = second_moments<G>(in, about);
      sum += second_moments<G>(out, about);
      const SecondMoments all = second_moments<G>(whole, about);
      // Round-off of the whole unit square, also for slivers in it.
      CHECK(std::abs(sum.xx - all.xx) < 8 * eps);
      CHECK(std::abs(sum.xy - all.xy) < 8 * eps);
      CHECK(std::abs(sum.yy - all.yy) < 8 * eps);
      // Moved to the origin by the parallel axis theorem.
      const Moments m = moments<G>(whole);
      const SecondMoments far = second_moments<G>(whole, {});
      if constexpr (G == Geometry::plane)
        CHECK(far.xx
              == Approx(all.xx + 2 * about.x * m.x - about.x * about.x * m.v)
                     .margin(50 * eps));
      CHECK(far.yy
            == Approx(all.yy + 2 * about.y * m.y - about.y * about.y * m.v)
                   .margin(50 * eps));
    };
    check.operator()<Geometry::plane>();
    check.operator()<Geometry::axisymmetric>();
  }
}
