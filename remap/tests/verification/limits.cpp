// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Where methods fail, both sides shown, and what long use does.

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>

using namespace remap;
using Catch::Approx;
using meshes::Diagonal;

namespace
{
constexpr int n = 20;

/// A jump carried to and fro by a shear wave whose nodes move `cells` cells.
struct Wave
{
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  Mesh mesh = data.mesh();
  std::vector<double> u;
  int cycles = 0;

  Wave()
  {
    for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
      u.push_back(data.x[2 * mesh.cell(c)[0]] < 0.5 ? 1.0 : 2.0);
  }

  [[nodiscard]] std::vector<double> wave(double cells) const
  {
    std::vector<double> out = data.x;
    for (std::size_t i = 0; i < out.size(); i += 2)
      out[i] += cells / n * std::sin(std::numbers::pi * data.x[i])
                * std::sin(2 * std::numbers::pi * data.x[i + 1]);
    return out;
  }

  Outcome run(double cells, int times, const Scheme& scheme, double max_loss)
  {
    Remapper remapper(mesh, {.scheme = scheme,
                             .max_loss = max_loss,
                             .boundaries = std::vector(4, Boundary::closed)});
    const auto away = wave(cells);
    const Field field{.values = u};
    Ledger ledger;
    for (int k = 0; k < times; ++k)
    {
      for (const bool there : {true, false})
        if (const Outcome o =
                remapper.remap(there ? data.x : away, there ? away : data.x,
                               {&field, 1}, {}, {}, ledger);
            o != Outcome::ok)
          return o;
      cycles += remapper.report().cycles;
    }
    return Outcome::ok;
  }
  [[nodiscard]] double lowest() const
  {
    return *std::min_element(u.begin(), u.end());
  }
  [[nodiscard]] double highest() const
  {
    return *std::max_element(u.begin(), u.end());
  }
};
} // namespace

TEST_CASE("limits: donor cell beyond its step blows up, sub-cycling saves it",
          "[verification]")
{
  Wave wild, tame;
  REQUIRE(wild.run(2.0, 20, scheme::DonorCell{},
                   std::numeric_limits<double>::infinity())
          == Outcome::ok);
  REQUIRE(tame.run(2.0, 20, scheme::DonorCell{}, 0.5) == Outcome::ok);
  CHECK(wild.cycles == 20);
  CHECK(wild.highest() > 1e3);
  CHECK(tame.cycles > 80);
  CHECK(tame.lowest() >= 1 - 1e-14);
  CHECK(tame.highest() <= 2 + 1e-14);
}

TEST_CASE("limits: a linear scheme without a limiter oscillates at a jump",
          "[verification]")
{
  Wave wild, tame;
  REQUIRE(wild.run(0.3, 20, scheme::Linear{}, 0.5) == Outcome::ok);
  REQUIRE(tame.run(0.3, 20, scheme::LimitedLinear{}, 0.5) == Outcome::ok);
  CHECK(wild.highest() > 2.05);
  CHECK(wild.lowest() < 0.95);
  CHECK(tame.highest() <= 2 + 1e-13);
  CHECK(tame.lowest() >= 1 - 1e-13);
}

TEST_CASE("limits: ten thousand remaps do not let mass or a constant drift",
          "[verification]")
{
  Wave w;
  std::vector<double> v(w.mesh.num_cells());
  cell_volumes(w.mesh, Geometry::plane, w.data.x, v);
  const auto mass = [&]
  {
    double sum = 0;
    for (std::size_t c = 0; c < v.size(); ++c)
      sum += v[c] * w.u[c];
    return sum;
  };
  const double before = mass();
  REQUIRE(w.run(0.2, 5000, scheme::LimitedLinear{}, 0.5) == Outcome::ok);
  // Round-off adds up like a random walk: √1e4 · 1e-16, and some.
  CHECK(std::abs(mass() - before) < 1e-12 * before);
  Wave flat;
  std::fill(flat.u.begin(), flat.u.end(), 1.0);
  REQUIRE(flat.run(0.2, 5000, scheme::LimitedLinear{}, 0.5) == Outcome::ok);
  CHECK(flat.lowest() > 1 - 1e-12);
  CHECK(flat.highest() < 1 + 1e-12);
}

TEST_CASE(
    "limits: the error of limited linear falls with order 2, donor's with 1",
    "[verification]")
{
  // A smooth field on smooth moving meshes, there and back in steps that shrink
  // with the cells; error against the exact means at the end.
  const auto error = [](int cells, const Scheme& scheme)
  {
    const meshes::Data data =
        meshes::rectangle(cells, cells, Diagonal::crossed);
    const Mesh mesh = data.mesh();
    Remapper remapper(mesh, {.scheme = scheme,
                             .boundaries = std::vector(4, Boundary::closed)});
    std::vector<double> u, x = data.x;
    const auto f = [](Point p)
    {
      return std::sin(2 * std::numbers::pi * p.x)
             * std::cos(std::numbers::pi * p.y);
    };
    // Means by a rule of degree 2.
    for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    {
      const Triple& v = mesh.cell(c);
      double sum = 0;
      for (int i = 0; i < 3; ++i)
        sum += f(middle(point(x, v[i]), point(x, v[(i + 1) % 3]))) / 3;
      u.push_back(sum);
    }
    const auto exact = u;
    const Field field{.values = u};
    Ledger ledger;
    const int steps = 4 * cells;
    for (int k = 1; k <= steps; ++k)
    {
      const double a =
          0.06 * std::sin(2 * std::numbers::pi * k / double(steps));
      auto to = data.x;
      for (std::size_t i = 0; i < to.size(); i += 2)
      {
        const double s = a * std::sin(std::numbers::pi * data.x[i])
                         * std::sin(std::numbers::pi * data.x[i + 1]);
        to[i] += s * std::cos(data.x[i + 1]);
        to[i + 1] += s;
      }
      if (k == steps)
        to = data.x;
      REQUIRE(remapper.remap(x, to, {&field, 1}, {}, {}, ledger)
              == Outcome::ok);
      x = to;
    }
    std::vector<double> v(mesh.num_cells());
    cell_volumes(mesh, Geometry::plane, x, v);
    double sum = 0;
    for (std::size_t c = 0; c < v.size(); ++c)
      sum += v[c] * std::abs(u[c] - exact[c]);
    return sum;
  };
  const auto order = [&](const Scheme& scheme)
  { return std::log2(error(32, scheme) / error(64, scheme)); };
  CHECK(order(scheme::DonorCell{}) == Approx(1).margin(0.15));
  CHECK(order(scheme::Linear{}) > 1.8);
  // The limiter clips smooth extrema; that costs part of an order.
  CHECK(order(scheme::LimitedLinear{}) > 1.6);
}
