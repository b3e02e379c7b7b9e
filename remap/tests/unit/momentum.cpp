// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Velocities: momentum is conserved with the masses of the new cells, no
// velocity leaves the hull of its neighbours', no kinetic energy is made. The
// usual way (momentum per volume, divided by the new masses) does none of it
// but the first.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <numeric>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
constexpr int n = 12;

/// A body with densities and velocities.
struct Body
{
  Geometry geometry;
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed, 0.5);
  Mesh mesh = data.mesh();
  std::vector<double> x = data.x, to, density, velocity;

  Body(Geometry g, unsigned seed, double lightest, double heaviest)
      : geometry(g), to(meshes::shaken(data.x, 0.2 / n, seed, 0.5, 0, 1, 1)),
        density(mesh.num_cells()), velocity(2 * mesh.num_nodes())
  {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> draw(0.0, 1.0);
    for (double& rho : density)
      rho = lightest + (heaviest - lightest) * draw(engine);
    for (double& v : velocity)
      v = draw(engine) < 0.5 ? -1 : 1;
  }

  [[nodiscard]] std::vector<double> masses(std::span<const double> at) const
  {
    std::vector<double> corner(3 * mesh.num_cells()), out(mesh.num_nodes());
    corner_volumes(mesh, geometry, at, corner);
    for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
      for (int i = 0; i < 3; ++i)
        out[mesh.cell(c)[i]] += density[c] * corner[3 * c + i];
    return out;
  }

  [[nodiscard]] double momentum(std::span<const double> m, int k) const
  {
    double sum = 0;
    for (std::size_t i = 0; i < m.size(); ++i)
      sum += m[i] * velocity[2 * i + k];
    return sum;
  }

  [[nodiscard]] double energy(std::span<const double> m) const
  {
    double sum = 0;
    for (std::size_t i = 0; i < m.size(); ++i)
      sum += 0.5 * m[i]
             * (velocity[2 * i] * velocity[2 * i]
                + velocity[2 * i + 1] * velocity[2 * i + 1]);
    return sum;
  }

  Report run(const Scheme& scheme, Ledger& ledger,
             Boundary boundary = Boundary::closed)
  {
    Remapper remapper(mesh, {.geometry = geometry,
                             .scheme = scheme,
                             .nodal_scheme = scheme,
                             .boundaries = std::vector(4, boundary),
                             .nodal_components = 2,
                             .per_mass = true});
    const Field rho{.values = density};
    const Field v{.values = velocity, .components = 2, .group = 2};
    REQUIRE(remapper.remap(
                x, to, {.cells = {&rho, 1}, .per_mass = {&v, 1}, .density = 0},
                {}, ledger)
            == Outcome::ok);
    return remapper.report();
  }
};
} // namespace

TEST_CASE("momentum: conserved, bounded, without new energy", "[momentum]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto seed = GENERATE(1u, 2u, 3u);
  const Scheme scheme =
      GENERATE(Scheme(scheme::DonorCell{}), Scheme(scheme::LimitedLinear{}));
  const auto boundary = GENERATE(Boundary::closed, Boundary::free_surface);
  INFO("seed " << seed << ", " << name_of(scheme));
  Body body(geometry, seed, 0.5, 2);
  if (boundary == Boundary::free_surface)
    for (double& y : body.to)
      y *= 1.01;
  const auto before = body.masses(body.x);
  const double p[] = {body.momentum(before, 0), body.momentum(before, 1)};
  const double energy = body.energy(before);
  Ledger ledger;
  const Report report = body.run(scheme, ledger, boundary);
  const auto after = body.masses(body.to);
  REQUIRE(ledger.per_mass.size() == 2);
  double mass = 0;
  for (double m : before)
    mass += m;
  for (int k = 0; k < 2; ++k)
    CHECK(std::abs(body.momentum(after, k) - p[k] - net(ledger.per_mass[k]))
          < 1e-13 * mass);
  for (double v : body.velocity)
    CHECK(std::abs(v) <= 1 + 1e-12);
  CHECK(report.mass_loss < 1);
  if (boundary == Boundary::closed)
    CHECK(body.energy(after) <= energy * (1 + 1e-14));
}

TEST_CASE("momentum: a uniform velocity stays uniform whatever the densities",
          "[momentum]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const auto boundary = GENERATE(Boundary::closed, Boundary::free_surface);
  Body body(geometry, 5, 0.01, 1);
  for (double& y : body.to)
    y *= boundary == Boundary::free_surface ? 0.99 : 1;
  for (std::size_t i = 0; i < body.velocity.size(); i += 2)
    body.velocity[i] = 3, body.velocity[i + 1] = -2;
  Ledger ledger;
  body.run(scheme::LimitedLinear{}, ledger, boundary);
  for (std::size_t i = 0; i < body.velocity.size(); i += 2)
  {
    CHECK(body.velocity[i] == Approx(3).epsilon(1e-12));
    CHECK(body.velocity[i + 1] == Approx(-2).epsilon(1e-12));
  }
}

