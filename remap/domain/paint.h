// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: materials laid over triangles in coats, like paint: a later coat
// covers what lies under it. In: domains with their materials, cells. Out: the
// materials of each cell, fractions and centroids exact to round-off, in the
// plane and about an axis. Conserved: the parts of a cell add up to it.
#pragma once

#include "remap/domain/domain.h"
#include "remap/materials/materials.h"

#include <cstdint>
#include <span>
#include <vector>

namespace remap
{
/// A domain filled with a material.
struct Coat
{
  Domain domain;
  int material = 0;
  bool everywhere = false; ///< in all cells; the domain is then not looked at
};

/// Some of a cell that no coat covers.
struct BarePlace
{
  std::int32_t cell = -1;
  double volume = 0; ///< [m³/m or m³/rad]
  Point at;          ///< a point of it [m]
};

/// What painting came to. No place is left bare, and no cell crowded, by coats
/// that are fit for use: whoever asked for them looks at both.
struct Painting
{
  /// Bare places are taken by the cell's other materials, or else material 0;
  /// crowded cells hold their largest material alone.
  Materials materials;
  std::vector<BarePlace> bare; ///< by ascending cell
  /// Cells with more materials than one can hold (`most_parts`), ascending.
  std::vector<std::int32_t> crowded;
};

/// Lay coats over triangles. These may be any set: a rank brings its own, and
/// finds the same to the last bit, whatever the others have.
///
/// Cells that no outline comes near are pure, whole boxes of them at once. The
/// others fall into slabs between heights where an edge of the cell or of a
/// coat begins, ends or crosses another one; in a slab edges lie side by side,
/// and the uppermost coat between two of them is counted. So one sum has all
/// coats, edges in common leave nothing between them, and the pieces fill the
/// cell.
///
/// Round-off is 16 eps of the largest coordinate of a cell and the edges that
/// meet it, times the cell's size: a smaller part goes to the cell's largest
/// one, and a smaller bare place counts as none.
///
/// @param[in] coats  in the order of painting
/// @param[in] cells  nodes, shape (num_cells, 3), in either order
/// @param[in] x      coordinates, shape (num_nodes, 2) [m]
/// @throws std::invalid_argument for a coat of a material that is none
template <Geometry G>
[[nodiscard]] Painting paint(std::span<const Coat> coats,
                             std::span<const std::int32_t> cells,
                             std::span<const double> x, int num_materials);
} // namespace remap
