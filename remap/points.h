// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: data at the points of a quadrature rule. A point stands for a
// triangle of its cell: one of three with a facet and the cell's centroid, or
// one of six between the medians. They move with the cell, so what they
// exchange is swept like what cells exchange, and their volumes add up to the
// cell's.
#pragma once

#include "remap/mesh.h"

namespace remap
{
/// Points of a cell, each by the two vertices a, b (0 to 2, of the cell as the
/// host lists it) of its triangle. Three points: a, b, centroid. Six points: a,
/// middle of a and b, centroid.
using PointLayout = std::vector<Pair>;

/// Every problem of a layout, in words; empty is good (an empty layout too).
std::vector<std::string> complaints(const PointLayout& layout);

/// Triangles of the points, as a mesh of their own. Triangle q of cell c is its
/// cell c · points + q; its first nodes are the mesh's.
class PointMesh
{
public:
  /// @param[in] mesh   kept by reference: must outlive this
  /// @param[in] layout three or six points
  /// @param[in] x      of the mesh's nodes, no cell inverted
  /// @throws std::invalid_argument with every complaint, one a line
  PointMesh(const Mesh& mesh, PointLayout layout, std::span<const double> x);

  [[nodiscard]] const Mesh& mesh() const { return _triangles; }
  /// The mesh whose cells have these points.
  [[nodiscard]] const Mesh& cells() const { return *_mesh; }
  [[nodiscard]] int points() const { return static_cast<int>(_layout.size()); }

  /// Vertex a of a triangle's layout: the mesh's node at its corner.
  [[nodiscard]] std::int32_t corner(std::int32_t triangle) const
  {
    return _triangles.cell(triangle)[0];
  }

  /// Place the nodes of a cell's triangles.
  /// @param[in]  x    of the mesh's nodes, shape (num_nodes, 2)
  /// @param[out] out  of the triangles' nodes, shape (mesh().num_nodes(), 2)
  void place(std::int32_t c, std::span<const double> x,
             std::span<double> out) const;

private:
  [[nodiscard]] Mesh make(std::span<const double> x) const;
  /// Vertex of a cell by the host's number of it.
  [[nodiscard]] int vertex(std::int32_t c, int v) const
  {
    return _mesh->flipped(c) and v > 0 ? 3 - v : v;
  }
  [[nodiscard]] std::int32_t centroid(std::int32_t c) const
  {
    return _mesh->num_nodes() + c;
  }
  /// Node in the middle of facet i of a cell.
  [[nodiscard]] std::int32_t middle(std::int32_t c, int i) const
  {
    return _mesh->num_nodes() + _mesh->num_cells() + _mesh->cell_facets(c)[i];
  }
  [[nodiscard]] bool six() const { return _layout.size() == 6; }

  const Mesh* _mesh;
  PointLayout _layout;
  Mesh _triangles;
};
} // namespace remap
