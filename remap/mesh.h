// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Topology of one rank's triangles, built once: facets, neighbours, contiguous.
// Coordinates are not kept; they come with every call. Around each node cells
// and nodes stand in the order of their global numbers, so that sums over a
// patch do not depend on how the mesh is cut into ranks.
#pragma once

#include "remap/geometry/measure.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace remap
{
/// A list of lists in one piece of memory (compressed rows).
struct Adjacency
{
  std::vector<std::int32_t> offsets; ///< size n + 1
  std::vector<std::int32_t> entries; ///< size offsets[n]

  [[nodiscard]] std::span<const std::int32_t> operator[](std::int32_t i) const
  {
    return {entries.data() + offsets[i], entries.data() + offsets[i + 1]};
  }
  [[nodiscard]] std::int32_t size() const
  {
    return static_cast<std::int32_t>(offsets.size()) - 1;
  }
};

/// Two ends of a facet, or the two cells beside it.
using Pair = std::array<std::int32_t, 2>;
/// Three vertices, or three facets, of a cell.
using Triple = std::array<std::int32_t, 3>;

/// What the host knows. Numbers are local; owned cells and nodes come first.
/// Needed: every cell that shares a vertex with an owned cell is here too, and
/// every owned node belongs to an owned cell. Ranks that share a cell list its
/// nodes in the same order.
struct MeshInput
{
  std::span<const std::int32_t> cells; ///< nodes, shape (num_cells, 3)
  std::span<const double> x;           ///< shape (num_nodes, 2) [m]
  std::size_t owned_cells = 0;         ///< first cells that are ours
  std::size_t owned_nodes = 0;         ///< first nodes that are ours
  /// Global numbers, shape (num_cells); empty: the local ones.
  std::span<const std::int64_t> cell_ids = {};
  /// Global numbers, shape (num_nodes); empty: the local ones.
  std::span<const std::int64_t> node_ids = {};
  /// Nodes of marked boundary facets, shape (num_marked, 2).
  std::span<const std::int32_t> marked = {};
  /// Their markers >= 0, shape (num_marked).
  std::span<const std::int32_t> markers = {};
};

/// Topology of a triangle mesh.
class Mesh
{
public:
  /// @param[in] input spans are read here and not kept
  /// @throws std::invalid_argument with every complaint, one a line
  explicit Mesh(const MeshInput& input);

  /// Every problem of an input, in words; empty is good.
  [[nodiscard]] static std::vector<std::string>
  complaints(const MeshInput& input);

  [[nodiscard]] std::int32_t num_cells() const
  {
    return static_cast<std::int32_t>(_cells.size());
  }
  [[nodiscard]] std::int32_t num_nodes() const { return _node_cells.size(); }
  [[nodiscard]] std::int32_t num_facets() const
  {
    return static_cast<std::int32_t>(_facets.size());
  }
  [[nodiscard]] std::int32_t owned_cells() const { return _owned_cells; }
  [[nodiscard]] std::int32_t owned_nodes() const { return _owned_nodes; }

  /// Vertices of a cell, counter-clockwise at the coordinates of the input.
  [[nodiscard]] const Triple& cell(std::int32_t c) const { return _cells[c]; }
  /// Were the last two vertices of the input exchanged to get there?
  [[nodiscard]] bool flipped(std::int32_t c) const { return _flipped[c] != 0; }
  /// Facets of a cell; facet i joins its vertices i and i + 1.
  [[nodiscard]] const Triple& cell_facets(std::int32_t c) const
  {
    return _cell_facets[c];
  }
  /// Ends of a facet; its left cell lies to the left of the way.
  [[nodiscard]] const Pair& facet(std::int32_t f) const { return _facets[f]; }
  /// Left and right cell; right is -1 on the boundary and at the halo's edge.
  [[nodiscard]] const Pair& facet_cells(std::int32_t f) const
  {
    return _facet_cells[f];
  }
  /// Marker of a facet, -1 if it has none.
  [[nodiscard]] std::int32_t marker(std::int32_t f) const
  {
    return _markers[f];
  }
  /// Largest marker + 1.
  [[nodiscard]] std::int32_t num_markers() const { return _num_markers; }
  /// Has the facet one cell because the body ends there, not the halo?
  [[nodiscard]] bool on_boundary(std::int32_t f) const
  {
    return _facet_cells[f][1] < 0
           and (_facet_cells[f][0] < _owned_cells
                or _facets[f][0] < _owned_nodes
                or _facets[f][1] < _owned_nodes);
  }
  /// Boundary facets that end and that start at a node, -1 where there is none
  /// or more than one.
  [[nodiscard]] const Pair& boundary_facets(std::int32_t node) const
  {
    return _node_boundary[node];
  }

  [[nodiscard]] const Adjacency& node_cells() const { return _node_cells; }
  [[nodiscard]] const Adjacency& node_nodes() const { return _node_nodes; }
  /// Cells that share a vertex; complete for owned cells.
  [[nodiscard]] const Adjacency& cell_cells() const { return _cell_cells; }
  [[nodiscard]] std::span<const std::int64_t> cell_ids() const
  {
    return _cell_ids;
  }
  [[nodiscard]] std::span<const std::int64_t> node_ids() const
  {
    return _node_ids;
  }

  /// Facets where the body ends, also those of ghosts: around the nodes of our
  /// cells all cells are here; elsewhere a facet with one cell is known to be
  /// the outline by its marker only.
  [[nodiscard]] std::vector<std::int32_t> outline() const;

private:
  void build_node_cells();
  void build_facets();
  void orient_facets();
  void build_node_nodes();
  void build_cell_cells();
  void mark(const MeshInput& input);

  std::int32_t _owned_cells = 0, _owned_nodes = 0, _num_markers = 0;
  std::vector<Triple> _cells, _cell_facets;
  std::vector<std::uint8_t> _flipped;
  std::vector<Pair> _facets, _facet_cells, _node_boundary;
  std::vector<std::int32_t> _markers;
  Adjacency _node_cells, _node_nodes, _cell_cells;
  std::vector<std::int64_t> _cell_ids, _node_ids;
};
} // namespace remap
