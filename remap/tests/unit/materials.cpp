// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials through a remap: with velocities, void, boundaries, slivers, moves
// of any length, and input that cannot be.

#include "remap/tests/materials.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>

using namespace remap;

namespace
{
constexpr int n = 10;
const std::vector<double> angles = {0.4, 1.7, 3.1, 4.9};
const std::vector<int> four = {0, 1, 2, 3};
constexpr Point centre = {0.47, 0.53};

/// A mesh filled in four sectors.
struct Scene
{
  meshes::Data data;
  Mesh mesh;
  std::vector<double> x;
  Materials materials;

  explicit Scene(Geometry g = Geometry::plane, int squares = n,
                 std::span<const int> material = four, int number = 4)
      : data(meshes::rectangle(squares, squares, meshes::Diagonal::crossed)),
        mesh(data.mesh()), x(data.x),
        materials(filled::fill(mesh, g, x, filled::sectors(centre, angles),
                               material, number))
  {
  }
};

/// Relative changes of integrals over materials.
double change(const std::vector<double>& a, const std::vector<double>& b)
{
  double out = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != 0 or b[k] != 0)
      out = std::max(out, std::abs(a[k] - b[k]) / std::abs(a[k]));
  return out;
}

double density(Point p, int k)
{
  return std::pow(10.0, k) * (1 + p.x * p.y);
}
} // namespace

TEST_CASE("materials: momentum with the masses of mixtures, in one call with "
          "all else",
          "[remap][materials]")
{
  const auto g = GENERATE(Geometry::plane, Geometry::axisymmetric);
  Scene s(g);
  const Scheme scheme =
      GENERATE(Scheme(scheme::DonorCell{}), Scheme(scheme::LimitedLinear{}));
  Remapper remapper(s.mesh, {.geometry = g,
                             .scheme = scheme,
                             .nodal_scheme = scheme,
                             .boundaries = std::vector(4, Boundary::closed),
                             .nodal_components = 2,
                             .per_mass = true,
                             .materials = {.number = 4, .sliver = 1e-2}});
  auto rho = filled::values(s.mesh, g, s.x, s.materials, density);
  std::vector<double> other(s.mesh.num_cells(), 1.5),
      pressure(s.mesh.num_nodes(), 2.5), v;
  for (std::int32_t i = 0; i < s.mesh.num_nodes(); ++i)
    v.insert(v.end(), {std::sin(7.0 * i), std::cos(3.0 * i)});
  const auto momentum = [&](int d)
  {
    std::vector<double> corner(std::size_t(3) * s.mesh.num_cells());
    corner_volumes(s.mesh, g, s.x, corner);
    double sum = 0;
    for (std::int32_t c = 0; c < s.mesh.num_cells(); ++c)
    {
      double mixture = 0;
      for (int k = 0; k < 4; ++k)
        if (const std::int32_t slot = s.materials.slot(c, k); slot >= 0)
          mixture += s.materials.fraction(c, k) * rho[slot];
      for (int i = 0; i < 3; ++i)
        sum += mixture * corner[3 * c + i] * v[2 * s.mesh.cell(c)[i] + d];
    }
    return sum;
  };
  const double before[] = {momentum(0), momentum(1)};
  const auto masses = filled::integrals(s.mesh, g, s.x, s.materials, rho);
  const double scale = masses[3];
  std::int64_t slivers = 0;
  const MaterialField field{.values = rho};
  const Field in_cells{.values = other}, in_nodes{.values = pressure},
      velocity{.values = v, .components = 2, .group = 2};
  Ledger ledger;
  for (unsigned k = 0; k < 6; ++k)
  {
    const auto y = meshes::shaken(s.data.x, 0.2 / n, k);
    REQUIRE(remapper.remap(s.x, y,
                           {.cells = {&in_cells, 1},
                            .nodes = {&in_nodes, 1},
                            .per_mass = {&velocity, 1},
                            .materials = &s.materials,
                            .of_materials = {&field, 1},
                            .material_density = 0},
                           {}, ledger)
            == Outcome::ok);
    s.x = y;
    slivers += remapper.report().materials.slivers;
  }
  CHECK(slivers > 0);
  for (int d = 0; d < 2; ++d)
    CHECK(std::abs(momentum(d) - before[d] - net(ledger.per_mass[d]))
          < 1e-13 * scale);
  CHECK(change(masses, filled::integrals(s.mesh, g, s.x, s.materials, rho))
        < 1e-13);
  for (const double u : other)
    REQUIRE(std::abs(u - 1.5) < 1e-12);
  for (const double u : pressure)
    REQUIRE(std::abs(u - 2.5) < 1e-12);
  for (const double u : v)
    REQUIRE(std::abs(u) < 1 + 1e-9);
}

