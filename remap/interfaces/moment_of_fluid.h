// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: moment of fluid: fractions are kept, and centroids come as near to
// the given ones as straight cuts allow. Looks at nothing but the cell.
//
// What is minimised, for two parts and for many: Σ fraction · distance² of the
// centroids, over the parts. For two parts of consistent data that is the same
// as the distance of either centroid.
//
// @source Dyadechko & Shashkov (2005); orders of materials: Ahn & Shashkov
// (2007). Departures: the minimum of a cut is found in closed form or between
// chords through vertices, so it is the global one; groups of parts may be cut
// from groups, which chains of single parts cannot show.
#pragma once

#include "remap/interfaces/stencil.h"
#include "remap/interfaces/tree.h"

#include <string_view>

namespace remap::reconstruction
{
struct MomentOfFluid
{
  static constexpr std::string_view name = "moment_of_fluid";
  static constexpr bool uses_centroids = true;

  /// Partition of one cell.
  template <Geometry G>
  static double solve(const Triangle& cell, std::span<const Part> parts,
                      Partition& out)
  {
    if constexpr (G == Geometry::plane)
      if (parts.size() == 2)
      {
        const Straight found =
            best_cut(cell, {parts[0].fraction, parts[0].centroid},
                     {parts[1].fraction, parts[1].centroid});
        out.count = 0;
        out.add({.plane = found.plane, .in = ~0, .out = ~1});
        return found.error;
      }
    return Trees<G>(cell, parts).solve(out);
  }
};
} // namespace remap::reconstruction
