// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mmale::mesh
{
/// Sides of the built-in shapes.
inline constexpr std::array<std::string_view, 4> side_names{"bottom", "right",
                                                            "top", "left"};

/// A whole mesh as plain arrays, before it is distributed.
///
/// Each node of the boundary has one edge that ends there and one that starts.
struct Grid
{
  std::vector<double> x;           ///< nodes, shape (n, 2) [m]
  std::vector<std::int64_t> cells; ///< shape (m, 3), counter-clockwise
  /// Boundary edges (node, node, index into names), the body on the left.
  std::vector<std::array<std::int64_t, 3>> edges;
  /// Sides or, of a mesh from gmsh, physical curves; "" for the edges of none.
  std::vector<std::string> names;
};

/// Points from 0 to `length`, closest together at `towards`.
///
/// Edges grow away from it by the factor `growth` up to `size`; all are then
/// scaled down together so that they fit.
std::vector<double> graded_line(double length, double size, double towards,
                                double finest, double growth, double radius);

/// The built-in mesh of a scene: a mapped rectangle of quadrilaterals, each cut
/// in two, after `refine`.
Grid make_grid(const scene::Mesh& mesh);
} // namespace mmale::mesh
