// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Polygons of a cell's parts, for pictures and files.
#pragma once

#include "remap/interfaces/partition.h"

#include <vector>

namespace remap
{
/// A convex polygon of one part; a part may have more than one.
struct CellPiece
{
  int part;
  std::vector<Point> outline; ///< counter-clockwise
};

/// The pieces of a triangle. Slivers of round-off are left out.
inline std::vector<CellPiece> pieces(const Triangle& cell, const Partition& by)
{
  std::vector<CellPiece> out;
  const double all = twice_area(cell[0], cell[1], cell[2]);
  split(Polygon<3>(polygon::turned(cell)), by,
        [&](int part, const Piece& p)
        {
          if (not(moments<Geometry::plane>(p).v > 1e-14 * std::abs(all)))
            return;
          out.push_back({part, {}});
          for (int i = 0; i < p.size; ++i)
            out.back().outline.push_back(p[i]);
        });
  return out;
}
} // namespace remap
