// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Random domains over random meshes; a seed makes the same again.
#pragma once

#include "remap/domain/domain.h"
#include "remap/tests/meshes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace fuzz
{
/// Rays of random length between two radii, counter-clockwise.
inline remap::Ring star(std::mt19937& random, remap::Point centre, double least,
                        double most, int points)
{
  std::uniform_real_distribution<double> radius(least, most), part(0.1, 0.9);
  remap::Ring out;
  for (int i = 0; i < points; ++i)
  {
    const double a = 2 * std::numbers::pi * (i + part(random)) / points;
    const double r = radius(random);
    out.push_back(centre + r * remap::Point{std::cos(a), std::sin(a)});
  }
  return out;
}

/// A domain over a mesh of the square from (0.5, 0) to (1.5, 1).
struct Laid
{
  meshes::Data mesh;
  remap::Domain domain;
  int kind;

  explicit Laid(std::uint64_t seed) : kind(static_cast<int>(seed % 6))
  {
    std::mt19937 random(static_cast<unsigned>(seed));
    const int n = 2 + static_cast<int>(seed / 6 % 5);
    mesh = meshes::rectangle(n, n, meshes::Diagonal::crossed, 0.5);
    if (kind != 2 and kind != 3)
      shake(random, n);
    domain = make(random, n);
  }

  [[nodiscard]] remap::Triangle place(std::size_t c) const
  {
    return {remap::point(mesh.x, mesh.cells[3 * c]),
            remap::point(mesh.x, mesh.cells[3 * c + 1]),
            remap::point(mesh.x, mesh.cells[3 * c + 2])};
  }

  [[nodiscard]] std::string what() const
  {
    constexpr std::array<const char*, 6> words = {
        "star with holes",          "partly outside",
        "vertices on the mesh's",   "edges on the mesh's",
        "thread of 1e-7 of a cell", "cell with a hole at its edge"};
    return words[static_cast<std::size_t>(kind)];
  }

private:
  void shake(std::mt19937& random, int n)
  {
    std::uniform_real_distribution<double> move(-0.25 / n, 0.25 / n);
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        for (int k = 0; k < 2; ++k)
          mesh.x[static_cast<std::size_t>(2 * (j * (n + 1) + i) + k)] +=
              move(random);
  }

  remap::Domain make(std::mt19937& random, int n) const
  {
    std::uniform_real_distribution<double> any(0.2, 0.8);
    const remap::Point c{1, 0.5};
    switch (kind)
    {
    case 0:
      return remap::Domain({star(random, c, 0.25, 0.5, 30),
                            star(random, c, 0.15, 0.24, 24),
                            star(random, c, 0.05, 0.14, 9)});
    case 1:
    {
      const remap::Point off{1.4, any(random)};
      return remap::Domain(
          {star(random, off, 0.3, 0.5, 20), star(random, off, 0.01, 0.25, 7)});
    }
    case 2:
    {
      // A quadrilateral with its corners on nodes, one on each side.
      std::uniform_int_distribution<int> node(0, n);
      const auto at = [&] { return static_cast<double>(node(random)) / n; };
      return remap::Domain::polygon({{0.5 + at(), 0},
                                     {1.5, 0.001 + 0.99 * at()},
                                     {0.5 + at(), 1},
                                     {0.5, 0.001 + 0.99 * at()}});
    }
    case 3:
    {
      const double h = 1.0 / n;
      return remap::Domain::rectangle({0.5 + h, 0}, {0.5 + 2 * h, h});
    }
    case 4:
    {
      const double y = any(random), slope = any(random) - 0.5;
      const double width = 1e-7 / n;
      return remap::Domain::polygon({{0.6, y},
                                     {1.4, y + 0.3 * slope},
                                     {1.4, y + 0.3 * slope + width},
                                     {0.6, y + width}});
    }
    default:
    {
      // A cell of the mesh as domain, and in it a triangle on its edge.
      std::uniform_int_distribution<std::size_t> cell(0, mesh.cells.size() / 3
                                                             - 1);
      const remap::Triangle t = place(cell(random));
      const remap::Point g = (1.0 / 3) * (t[0] + t[1] + t[2]);
      const auto between = [](remap::Point a, remap::Point b, double s)
      { return a + s * (b - a); };
      return remap::Domain({{t[0], t[1], t[2]},
                            {between(t[0], g, 0.5), between(t[1], g, 0.5),
                             between(t[0], g, 0.9)}});
    }
    }
  }
};
} // namespace fuzz
