// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Meshes for tests: rectangles cut into triangles, shaken with a seed.
#pragma once

#include "remap/mesh.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace meshes
{
/// Nodes and cells, and marked boundary facets: 0 bottom, 1 right, 2 top,
/// 3 left.
struct Data
{
  std::vector<double> x;
  std::vector<std::int32_t> cells, marked, markers;

  [[nodiscard]] remap::MeshInput input() const
  {
    return {.cells = cells,
            .x = x,
            .owned_cells = cells.size() / 3,
            .owned_nodes = x.size() / 2,
            .cell_ids = {},
            .node_ids = {},
            .marked = marked,
            .markers = markers};
  }
  [[nodiscard]] remap::Mesh mesh() const { return remap::Mesh(input()); }
};

/// How squares are cut.
enum class Diagonal
{
  right,   ///< all like /
  crossed, ///< alternating like a chess board
  four,    ///< both: four triangles a square
};

inline Data rectangle(int nx, int ny, Diagonal diagonal, double x0 = 0,
                      double y0 = 0, double width = 1, double height = 1)
{
  Data out;
  const auto at = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
    {
      out.x.push_back(x0 + width * i / nx);
      out.x.push_back(y0 + height * j / ny);
    }
  const auto add = [&out](int a, int b, int c)
  {
    for (const int i : {a, b, c})
      out.cells.push_back(i);
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
    {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1),
                d = at(i, j + 1);
      if (diagonal == Diagonal::four)
      {
        const int m = static_cast<int>(out.x.size() / 2);
        out.x.push_back(x0 + width * (i + 0.5) / nx);
        out.x.push_back(y0 + height * (j + 0.5) / ny);
        add(a, b, m), add(b, c, m), add(c, d, m), add(d, a, m);
      }
      else if (diagonal == Diagonal::crossed and (i + j) % 2 == 1)
        add(a, b, d), add(b, c, d);
      else
        add(a, b, c), add(a, c, d);
    }
  const auto mark = [&out](int a, int b, int marker)
  {
    out.marked.insert(out.marked.end(), {a, b});
    out.markers.push_back(marker);
  };
  for (int i = 0; i < nx; ++i)
    mark(at(i, 0), at(i + 1, 0), 0), mark(at(i, ny), at(i + 1, ny), 2);
  for (int j = 0; j < ny; ++j)
    mark(at(nx, j), at(nx, j + 1), 1), mark(at(0, j), at(0, j + 1), 3);
  return out;
}

/// Is a node on the outline of the rectangle it was made in?
inline bool on_outline(remap::Point p, double x0 = 0, double y0 = 0,
                       double width = 1, double height = 1)
{
  return p.x == x0 or p.y == y0 or p.x == x0 + width or p.y == y0 + height;
}

/// Inner nodes moved by up to `by` in each coordinate, the same for a seed.
inline std::vector<double> shaken(std::span<const double> x, double by,
                                  unsigned seed, double x0 = 0, double y0 = 0,
                                  double width = 1, double height = 1)
{
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> shift(-by, by);
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size() / 2; ++i)
  {
    const double dx = shift(engine), dy = shift(engine);
    if (on_outline({x[2 * i], x[2 * i + 1]}, x0, y0, width, height))
      continue;
    out[2 * i] += dx;
    out[2 * i + 1] += dy;
  }
  return out;
}

/// Turned about a centre, positive counter-clockwise.
inline std::vector<double> turned(std::span<const double> x, double angle,
                                  remap::Point about)
{
  std::vector<double> out(x.begin(), x.end());
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < x.size() / 2; ++i)
  {
    const double dx = x[2 * i] - about.x, dy = x[2 * i + 1] - about.y;
    out[2 * i] = about.x + c * dx - s * dy;
    out[2 * i + 1] = about.y + s * dx + c * dy;
  }
  return out;
}
} // namespace meshes
