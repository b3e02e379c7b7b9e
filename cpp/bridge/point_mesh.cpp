// SPDX-License-Identifier: LGPL-3.0-or-later
#include "point_mesh.h"

#include "lagrangian/kernel.h"
#include <algorithm>

namespace mmale::bridge
{
namespace
{
std::array<int, 2> edge(int a, int b)
{
  return {std::min(a, b), std::max(a, b)};
}

/// Edges of six points' triangles have middles; of three points' none.
std::vector<std::array<int, 2>> edges(const mesh::Domain& domain, int points)
{
  std::vector<std::array<int, 2>> out;
  if (points == 3)
    return out;
  for (const auto& c : domain.cells)
    for (int v = 0; v < 3; ++v)
      out.push_back(edge(c[v], c[(v + 1) % 3]));
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Vertex of a cell where a point has its n-th largest share.
template <std::size_t size>
int ranked(const std::array<std::array<double, 3>, size>& points, int q, int n)
{
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, std::greater{}, [&](int v) { return points[q][v]; });
  return order[n];
}
} // namespace

PointMesh::PointMesh(const mesh::Domain& domain, int points)
    : _domain(domain), _points(points), _edges(edges(domain, points)),
      _mesh(make_mesh())
{
}

/// Node in the middle of an edge.
int PointMesh::middle(int a, int b) const
{
  const auto at = std::ranges::lower_bound(_edges, edge(a, b));
  return _domain.num_nodes() + _domain.num_cells()
         + static_cast<int>(at - _edges.begin());
}

::remap::Mesh PointMesh::make_mesh()
{
  std::vector<std::int32_t> cells, marked, markers;
  std::vector<std::int64_t> cell_ids;
  for (int c = 0; c < _domain.num_cells(); ++c)
  {
    const auto& n = _domain.cells[c];
    const int centroid = _domain.num_nodes() + c;
    for (int q = 0; q < _points; ++q)
    {
      cell_ids.push_back(_domain.cell_id[c] * _points + q);
      if (_points == 3)
      {
        const int far = ranked(lagrangian::points<3>(), q, 2);
        cells.insert(cells.end(),
                     {n[(far + 1) % 3], n[(far + 2) % 3], centroid});
        continue;
      }
      const int i = ranked(lagrangian::points<6>(), q, 0),
                j = ranked(lagrangian::points<6>(), q, 1);
      const int m = middle(n[i], n[j]);
      const bool forward = j == (i + 1) % 3;
      cells.insert(cells.end(),
                   {forward ? n[i] : m, forward ? m : n[i], centroid});
    }
  }
  for (const mesh::Facet& f : _domain.facets)
  {
    if (_points == 3)
      marked.insert(marked.end(), {f.a, f.b});
    else
    {
      const int m = middle(f.a, f.b);
      marked.insert(marked.end(), {f.a, m, m, f.b});
    }
    markers.insert(markers.end(), _points / 3, f.boundary);
  }
  const auto x = nodes(_domain.initial_x);
  return ::remap::Mesh(
      {.cells = cells,
       .x = x,
       .owned_cells = static_cast<std::size_t>(_points)
                      * static_cast<std::size_t>(_domain.num_owned_cells),
       .owned_nodes = static_cast<std::size_t>(_domain.num_owned_nodes),
       .cell_ids = cell_ids,
       .marked = marked,
       .markers = markers});
}

std::vector<double> PointMesh::nodes(std::span<const double> x) const
{
  std::vector<double> out(x.begin(), x.end());
  out.reserve(x.size() + 2 * (_domain.cells.size() + _edges.size()));
  for (const auto& [i, j, k] : _domain.cells)
    for (int d = 0; d < 2; ++d)
      out.push_back((x[2 * i + d] + x[2 * j + d] + x[2 * k + d]) / 3);
  for (const auto& [a, b] : _edges)
    for (int d = 0; d < 2; ++d)
      out.push_back(0.5 * (x[2 * a + d] + x[2 * b + d]));
  return out;
}

::remap::Host PointMesh::host(const ::remap::Host& cells) const
{
  ::remap::Host out = cells;
  out.node_halo = {}; // nothing lives at the nodes of the triangles
  if (cells.cell_halo)
    out.cell_halo = [halo = cells.cell_halo,
                     points = _points](std::span<double> v, int block)
    { halo(v, block * points); };
  return out;
}
} // namespace mmale::bridge
