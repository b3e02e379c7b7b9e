// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: moment of fluid: fractions are kept, and centroids come as near to
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
  static constexpr bool exact = true; ///< for straight interfaces

  /// Two parts are taken for a filament from this distance of a centroid, in
  /// spreads of the cell (root mean square of its vertices' distance from the
  /// middle, across): a well-resolved curve stays below 0.01, a right angle
  /// below 0.1. Larger: fewer filaments are seen; infinite: none.
  double filament = 0.15;

  /// Partition of one cell.
  template <Geometry G>
  Tally solve(const Triangle& cell, std::span<const Part> parts,
              Partition& out) const
  {
    if constexpr (G == Geometry::plane)
      if (parts.size() == 2)
      {
        const Straight found =
            best_cut(cell, {parts[0].fraction, parts[0].centroid},
                     {parts[1].fraction, parts[1].centroid});
        out.count = 0;
        out.add({.plane = found.plane, .in = ~0, .out = ~1});
        if (not far_off(cell, found.error, parts[0].fraction,
                        parts[1].fraction))
          return {.error = found.error};
      }
    return Trees<G>(cell, parts, filament).solve(out);
  }

private:
  /// May the smaller part be that far off? The least spread of a triangle is
  /// at least the product of both over their sum.
  [[nodiscard]] bool far_off(const Triangle& t, double error, double f,
                             double g) const
  {
    const Point a = t[1] - t[0], b = t[2] - t[1], c = t[0] - t[2];
    const double twice = cross(a, c), sum = dot(a, a) + dot(b, b) + dot(c, c);
    const double small = std::min(f, g), large = std::max(f, g);
    return error * large * sum
           > filament * filament * small * twice * twice / 3;
  }
};
} // namespace remap::reconstruction