TEST_CASE("materials: void has no fields and spoils none", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  Scene s;
  auto rho = filled::values(s.mesh, Geometry::plane, s.x, s.materials, density);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  filled::each_slot(s.mesh, Geometry::plane, s.x, s.materials,
                    [&](std::int32_t slot, int k, double, Point)
                    { rho[slot] = k == 2 ? nan : rho[slot]; });
  for (const std::int32_t c : s.materials.mixed())
    rho[c] = nan;
  const std::vector<std::uint8_t> carriers = {1, 1, 0, 1};
  const MaterialField field{.values = rho, .carriers = carriers};
  Remapper remapper(s.mesh, {.method = method, .materials = {.number = 4}});
  Ledger ledger;
  const auto y = meshes::shaken(s.data.x, 0.2 / n, 3);
  const auto volumes =
      filled::integrals(s.mesh, Geometry::plane, s.x, s.materials);
  for (int k = 0; k < 4; ++k)
    REQUIRE(
        remapper.remap(k % 2 == 0 ? s.x : y, k % 2 == 0 ? y : s.x,
                       {.materials = &s.materials, .of_materials = {&field, 1}},
                       {}, ledger)
        == Outcome::ok);
  filled::each_slot(s.mesh, Geometry::plane, s.x, s.materials,
                    [&](std::int32_t slot, int k, double, Point)
                    {
                      const double unit = std::pow(10.0, k);
                      REQUIRE(
                          (k == 2 ? rho[slot] == 0
                                  : rho[slot] > unit and rho[slot] < 2 * unit));
                    });
  CHECK(change(volumes,
               filled::integrals(s.mesh, Geometry::plane, s.x, s.materials))
        < 1e-13);
}

TEST_CASE("materials: what passes the boundary is booked by material",
          "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const auto g = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto kind =
      GENERATE(Boundary::closed, Boundary::free_surface, Boundary::open);
  Scene s(g);
  auto rho = filled::values(s.mesh, g, s.x, s.materials, density);
  const std::vector<double> inflow(4, 7.0);
  const MaterialField field{.values = rho, .inflow = inflow};
  Remapper remapper(s.mesh,
                    {.geometry = g,
                     .method = method,
                     .boundaries = std::vector(4, kind),
                     .materials = {.number = 4, .inflow = {1, 1, 1, 1}}});
  const auto volumes = filled::integrals(s.mesh, g, s.x, s.materials);
  const auto masses = filled::integrals(s.mesh, g, s.x, s.materials, rho);
  Ledger ledger;
  auto y = meshes::shaken(s.data.x, 0.15 / n, 3);
  for (std::size_t i = 0; i < y.size(); i += 2)
    y[i] *= 1.02, y[i + 1] = 0.98 * y[i + 1] + 0.005;
  REQUIRE(remapper.remap(
              s.x, y, {.materials = &s.materials, .of_materials = {&field, 1}},
              {}, ledger)
          == Outcome::ok);
  const auto after = filled::integrals(s.mesh, g, y, s.materials);
  const auto masses_after = filled::integrals(s.mesh, g, y, s.materials, rho);
  REQUIRE(ledger.material_volume.size() == 4);
  double gained = 0;
  for (std::size_t k = 0; k < 4; ++k)
  {
    CHECK(std::abs(volumes[k] + net(ledger.material_volume[k]) - after[k])
          < 1e-14);
    CHECK(std::abs(masses[k] + net(ledger.of_materials[k]) - masses_after[k])
          < 1e-13 * masses[k]);
    const Exchange& e = ledger.material_volume[k];
    const double in = e[std::size_t(Way::inflow)];
    CHECK((kind == Boundary::open and k == 1 ? in > 0 : in == 0));
    if (in > 0)
      CHECK(std::abs(ledger.of_materials[k][std::size_t(Way::inflow)] - 7 * in)
            < 1e-14);
    gained += net(e);
  }
  CHECK(std::abs(gained - net(ledger.cell_volume)) < 1e-14);
}

TEST_CASE("materials: moves of any length", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const double by = GENERATE(0.05, 0.2, 0.5, 1.0, 2.0);
  Scene s;
  auto rho = filled::values(s.mesh, Geometry::plane, s.x, s.materials, density);
  const MaterialField field{.values = rho};
  Remapper remapper(s.mesh, {.method = method, .materials = {.number = 4}});
  const auto volumes =
      filled::integrals(s.mesh, Geometry::plane, s.x, s.materials);
  const auto masses =
      filled::integrals(s.mesh, Geometry::plane, s.x, s.materials, rho);
  Ledger ledger;
  auto y = s.x;
  for (std::size_t i = 0; i < y.size(); i += 2)
  {
    const double bump = std::sin(std::numbers::pi * y[i])
                        * std::sin(std::numbers::pi * y[i + 1]);
    const double turn = by / n * bump;
    const double a = y[i] - 0.5, b = y[i + 1] - 0.5;
    // An eddy of that many cells in one step.
    y[i] += -3 * turn * b, y[i + 1] += 3 * turn * a;
  }
  for (int k = 0; k < 2; ++k)
    REQUIRE(
        remapper.remap(k % 2 == 0 ? s.x : y, k % 2 == 0 ? y : s.x,
                       {.materials = &s.materials, .of_materials = {&field, 1}},
                       {}, ledger)
        == Outcome::ok);
  CHECK(filled::unsound(s.materials) < 1e-14);
  CHECK(change(volumes,
               filled::integrals(s.mesh, Geometry::plane, s.x, s.materials))
        < 1e-13);
  CHECK(change(masses, filled::integrals(s.mesh, Geometry::plane, s.x,
                                         s.materials, rho))
        < 1e-13);
}

