// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace remap;

namespace
{
/// Global numbers, or the local ones if the host gave none.
std::vector<std::int64_t> ids_or_local(std::span<const std::int64_t> ids,
                                       std::size_t n)
{
  std::vector<std::int64_t> out(ids.begin(), ids.end());
  if (out.empty())
  {
    out.resize(n);
    std::iota(out.begin(), out.end(), std::int64_t(0));
  }
  return out;
}

/// Order of local numbers by global number.
auto by_id(const std::vector<std::int64_t>& ids)
{
  return [&ids](std::int32_t a, std::int32_t b) { return ids[a] < ids[b]; };
}

/// Complaints about single cells: node numbers, repeated nodes, no area.
void complain_of_cells(const MeshInput& in, std::vector<std::string>& out)
{
  const auto num_nodes = static_cast<std::int32_t>(in.x.size() / 2);
  for (std::size_t c = 0; c < in.cells.size() / 3; ++c)
  {
    const std::int32_t* v = &in.cells[3 * c];
    if (std::any_of(v, v + 3, [num_nodes](std::int32_t i)
                    { return i < 0 or i >= num_nodes; }))
      out.push_back("cell " + std::to_string(c) + ": no such node");
    else
    {
      const double area =
          twice_area(point(in.x, v[0]), point(in.x, v[1]), point(in.x, v[2]));
      if (not(std::abs(area) > 0) or not std::isfinite(area))
        out.push_back("cell " + std::to_string(c) + ": no area");
    }
  }
}
} // namespace

std::vector<std::string> Mesh::complaints(const MeshInput& in)
{
  std::vector<std::string> out;
  const std::size_t num_cells = in.cells.size() / 3;
  const std::size_t num_nodes = in.x.size() / 2;
  if (in.cells.size() % 3 != 0)
    out.push_back("cells: three nodes a cell are needed");
  if (in.x.size() % 2 != 0)
    out.push_back("x: two coordinates a node are needed");
  if (in.owned_cells > num_cells)
    out.push_back("owned_cells: more than there are cells");
  if (in.owned_nodes > num_nodes)
    out.push_back("owned_nodes: more than there are nodes");
  if (not in.cell_ids.empty() and in.cell_ids.size() != num_cells)
    out.push_back("cell_ids: one number a cell is needed");
  if (not in.node_ids.empty() and in.node_ids.size() != num_nodes)
    out.push_back("node_ids: one number a node is needed");
  if (in.marked.size() != 2 * in.markers.size())
    out.push_back("marked: two nodes a marker are needed");
  if (std::any_of(in.markers.begin(), in.markers.end(),
                  [](std::int32_t m) { return m < 0; }))
    out.push_back("markers: must not be negative");
  if (std::any_of(
          in.marked.begin(), in.marked.end(), [&](std::int32_t i)
          { return i < 0 or i >= static_cast<std::int32_t>(num_nodes); }))
    out.push_back("marked: no such node");
  if (out.empty())
    complain_of_cells(in, out);
  return out;
}

Mesh::Mesh(const MeshInput& in)
{
  if (const auto all = complaints(in); not all.empty())
  {
    std::string text;
    for (const std::string& line : all)
      text += line + "\n";
    throw std::invalid_argument(text);
  }
  _owned_cells = static_cast<std::int32_t>(in.owned_cells);
  _owned_nodes = static_cast<std::int32_t>(in.owned_nodes);
  const std::size_t n = in.cells.size() / 3;
  _cells.resize(n);
  _flipped.resize(n);
  for (std::size_t c = 0; c < n; ++c)
  {
    Triple v = {in.cells[3 * c], in.cells[3 * c + 1], in.cells[3 * c + 2]};
    _flipped[c] =
        twice_area(point(in.x, v[0]), point(in.x, v[1]), point(in.x, v[2])) < 0;
    if (_flipped[c])
      std::swap(v[1], v[2]);
    _cells[c] = v;
  }
  _cell_ids = ids_or_local(in.cell_ids, n);
  _node_ids = ids_or_local(in.node_ids, in.x.size() / 2);
  build_node_cells();
  build_facets();
  orient_facets();
  build_node_nodes();
  build_cell_cells();
  mark(in);
}

void Mesh::build_node_cells()
{
  auto& [offsets, entries] = _node_cells;
  offsets.assign(_node_ids.size() + 1, 0);
  for (const Triple& v : _cells)
    for (std::int32_t i : v)
      ++offsets[i + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  entries.resize(3 * _cells.size());
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::int32_t c = 0; c < num_cells(); ++c)
    for (std::int32_t i : _cells[c])
      entries[next[i]++] = c;
  for (std::int32_t i = 0; i < num_nodes(); ++i)
    std::sort(entries.begin() + offsets[i], entries.begin() + offsets[i + 1],
              by_id(_cell_ids));
}

