// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "grid.h"
#include "msh.h"

namespace mmale::mesh
{
/// The triangles of a mesh file as one sound body, or why they are none.
///
/// Cells outside of any physical surface are left out if there is one. A
/// surface that gmsh has oriented clockwise is turned. Boundaries are the named
/// physical curves. Complaints: what is not plane, not first order, no
/// triangle; flat, inverted or overlapping cells; parts that do not hang
/// together, nodes that hang or lie on each other; curves inside the body or
/// with two names; in axisymmetry nodes beyond the axis.
///
/// @param[in]  file         its name for messages
/// @param[out] complaints   all of them, each kind once with its first place
Grid make_sound_grid(const Msh& msh, const std::string& file, bool axisymmetric,
                     std::vector<scene::Complaint>& complaints);
} // namespace mmale::mesh
