// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Nodes that move on curves: a body's curved boundary, a rigid profile.

#include "remap/smoothing/boundary_curve.h"
#include "remap/smoothing/smooth.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <numbers>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// A quarter of a ring, radii 1 and 2, nodes of the inner arc gathered towards
/// one end.
struct Ring
{
  int n;
  meshes::Data data;
  Mesh mesh;
  std::vector<double> x;
  std::vector<Kind> kinds;
  std::vector<double> direction;

  explicit Ring(int n, double gathered = 0.5)
      : n(n), data(meshes::rectangle(n, n, Diagonal::crossed)),
        mesh(data.mesh()), x(data.x), direction(data.x.size())
  {
    for (std::size_t i = 0; i < x.size(); i += 2)
    {
      const double s = data.x[i], t = data.x[i + 1];
      const double along = s + gathered * (1 - t) * s * (1 - s);
      const double angle = std::numbers::pi / 2 * (1 - along);
      x[i] = (1 + t) * std::cos(angle);
      x[i + 1] = (1 + t) * std::sin(angle);
      const bool end = s == 0 or s == 1, arc = t == 0 or t == 1;
      kinds.push_back(end and arc ? Kind::fixed
                      : arc       ? Kind::curve
                      : end       ? Kind::slide
                                  : Kind::free);
      direction[i] = s == 1;
      direction[i + 1] = s == 0;
    }
  }

  /// Farthest from its arc of any node of one.
  [[nodiscard]] double off() const
  {
    double out = 0;
    for (std::size_t i = 0; i < kinds.size(); ++i)
      if (kinds[i] == Kind::curve)
      {
        const double wanted = data.x[2 * i + 1] == 0 ? 1 : 2;
        out = std::max(out,
                       std::abs(std::hypot(x[2 * i], x[2 * i + 1]) - wanted));
      }
    return out;
  }

  [[nodiscard]] double worst() const
  {
    return worst_quality(mesh, x, Measure::radius_ratio, {}, {});
  }

  /// Smoothed; with curved boundary nodes as told.
  void smooth(const Guide& guide, int sweeps = 100)
  {
    Smoothing smoothing(mesh, {.sweeps = sweeps}, {});
    const std::vector<std::uint8_t> flags(kinds.size(), 1);
    REQUIRE(smoothing.smooth(
                x, flags,
                {.kinds = kinds, .direction = direction, .guide = &guide}, {})
            == Outcome::ok);
  }
};

/// The chords between the nodes as they were: what a node that slides along
/// straight facets would do.
Polyline chords(const Ring& ring)
{
  std::vector<Point> points;
  for (int i = 0; i <= ring.n; ++i)
    points.push_back(point(ring.x, i));
  return Polyline(points);
}
} // namespace

TEST_CASE("boundary curve: nodes slide along an arc and stay on it",
          "[smoothing][curve]")
{
  Ring ring(16);
  const double before = ring.worst();
  const auto x0 = ring.x;
  BoundaryCurve curve(ring.mesh);
  curve.follow(ring.x, ring.kinds, {});
  ring.smooth(curve);
  CHECK(ring.worst() > before);
  double slid = 0;
  for (int i = 0; i <= ring.n; ++i)
    slid = std::max(slid, std::hypot(ring.x[2 * i] - x0[2 * i],
                                     ring.x[2 * i + 1] - x0[2 * i + 1]));
  CHECK(slid > 0.02); // a quarter of a facet
  // Facets are 0.1 long: chords would be off by 0.1² / 8 = 1.2e-3.
  CHECK(ring.off() < 2e-5);
}

TEST_CASE("boundary curve: off by O(h⁴), chords by O(h²)", "[smoothing][curve]")
{
  // Facets of even length, each node brought to its curve from half a facet
  // away; the arcs have radius 1.
  const auto off = [](int n, bool cubic)
  {
    Ring ring(n, 0);
    BoundaryCurve curve(ring.mesh);
    curve.follow(ring.x, ring.kinds, {});
    const Polyline line = chords(ring);
    const Guide& guide = cubic ? static_cast<const Guide&>(curve) : line;
    double out = 0;
    for (int i = 2; i < n - 1; ++i) // the ends apart: below
    {
      const double angle = std::numbers::pi / 2 * (1 - (i + 0.5) / n);
      const Point p = {std::cos(angle), std::sin(angle)};
      const Point at = guide.foot(i, p).at;
      out = std::max(out, std::abs(std::hypot(at.x, at.y) - 1));
    }
    return out;
  };
  CHECK(off(8, false) / off(16, false) == Approx(4).epsilon(0.05));
  CHECK(off(8, true) / off(16, true) == Approx(16).epsilon(0.1));
  CHECK(off(16, true) < 1e-6);
}

