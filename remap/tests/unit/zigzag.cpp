// SPDX-License-Identifier: LGPL-3.0-or-later
//
// A zigzag of a free surface, and what must not be taken for one.

#include "remap/geometry/volumes.h"
#include "remap/smoothing/smooth.h"
#include "remap/smoothing/surface.h"
#include "remap/tests/meshes.h"
#include "remap/tests/ranks.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <numeric>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
/// A block whose top has a wave of some amplitude and length, in facets.
struct Block
{
  static constexpr int n = 16;
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed, 0.5, 0);
  std::vector<double> x = data.x;
  std::vector<Kind> kinds;

  Block(double amplitude, double facets)
  {
    for (std::size_t i = 0; i < x.size(); i += 2)
    {
      const double s = (data.x[i] - 0.5) * n, t = data.x[i + 1];
      const bool top = t == 1 and s > 0 and s < n;
      const double phase = 2 * std::numbers::pi * s / facets;
      x[i + 1] += t * amplitude / n * std::cos(phase);
      kinds.push_back(top ? Kind::surface
                      : meshes::on_outline({data.x[i], t}, 0.5, 0)
                          ? Kind::fixed
                          : Kind::free);
    }
  }

  /// Largest height of a surface node over the line of its neighbours, in
  /// facets; the ends of the surface apart.
  [[nodiscard]] double roughness(std::span<const double> at) const
  {
    double out = 0;
    for (int i = 2; i < n - 1; ++i)
    {
      const auto p = [&](int k) { return point(at, n * (n + 1) + k); };
      const Point chord = p(i + 1) - p(i - 1);
      out = std::max(out, n * std::abs(cross(chord, p(i) - p(i - 1)))
                              / std::sqrt(dot(chord, chord)));
    }
    return out;
  }

  [[nodiscard]] double volume(Geometry geometry,
                              std::span<const double> at) const
  {
    std::vector<double> v(data.cells.size() / 3);
    cell_volumes(data.mesh(), geometry, at, v);
    return std::accumulate(v.begin(), v.end(), 0.0);
  }
};

/// Smoothed, the surface towards even facets.
std::vector<double> smoothed(const Block& block, Geometry geometry, int sweeps)
{
  const Mesh mesh = block.data.mesh();
  const std::vector<double> spacing(mesh.num_facets(), 1.0);
  const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  Smoothing smoothing(mesh, {.geometry = geometry, .sweeps = sweeps}, {});
  auto x = block.x;
  REQUIRE(
      smoothing.smooth(x, flags, {.kinds = block.kinds, .spacing = spacing}, {})
      == Outcome::ok);
  return x;
}
} // namespace

TEST_CASE("zigzag: moves of one node along its chord keep it", "[zigzag]")
{
  // The naive way: heights over chords stay, however often nodes are spread.
  const Point a{0, 0}, c{2, 0};
  Point b{1, 0.5};
  for (int k = 0; k < 10; ++k)
    b = surface::at<Geometry::plane>(a, b, c, surface::part(a, b, c, 1.0, 1.0));
  CHECK(b.y == 0.5);
}

