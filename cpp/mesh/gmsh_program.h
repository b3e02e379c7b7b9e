// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace mmale::mesh
{
/// Let the program `gmsh` mesh the plane part of a .geo.
///
/// @param[in] refine all edges are divided by it, as far as the .geo lets them
/// @param[in] folder where it may write; mesh.msh in it is the mesh, ASCII
/// @return what went wrong, in words; empty is good
std::string run_gmsh(const std::filesystem::path& geo, double refine,
                     const std::filesystem::path& folder);
} // namespace mmale::mesh
