// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: which cells of a mesh a polygon meets: a walk over facets, outwards
// from one of them, at any distance.
#pragma once

#include "remap/materials/bent.h"
#include "remap/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace remap
{
/// A polygon, and how far it reaches beyond the facets of a triangle that it is
/// nearly.
struct Reach
{
  /// @param[in] p     kept by reference
  /// @param[in] nodes the triangle
  Reach(const Polygon<6>& p, const Triangle& nodes);

  const Polygon<6>* polygon;
  std::array<Point, 3> normal;
  std::array<double, 3> far;
};

/// Walks through a mesh, with the room they need.
class CellWalk
{
public:
  /// A cell that a polygon meets, or nearly.
  struct Met
  {
    std::int32_t cell;
    unsigned cuts; ///< its half-planes, a bit each, that cut the polygon
  };

  /// @param[in] mesh kept by reference: must outlive this
  explicit CellWalk(const Mesh& mesh);

  /// Find the cells that overlap a polygon, and maybe some that only nearly do.
  ///
  /// @param[in] x      of the mesh's nodes, shape (num_nodes, 2) [m]
  /// @param[in] p      star-shaped, counter-clockwise, measured from `origin`
  /// @param[in] nodes  the triangle that it is nearly, measured from there
  /// @param[in] start  some cell near by
  void meet(std::span<const double> x, const Polygon<6>& p,
            const Triangle& nodes, Point origin, std::int32_t start);
  /// The same by looking at every cell: for polygons that meet the mesh in
  /// places that no walk inside it connects.
  void meet_everywhere(std::span<const double> x, const Polygon<6>& p,
                       const Triangle& nodes, Point origin);

  /// Cell that holds a point, or the last one on the way to it.
  [[nodiscard]] std::int32_t locate(std::span<const double> x,
                                    std::int32_t from, Point target) const;

  /// Cells found.
  [[nodiscard]] std::span<const Met> met() const { return _met; }
  /// Facets with no cell behind them that the polygon may reach over.
  [[nodiscard]] std::span<const std::int32_t> edges() const { return _edges; }
  /// Does the body end at a facet (or only what this rank sees of it)?
  [[nodiscard]] bool is_outline(std::int32_t f) const
  {
    return _is_outline[f] != 0;
  }
  /// Facets where the body ends.
  [[nodiscard]] std::span<const std::int32_t> outline() const
  {
    return _outline;
  }
  /// The outline's facet nearest to a point, or -1.
  [[nodiscard]] std::int32_t nearest_outline(std::span<const double> x,
                                             Point p) const;
  /// Place of a cell, measured from `origin`.
  [[nodiscard]] Triangle place(std::span<const double> x, std::int32_t c,
                               Point origin) const
  {
    const Triple& n = _mesh->cell(c);
    return {point(x, n[0]) - origin, point(x, n[1]) - origin,
            point(x, n[2]) - origin};
  }

private:
  void spread(std::span<const double> x, const Reach& p, Point origin);
  [[nodiscard]] std::int32_t beside(std::int32_t c, int k) const
  {
    const auto [left, right] = _mesh->facet_cells(_mesh->cell_facets(c)[k]);
    return left == c ? right : left;
  }

  const Mesh* _mesh;
  std::vector<std::uint32_t> _seen; ///< number of the last walk that came by
  std::uint32_t _walk = 0;
  std::vector<std::int32_t> _queue;
  std::vector<Met> _met;
  std::vector<std::int32_t> _edges, _outline;
  std::vector<std::uint8_t> _is_outline;
};
} // namespace remap
