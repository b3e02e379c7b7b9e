// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "grid.h"
#include "scene/outline.h"
#include <memory>
#include <mpi.h>

/// Meshes from gmsh: a .msh is read, a .geo is meshed first by the program
/// `gmsh`, which is called and never linked (it is under the GPL).
namespace mmale::mesh
{
/// A mesh as read, and what the scene's checks want to know of it.
struct Loaded
{
  std::shared_ptr<const Grid> grid;
  scene::Outline outline; ///< with complaints the grid is empty
};

/// Read the mesh of a scene with shape "gmsh". On one process.
Loaded load_gmsh(const scene::Scene& scene);

/// The mesh of any scene: built in, on every process, or read on rank 0.
/// Collective.
/// @throws std::runtime_error on all ranks when the file gives no mesh
Grid obtain_grid(MPI_Comm comm, const scene::Scene& scene);
} // namespace mmale::mesh
