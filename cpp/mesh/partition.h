// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <dolfinx/mesh/utils.h>

namespace mmale::mesh
{
/// Partitioner with a halo of all cells that share a vertex.
///
/// DOLFINx 0.9 ghosts across facets only; the remap needs whole patches.
dolfinx::mesh::CellPartitionFunction vertex_halo_partitioner();
} // namespace mmale::mesh
