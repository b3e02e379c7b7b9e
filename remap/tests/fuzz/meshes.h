// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Small meshes and moves to break an overlay: nodes that stay, that move by
// round-off, along an edge, to the place where another node was; long moves,
// thin cells, a moved outline. One number makes one of them.
#pragma once

#include "remap/tests/carry.h"
#include "remap/tests/fuzz/pairs.h"
#include "remap/tests/meshes.h"

#include <string>

namespace fuzz
{
class Move
{
  static constexpr int n = 6;
  Random _random;
  std::string _what; // drawn with the positions below

public:
  bool outline_moves = false;
  meshes::Data data;
  remap::Mesh mesh;
  std::vector<double> from, to;

  explicit Move(std::uint64_t seed)
      : _random(seed), data(draw_mesh()), mesh(data.mesh()), from(valid(false)),
        to(valid(true))
  {
  }

  [[nodiscard]] std::vector<std::int32_t> touched() const
  {
    return carry::touched(mesh, from, to);
  }
  [[nodiscard]] remap::Triangle place(std::span<const double> x,
                                      std::int32_t c) const
  {
    const auto& v = mesh.cell(c);
    return {remap::point(x, v[0]), remap::point(x, v[1]),
            remap::point(x, v[2])};
  }
  /// Which moves were drawn.
  [[nodiscard]] std::string what() const { return _what; }

private:
  double unit(int bits = 20)
  {
    const auto range = std::uint64_t(1) << bits;
    return static_cast<double>(_random.below(range))
           / static_cast<double>(range);
  }

  meshes::Data draw_mesh()
  {
    constexpr meshes::Diagonal ways[] = {meshes::Diagonal::right,
                                         meshes::Diagonal::crossed,
                                         meshes::Diagonal::four};
    // Aspect ratios up to 1e4.
    constexpr double heights[] = {1, 1, 0.03, 1e-4};
    const auto way = ways[_random.below(3)];
    return meshes::rectangle(n, n, way, 0, 0, 1, heights[_random.below(4)]);
  }

  /// Some node positions without inverted cells; milder and milder until then.
  std::vector<double> valid(bool target)
  {
    const double height = data.x[2 * (n + 1) * n + 1];
    std::vector<double> v(mesh.num_cells());
    for (double by = 0.45 / n;; by *= 0.8)
    {
      _what.clear();
      outline_moves = false;
      std::vector<double> x(data.x);
      for (std::size_t i = 0; i < x.size(); i += 2)
        if (not meshes::on_outline({x[i], x[i + 1]}, 0, 0, 1, height))
          shift(x, i, by, by * height);
      if (target)
        deform(x, height);
      remap::cell_volumes(mesh, remap::Geometry::plane, x, v);
      if (*std::min_element(v.begin(), v.end()) > 1e-3 * height / (n * n))
        return x;
    }
  }

  /// One node: stays, by round-off, along an axis, or anywhere.
  void shift(std::vector<double>& x, std::size_t i, double dx, double dy)
  {
    const double p = 2 * unit() - 1, q = 2 * unit() - 1;
    switch (_random.below(5))
    {
    case 0:
      break;
    case 1:
      x[i] += 1e-14 * p * dx * n, x[i + 1] += 1e-14 * q * dy * n;
      break;
    case 2:
      x[i] += 0.5 * dx;
      break;
    default:
      x[i] += p * dx, x[i + 1] += q * dy;
    }
  }

  /// The mesh as a whole.
  void deform(std::vector<double>& x, double height)
  {
    const auto way = _random.below(6);
    const double by = 3 * unit() / n;
    const auto column = static_cast<double>(_random.below(3)) / n;
    constexpr const char* names[] = {"inner nodes", "eddy",     "shifted",
                                     "stretched",   "mirrored", "sheared"};
    _what = names[way];
    outline_moves = way == 2 or way == 3 or way == 5;
    for (std::size_t i = 0; i < x.size(); i += 2)
    {
      double &a = x[i], &b = x[i + 1];
      const double s = std::sin(std::numbers::pi * a)
                       * std::sin(std::numbers::pi * b / height);
      switch (way)
      {
      case 1:
        a += by * s * 0.6, b += by * s * 0.6 * height;
        break;
      case 2: // by whole columns: nodes land where nodes were
        a += column;
        break;
      case 3:
        a *= 1 + by, b *= 1 - by / 2;
        break;
      case 4: // half a turn: every cell goes to the other end
        a = 1 - a, b = height - b;
        break;
      case 5:
        a += by * b / height;
        break;
      default:
        break;
      }
    }
  }
};
} // namespace fuzz
