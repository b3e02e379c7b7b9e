// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include <array>
#include <cstdint>
#include <istream>
#include <map>
#include <string>
#include <vector>

/// Gmsh's mesh files as they are written: MSH 2.2 and 4.1, ASCII.
namespace mmale::mesh
{
struct Msh
{
  struct Node
  {
    std::int64_t tag;
    std::array<double, 3> x; ///< [m]
    int line;                ///< of the file
  };
  /// An edge (two nodes) or a triangle (three).
  struct Element
  {
    std::int64_t tag;
    std::int64_t entity;               ///< curve or surface that it is of
    std::array<std::int64_t, 3> nodes; ///< tags
    std::vector<std::int64_t> groups;  ///< physical groups, by tag
    int line;                          ///< of the file
  };
  /// Elements of a type that cannot be used.
  struct Other
  {
    std::int64_t count = 0;
    std::int64_t first = 0; ///< tag
    int line = 0;           ///< of the first
  };
  std::vector<Node> nodes;
  std::vector<Element> edges, triangles;
  std::map<int, Other> others; ///< by gmsh's number of the type
  std::map<std::int64_t, std::string> curve_names, surface_names;
};

/// Read a mesh file.
///
/// @param[in]  file       its name for messages
/// @param[out] complaints the first thing that is no MSH; empty is good
/// @source gmsh reference manual, "MSH file format" and "(Legacy)"
Msh read_msh(std::istream& text, const std::string& file,
             std::vector<scene::Complaint>& complaints);
} // namespace mmale::mesh