TEST_CASE("boundary curve: the cubic at a curve's end is of third order",
          "[smoothing][curve]")
{
  const auto off = [](int n)
  {
    Ring ring(n, 0);
    BoundaryCurve curve(ring.mesh);
    curve.follow(ring.x, ring.kinds, {});
    const double angle = std::numbers::pi / 2 * (1 - 0.5 / n);
    const Point at = curve.foot(1, {std::cos(angle), std::sin(angle)}).at;
    return std::abs(std::hypot(at.x, at.y) - 1);
  };
  CHECK(off(16) / off(32) > 7);
  CHECK(off(16) < 2e-4);
}

TEST_CASE("boundary curve: a straight boundary stays straight",
          "[smoothing][curve]")
{
  const meshes::Data data = meshes::rectangle(6, 6, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < data.x.size(); i += 2)
    kinds.push_back(data.x[i + 1] == 1 and data.x[i] > 0 and data.x[i] < 1
                        ? Kind::curve
                        : Kind::fixed);
  BoundaryCurve curve(mesh);
  curve.follow(data.x, kinds, {});
  for (int i = 1; i < 6; ++i)
    for (double d : {-0.12, 0.0, 0.05})
    {
      const auto foot = curve.foot(42 + i, {i / 6.0 + d, 1.1});
      CHECK(foot.at.x == Approx(i / 6.0 + d).epsilon(1e-12));
      CHECK(foot.at.y == Approx(1).epsilon(1e-14));
      CHECK(foot.along.y == Approx(0).margin(1e-14));
    }
}

TEST_CASE("profile: nodes are held to it and slide along it",
          "[smoothing][curve]")
{
  // The bottom of a block lies on a rigid wedge; nodes are not where cells want
  // them. The tip is one of the profile's points.
  constexpr int n = 12;
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const Polyline wedge({{-1, -0.2}, {0.5, 0.1}, {2, -0.2}});
  auto x = data.x;
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < x.size(); i += 2)
  {
    const double s = data.x[i], t = data.x[i + 1];
    const double at = s + 0.5 * (1 - t) * s * (1 - s) * (0.5 - s);
    const double foot = 0.1 - 0.2 * std::abs(at - 0.5);
    x[i] = at;
    x[i + 1] = foot + t * (1 - foot);
    const bool end = s == 0 or s == 1;
    kinds.push_back(t == 0 and not end           ? Kind::curve
                    : meshes::on_outline({s, t}) ? Kind::fixed
                                                 : Kind::free);
  }
  const auto x0 = x;
  Smoothing smoothing(mesh, {.sweeps = 50}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds, .guide = &wedge}, {})
          == Outcome::ok);
  double slid = 0;
  for (int i = 1; i < n; ++i)
  {
    CHECK(std::abs(x[2 * i + 1] - (0.1 - 0.2 * std::abs(x[2 * i] - 0.5)))
          < 1e-15);
    slid = std::max(slid, std::abs(x[2 * i] - x0[2 * i]));
  }
  CHECK(slid > 1e-3);
  CHECK(smoothing.report().worst_after >= smoothing.report().worst_before);
}

TEST_CASE("profile: a node that has left it comes back", "[smoothing][curve]")
{
  constexpr int n = 6;
  const meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const Polyline floor({{-1, 0}, {2, 0}});
  auto x = data.x;
  x[2 * 3 + 1] = -0.01;
  std::vector<Kind> kinds(mesh.num_nodes(), Kind::fixed);
  kinds[3] = Kind::curve;
  Smoothing smoothing(mesh, {}, {});
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  REQUIRE(smoothing.smooth(x, flags, {.kinds = kinds, .guide = &floor}, {})
          == Outcome::ok);
  CHECK(x[2 * 3 + 1] == 0);
  // And without a guide it is the caller's mistake.
  CHECK(smoothing.smooth(x, flags, {.kinds = kinds}, {})
        == Outcome::wrong_size);
}
