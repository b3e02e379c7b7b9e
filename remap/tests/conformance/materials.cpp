// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What is promised of materials and their fields, for every scheme, swept and
// overlaid, in the plane and in axisymmetry.

#include "remap/tests/materials.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>

using namespace remap;
using Catch::Matchers::WithinAbs;

namespace
{
constexpr int n = 12;
const std::vector<double> angles = {0.4, 1.7, 3.1, 4.9};
const std::vector<int> four = {0, 1, 2, 3};

/// A shaken mesh, filled in four sectors, and another shaken one.
struct Scene
{
  Geometry geometry;
  meshes::Data data;
  Mesh mesh;
  std::vector<double> x, y;
  Materials materials;

  explicit Scene(Geometry g, unsigned seed = 1, double by = 0.2)
      : geometry(g), data(meshes::rectangle(n, n, meshes::Diagonal::crossed)),
        mesh(data.mesh()), x(meshes::shaken(data.x, by / n, seed)),
        y(meshes::shaken(data.x, by / n, seed + 100)),
        materials(filled::fill(mesh, g, x,
                               filled::sectors({0.47, 0.53}, angles), four, 4))
  {
  }

  [[nodiscard]] Options options(Method method, const Scheme& scheme) const
  {
    return {.geometry = geometry,
            .method = method,
            .scheme = scheme,
            .boundaries = std::vector(4, Boundary::closed),
            .materials = {.number = 4, .components = 3}};
  }
  [[nodiscard]] std::vector<double> values(const filled::Value& f) const
  {
    return filled::values(mesh, geometry, x, materials, f);
  }
};

double largest_change(const std::vector<double>& a, const std::vector<double>& b)
{
  double out = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    out = std::max(out, std::abs(a[k] - b[k]) / std::abs(a[k]));
  return out;
}

const auto geometries = {Geometry::plane, Geometry::axisymmetric};
const auto methods = {Method::swept, Method::overlay};

/// Call with every scheme of the library.
template <class Call>
void each_scheme(const Call& call)
{
  for (const auto name : names<Schemes>())
  {
    INFO(name);
    call(*find<Schemes>(name));
  }
}
} // namespace

TEST_CASE("materials: volumes of each, and what they carry, are conserved",
          "[remap][materials]")
{
  const auto g = GENERATE(values(geometries));
  const auto method = GENERATE(values(methods));
  each_scheme(
      [&](const Scheme& scheme)
      {
        Scene s(g);
        auto rho = s.values([](Point p, int k)
                            { return std::pow(10.0, k) * (1 + p.x * p.y); });
        const auto volumes = filled::integrals(s.mesh, g, s.x, s.materials);
        const auto masses = filled::integrals(s.mesh, g, s.x, s.materials, rho);
        Remapper remapper(s.mesh, s.options(method, scheme));
        const MaterialField field{.values = rho};
        Ledger ledger;
        for (int k = 0; k < 6; ++k)
          REQUIRE(remapper.remap(k % 2 == 0 ? s.x : s.y,
                                 k % 2 == 0 ? s.y : s.x,
                                 {.materials = &s.materials,
                                  .of_materials = {&field, 1}},
                                 {}, ledger)
                  == Outcome::ok);
        CHECK(rho.size() == std::size_t(s.materials.num_slots()));
        CHECK(filled::unsound(s.materials) < 1e-14);
        CHECK(largest_change(volumes, filled::integrals(s.mesh, g, s.x,
                                                        s.materials))
              < 1e-13);
        CHECK(largest_change(masses, filled::integrals(s.mesh, g, s.x,
                                                       s.materials, rho))
              < 1e-13);
      });
}
