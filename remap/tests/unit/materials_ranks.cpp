// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials, their fields, and all else that travels with them, on one rank and
// on more: ranks are threads.

#include "remap/tests/materials.h"
#include "remap/tests/ranks.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>

#include <map>

using namespace remap;

namespace
{
constexpr int n = 10;
const std::vector<double> angles = {0.4, 1.7, 3.1, 4.9};
const std::vector<int> four = {0, 1, 2, 3};

/// What a rank has at the end, in global numbers: of each cell and material
/// fraction, centroid, density, a vector; of nodes the velocity.
struct Result
{
  std::map<std::pair<std::int64_t, int>, std::array<double, 6>> slots;
  std::vector<std::pair<std::int64_t, std::array<double, 2>>> velocity;
  Ledger ledger;
  MaterialReport report;
  bool ok = true;
};

Result carry(Geometry geometry, Method method, const Scheme& scheme,
             const meshes::Data& data, const ranks::Part& part,
             const Host& host)
{
  const Mesh mesh = part.mesh();
  const bool masses = method == Method::swept;
  const auto place = [&](unsigned seed)
  {
    auto all = meshes::shaken(data.x, 0.25 / n, seed);
    for (std::size_t i = 0; i < all.size(); i += 2)
      all[i] = 1 + (all[i] - 0) * (1 + 0.01 * seed); // outline moves too
    return ranks::Part::take(all, part.nodes, 2);
  };
  auto x = place(1);
  Materials m = filled::fill(mesh, geometry, x,
                             filled::sectors({1.47, 0.53}, angles), four, 5);
  auto rho = filled::values(mesh, geometry, x, m, [](Point p, int k)
                            { return (1 + k * k) * (1 + p.x * p.y); });
  std::vector<double> vector;
  for (std::size_t s = 0; s < rho.size(); ++s)
    vector.insert(vector.end(), {std::sin(9 * rho[s]), std::cos(9 * rho[s])});
  std::vector<double> cells, velocity;
  for (const std::int64_t c : part.cells)
    cells.push_back(std::sin(static_cast<double>(c)));
  for (const std::int64_t i : part.nodes)
    velocity.insert(velocity.end(), {std::sin(1.0 * i), std::cos(2.0 * i)});
  const std::vector<double> inflow = {0, 3, 0, 0}, inflow2(8, 0.5);
  Remapper remapper(mesh,
                    {.geometry = geometry,
                     .method = method,
                     .scheme = scheme,
                     .nodal_scheme = scheme,
                     .max_loss = 0.3,
                     .boundaries = {Boundary::closed, Boundary::open,
                                    Boundary::free_surface, Boundary::closed},
                     .nodal_components = masses ? 2 : 0,
                     .per_mass = masses,
                     .materials = {.number = 5,
                                   .components = 2,
                                   .sliver = 1e-3,
                                   .inflow = {0, 4, 0, 0}}});
  Result out;
  for (unsigned k = 0; k < 4; ++k)
  {
    const auto y = place(k + 2);
    const MaterialField of_materials[] = {{.values = rho, .inflow = inflow},
                                          {.values = vector,
                                           .components = 2,
                                           .group = 2,
                                           .bound = Bound::ball,
                                           .inflow = inflow2}};
    const Field field{.values = cells, .inflow = inflow};
    const Field moving{.values = velocity,
                       .components = 2,
                       .group = 2,
                       .bound = Bound::ball,
                       .inflow = inflow2};
    Fields fields{
        .cells = {&field, 1}, .materials = &m, .of_materials = of_materials};
    if (masses)
    {
      fields.per_mass = {&moving, 1};
      fields.material_density = 0;
    }
    out.ok = out.ok
             and remapper.remap(x, y, fields, host, out.ledger) == Outcome::ok;
    const MaterialReport& r = remapper.report().materials;
    out.report.slivers += r.slivers;
    out.report.capped += r.capped;
    x = y;
  }
  // Ghosts too are as their owners have them.
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    for (int k = 0; k < 5; ++k)
      if (const std::int32_t s = m.slot(c, k); s >= 0)
      {
        const bool pure = s == c;
        const Point at = pure ? Point{} : m.part(s).centroid;
        out.slots[{part.cells[c], k}] = {
            m.fraction(c, k), at.x,          at.y,
            rho[s],           vector[2 * s], vector[2 * s + 1]};
      }
  for (std::size_t i = 0; i < part.nodes.size(); ++i)
    out.velocity.push_back(
        {part.nodes[i], {velocity[2 * i], velocity[2 * i + 1]}});
  return out;
}
} // namespace

TEST_CASE("materials: the same on any number of ranks", "[ranks][materials]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto method = GENERATE(Method::swept, Method::overlay);
  const int size = GENERATE(2, 3);
  const int how = GENERATE(0, 2);
  const Scheme scheme =
      GENERATE(Scheme(scheme::LimitedLinear{}), Scheme(scheme::SmoothExtrema{}),
               Scheme(scheme::VanLeer{}));
  INFO("size " << size << ", dealt " << how << ", " << name_of(scheme));
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const auto run = [&](int number)
  {
    ranks::World world(data, ranks::deal(data, number, how), number);
    std::vector<Result> out(number);
    world.run([&](int r, const ranks::Part& p, const Host& host)
              { out[r] = carry(geometry, method, scheme, data, p, host); });
    return out;
  };
  const Result alone = run(1)[0];
  REQUIRE(alone.ok);
  CHECK(alone.report.slivers > 0);
  std::map<std::int64_t, std::array<double, 2>> velocity(alone.velocity.begin(),
                                                         alone.velocity.end());
  for (const Result& part : run(size))
  {
    REQUIRE(part.ok);
    CHECK(part.report.slivers == alone.report.slivers);
    CHECK(part.report.capped == alone.report.capped);
    double gap = 0;
    bool all_there = true;
    for (const auto& [key, value] : part.slots)
    {
      const auto it = alone.slots.find(key);
      all_there = all_there and it != alone.slots.end();
      for (std::size_t k = 0; it != alone.slots.end() and k < 6; ++k)
        gap = std::max(gap, std::abs(it->second[k] - value[k]));
    }
    for (const auto& [i, v] : part.velocity)
      for (std::size_t k = 0; k < 2; ++k)
        gap = std::max(gap, std::abs(velocity[i][k] - v[k]));
    CHECK(all_there);
    // Densities are up to 30.
    CHECK(gap < 1e-12);
    for (std::size_t k = 0; k < alone.ledger.of_materials.size(); ++k)
      CHECK(std::abs(net(part.ledger.of_materials[k])
                     - net(alone.ledger.of_materials[k]))
            < 1e-13);
  }
}