void Mesh::build_facets()
{
  _cell_facets.assign(_cells.size(), {-1, -1, -1});
  for (std::int32_t c = 0; c < num_cells(); ++c)
    for (int i = 0; i < 3; ++i)
    {
      if (_cell_facets[c][i] >= 0)
        continue;
      const Pair ends = {_cells[c][i], _cells[c][(i + 1) % 3]};
      const std::int32_t f = num_facets();
      _cell_facets[c][i] = f;
      _facets.push_back(ends);
      _facet_cells.push_back({c, -1});
      // A cell on the other side walks the facet the other way round.
      for (std::int32_t d : _node_cells[ends[0]])
        for (int j = 0; j < 3; ++j)
        {
          if (d == c)
            continue;
          const Pair other = {_cells[d][(j + 1) % 3], _cells[d][j]};
          const bool same_way = other[0] == ends[1] and other[1] == ends[0];
          const bool third = other == ends and _cell_facets[d][j] >= 0;
          if (same_way or third or (other == ends and _facet_cells[f][1] >= 0))
            throw std::invalid_argument("cells " + std::to_string(c) + " and "
                                        + std::to_string(d)
                                        + ": overlap at a facet");
          if (other == ends)
          {
            _facet_cells[f][1] = d;
            _cell_facets[d][j] = f;
          }
        }
    }
}

void Mesh::orient_facets()
{
  // From the smaller global number to the larger, so that what a facet sweeps
  // is the same to the last bit on every rank that sees it.
  for (std::int32_t f = 0; f < num_facets(); ++f)
    if (_facet_cells[f][1] >= 0
        and _node_ids[_facets[f][0]] > _node_ids[_facets[f][1]])
    {
      std::swap(_facets[f][0], _facets[f][1]);
      std::swap(_facet_cells[f][0], _facet_cells[f][1]);
    }
}

void Mesh::build_node_nodes()
{
  auto& [offsets, entries] = _node_nodes;
  offsets.assign(_node_ids.size() + 1, 0);
  for (const Pair& ends : _facets)
    for (std::int32_t i : ends)
      ++offsets[i + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  entries.resize(2 * _facets.size());
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  for (const auto& [a, b] : _facets)
  {
    entries[next[a]++] = b;
    entries[next[b]++] = a;
  }
  for (std::int32_t i = 0; i < num_nodes(); ++i)
    std::sort(entries.begin() + offsets[i], entries.begin() + offsets[i + 1],
              by_id(_node_ids));
}

void Mesh::build_cell_cells()
{
  auto& [offsets, entries] = _cell_cells;
  offsets.assign(1, 0);
  for (std::int32_t c = 0; c < num_cells(); ++c)
  {
    const auto first = static_cast<std::ptrdiff_t>(entries.size());
    for (std::int32_t i : _cells[c])
      for (std::int32_t d : _node_cells[i])
        if (d != c)
          entries.push_back(d);
    std::sort(entries.begin() + first, entries.end(), by_id(_cell_ids));
    entries.erase(std::unique(entries.begin() + first, entries.end()),
                  entries.end());
    offsets.push_back(static_cast<std::int32_t>(entries.size()));
  }
  entries.shrink_to_fit();
}

void Mesh::mark(const MeshInput& in)
{
  _markers.assign(_facets.size(), -1);
  _node_boundary.assign(_node_ids.size(), {-1, -1});
  // -2: more than one, so that the third does not look like the first.
  const auto note = [](std::int32_t& slot, std::int32_t f)
  { slot = slot == -1 ? f : -2; };
  for (std::int32_t f = 0; f < num_facets(); ++f)
    if (_facet_cells[f][1] < 0)
    {
      note(_node_boundary[_facets[f][1]][0], f);
      note(_node_boundary[_facets[f][0]][1], f);
    }
  for (Pair& both : _node_boundary)
    if (both[0] < 0 or both[1] < 0)
      both = {-1, -1};
  for (std::size_t k = 0; k < in.markers.size(); ++k)
  {
    const std::int32_t a = in.marked[2 * k];
    const std::int32_t b = in.marked[2 * k + 1];
    for (std::int32_t c : _node_cells[a])
      for (std::int32_t f : _cell_facets[c])
        if (_facet_cells[f][1] < 0
            and (_facets[f] == Pair{a, b} or _facets[f] == Pair{b, a}))
          _markers[f] = in.markers[k];
    _num_markers = std::max(_num_markers, in.markers[k] + 1);
  }
}

std::vector<std::int32_t> Mesh::outline() const
{
  std::vector<std::uint8_t> complete(num_nodes());
  for (std::int32_t c = 0; c < _owned_cells; ++c)
    for (std::int32_t i : _cells[c])
      complete[i] = 1;
  std::vector<std::int32_t> out;
  for (std::int32_t f = 0; f < num_facets(); ++f)
    if (const auto [a, b] = _facets[f];
        _facet_cells[f][1] < 0
        and (complete[a] != 0 or complete[b] != 0 or _markers[f] >= 0))
      out.push_back(f);
  return out;
}
