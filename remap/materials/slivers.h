// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: slivers swept up. A fraction below a stated one goes to a neighbour
// that holds that material and takes the same volume of another one from there,
// one that both cells hold: volumes of cells and of materials stay. Where no
// neighbour has both, the sliver is kept.
#pragma once

#include "remap/host.h"
#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <functional>

namespace remap
{
/// What was swept up; of this rank's cells.
struct SliverReport
{
  std::int32_t swept = 0, kept = 0;
  double volume = 0; ///< that changed places
};

/// Sweep up, at most one material a cell. Collective.
///
/// @param[in,out] materials ghosts up to date, then too
/// @param[in]     least     fractions below are slivers; below 1e-2
/// @param[in]     volume    of a cell
SliverReport sweep_slivers(const Mesh& mesh, Materials& materials, double least,
                           const std::function<double(std::int32_t)>& volume,
                           const Host& host);
} // namespace remap
