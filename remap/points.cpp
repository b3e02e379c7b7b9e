// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/points.h"

#include <algorithm>
#include <stdexcept>

using namespace remap;

std::vector<std::string> remap::complaints(const PointLayout& layout)
{
  std::vector<std::string> out;
  if (not layout.empty() and layout.size() != 3 and layout.size() != 6)
    out.push_back("points: 3 or 6 a cell");
  auto sorted = layout;
  for (Pair& p : sorted)
  {
    if (p[0] < 0 or p[0] > 2 or p[1] < 0 or p[1] > 2 or p[0] == p[1])
      out.push_back("points: two different vertices, 0 to 2, are needed");
    // Three points stand for facets, whichever way these run.
    if (layout.size() == 3 and p[0] > p[1])
      std::swap(p[0], p[1]);
  }
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    out.push_back("points: two of them stand for the same triangle");
  return out;
}

PointMesh::PointMesh(const Mesh& mesh, PointLayout layout,
                     std::span<const double> x)
    : _mesh(&mesh), _layout(std::move(layout)), _triangles(make(x))
{
}

void PointMesh::place(std::int32_t c, std::span<const double> x,
                      std::span<double> out) const
{
  const Triple& n = _mesh->cell(c);
  const auto put = [&out](std::int32_t i, Point p)
  {
    out[2 * i] = p.x;
    out[2 * i + 1] = p.y;
  };
  const Point v[] = {point(x, n[0]), point(x, n[1]), point(x, n[2])};
  for (int i = 0; i < 3; ++i)
  {
    put(n[i], v[i]);
    if (six())
      put(middle(c, i), remap::middle(v[i], v[(i + 1) % 3]));
  }
  put(centroid(c), 1.0 / 3 * (v[0] + v[1] + v[2]));
}

Mesh PointMesh::make(std::span<const double> x) const
{
  std::string trouble;
  for (const std::string& line : complaints(_layout))
    trouble += line + "\n";
  if (x.size() != std::size_t(2) * _mesh->num_nodes())
    trouble += "x: two coordinates a node are needed\n";
  if (not trouble.empty())
    throw std::invalid_argument(trouble);
  const std::int32_t facets = six() ? _mesh->num_facets() : 0;
  std::vector<std::int32_t> cells, marked, markers;
  std::vector<std::int64_t> ids;
  std::vector<double> nodes(
      std::size_t(2) * (_mesh->num_nodes() + _mesh->num_cells() + facets));
  const auto points = static_cast<std::int64_t>(_layout.size());
  // Numbers that order the ends of every facet alike on all ranks: vertices,
  // centroids, middles; no facet joins two middles.
  std::vector<std::int64_t> node_ids(_mesh->node_ids().begin(),
                                     _mesh->node_ids().end());
  for (std::int64_t c : _mesh->cell_ids())
    node_ids.push_back((std::int64_t(1) << 61) + c);
  for (std::int32_t f = 0; f < facets; ++f)
    node_ids.push_back((std::int64_t(1) << 62) + f);
  for (std::int32_t c = 0; c < _mesh->num_cells(); ++c)
  {
    place(c, x, nodes);
    for (std::size_t q = 0; q < _layout.size(); ++q)
    {
      const int a = vertex(c, _layout[q][0]), b = vertex(c, _layout[q][1]);
      const int facet = b == (a + 1) % 3 ? a : b;
      const Triple& n = _mesh->cell(c);
      cells.insert(cells.end(),
                   {n[a], six() ? middle(c, facet) : n[b], centroid(c)});
      ids.push_back(points * _mesh->cell_ids()[c]
                    + static_cast<std::int64_t>(q));
    }
    for (int i = 0; i < 3; ++i)
    {
      const std::int32_t f = _mesh->cell_facets(c)[i];
      if (_mesh->marker(f) < 0)
        continue;
      const auto [a, b] = _mesh->facet(f);
      if (six())
        marked.insert(marked.end(), {a, middle(c, i), middle(c, i), b});
      else
        marked.insert(marked.end(), {a, b});
      markers.insert(markers.end(), six() ? 2 : 1, _mesh->marker(f));
    }
  }
  return Mesh({.cells = cells,
               .x = nodes,
               .owned_cells = _layout.size() * _mesh->owned_cells(),
               .owned_nodes = static_cast<std::size_t>(_mesh->owned_nodes()),
               .cell_ids = ids,
               .node_ids = node_ids,
               .marked = marked,
               .markers = markers});
}
