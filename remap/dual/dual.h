// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the median dual. A cell is cut by its medians into three corners;
// the corners around a node are its dual volume. Middles and centroids of cells
// move on straight lines when the nodes do, so dual facets sweep exactly what
// the dual volumes gain and lose.
#pragma once

#include "remap/geometry/swept.h"
#include "remap/mesh.h"

namespace remap::dual
{
/// Vertices of a cell in space.
struct Corners
{
  Point v[3];
  [[nodiscard]] Point centroid() const
  {
    return 1.0 / 3 * (v[0] + v[1] + v[2]);
  }
};

inline Corners corners(const Mesh& mesh, std::int32_t c,
                       std::span<const double> x)
{
  const Triple& n = mesh.cell(c);
  return {{point(x, n[0]), point(x, n[1]), point(x, n[2])}};
}

/// Dual volume of a node with its first moments.
template <Geometry G>
Moments volume(const Mesh& mesh, std::int32_t node, std::span<const double> x)
{
  Moments sum;
  for (std::int32_t c : mesh.node_cells()[node])
  {
    const Triple& n = mesh.cell(c);
    const int i = n[0] == node ? 0 : (n[1] == node ? 1 : 2);
    sum += corner<G>(point(x, n[i]), point(x, n[(i + 1) % 3]),
                     point(x, n[(i + 2) % 3]));
  }
  return sum;
}

/// The facet between the corners of vertices i (left) and i + 1 (right).
inline Motion facet(const Corners& before, const Corners& after, int i)
{
  const int j = (i + 1) % 3;
  return {middle(before.v[i], before.v[j]), before.centroid(),
          middle(after.v[i], after.v[j]), after.centroid()};
}
} // namespace remap::dual
