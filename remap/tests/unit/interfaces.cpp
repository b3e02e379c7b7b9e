// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The parts of reconstruction by themselves: lines placed, the best cut beside
// a search over all directions, strips, junctions, pictures.

#include "remap/interfaces/pieces.h"
#include "remap/tests/fuzz/cells.h"
#include "remap/tests/partitions.h"

#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <limits>

using namespace remap;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

Piece piece(const Triangle& t)
{
  Piece out;
  for (const Point& p : t)
    out.push(p);
  return out;
}

/// Regular polygon, turned, beside the axis.
Piece regular(int n, double turn)
{
  Piece out;
  for (int i = 0; i < n; ++i)
  {
    const double a = turn + 2 * std::numbers::pi * i / n;
    out.push({1.2 + std::cos(a), std::sin(a)});
  }
  return out;
}

template <Geometry G>
void place_lines()
{
  for (int n = 3; n <= 8; ++n)
    for (int k = 0; k < 50; ++k)
    {
      const Piece p = regular(n, 0.1 * k);
      const double all = moments<G>(p).v;
      const double angle = 0.37 * k;
      const Point normal = {std::cos(angle), std::sin(angle)};
      for (const double f : {1e-14, 1e-9, 1e-4, 0.1, 0.25, 0.5, 0.73, 0.999})
      {
        Piece in, out;
        split(p, place_fraction<G>(p, normal, f, 1 - f, 0), in, out);
        INFO(n << " corners, fraction " << f << ", angle " << angle);
        CHECK(std::abs(moments<G>(in).v / all - f) < 4 * eps);
      }
    }
}

/// Σ fraction · distance² of both parts for a line of this direction; by
/// bisection and clipping alone.
template <Geometry G>
double error_at(const Triangle& t, std::span<const Part> parts, double angle)
{
  const Point n = {std::cos(angle), std::sin(angle)};
  const Piece p = piece(t);
  const double all = moments<G>(p).v;
  double lo = 1e300, hi = -1e300;
  for (const Point& v : t)
  {
    lo = std::min(lo, dot(n, v));
    hi = std::max(hi, dot(n, v));
  }
  Piece in, out;
  for (int i = 0; i < 60; ++i)
  {
    const double d = 0.5 * (lo + hi);
    split(p, HalfPlane{n, d * n}, in, out);
    (moments<G>(in).v < parts[0].fraction * all ? lo : hi) = d;
  }
  const Point a = moments<G>(in).centroid() - parts[0].centroid,
              b = moments<G>(out).centroid() - parts[1].centroid;
  return parts[0].fraction * dot(a, a) + parts[1].fraction * dot(b, b);
}

/// Targets that no line meets: the best of a scan must not be better.
template <Geometry G>
void beat_the_scan(int cells)
{
  for (int k = 0; k < cells; ++k)
  {
    fuzz::Random r(static_cast<std::uint64_t>(k) + 77);
    const double aspect = k % 3 == 0 ? 0.02 : 1;
    const Triangle t = fuzz::triangle(r, aspect, G == Geometry::axisymmetric);
    const double f = 0.01 + 0.98 * fuzz::draw(r);
    const auto place = [&]
    {
      double p = fuzz::draw(r), q = fuzz::draw(r);
      if (p + q > 1)
        p = 1 - p, q = 1 - q;
      return t[0] + p * (t[1] - t[0]) + q * (t[2] - t[0]);
    };
    // Anywhere in the cell; the other one where it must then be, or not.
    const Moments all = moments<G>(Polygon<3>(t));
    const Point g = place();
    const Point h =
        k % 2 == 0 ? 1 / (1 - f) * (all.centroid() - f * g) : place();
    const Part parts[2] = {{0, f, g}, {1, 1 - f, h}};
    Partition by;
    const Tally tally =
        reconstruction::MomentOfFluid{.filament = 1e9}.solve<G>(t, parts, by);
    double least = 1e300;
    constexpr int steps = 720;
    for (int i = 0; i < steps; ++i)
    {
      // Directions as they are spread in a cell of this aspect.
      const double a = 2 * std::numbers::pi * i / steps;
      least = std::min(
          least,
          error_at<G>(t, parts, std::atan2(std::sin(a), aspect * std::cos(a))));
    }
    INFO("cell " << k << ": found " << tally.error << ", scan " << least);
    CHECK(tally.error <= least * (1 + 1e-9));
    // What is reported is what is there.
    const auto m = fuzz::moments_by<G>(t, by, 2);
    double real = 0;
    for (int i = 0; i < 2; ++i)
    {
      const Point d = m[i].centroid() - parts[i].centroid;
      real += parts[i].fraction * dot(d, d);
    }
    CHECK(std::abs(real - tally.error) < 1e-11 * (real + all.v));
  }
}
} // namespace

TEST_CASE("placement: volumes are met to 4 eps of the polygon", "[interfaces]")
{
  place_lines<Geometry::plane>();
  place_lines<Geometry::axisymmetric>();
}

TEST_CASE("moment of fluid: no direction is better than what is found",
          "[interfaces]")
{
  beat_the_scan<Geometry::plane>(300);
  beat_the_scan<Geometry::axisymmetric>(100);
}

TEST_CASE("moment of fluid: a triangle's closed form and the turning line "
          "agree",
          "[interfaces]")
{
  for (std::uint64_t k = 0; k < 500; ++k)
  {
    fuzz::Random r(k);
    const Triangle t = fuzz::triangle(r, k % 2 == 0 ? 1 : 1e-3, false);
    const double f = std::pow(10, -6 * fuzz::draw(r));
    const Point o = 1.0 / 3 * (t[0] + t[1] + t[2]);
    const double p = fuzz::draw(r), q = (1 - p) * fuzz::draw(r);
    const Point g = p * (t[1] - o) + q * (t[2] - o);
    if (f > 0.99)
      continue;
    const Target in = {f, g}, out = {1 - f, -f / (1 - f) * g};
    Piece local;
    for (const Point& v : t)
      local.push(v - o);
    const Straight a =
        best_cut(Triangle{local[0], local[1], local[2]}, in, out);
    const Straight b = best_cut<Geometry::plane>(
        local, moments<Geometry::plane>(local), in, out, 0);
    INFO("cell " << k << ", fraction " << f << ": " << a.error << ", off by "
                 << a.error - b.error);
    // Corners of 1e-3 of an edge know their own size to 1e-9 in slivers.
    CHECK(std::abs(a.error - b.error) <= 1e-8 * a.error + 1e-28);
  }
}

TEST_CASE("interfaces: pieces for pictures fill the cell", "[interfaces]")
{
  const Triangle t = {Point{0.1, 0.2}, {1.3, 0.1}, {0.5, 1.4}};
  const Partition by = partitions::wye({0.6, 0.5}, 0.4);
  double area = 0;
  int count = 0;
  for (const CellPiece& p : pieces(t, by))
  {
    CHECK(p.outline.size() >= 3);
    Piece q;
    for (const Point& v : p.outline)
      q.push(v);
    area += moments<Geometry::plane>(q).v;
    ++count;
    CHECK((p.part >= 0 and p.part < 3));
  }
  // The widest wedge has two pieces.
  CHECK(count == 4);
  CHECK(std::abs(area / moments<Geometry::plane>(Polygon<3>(t)).v - 1)
        < 8 * eps);
}
