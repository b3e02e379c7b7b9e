// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "remap/host.h"
#include "remap/mesh.h"
#include <array>
#include <span>
#include <vector>

namespace mmale::bridge
{
/// The triangles that the points of layout `quadrature` stand for, as a mesh of
/// their own: a cell falls into three at its centroid, or into six between its
/// medians. They move with the cell, so what is carried between them is
/// conserved and stays with its points (METHOD.md, step 3).
class PointMesh
{
public:
  /// @param[in] points of a cell, 3 or 6
  PointMesh(const mesh::Domain& domain, int points);

  const ::remap::Mesh& mesh() const { return _mesh; }

  /// Nodes of the triangles when those of the cells are at x.
  std::vector<double> nodes(std::span<const double> x) const;

  /// Halo of arrays over the triangles, from that of the cells.
  ::remap::Host host(const ::remap::Host& cells) const;

private:
  ::remap::Mesh make_mesh();
  int middle(int a, int b) const;

  const mesh::Domain& _domain;
  int _points;
  std::vector<std::array<int, 2>> _edges; ///< ascending; of six points only
  ::remap::Mesh _mesh;
};
} // namespace mmale::bridge
