// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Centroids of materials through a Lagrangian step.

#include "remap/materials/move.h"
#include "remap/interfaces/interfaces.h"
#include "remap/tests/meshes.h"
#include "remap/tests/shapes.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

#include <array>

using namespace remap;
using meshes::Diagonal;

namespace
{
constexpr int n = 8;
constexpr double h = 1.0 / n;

/// x → a x + b.
struct Map
{
  double xx, xy, yx, yy;
  Point b;

  [[nodiscard]] Point vector(Point p) const
  {
    return {xx * p.x + xy * p.y, yx * p.x + yy * p.y};
  }
  [[nodiscard]] Point operator()(Point p) const { return vector(p) + b; }
  [[nodiscard]] HalfPlane operator()(const HalfPlane& half) const
  {
    const Point along = vector({-half.normal.y, half.normal.x});
    return {{along.y, -along.x}, (*this)(half.at)};
  }
  [[nodiscard]] std::vector<double> nodes(std::span<const double> x) const
  {
    std::vector<double> out;
    for (std::size_t i = 0; i < x.size() / 2; ++i)
    {
      const Point p = (*this)(point(x, static_cast<std::int32_t>(i)));
      out.insert(out.end(), {p.x, p.y});
    }
    return out;
  }
};

template <Geometry G>
Materials layers(const Mesh& mesh, std::span<const double> x, HalfPlane below)
{
  return shapes::lay<G>(mesh, x,
                        {shapes::part_in(shapes::everything<G>, {below})});
}

/// Largest distance of centroids.
double apart(const Materials& a, const Materials& b)
{
  double most = a.mixed().size() == b.mixed().size() ? 0 : 1;
  for (std::int32_t c : a.mixed())
  {
    const auto p = a.parts(a.row(c)), q = b.parts(b.row(c));
    for (std::size_t k = 0; k < p.size(); ++k)
      most = std::max(most, std::hypot(p[k].centroid.x - q[k].centroid.x,
                                       p[k].centroid.y - q[k].centroid.y));
  }
  return most;
}

/// How far the parts' volumes that a reconstruction puts to the wrong side of
/// a line are, over the cell's: 0 if it is found exactly.
double misplaced(const Mesh& mesh, std::span<const double> x,
                 const Materials& materials, HalfPlane below)
{
  Interfaces interfaces(mesh, {});
  interfaces.reconstruct(x, materials, {});
  double most = 0;
  for (std::int32_t c : materials.mixed())
  {
    const std::int32_t row = materials.row(c);
    Piece cell;
    for (std::int32_t i : mesh.cell(c))
      cell.push(point(x, i));
    const double whole = moments<Geometry::plane>(cell).v;
    split(cell, interfaces.partition(row),
          [&](int part, const Piece& piece)
          {
            const int material = materials.parts(row)[part].material;
            Piece in, out;
            split(piece, below, in, out);
            const double wrong =
                moments<Geometry::plane>(material == 1 ? out : in).v;
            most = std::max(most, wrong / whole);
          });
  }
  return most;
}
} // namespace

TEST_CASE("move: centroids follow an affine motion exactly",
          "[materials][move]")
{
  const auto map = GENERATE(Map{1.3, 0.4, -0.2, 0.8, {2, -1}}, // any
                            Map{0.6, 0, 0, 0.6, {}});          // compression
  const auto data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto x0 = meshes::shaken(data.x, 0.2 * h, 1);
  const HalfPlane below{{0.3, 1}, {0.4, 0.52}};
  Materials now = layers<Geometry::plane>(mesh, x0, below);
  const auto x1 = map.nodes(x0);
  const auto wanted = layers<Geometry::plane>(mesh, x1, map(below));
  const auto report = move(mesh, Geometry::plane, x0, x1, now);
  CHECK(report.held == 0);
  CHECK(report.shift < 1e-14);
  CHECK(apart(now, wanted) < 1e-13);
}

TEST_CASE("move: uniform compression is exact about an axis too",
          "[materials][move]")
{
  const auto data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto x0 = meshes::shaken(data.x, 0.2 * h, 1);
  const Map map{0.6, 0, 0, 0.6, {}};
  const HalfPlane below{{0.3, 1}, {0.4, 0.52}};
  Materials now = layers<Geometry::axisymmetric>(mesh, x0, below);
  const auto x1 = map.nodes(x0);
  const auto wanted = layers<Geometry::axisymmetric>(mesh, x1, map(below));
  const auto report = move(mesh, Geometry::axisymmetric, x0, x1, now);
  CHECK(report.shift < 1e-13);
  CHECK(apart(now, wanted) < 1e-13);
}

