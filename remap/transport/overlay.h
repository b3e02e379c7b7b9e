// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the exact overlap of the old cells with the new ones, for moves
// of any length. In: old and new coordinates, the cells that change. Out: what
// goes from each old cell to each new one, with centroids, and what stays.
// Conserved: parts of an old cell add up to it, parts of a new one fill it, to
// round-off; what a moved boundary gained or lost is a piece of its own.
#pragma once

#include "remap/geometry/polygon.h"
#include "remap/mesh.h"
#include "remap/outcome.h"

#include <span>
#include <vector>

namespace remap
{
/// Overlap of a mesh with itself after a move, with the room it needs.
///
/// From each new cell a walk over facets visits the old cells that it overlaps,
/// and no others, so near neighbours alone cost time. Allocates at set-up, and
/// when a move makes more pieces than any before. Calls no host: on ranks the
/// outcome is to be agreed on.
///
/// A rank computes all pairs with one of its own cells in them; on every rank
/// that sees a pair it is the same to the last bit.
class Overlay
{
public:
  /// What goes from one cell to another.
  struct Piece
  {
    std::int32_t from = -1;   ///< old cell; -1: from outside the old mesh
    std::int32_t to = -1;     ///< new cell; -1: to outside the new mesh
    double volume = 0;        ///< > 0
    Point at;                 ///< its centroid
    std::int32_t facet = -1;  ///< of the outline, if one end is outside
    std::int32_t marker = -1; ///< of that facet
  };

  /// What stays in its cell: the overlap of its old with its new place.
  struct Rest
  {
    double volume = 0; ///< 0 if the cell left its place wholly
    Point at;          ///< its centroid; the old cell's, if nothing stays
  };

  /// @param[in] mesh kept by reference: must outlive this
  explicit Overlay(const Mesh& mesh);

  /// Overlap of the cells that change.
  ///
  /// Where the outline moved, old volume beyond the new mesh is lost and new
  /// volume beyond the old mesh is gained; the marker is that of the outline's
  /// facet with the longest part in that cell, or of the nearest facet if the
  /// cell lies outside wholly. What round-off leaves over is not a piece.
  ///
  /// @param[in] x_old, x_new shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in] touched cells next to a node that moved, ghosts too
  /// @return ok; inverted_start, inverted_target: a cell has no positive
  ///         volume, or the mesh covers a place twice; beyond_halo: a cell of
  ///         ours overlaps cells that this rank does not see
  template <Geometry G>
  [[nodiscard]] Outcome intersect(std::span<const double> x_old,
                                  std::span<const double> x_new,
                                  std::span<const std::int32_t> touched);

  /// Pieces of the last call; each pair of cells once.
  [[nodiscard]] std::span<const Piece> pieces() const { return _pieces; }
  /// What stays in a touched cell of ours.
  [[nodiscard]] const Rest& rest(std::int32_t c) const { return _rest[c]; }
  /// Pairs of the last call that no walk found, but the comparison of what was
  /// left over. More than a few only where an outline moved far.
  [[nodiscard]] int matched() const { return _matched; }
  /// Global number of the cell that made the last call fail, or -1.
  [[nodiscard]] std::int64_t worst_cell() const { return _worst; }

private:
  /// One of the two meshes: where its cells are, and how much of each is found.
  struct Side
  {
    std::span<const double> x;
    std::vector<Moments> whole;     ///< of a touched cell, about its first node
    std::vector<double> found;      ///< volume of overlaps so far
    std::vector<double> length;     ///< longest edge
    std::vector<double> other;      ///< longest edge of those overlapped
    std::vector<Pair> range;        ///< pieces of its walk: first, behind last
    std::vector<std::int32_t> left; ///< cells of ours that are not all found
    std::vector<double> volume;     ///< what of them is not found
  };
  /// Around a cell's place.
  struct Box
  {
    Point lo, hi;
    std::int32_t cell;
  };
  /// What was found of a cell, and what limits the other mesh inside it.
  struct Edge
  {
    Moments found;           ///< about the cell's first node
    double length = 0;       ///< of the longest part of an outline facet
    std::int32_t facet = -1; ///< that facet
    bool outline = false, halo = false;
  };

  [[nodiscard]] Triangle place(const Side& side, std::int32_t c) const;
  void start(std::span<const double> x_old, std::span<const double> x_new,
             std::span<const std::int32_t> touched);
  template <Geometry G>
  [[nodiscard]] bool measure(Side& side);
  void visit(std::int32_t c, std::uint32_t wanted);
  void spread(const Side& through, const Triangle& target, std::size_t first);
  template <class Use>
  void walk(const Side& through, std::int32_t c, const Triangle& target,
            Use&& use);
  [[nodiscard]] std::int32_t locate(const Side& through, std::int32_t from,
                                    const Triangle& target) const;
  template <Geometry G>
  bool add(std::int32_t c, std::int32_t d, const Triangle& old_place,
           const Triangle& new_place, unsigned cuts);
  template <Geometry G>
  [[nodiscard]] bool collect_left(Side& side);
  template <Geometry G>
  void match();
  void boxes(const Side& side, bool ghosts, std::vector<Box>& out) const;
  [[nodiscard]] bool known(std::int32_t c, std::int32_t d) const;
  template <Geometry G>
  [[nodiscard]] Outcome close(Side& side, const Side& through);
  [[nodiscard]] Edge edge_inside(const Side& through, std::int32_t c,
                                 const Triangle& target, Edge found) const;
  [[nodiscard]] std::int32_t nearest_outline(const Side& side, Point p) const;

  const Mesh* _mesh;
  std::vector<Triple> _beside;        ///< cell behind each facet, or num_cells
  std::vector<std::int32_t> _outline; ///< facets on the boundary of the body
  std::vector<std::uint8_t> _is_outline; ///< is a facet among them?
  std::span<const std::int32_t> _touched;
  std::vector<std::uint32_t> _seen; ///< number of the last walk that came by
  std::uint32_t _walk = 0;
  std::vector<std::int32_t> _queue; ///< cells to visit, the first _queued
  std::vector<std::uint8_t> _cuts;  ///< half-planes that cut each of them
  std::size_t _queued = 0;
  std::vector<std::int32_t> _slot;
  Side _old, _new;
  std::vector<Rest> _rest;
  std::vector<Piece> _pieces;
  std::vector<Edge> _edges;
  std::vector<Box> _old_boxes, _new_boxes;
  int _matched = 0;
  std::int64_t _worst = -1;
};
} // namespace remap
