// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: a domain laid over triangles. In: a domain, cells. Out: volume and
// first moments of the part of each cell in the domain, to round-off, in the
// plane and about an axis; and that part itself as convex polygons. The parts
// of cells that fill the domain add up to it.
#pragma once

#include "remap/domain/domain.h"

#include <cstdint>
#include <span>
#include <vector>

namespace remap
{
/// Convex polygons of 3 or 4 vertices, counter-clockwise, each in one cell.
struct DomainPieces
{
  std::vector<Point> points;
  std::vector<std::int32_t> offsets = {0}; ///< size num + 1, into points
  std::vector<std::int32_t> cells;         ///< size num

  [[nodiscard]] std::size_t size() const { return cells.size(); }
  [[nodiscard]] std::span<const Point> operator[](std::size_t i) const
  {
    return std::span(points).subspan(
        static_cast<std::size_t>(offsets[i]),
        static_cast<std::size_t>(offsets[i + 1] - offsets[i]));
  }
};

/// What of each cell lies in a domain.
struct PartialVolumes
{
  /// Volume and first moments, shape (num_cells). All or nothing of a cell
  /// where what is missing is round-off: 16 eps of the box around the cell and
  /// the edges that meet it, times the cell's size.
  std::vector<Moments> parts;
  std::vector<std::int32_t> mixed; ///< cells that are neither, ascending
  std::int32_t full = 0;           ///< cells wholly inside
};

/// Lay a domain over triangles. They may be any set: a rank brings its own.
///
/// A tree of boxes of cells is walked down where the outline passes; on the
/// way the outline is thinned to what the box can see, without making a new
/// point. In a cell at its end the rest is cut by the cell's three edges.
///
/// @param[in] cells  nodes, shape (num_cells, 3), in either order
/// @param[in] x      coordinates, shape (num_nodes, 2) [m]
/// @param[out] pieces if not null: the parts as polygons, in order of cells
template <Geometry G>
[[nodiscard]] PartialVolumes
partial_volumes(const Domain& domain, std::span<const std::int32_t> cells,
                std::span<const double> x, DomainPieces* pieces = nullptr);
} // namespace remap