TEST_CASE("zigzag: two nodes lose a turn and keep the area", "[zigzag]")
{
  // By hand: heights 1 and −1, chord of three facets along x. Over its
  // neighbours' line the first stands 1 + 1/2, the second −3/2; steps of −1 and
  // 1 make the way straight.
  const surface::Step even =
      surface::straighten({0, 0}, {1, 1}, {2, -1}, {3, 0});
  CHECK(even.first == Approx(-1));
  CHECK(even.second == Approx(1));
  // Turned the same way at both nodes, or folded back: nothing.
  CHECK(surface::straighten({0, 0}, {1, 1}, {2, 1}, {3, 0}).first == 0);
  CHECK(surface::straighten({0, 0}, {2, 1}, {1, -1}, {3, 0}).first == 0);

  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> draw(0.2, 1.0);
  for (int k = 0; k < 100; ++k)
  {
    const Point a{2, 0}, b{a.x + draw(engine), draw(engine)},
        c{b.x + draw(engine), -draw(engine)}, d{c.x + draw(engine), 0.1};
    const auto step = surface::straighten(a, b, c, d);
    const auto [p, q] = surface::pair_at(geometry, a, b, c, d, 1, step);
    REQUIRE(not(p == b));
    const auto volume = [&](Point u, Point v)
    {
      const auto part = [&](Point e, Point f, Point g)
      {
        return geometry == Geometry::plane
                   ? triangle<Geometry::plane>(e, f, g).v
                   : triangle<Geometry::axisymmetric>(e, f, g).v;
      };
      return part({2, -9}, a, u) + part({2, -9}, u, v) + part({2, -9}, v, d);
    };
    CHECK(volume(p, q) == Approx(volume(b, c)).epsilon(1e-13));
    const auto turn = [](Point e, Point f, Point g)
    { return cross(f - e, g - f); };
    if (geometry == Geometry::plane)
    {
      // One turn is gone, the other one smaller and not reversed.
      const double s = turn(a, p, q), t = turn(p, q, d);
      CHECK(std::min(std::abs(s), std::abs(t)) < 1e-12);
      CHECK(s * turn(a, b, c) >= -1e-12);
      CHECK(t * turn(b, c, d) >= -1e-12);
    }
  }
}

TEST_CASE("zigzag: a surface loses it and keeps its volume", "[zigzag]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const Block block(0.25, 2);
  const double before = block.roughness(block.x);
  REQUIRE(before > 0.4);
  const auto x = smoothed(block, geometry, 40);
  // What stays turns by less than `Zigzag::turn` at every other node.
  CHECK(block.roughness(x) < 0.2 * before);
  const double volume = block.volume(geometry, block.x);
  CHECK(std::abs(block.volume(geometry, x) - volume) < 1e-13 * volume);
}

TEST_CASE("zigzag: a wave of eight facets is none", "[zigzag]")
{
  // A wave's turns have one sign over half of its length; at the zero between
  // them one is small.
  const Block block(0.4, 8);
  const double before = block.roughness(block.x);
  REQUIRE(before > 0.08);
  const auto x = smoothed(block, Geometry::plane, 40);
  CHECK(block.roughness(x) > 0.9 * before);
}

TEST_CASE("zigzag: the same on any number of ranks", "[zigzag][ranks]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const Block block(0.25, 2);
  const auto alone = smoothed(block, geometry, 6);
  const int size = GENERATE(2, 3);
  const int how = GENERATE(0, 1);
  std::vector<int> owner;
  for (std::size_t c = 0; c < block.data.cells.size() / 3; ++c)
    owner.push_back(
        how == 0
            ? static_cast<int>(c * 7 % std::size_t(size))
            : std::min(size - 1,
                       int((block.data.x[2 * block.data.cells[3 * c]] - 0.5)
                           * size)));
  ranks::World world(block.data, owner, size);
  std::vector<double> gap(size, 0.0);
  world.run(
      [&](int rank, const ranks::Part& part, const Host& host)
      {
        const Mesh mesh = part.mesh();
        const std::vector<double> spacing(mesh.num_facets(), 1.0);
        const std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
        std::vector<Kind> kinds;
        for (std::int64_t i : part.nodes)
          kinds.push_back(block.kinds[i]);
        Smoothing smoothing(mesh, {.geometry = geometry, .sweeps = 6}, host);
        auto x = ranks::Part::take(block.x, part.nodes, 2);
        if (smoothing.smooth(x, flags, {.kinds = kinds, .spacing = spacing},
                             host)
            != Outcome::ok)
          gap[rank] = 1e9;
        const auto wanted = ranks::Part::take(alone, part.nodes, 2);
        for (std::size_t i = 0; i < x.size(); ++i)
          gap[rank] = std::max(gap[rank], std::abs(x[i] - wanted[i]));
      });
  for (double g : gap)
    CHECK(g == 0);
}
