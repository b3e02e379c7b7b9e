// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace mmale::mesh
{
/// A straight stretch of one boundary: edges in a row whose nodes lie on the
/// chord of its ends to 1e-9 of its length. Of a curved boundary each edge is
/// a side of its own.
struct Side
{
  int boundary;                          ///< as in the edges
  int edges;                             ///< how many
  std::array<std::int64_t, 2> end_nodes; ///< the body on the left from 0 to 1
  std::array<std::array<double, 2>, 2> ends; ///< their places [m]

  double length() const
  {
    return std::hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
  }
  /// Longer along direction d than 1e-9 of its length?
  bool extends(int d) const
  {
    return std::abs(ends[1][d] - ends[0][d]) > straight * length();
  }
  static constexpr double straight = 1e-9;
};

/// The line that a boundary lies on, if it lies on one.
///
/// @return extreme points along it; NaN where the sides are not in line
std::array<std::array<double, 2>, 2> common_line(std::span<const Side> sides,
                                                 int boundary);

/// Find the straight sides of a body's outline.
///
/// @param[in]  x     nodes, shape (n, 2) [m]
/// @param[in]  edges (node, node, boundary), the body on the left
/// @param[out] sides
/// @return index of its side for each edge
std::vector<int> find_sides(std::span<const double> x,
                            std::span<const std::array<std::int64_t, 3>> edges,
                            std::vector<Side>& sides);
} // namespace mmale::mesh