TEST_CASE("materials: slivers are swept up, and counted", "[remap][materials]")
{
  const auto method = GENERATE(Method::swept, Method::overlay);
  const auto run = [&](double sliver, std::int64_t& swept, std::int64_t& left)
  {
    Scene s;
    Remapper remapper(s.mesh, {.method = method,
                               .materials = {.number = 4, .sliver = sliver}});
    Ledger ledger;
    auto x = s.x;
    swept = 0;
    for (unsigned k = 0; k < 10; ++k)
    {
      const auto y = meshes::shaken(s.data.x, 0.2 / n, k);
      REQUIRE(remapper.remap(x, y, {.materials = &s.materials}, {}, ledger)
              == Outcome::ok);
      x = y;
      swept += remapper.report().materials.slivers;
    }
    left = remapper.report().materials.slivers_left;
    std::int64_t parts = 0;
    for (std::size_t r = 0; r < s.materials.mixed().size(); ++r)
      for (const Part& p : s.materials.parts(static_cast<std::int32_t>(r)))
        parts += p.fraction < 1e-4 ? 1 : 0;
    return parts;
  };
  std::int64_t swept = 0, left = 0;
  const auto kept = run(0, swept, left);
  CHECK(swept == 0);
  CHECK(left == 0);
  const auto few = run(1e-4, swept, left);
  INFO(kept << " kept, " << few << " after " << swept << " were swept up");
  CHECK(swept > 0);
  CHECK(few == left);
  CHECK(few <= kept);
  if (method == Method::swept)
    CHECK(few < kept / 4);
}

TEST_CASE("materials: input that cannot be is refused, untouched",
          "[remap][materials]")
{
  Scene s;
  auto rho = filled::values(s.mesh, Geometry::plane, s.x, s.materials, density);
  const auto y = meshes::shaken(s.data.x, 0.2 / n, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Remapper remapper(s.mesh, {.materials = {.number = 4}});
  Ledger ledger;
  const auto outcome = [&](Materials m, std::vector<double> u)
  {
    const MaterialField field{.values = u};
    const auto kept = u;
    const Outcome out = remapper.remap(
        s.x, y, {.materials = &m, .of_materials = {&field, 1}}, {}, ledger);
    CHECK((out == Outcome::ok or u == kept));
    return out;
  };
  CHECK(outcome(s.materials, rho) == Outcome::ok);
  CHECK(outcome(s.materials, {1, 2, 3}) == Outcome::wrong_size);
  CHECK(outcome(Materials(3, 4), {1, 1, 1}) == Outcome::wrong_size);
  CHECK(outcome(Materials(s.mesh.num_cells(), 5),
                std::vector<double>(s.mesh.num_cells()))
        == Outcome::wrong_size);
  const auto spoilt = [&](const auto& spoil)
  {
    Materials m = s.materials;
    spoil(m.parts(3));
    return outcome(m, rho);
  };
  CHECK(spoilt([](auto parts) { parts[0].fraction += 1e-9; })
        == Outcome::bad_materials);
  CHECK(spoilt([&](auto parts) { parts[0].fraction = nan; })
        == Outcome::bad_materials);
  CHECK(spoilt(
            [](auto parts)
            {
              parts[0].fraction += 1;
              parts[1].fraction -= 1;
            })
        == Outcome::bad_materials);
  CHECK(spoilt([](auto parts) { parts[0].centroid.x += 1; })
        == Outcome::bad_materials);
  CHECK(spoilt([&](auto parts) { parts[1].centroid.y = nan; })
        == Outcome::bad_materials);
  CHECK(spoilt([](auto parts) { std::swap(parts[0], parts[1]); })
        == Outcome::bad_materials);
  CHECK(spoilt([](auto parts) { parts[1].material = 4; })
        == Outcome::bad_materials);
  Materials m = s.materials;
  m.set_pure(0, 4);
  CHECK(outcome(m, rho) == Outcome::bad_materials);
  // Materials without room for them.
  Remapper without(s.mesh, {});
  CHECK(without.remap(s.x, y, {.materials = &m}, {}, ledger)
        == Outcome::wrong_size);
  CHECK_THROWS_AS(Remapper(s.mesh, {.materials = {.number = 9}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(
      Remapper(s.mesh, {.materials = {.number = 2, .inflow = {0, 2}}}),
      std::invalid_argument);
}
