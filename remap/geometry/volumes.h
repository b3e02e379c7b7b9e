// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Volumes of all cells, of all dual volumes, of all corners. Plane: per unit
// thickness [m³/m]; axisymmetric: per radian [m³/rad].
#pragma once

#include "remap/mesh.h"

namespace remap
{
/// Volumes of all cells and where their means are taken.
/// @param[in]  x         shape (num_nodes, 2) [m]
/// @param[out] volumes   shape (num_cells)
/// @param[out] centroids shape (num_cells, 2), or empty
void cell_volumes(const Mesh& mesh, Geometry geometry,
                  std::span<const double> x, std::span<double> volumes,
                  std::span<double> centroids = {});

/// Dual volumes of all nodes: the corners around a node added up; complete for
/// owned nodes. In the plane a third of the cells around it.
/// @param[out] volumes   shape (num_nodes)
/// @param[out] centroids shape (num_nodes, 2), or empty
void dual_volumes(const Mesh& mesh, Geometry geometry,
                  std::span<const double> x, std::span<double> volumes,
                  std::span<double> centroids = {});

/// Corner volumes, shape (num_cells, 3), in the order of `mesh.cell(c)`.
void corner_volumes(const Mesh& mesh, Geometry geometry,
                    std::span<const double> x, std::span<double> volumes);
} // namespace remap