TEST_CASE("momentum: per volume, divided by new masses, it leaves its bounds",
          "[momentum]")
{
  Body body(Geometry::plane, 3, 0.1, 2);
  const auto before = body.masses(body.x);
  std::vector<double> v0(body.mesh.num_nodes()), v1 = v0;
  dual_volumes(body.mesh, body.geometry, body.x, v0);
  dual_volumes(body.mesh, body.geometry, body.to, v1);
  auto per_volume = body.velocity;
  for (std::size_t i = 0; i < per_volume.size(); ++i)
    per_volume[i] *= before[i / 2] / v0[i / 2];
  Remapper remapper(body.mesh, {.boundaries = std::vector(4, Boundary::closed),
                                .nodal_components = 2});
  const Field rho{.values = body.density};
  const Field momentum{.values = per_volume, .components = 2};
  Ledger ledger;
  REQUIRE(remapper.remap(body.x, body.to, {&rho, 1}, {&momentum, 1}, {}, ledger)
          == Outcome::ok);
  const auto after = body.masses(body.to);
  double fastest = 0;
  for (std::size_t i = 0; i < per_volume.size(); ++i)
    fastest =
        std::max(fastest, std::abs(per_volume[i] * v1[i / 2] / after[i / 2]));
  CHECK(fastest > 1.05);
}

TEST_CASE("momentum: bounds hold while no node loses all its mass at once",
          "[momentum]")
{
  const auto most = [](double ratio, double& fastest)
  {
    double loss = 0;
    fastest = 0;
    for (unsigned seed : {1u, 2u, 3u, 4u})
    {
      Body body(Geometry::plane, seed, 0, 1);
      for (double& rho : body.density)
        rho = rho < 0.5 ? 1 : ratio;
      Ledger ledger;
      loss = std::max(loss, body.run(scheme::DonorCell{}, ledger).mass_loss);
      for (double v : body.velocity)
        fastest = std::max(fastest, std::abs(v));
    }
    return loss;
  };
  double fastest = 0;
  CHECK(most(1e3, fastest) < 1);
  CHECK(fastest <= 1 + 1e-12);
  CHECK(most(1e6, fastest) > 1); // and is told
  CHECK(fastest > 1.001);
}

TEST_CASE("momentum: a pressure beside it is repaired in volumes, not masses",
          "[momentum]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  Body body(geometry, 3, 0.1, 2);
  std::vector<double> before(body.mesh.num_nodes()), after = before, p = before;
  dual_volumes(body.mesh, geometry, body.x, before);
  dual_volumes(body.mesh, geometry, body.to, after);
  for (std::size_t i = 0; i < p.size(); ++i)
    p[i] = body.velocity[2 * i] > 0 ? 1 : 0;
  Remapper remapper(body.mesh, {.geometry = geometry,
                                .nodal_scheme = scheme::Linear{},
                                .boundaries = std::vector(4, Boundary::closed),
                                .nodal_components = 2,
                                .per_mass = true});
  const double least = 0, most = 1;
  const Field rho{.values = body.density};
  const Field pressure{.values = p, .least = {&least, 1}, .most = {&most, 1}};
  const Field v{.values = body.velocity, .components = 2, .group = 2};
  double sum = std::inner_product(p.begin(), p.end(), before.begin(), 0.0);
  Ledger ledger;
  REQUIRE(remapper.remap(body.x, body.to,
                         {.cells = {&rho, 1},
                          .nodes = {&pressure, 1},
                          .per_mass = {&v, 1},
                          .density = 0},
                         {}, ledger)
          == Outcome::ok);
  CHECK(remapper.report().repaired > 0);
  sum -= std::inner_product(p.begin(), p.end(), after.begin(), 0.0);
  CHECK(std::abs(sum + net(ledger.nodes[0])) < 1e-14);
}

TEST_CASE("momentum: order two for a smooth velocity", "[momentum]")
{
  const auto error = [](int cells, const Scheme& scheme)
  {
    const meshes::Data data =
        meshes::rectangle(cells, cells, Diagonal::crossed);
    const Mesh mesh = data.mesh();
    const auto value = [](Point p)
    { return Point{std::sin(3 * p.x) * p.y, std::cos(2 * p.y + p.x)}; };
    const auto at_nodes = [&](std::span<const double> x)
    {
      std::vector<double> v(mesh.num_nodes()), c(2 * mesh.num_nodes()), out;
      dual_volumes(mesh, Geometry::plane, x, v, c);
      for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
      {
        const Point p = value(point(c, i));
        out.insert(out.end(), {p.x, p.y});
      }
      return out;
    };
    const auto to = meshes::shaken(data.x, 0.2 / cells, 3);
    auto v = at_nodes(data.x);
    const auto exact = at_nodes(to);
    std::vector<double> density(mesh.num_cells(), 2.0);
    Remapper remapper(mesh, {.nodal_scheme = scheme,
                             .boundaries = std::vector(4, Boundary::closed),
                             .nodal_components = 2,
                             .per_mass = true});
    const Field rho{.values = density};
    const Field field{.values = v, .components = 2, .group = 2};
    Ledger ledger;
    REQUIRE(remapper.remap(
                data.x, to,
                {.cells = {&rho, 1}, .per_mass = {&field, 1}, .density = 0}, {},
                ledger)
            == Outcome::ok);
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i)
      sum += std::abs(v[i] - exact[i]);
    return sum / static_cast<double>(v.size());
  };
  const auto order = [&](const Scheme& scheme)
  { return std::log2(error(20, scheme) / error(40, scheme)); };
  CHECK(order(scheme::SmoothExtrema{}) > 1.7);
  CHECK(order(scheme::DonorCell{}) < 1.3);
  CHECK(error(40, scheme::SmoothExtrema{})
        < 0.3 * error(40, scheme::DonorCell{}));
}
