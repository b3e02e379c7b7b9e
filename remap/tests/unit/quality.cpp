// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/optimise.h"
#include "remap/tests/meshes.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

/// |T|²/(2 det T), T = A W⁻¹ written out, as the definition has it.
double distortion_by_definition(Point p, Point q, Point u, Point v)
{
  const double w = cross(u, v);
  const double inverse[2][2] = {{v.y / w, -v.x / w}, {-u.y / w, u.x / w}};
  const double a[2][2] = {{p.x, q.x}, {p.y, q.y}};
  double t[2][2] = {}, norm = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
    {
      for (int k = 0; k < 2; ++k)
        t[i][j] += a[i][k] * inverse[k][j];
      norm += t[i][j] * t[i][j];
    }
  return norm / (2 * (t[0][0] * t[1][1] - t[0][1] * t[1][0]));
}

struct Points
{
  std::mt19937 engine;
  std::uniform_real_distribution<double> u{-1.0, 1.0};
  explicit Points(unsigned seed) : engine(seed) {}
  Point operator()() { return {u(engine), u(engine)}; }
};
} // namespace

TEST_CASE("quality: radius ratios known by hand", "[quality]")
{
  using quality::radius_ratio;
  CHECK(radius_ratio({0, 0}, {3, 0}, {0, 4}) == Approx(0.8).epsilon(4 * eps));
  CHECK(radius_ratio({0, 0}, {1, 0}, {0, 1})
        == Approx(2 * (std::numbers::sqrt2 - 1)).epsilon(4 * eps));
  CHECK(radius_ratio({0, 0}, {1, 0}, {0.5, std::numbers::sqrt3 / 2})
        == Approx(1).epsilon(4 * eps));
  CHECK(radius_ratio({0, 0}, {0, 4}, {3, 0}) == Approx(-0.8).epsilon(4 * eps));
  CHECK(radius_ratio({0, 0}, {1, 1}, {2, 2}) == 0);
}

TEST_CASE("quality: shape is |T|²/(2 det T) written out", "[quality]")
{
  const auto seed = GENERATE(1u, 2u);
  INFO("seed " << seed);
  Points draw(seed);
  for (int k = 0; k < 1000; ++k)
  {
    const Point p = draw(), q = draw(), u = draw(), v = draw();
    if (std::abs(cross(p, q)) < 1e-2 or std::abs(cross(u, v)) < 1e-2)
      continue;
    const double wanted = distortion_by_definition(p, q, u, v);
    const auto target = quality::Target::of(u, v);
    // Cancellation is bounded by the areas above 1e-2.
    CHECK(quality::distortion(target, p, q) == Approx(wanted).epsilon(1e-11));
    CHECK(quality::shape(target, {0, 0}, p, q)
          == Approx(1 / wanted).epsilon(1e-11));
    // The same cell and target, both seen from the next vertex.
    CHECK(quality::distortion(target.next(), q - p, Point{0, 0} - p)
          == Approx(wanted).epsilon(1e-10));
  }
}

TEST_CASE("quality: the mean ratio of 3-4-5 is 4√3·6/50", "[quality]")
{
  CHECK(quality::shape(quality::equilateral, {0, 0}, {3, 0}, {0, 4})
        == Approx(4 * std::numbers::sqrt3 * 6 / 50).epsilon(4 * eps));
}

TEST_CASE("optimise: gradient and Hessian agree with differences", "[quality]")
{
  const PatchCell cells[] = {
      {{1, 0}, {0.4, 0.9}, quality::equilateral},
      {{0.4, 0.9}, {-0.8, 0.5}, quality::Target::of({2, 0.1}, {0.3, 1})},
      {{-0.8, 0.5}, {-0.2, -1}, quality::Target::of({1, 0}, {0, 3})},
      {{-0.2, -1}, {1, 0}, quality::Target::of({1, 0.5}, {-0.2, 1})}};
  const Point x = {0.1, -0.05};
  const auto f = [&](double dx, double dy)
  {
    double sum = 0;
    for (const PatchCell& c : cells)
      sum += quality::distortion(c.target, c.a - x - Point{dx, dy},
                                 c.b - x - Point{dx, dy});
    return sum;
  };
  const smoother::Distortion d = smoother::distortion_of_power(cells, x);
  const double h = 1e-4; // error h² of the central differences
  CHECK(d.f == Approx(f(0, 0)).epsilon(1e-14));
  CHECK(d.g.x == Approx((f(h, 0) - f(-h, 0)) / (2 * h)).epsilon(1e-6));
  CHECK(d.g.y == Approx((f(0, h) - f(0, -h)) / (2 * h)).epsilon(1e-6));
  CHECK(d.xx
        == Approx((f(h, 0) - 2 * f(0, 0) + f(-h, 0)) / (h * h)).epsilon(1e-6));
  CHECK(d.yy
        == Approx((f(0, h) - 2 * f(0, 0) + f(0, -h)) / (h * h)).epsilon(1e-6));
  CHECK(d.xy
        == Approx((f(h, h) - f(h, -h) - f(-h, h) + f(-h, -h)) / (4 * h * h))
               .epsilon(1e-6));
}
