// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "domain.h"
#include <array>
#include <span>

/// Volumes of a triangle and of the three corners into which its medians cut
/// it; per unit thickness, or per radian about x = 0.
///
/// The corners around a node are its dual volume: mass is lumped in them, and
/// the remap carries nodal values in them.
namespace mmale::mesh
{
/// Volume of a triangle with vertices x0 y0 x1 y1 x2 y2 [m3/m or m3/rad];
/// negative when it is inverted.
inline double triangle_volume(const std::array<double, 6>& x, bool axisymmetric)
{
  const double area =
      0.5 * ((x[2] - x[0]) * (x[5] - x[1]) - (x[4] - x[0]) * (x[3] - x[1]));
  return axisymmetric ? area * (x[0] + x[2] + x[4]) / 3 : area;
}

/// Volume of a cell.
inline double cell_volume(const Domain& domain, std::span<const double> x,
                          int cell, bool axisymmetric)
{
  const auto [i, j, k] = domain.cells[cell];
  return triangle_volume(
      {x[2 * i], x[2 * i + 1], x[2 * j], x[2 * j + 1], x[2 * k], x[2 * k + 1]},
      axisymmetric);
}

/// Volumes of its corners; their sum is that of the cell.
inline std::array<double, 3> corner_volumes(const Domain& domain,
                                            std::span<const double> x, int cell,
                                            bool axisymmetric)
{
  const double third = cell_volume(domain, x, cell, false) / 3;
  if (not axisymmetric)
    return {third, third, third};
  std::array<double, 3> out;
  const auto& n = domain.cells[cell];
  for (int v = 0; v < 3; ++v) // a corner's centroid has shares 22, 7, 7 of 36
    out[v] = third
             * (22 * x[2 * n[v]] + 7 * x[2 * n[(v + 1) % 3]]
                + 7 * x[2 * n[(v + 2) % 3]])
             / 36;
  return out;
}

/// Sum of the corners around each node, each times a number of its cell, as
/// the mass of a node from densities; ghosts too. Collective.
///
/// @param[in] x     nodes, shape (n, 2) [m]
/// @param[in] value of all cells, ghosts too; empty: 1
inline std::vector<double> lump(const Domain& domain, std::span<const double> x,
                                std::span<const double> value,
                                bool axisymmetric)
{
  std::vector<double> sum(domain.num_nodes(), 0);
  for (int c = 0; c < domain.num_cells(); ++c)
  {
    const auto corner = corner_volumes(domain, x, c, axisymmetric);
    for (int v = 0; v < 3; ++v)
      sum[domain.cells[c][v]] += corner[v] * (value.empty() ? 1 : value[c]);
  }
  domain.node_halo->update(sum, 1);
  return sum;
}
} // namespace mmale::mesh