TEST_CASE("move: a layer compressed alone stays a layer, and moment of fluid "
          "finds it",
          "[materials][move]")
{
  // y → piecewise linear: the lower layer to half its height.
  const double height = GENERATE(0.4, 0.44, 0.49);
  const auto data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  std::vector<double> x1 = data.x;
  for (std::size_t i = 1; i < x1.size(); i += 2)
    x1[i] = x1[i] < height ? x1[i] / 2 : x1[i] - height / 2;
  const HalfPlane before{{0, 1}, {0, height}}, after{{0, 1}, {0, height / 2}};
  const auto start = layers<Geometry::plane>(mesh, data.x, before);
  const auto wanted = layers<Geometry::plane>(mesh, x1, after);
  std::vector<double> fractions;
  for (std::int32_t c : start.mixed())
    for (const Part& p : wanted.parts(wanted.row(c)))
      fractions.push_back(p.fraction);
  Interfaces interfaces(mesh, {});
  interfaces.reconstruct(data.x, start, {});

  Materials now = start;
  const auto report = move(mesh, Geometry::plane, data.x, x1,
                           interfaces.partitions(), fractions, now);
  CHECK(report.held == 0);
  CHECK(apart(now, wanted) < 1e-13);
  CHECK(misplaced(mesh, x1, now, after) < 1e-12);

  // Fractions changed, centroids only moved with the cell.
  Materials naive = start;
  (void)move(mesh, Geometry::plane, data.x, x1, naive);
  std::size_t i = 0;
  for (std::int32_t c : naive.mixed())
    for (Part& p : naive.parts(naive.row(c)))
      p.fraction = fractions[i++];
  CHECK(misplaced(mesh, x1, naive, after) > 1e-3);
}

TEST_CASE("move: whatever the fractions and the motion, the sum rule holds and "
          "centroids stay inside",
          "[materials][move]")
{
  const auto seed = GENERATE(1u, 2u, 3u, 4u);
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  INFO("seed " << seed);
  const auto data = meshes::rectangle(n, n, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto x0 = meshes::shaken(data.x, 0.2 * h, seed);
  const auto x1 = meshes::shaken(data.x, 0.2 * h, seed + 10);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> draw(1e-3, 1);
  Materials now(mesh.num_cells(), 4);
  std::vector<double> fractions;
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    std::vector<Part> parts;
    std::array<double, 4> f0{}, f1{};
    double s0 = 0, s1 = 0;
    const int count = 2 + static_cast<int>(3 * draw(engine)) % 3;
    for (int k = 0; k < count; ++k)
    {
      s0 += f0[k] = draw(engine);
      s1 += f1[k] = std::pow(draw(engine), 3);
    }
    const auto [i, j, l] = mesh.cell(c);
    const Point o = point(x0, i);
    for (int k = 0; k < count; ++k)
    {
      const double a = draw(engine), b = (1 - a) * draw(engine);
      parts.push_back(
          {k, f0[k] / s0, o + a * (point(x0, j) - o) + b * (point(x0, l) - o)});
      fractions.push_back(f1[k] / s1);
    }
    now.add_row(c, parts);
  }
  Interfaces interfaces(mesh, {.geometry = geometry});
  interfaces.reconstruct(x0, now, {});
  (void)move(mesh, geometry, x0, x1, interfaces.partitions(), fractions, now);
  std::size_t at = 0;
  for (std::int32_t c : now.mixed())
  {
    const auto [i, j, k] = mesh.cell(c);
    const Point p = point(x1, i), q = point(x1, j), r = point(x1, k);
    const Point g = geometry == Geometry::plane
                        ? triangle<Geometry::plane>(p, q, r).centroid()
                        : triangle<Geometry::axisymmetric>(p, q, r).centroid();
    Point sum;
    for (const Part& part : now.parts(now.row(c)))
    {
      CHECK(part.fraction == fractions[at++]);
      sum = sum + part.fraction * part.centroid;
      const double scale = 1e-12 * h * h;
      CHECK(twice_area(p, q, part.centroid) > -scale);
      CHECK(twice_area(q, r, part.centroid) > -scale);
      CHECK(twice_area(r, p, part.centroid) > -scale);
    }
    CHECK(std::hypot(sum.x - g.x, sum.y - g.y) < 1e-13);
  }
}
