// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials on meshes and moves made to break a remap, told apart by lines laid
// anywhere, also through nodes and along edges: conserved, sound, in their
// bounds. Fit for sanitizers; a failure names the number that makes it again.

#include "remap/tests/materials.h"
#include "remap/tests/fuzz/meshes.h"

#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace remap;

namespace
{
/// Materials, fields and options for a mesh, all from one number.
struct Case
{
  std::uint64_t seed;
  fuzz::Move move;
  fuzz::Random random;
  Geometry geometry;
  int number;
  Materials materials;
  std::vector<double> u, vector;
  double height;

  explicit Case(std::uint64_t s)
      : seed(s), move(s), random(s + 77),
        geometry(random.below(2) == 0 ? Geometry::plane
                                      : Geometry::axisymmetric),
        number(2 + static_cast<int>(random.below(4))), materials(0, 0)
  {
    height = 0;
    for (std::size_t i = 1; i < move.data.x.size(); i += 2)
      height = std::max(height, move.data.x[i]);
    Partition plane;
    std::vector<int> material;
    for (int k = 0; k + 1 < number; ++k)
    {
      plane.add({line(),
                 static_cast<std::int8_t>(k + 2 < number ? k + 1 : ~(k + 1)),
                 static_cast<std::int8_t>(~k)});
      material.push_back(k);
    }
    material.push_back(number - 1);
    materials =
        filled::fill(move.mesh, geometry, move.from, plane, material, number);
    u = filled::values(move.mesh, geometry, move.from, materials,
                       [&](Point, int k) { return low(k) + unit(); });
    for (const double v : u)
      vector.insert(vector.end(), {std::sin(99 * v), std::cos(99 * v)});
  }

  double unit()
  {
    return static_cast<double>(random.below(1 << 20)) / (1 << 20);
  }
  static double low(int k) { return std::pow(100.0, k) - 5; }

  /// Through two nodes as they were, or anywhere.
  HalfPlane line()
  {
    const auto nodes = static_cast<std::uint64_t>(move.mesh.num_nodes());
    const auto node = [&]
    {
      const auto i = static_cast<std::int32_t>(random.below(nodes));
      return random.below(2) == 0 ? point(move.from, i)
                                  : Point{unit(), height * unit()};
    };
    const Point a = node(), b = node();
    return a == b ? HalfPlane::below({1, 0}, 0.5) : HalfPlane::left_of(a, b);
  }
};

void check(std::uint64_t seed)
{
  Case c(seed);
  const auto method = c.random.below(2) == 0 ? Method::swept : Method::overlay;
  const auto all = names<Schemes>();
  const Scheme scheme =
      *find<Schemes>(all[static_cast<std::size_t>(c.random.below(all.size()))]);
  const auto kind = static_cast<Boundary>(c.random.below(3));
  INFO("case " << seed << " (" << c.move.what() << ", " << name_of(scheme)
               << ", " << c.number << " materials, "
               << (method == Method::swept ? "swept" : "overlay") << ")");
  Remapper remapper(
      c.move.mesh,
      {.geometry = c.geometry,
       .method = method,
       .scheme = scheme,
       .overlay_ready = true,
       .boundaries = std::vector(4, kind),
       .materials = {.number = c.number,
                     .components = 2,
                     .sliver = c.random.below(2) == 0 ? 1e-3 : 1e-8,
                     .inflow = std::vector(4, c.number - 1)}});
  const auto integrals = [&](bool there, std::span<const double> u)
  {
    return filled::integrals(c.move.mesh, c.geometry,
                             there ? c.move.to : c.move.from, c.materials, u);
  };
  const std::vector<double> inflow(4, Case::low(c.number - 1) + 0.5),
      inflow2(8, 0.6);
  const MaterialField fields[] = {
      {.values = c.u, .inflow = inflow},
      {.values = c.vector, .components = 2, .group = 2, .inflow = inflow2}};
  const auto volumes = integrals(false, {}), sums = integrals(false, c.u);
  double body = 0;
  for (const double v : volumes)
    body += v;
  Ledger ledger;
  for (int k = 0; k < 2; ++k)
    REQUIRE(remapper.remap(k == 0 ? c.move.from : c.move.to,
                           k == 0 ? c.move.to : c.move.from,
                           {.materials = &c.materials, .of_materials = fields},
                           {}, ledger)
            == Outcome::ok);
  CHECK(filled::unsound(c.materials) < 1e-14);
  const auto volumes_now = integrals(false, {}),
             sums_now = integrals(false, c.u);
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    CHECK(std::abs(volumes_now[k] - volumes[k] - net(ledger.material_volume[k]))
          < 1e-13 * body);
    CHECK(std::abs(sums_now[k] - sums[k] - net(ledger.of_materials[k]))
          < 1e-13 * body * std::pow(100.0, k));
  }
  const bool bounded =
      std::visit([]<class S>(const S&)
                 { return S::bounded and not S::limiter::extends; }, scheme);
  double worst = 0, longest = 0;
  filled::each_slot(
      c.move.mesh, c.geometry, c.move.from, c.materials,
      [&](std::int32_t s, int k, double, Point)
      {
        worst = std::max({worst, (c.u[s] - Case::low(k) - 1) / std::pow(100, k),
                          (Case::low(k) - c.u[s]) / std::pow(100, k)});
        longest =
            std::max(longest, std::hypot(c.vector[2 * s], c.vector[2 * s + 1]));
      });
  if (bounded)
  {
    CHECK(worst < 1e-9);
    CHECK(longest < 1 + 1e-9);
  }
  CHECK(std::isfinite(worst));
}
} // namespace

TEST_CASE("materials: sound and conserved in 300 cases made to break them",
          "[fuzz]")
{
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    check(seed);
}

TEST_CASE("materials: sound and conserved in 30 000 cases made to break them",
          "[fuzz][slow]")
{
  for (std::uint64_t seed = 10'000; seed < 40'000; ++seed)
    check(seed);
}
