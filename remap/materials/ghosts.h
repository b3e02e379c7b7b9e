// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: materials of ghost cells from their owners: how many parts a cell
// has, then part by part. Interfaces need not travel.
#pragma once

#include "remap/host.h"
#include "remap/materials/materials.h"
#include "remap/mesh.h"

namespace remap
{
/// Rows of our own cells stay in their order; those of ghosts come behind.
/// Collective; nothing to do on one process.
void update_ghosts(const Mesh& mesh, Materials& materials, const Host& host);
} // namespace remap
