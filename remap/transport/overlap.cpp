// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/transport/overlap.h"

using namespace remap;

namespace
{
/// Six triangles of a cell, the first two at its vertex 0, and so on.
const PointLayout parts_of_corners = {{0, 1}, {0, 2}, {1, 2},
                                      {1, 0}, {2, 0}, {2, 1}};

/// Put a piece among those of a set of volumes; what stays is none.
void add(ControlVolumes& cv, const Overlay::Piece& piece, std::int32_t from,
         std::int32_t to)
{
  if (from == to)
    return;
  cv.make_room();
  if (from >= 0 and to >= 0)
    cv.exchange(from, to, piece.volume, piece.at);
  else
    cv.pass(from, to, piece.volume, piece.at, piece.facet, piece.marker);
}
} // namespace

Overlap::Overlap(const Mesh& mesh, const PointMesh* points)
    : _mesh(&mesh), _cells(mesh)
{
  if (points)
    _points = std::make_unique<Overlay>(points->mesh());
}

template <Geometry G>
Outcome Overlap::cells(CellVolumes& cells, std::span<const double> x,
                       std::span<const double> y)
{
  cells.drop_pieces();
  const Outcome out = _cells.intersect<G>(x, y, cells.touched);
  _worst = _cells.worst_cell();
  if (out == Outcome::ok)
    for (const Overlay::Piece& p : _cells.pieces())
      add(cells, p, p.from, p.to);
  cells.settle_pieces();
  return out;
}

template <Geometry G>
Outcome Overlap::points(CellVolumes& points, std::span<const double> x,
                        std::span<const double> y)
{
  points.drop_pieces();
  const Outcome out = _points->intersect<G>(x, y, points.touched);
  if (out == Outcome::ok)
    for (const Overlay::Piece& p : _points->pieces())
      add(points, p, p.from, p.to);
  points.settle_pieces();
  return out;
}

template <Geometry G>
Outcome Overlap::nodes(NodalVolumes& nodes, std::span<const std::int32_t> cells,
                       std::span<const double> x, std::span<const double> y)
{
  if (_mesh->num_cells() > _mesh->owned_cells())
    return Outcome::beyond_halo;
  if (not _parts)
  {
    _parts = std::make_unique<PointMesh>(*_mesh, parts_of_corners, x);
    _nodes = std::make_unique<Overlay>(_parts->mesh());
    _from.resize(std::size_t(2) * _parts->mesh().num_nodes());
    _to.resize(_from.size());
  }
  const int parts = _parts->points();
  _touched.clear();
  for (std::int32_t c : cells)
  {
    _parts->place(c, x, _from);
    _parts->place(c, y, _to);
    for (int q = 0; q < parts; ++q)
      _touched.push_back(parts * c + q);
  }
  nodes.drop_pieces();
  const Outcome out = _nodes->intersect<G>(_from, _to, _touched);
  const auto node = [&](std::int32_t part)
  { return part < 0 ? -1 : _parts->corner(part); };
  if (out == Outcome::ok)
    for (const Overlay::Piece& p : _nodes->pieces())
      add(nodes, p, node(p.from), node(p.to));
  nodes.settle_pieces();
  return out;
}

template Outcome Overlap::cells<Geometry::plane>(CellVolumes&,
                                                 std::span<const double>,
                                                 std::span<const double>);
template Outcome
Overlap::cells<Geometry::axisymmetric>(CellVolumes&, std::span<const double>,
                                       std::span<const double>);
template Outcome Overlap::points<Geometry::plane>(CellVolumes&,
                                                  std::span<const double>,
                                                  std::span<const double>);
template Outcome
Overlap::points<Geometry::axisymmetric>(CellVolumes&, std::span<const double>,
                                        std::span<const double>);
template Outcome Overlap::nodes<Geometry::plane>(NodalVolumes&,
                                                 std::span<const std::int32_t>,
                                                 std::span<const double>,
                                                 std::span<const double>);
template Outcome Overlap::nodes<Geometry::axisymmetric>(
    NodalVolumes&, std::span<const std::int32_t>, std::span<const double>,
    std::span<const double>);
