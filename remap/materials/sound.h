// SPDX-License-Identifier: LGPL-3.0-or-later
//
// A look at materials that come from outside, before anything is done.
#pragma once

#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <span>

namespace remap
{
/// Do fractions add up, are parts in their cells, and are their numbers those
/// of materials?
///
/// @param[in] x shape (num_nodes, 2) [m]
[[nodiscard]] bool sound(const Mesh& mesh, const Materials& materials,
                         std::span<const double> x);
} // namespace remap
