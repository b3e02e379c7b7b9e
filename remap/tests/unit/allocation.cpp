// SPDX-License-Identifier: LGPL-3.0-or-later
//
// After set-up and a first call nothing is allocated.

#include "remap/remap.h"
#include "remap/smoothing/boundary_curve.h"
#include "remap/smoothing/smooth.h"
#include "remap/tests/carry.h"
#include "remap/tests/meshes.h"
#include "remap/tests/partitions.h"

#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <new>

namespace
{
std::atomic<long> allocations = 0;
} // namespace

// Counting replacements for the whole test program.
void* operator new(std::size_t size)
{
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size))
    return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept
{
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept
{
  std::free(p);
}

using namespace remap;

TEST_CASE("remap and smoothing allocate nothing after set-up", "[allocation]")
{
  const meshes::Data data =
      meshes::rectangle(20, 20, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  Remapper remapper(mesh, {.max_loss = 0.1,
                           .boundaries = std::vector(4, Boundary::free_surface),
                           .cell_components = 5,
                           .nodal_components = 3});
  Smoothing smoothing(mesh, {}, {});
  std::vector<double> u(5 * mesh.num_cells(), 1.0),
      w(3 * mesh.num_nodes(), 1.0);
  const Field cells{.values = u, .components = 5};
  const Field nodes{.values = w, .components = 3};
  Ledger ledger;
  const Host host;
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < data.x.size(); i += 2)
  {
    const Point p = {data.x[i], data.x[i + 1]};
    const bool side = p.x == 0 or p.x == 1;
    kinds.push_back(p.y == 1 and not side   ? Kind::surface
                    : p.y == 0 and not side ? Kind::curve
                    : meshes::on_outline(p) ? Kind::fixed
                                            : Kind::free);
  }
  std::vector<std::uint8_t> flags(mesh.num_nodes(), 1);
  const auto spacing = facet_lengths(mesh, data.x);
  BoundaryCurve curve(mesh);
  const Constraints constraints{
      .kinds = kinds, .guide = &curve, .spacing = spacing};
  // The start is a tangle, and its surface a zigzag: nothing is left out.
  const auto from = meshes::shaken(data.x, 0.015, 3);
  auto tangled = meshes::shaken(data.x, 0.04, 3);
  for (std::int32_t i = 1; i < 20; ++i)
    tangled[2 * (21 * 20 + i) + 1] += i % 2 == 0 ? 0.005 : -0.005;
  auto to = from;
  const auto once = [&]
  {
    to = tangled; // no allocation: the sizes agree
    curve.follow(to, kinds, host);
    smoothing.flag(to, {}, flags, host);
    std::fill(flags.begin(), flags.end(), std::uint8_t(1));
    if (smoothing.smooth(to, flags, constraints, host) != Outcome::ok
        or smoothing.report().untangled == 0)
      return false;
    to = from;
    return smoothing.smooth(to, flags, constraints, host) == Outcome::ok
           and remapper.remap(from, to, {&cells, 1}, {&nodes, 1}, host, ledger)
                   == Outcome::ok;
  };
  REQUIRE(once());
  const long before = allocations;
  const bool good = once();
  const long after = allocations;
  CHECK(good);
  CHECK(remapper.report().cycles > 1);
  CHECK(after == before);
}

TEST_CASE("an overlay allocates nothing after set-up", "[allocation][overlay]")
{
  const meshes::Data data =
      meshes::rectangle(20, 20, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto from = meshes::shaken(data.x, 0.0125, 3);
  auto to = meshes::shaken(data.x, 0.0125, 4);
  for (std::size_t i = 0; i < to.size(); i += 2)
    to[i] += 0.13; // the outline moves too, by more than two cells
  const auto touched = carry::touched(mesh, from, to);
  Overlay overlay(mesh);
  const long before = allocations;
  const bool good =
      overlay.intersect<Geometry::plane>(from, to, touched) == Outcome::ok;
  const long after = allocations;
  CHECK(good);
  CHECK(overlay.pieces().size() > touched.size());
  CHECK(after == before);
}

TEST_CASE("reconstruction allocates nothing after a first call",
          "[allocation][interfaces]")
{
  const meshes::Data data =
      meshes::rectangle(12, 12, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto x = meshes::shaken(data.x, 0.02, 5);
  const Materials materials = partitions::lay<Geometry::plane>(
      mesh, x, partitions::wye({0.51, 0.47}, 0.3), 3);
  const Host host;
  [&]<class... R>(std::tuple<R...>*)
  {
    const auto check = [&](auto method)
    {
      Interfaces interfaces(mesh, {.method = method});
      interfaces.reconstruct(x, materials, host);
      const long before = allocations;
      interfaces.reconstruct(x, materials, host);
      const long after = allocations;
      CHECK(after == before);
    };
    (check(R{}), ...);
  }(static_cast<Reconstructions*>(nullptr));
}
