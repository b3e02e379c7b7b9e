// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: centroids of materials through a Lagrangian step, so that moment of
// fluid works between remaps. They move with the affine map of their cell,
// which is exact where the deformation is one for all materials. Where the host
// has compressed materials differently, interfaces move parallel to themselves
// until the new fractions are there, and centroids with the polygons.
//
// Then Σ f g is the cell's centroid again: all centroids are shifted by one
// vector; and if one has left the cell, all go towards the cell's centroid by
// one factor, which leaves the sum.
#pragma once

#include "remap/interfaces/partition.h"
#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <span>

namespace remap
{
/// What a move did.
struct MoveReport
{
  /// Largest shift that the sum rule asked for, over the longest edge.
  double shift = 0;
  /// Cells where a centroid had to be held inside.
  std::int32_t held = 0;
};

/// Centroids of all mixed cells, ghosts too, with fractions as they are.
///
/// @param[in]     x0, x1    shape (num_nodes, 2), ghosts up to date [m]
/// @param[in,out] materials centroids at x0, then at x1
MoveReport move(const Mesh& mesh, Geometry geometry, std::span<const double> x0,
                std::span<const double> x1, Materials& materials);

/// The same with new fractions.
///
/// @param[in]     partitions interfaces at x0, by row of `materials`
/// @param[in]     fractions  at x1, shape (number of parts): of the parts in
/// the order of their slots; > 0, those of a cell add up to 1
MoveReport move(const Mesh& mesh, Geometry geometry, std::span<const double> x0,
                std::span<const double> x1,
                std::span<const Partition> partitions,
                std::span<const double> fractions, Materials& materials);
} // namespace remap
