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

double largest_change(const std::vector<double>& a,
                      const std::vector<double>& b)
{
  double out = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    out = std::max(out, std::abs(a[k] - b[k]) / std::abs(a[k]));
  return out;
}

/// So many remaps between a scene's two meshes, with one field; it starts at x.
void there_and_back(Remapper& remapper, Scene& s, const MaterialField& field,
                    int remaps, Ledger& ledger)
{
  for (int k = 0; k < remaps; ++k)
    REQUIRE(
        remapper.remap(k % 2 == 0 ? s.x : s.y, k % 2 == 0 ? s.y : s.x,
                       {.materials = &s.materials, .of_materials = {&field, 1}},
                       {}, ledger)
        == Outcome::ok);
}

const auto geometries = {Geometry::plane, Geometry::axisymmetric};
const auto methods = {Method::swept, Method::overlay};

/// Call with every scheme of the library.
template <class Call>
void each_scheme(const Call& call)
{
  for (const std::string& name : names<Schemes>())
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
        there_and_back(remapper, s, field, 6, ledger);
        CHECK(rho.size() == std::size_t(s.materials.num_slots()));
        CHECK(filled::unsound(s.materials) < 1e-14);
        CHECK(largest_change(volumes,
                             filled::integrals(s.mesh, g, s.x, s.materials))
              < 1e-13);
        CHECK(largest_change(
                  masses, filled::integrals(s.mesh, g, s.x, s.materials, rho))
              < 1e-13);
      });
}

TEST_CASE("materials: uniform stays uniform in each, whatever is beside it",
          "[remap][materials]")
{
  const auto g = GENERATE(values(geometries));
  const auto method = GENERATE(values(methods));
  each_scheme(
      [&](const Scheme& scheme)
      {
        Scene s(g);
        const auto own = [](Point, int k) { return std::pow(1000.0, k); };
        auto rho = s.values(own);
        Remapper remapper(s.mesh, s.options(method, scheme));
        const MaterialField field{.values = rho};
        Ledger ledger;
        there_and_back(remapper, s, field, 10, ledger);
        double worst = 0;
        filled::each_slot(s.mesh, g, s.x, s.materials,
                          [&](std::int32_t slot, int k, double, Point)
                          {
                            const double is = std::pow(1000.0, k);
                            worst =
                                std::max(worst, std::abs(rho[slot] - is) / is);
                          });
        // Without a limiter the round-off of gradients adds up.
        CHECK(worst < 1e-11);
      });
}

TEST_CASE("materials: no value leaves what its material held",
          "[remap][materials]")
{
  const auto g = GENERATE(values(geometries));
  const auto method = GENERATE(values(methods));
  each_scheme(
      [&](const Scheme& scheme)
      {
        if (not std::visit([]<class S>(const S&) { return S::bounded; },
                           scheme))
          return;
        Scene s(g);
        std::mt19937 engine(7);
        std::uniform_real_distribution<double> unit(0, 1);
        const std::vector<double> lowest = {1, 10, 1000, -5},
                                  highest = {2, 11, 1003, -4};
        auto u = s.values(
            [&](Point, int k)
            { return lowest[k] + (highest[k] - lowest[k]) * unit(engine); });
        Remapper remapper(s.mesh, s.options(method, scheme));
        // Keeps only the range that a field brings; the others' is none.
        const std::vector<double> least = {-5}, most = {1003};
        const bool smooth =
            std::holds_alternative<scheme::SmoothExtrema>(scheme);
        const MaterialField field{.values = u, .least = least, .most = most};
        Ledger ledger;
        there_and_back(remapper, s, field, 10, ledger);
        double worst = 0;
        filled::each_slot(s.mesh, g, s.x, s.materials,
                          [&](std::int32_t slot, int k, double, Point)
                          {
                            worst = std::max({worst, u[slot] - highest[k],
                                              lowest[k] - u[slot]});
                          });
        // What is beside is ten to a thousand times as far.
        CHECK(worst < (smooth ? 1.0 : 1e-10));
      });
}

TEST_CASE("materials: fields linear in each stay so", "[remap][materials]")
{
  const auto g = GENERATE(values(geometries));
  const auto method = Method::overlay;
  Scene s(g);
  const auto f = [](Point p, int k)
  { return std::pow(10.0, k) * (2 + (k + 1) * p.x - 0.5 * p.y); };
  auto u = s.values(f);
  Remapper remapper(s.mesh, s.options(method, scheme::Linear{}));
  const MaterialField field{.values = u};
  Ledger ledger;
  there_and_back(remapper, s, field, 4, ledger);
  double worst = 0;
  int n_bad = 0;
  filled::each_slot(s.mesh, g, s.x, s.materials,
                    [&](std::int32_t slot, int k, double, Point at)
                    {
                      const double e =
                          std::abs(u[slot] - f(at, k)) / std::pow(10.0, k);
                      worst = std::max(worst, e);
                      n_bad += e > 1e-10;
                    });
  INFO(n_bad << " of " << s.materials.num_slots() << " capped "
             << remapper.report().materials.capped);
  CHECK(worst < 1e-10);
}

TEST_CASE("materials: a straight interface stays straight",
          "[remap][materials]")
{
  const auto g = GENERATE(values(geometries));
  Scene s(g);
  const auto cut = filled::line({0.3, 1}, {0.5, 0.52});
  const std::vector<int> two = {0, 1};
  s.materials = filled::fill(s.mesh, g, s.x, cut, two, 4);
  Remapper remapper(s.mesh,
                    s.options(Method::overlay, scheme::LimitedLinear{}));
  Ledger ledger;
  for (int k = 0; k < 4; ++k)
    REQUIRE(remapper.remap(k % 2 == 0 ? s.x : s.y, k % 2 == 0 ? s.y : s.x,
                           {.materials = &s.materials}, {}, ledger)
            == Outcome::ok);
  const auto exact = filled::fill(s.mesh, g, s.x, cut, two, 4);
  double worst = 0;
  for (std::int32_t c = 0; c < s.mesh.num_cells(); ++c)
    worst = std::max(
        worst, std::abs(s.materials.fraction(c, 0) - exact.fraction(c, 0)));
  CHECK(worst < 1e-12);
}
