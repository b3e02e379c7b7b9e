// SPDX-License-Identifier: LGPL-3.0-or-later
#include "grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace mmale::mesh
{
namespace
{
/// Edges from a fine end over `length`, scaled down to fit.
std::vector<double> edges_from(double length, double size, double finest,
                               double growth, double radius)
{
  std::vector<double> edges;
  double edge = finest;
  for (double reached = 0; reached < length * (1 - 1e-10);)
  {
    edges.push_back(edge);
    reached += edge;
    if (reached >= radius * (1 - 1e-10))
      edge = std::min(size, edge * growth);
  }
  const double sum = std::accumulate(edges.begin(), edges.end(), 0.0);
  for (double& e : edges)
    e *= length / sum;
  return edges;
}

std::vector<double> even_line(double length, int cells)
{
  std::vector<double> line(cells + 1);
  for (int i = 0; i <= cells; ++i)
    line[i] = length * i / cells;
  return line;
}

/// Node lines in both directions, in local coordinates 0 … 1.
std::array<std::vector<double>, 2> lines(const scene::Mesh& mesh)
{
  std::array<std::vector<double>, 2> out;
  const std::array extent{mesh.width, mesh.height};
  for (int d = 0; d < 2; ++d)
  {
    if (mesh.cells[d] > 0)
      out[d] = even_line(1, mesh.cells[d]);
    else if (not mesh.grading)
      out[d] = even_line(1, std::max(1.0, std::round(extent[d] / mesh.size)));
    else
    {
      const auto& g = *mesh.grading;
      out[d] = graded_line(extent[d], mesh.size, g.towards[d] - mesh.origin[d],
                           g.size, g.growth, g.radius);
      for (double& x : out[d])
        x /= extent[d];
    }
    out[d].back() = 1;
  }
  return out;
}

std::array<scene::Point, 4> corners(const scene::Mesh& mesh)
{
  if (mesh.shape == "quadrilateral")
    return mesh.corners;
  const auto [x, y] = mesh.origin;
  return {{{x, y},
           {x + mesh.width, y},
           {x + mesh.width, y + mesh.height},
           {x, y + mesh.height}}};
}

bool cut_right(scene::Diagonal diagonal, int i, int j)
{
  return diagonal == scene::Diagonal::right
         or (diagonal == scene::Diagonal::alternating and (i + j) % 2 == 0);
}

/// Move inner nodes at random, the same for any machine and any ranks.
void distort(Grid& grid, std::size_t nx, std::size_t ny, double share)
{
  std::mt19937_64 random(1);
  const auto unit = [&] { return 2.0 * (random() >> 11) / (1ull << 53) - 1.0; };
  const std::vector<double> x = grid.x;
  for (std::size_t j = 1; j < ny; ++j)
    for (std::size_t i = 1; i < nx; ++i)
    {
      const std::size_t n = j * (nx + 1) + i;
      const double shift[2] = {share * unit(), share * unit()};
      for (int d = 0; d < 2; ++d)
      {
        const std::size_t step = d == 0 ? 1 : nx + 1;
        const double edge =
            std::min(std::abs(x[2 * (n + step) + d] - x[2 * n + d]),
                     std::abs(x[2 * n + d] - x[2 * (n - step) + d]));
        grid.x[2 * n + d] += shift[d] * edge;
      }
    }
}
} // namespace

std::vector<double> graded_line(double length, double size, double towards,
                                double finest, double growth, double radius)
{
  std::vector<double> line;
  const auto below = edges_from(towards, size, finest, growth, radius);
  const auto above = edges_from(length - towards, size, finest, growth, radius);
  double x = 0;
  line.push_back(x);
  if (towards > 0)
  {
    for (std::size_t k = below.size(); k-- > 0;)
      line.push_back(x += below[k]);
    line.back() = x = towards;
  }
  if (towards < length)
    for (double e : above)
      line.push_back(x += e);
  line.back() = length;
  return line;
}

Grid make_grid(const scene::Mesh& coarse)
{
  const scene::Mesh mesh = coarse.refined();
  const auto line = lines(mesh);
  const auto corner = corners(mesh);
  const std::size_t nx = line[0].size() - 1, ny = line[1].size() - 1;
  Grid grid;
  grid.names.assign(side_names.begin(), side_names.end());
  for (double b : line[1])
    for (double a : line[0])
      for (int d = 0; d < 2; ++d)
        grid.x.push_back((1 - b) * ((1 - a) * corner[0][d] + a * corner[1][d])
                         + b * ((1 - a) * corner[3][d] + a * corner[2][d]));
  if (mesh.distortion > 0)
    distort(grid, nx, ny, mesh.distortion);

  const auto node = [nx](std::size_t i, std::size_t j)
  { return static_cast<std::int64_t>(j * (nx + 1) + i); };
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i)
    {
      const std::int64_t a = node(i, j), b = node(i + 1, j),
                         c = node(i + 1, j + 1), d = node(i, j + 1);
      if (cut_right(mesh.diagonal, i, j))
        grid.cells.insert(grid.cells.end(), {a, b, c, a, c, d});
      else
        grid.cells.insert(grid.cells.end(), {a, b, d, b, c, d});
    }
  for (std::size_t i = 0; i < nx; ++i)
  {
    grid.edges.push_back({node(i, 0), node(i + 1, 0), 0});
    grid.edges.push_back({node(i + 1, ny), node(i, ny), 2});
  }
  for (std::size_t j = 0; j < ny; ++j)
  {
    grid.edges.push_back({node(nx, j), node(nx, j + 1), 1});
    grid.edges.push_back({node(0, j + 1), node(0, j), 3});
  }
  return grid;
}
} // namespace mmale::mesh
