// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, a rezone in part: where a full move would take many sub-cycles of
// the transport, nodes go only so far towards their new places that no cell
// loses more than a stated part of itself. Kept: no cell inverts on the way;
// the result is the same on any number of ranks.
#pragma once

#include "remap/host.h"
#include "remap/mesh.h"

#include <span>

namespace remap
{
/// What came of it.
struct Relaxation
{
  double part = 1; ///< of the way that nodes go, in [0, 1]
  double loss = 0; ///< largest of a cell over the full way; infinite if a cell
                   ///< loses its volume there
};

/// Bring new places nearer to old ones. Collective: one reduction.
///
/// @param[in]     most  part of its volume that a cell may lose, > 0: so many
///                      sub-cycles times what one may take
/// @param[in]     x_old shape (num_nodes, 2), no cell inverted, ghosts up to
///                      date [m]
/// @param[in,out] x_new shape (num_nodes, 2), ghosts up to date in and out [m]
Relaxation relax(const Mesh& mesh, Geometry geometry, double most,
                 std::span<const double> x_old, std::span<double> x_new,
                 const Host& host);
} // namespace remap
