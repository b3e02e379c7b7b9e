// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: what old volumes give to new ones by exact overlap, as pieces of
// control volumes: of cells, of the triangles of their points, and of dual
// volumes, which are made of six triangles a cell.
#pragma once

#include "remap/points.h"
#include "remap/transport/cell_volumes.h"
#include "remap/transport/nodal_volumes.h"
#include "remap/transport/overlay.h"

#include <memory>

namespace remap
{
/// Overlap of all that a remap carries, with the room it needs.
class Overlap
{
public:
  /// @param[in] points triangles of the points, or null
  Overlap(const Mesh& mesh, const PointMesh* points);

  /// Pieces between x and y, from scratch. `next` is to be known already.
  /// @return as Overlay::intersect, of this rank
  template <Geometry G>
  [[nodiscard]] Outcome cells(CellVolumes& cells, std::span<const double> x,
                              std::span<const double> y);
  template <Geometry G>
  [[nodiscard]] Outcome points(CellVolumes& points, std::span<const double> x,
                               std::span<const double> y);
  /// On one process only: a rank does not see all that the corners around its
  /// nodes exchange, and says beyond_halo. Makes room at its first use.
  /// @param[in] cells that change
  template <Geometry G>
  [[nodiscard]] Outcome
  nodes(NodalVolumes& nodes, std::span<const std::int32_t> cells,
        std::span<const double> x, std::span<const double> y);

  /// Global number of the cell that made the last call fail, or -1.
  [[nodiscard]] std::int64_t worst_cell() const { return _worst; }

private:
  const Mesh* _mesh;
  Overlay _cells;
  std::unique_ptr<Overlay> _points;
  // Of the dual volumes: triangles between the medians.
  std::unique_ptr<PointMesh> _parts;
  std::unique_ptr<Overlay> _nodes;
  std::vector<double> _from, _to; // nodes of these triangles
  std::vector<std::int32_t> _touched;
  std::int64_t _worst = -1;
};
} // namespace remap
