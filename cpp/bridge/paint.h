// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "remap/materials/materials.h"
#include "scene/outline.h"
#include "scene/scene.h"
#include <string>

namespace mmale::bridge
{
/// For the scene's checks: a region with shape "polygon" or "file".
/// @param[in] key of its table in the scene
scene::DomainOutline region_outline(const std::string& key,
                                    const scene::Region& region);

/// The regions of a scene laid into the cells (METHOD.md, step 0): materials
/// of all local cells, ghosts too, numbered as in `scene.material`. Without
/// regions the first one fills the body. Every rank paints its own cells, and
/// finds in them the same as any other. Collective; files are read on the
/// first rank only.
///
/// @throws std::runtime_error on all ranks where files have complaints, where
///         no region covers some of the body, or where a cell has more
///         materials than it can hold
::remap::Materials paint(const scene::Scene& scene, const mesh::Domain& mesh);
} // namespace mmale::bridge
