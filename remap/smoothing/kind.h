// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: what a node may do when the mesh is smoothed.
#pragma once

#include <cstdint>

namespace remap
{
/// What a node may do.
enum class Kind : std::uint8_t
{
  fixed,   ///< stays
  free,    ///< goes anywhere
  slide,   ///< along its direction
  curve,   ///< along its curve, which the constraints' guide knows. If it has
           ///< left it, it comes back, and may lower its patch's worst quality
           ///< by that, but not below the threshold.
  surface, ///< parallel to the chord of its neighbours on the boundary, keeping
           ///< area or volume. With a spacing it goes where the lengths of its
           ///< two facets have the wanted ratio, and may lower its patch's
           ///< worst quality, but not below the threshold; without, it goes
           ///< where the smoother wants it, like a sliding node.
};
} // namespace remap
