// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: the cells around each node in the order in which smoothers see
// them, found once for a mesh.
#pragma once

#include "remap/mesh.h"
#include "remap/smoothing/patch.h"

#include <span>
#include <vector>

namespace remap
{
/// Stars of the nodes of ours.
class Stars
{
public:
  explicit Stars(const Mesh& mesh);

  /// A star's cells at the given places. Allocates nothing if `patch` has room
  /// for `widest` cells.
  ///
  /// @param[in] x       shape (num_nodes, 2) [m]
  /// @param[in] targets shape (num_cells); empty: equilateral
  void gather(std::int32_t node, std::span<const double> x,
              std::span<const quality::Target> targets,
              std::vector<PatchCell>& patch) const;

  /// Cells of the largest star.
  [[nodiscard]] std::size_t widest() const { return _widest; }

private:
  /// The other two nodes of a cell, and which vertex the star's own node is.
  struct Cell
  {
    std::int32_t a, b, cell, vertex;
  };

  std::vector<std::int32_t> _start; // of each node in _cells
  std::vector<Cell> _cells;
  std::size_t _widest = 0;
};
} // namespace remap
