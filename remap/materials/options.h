// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: how materials travel, and what was to be mended on the way.
#pragma once

#include "remap/interfaces/library.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace remap
{
/// How materials travel.
struct MaterialOptions
{
  int number = 0;     ///< of materials; 0: cells hold no materials
  int components = 1; ///< of the widest field of materials that will come
  /// Filaments are not looked for: what facets sweep beyond a donor is taken
  /// from its interfaces drawn on, so centroids are off by more than a corner
  /// is, and would pass for filaments.
  Reconstruction reconstruction = reconstruction::MomentOfFluid{
      .filament = std::numeric_limits<double>::infinity()};
  /// Parts below this fraction of their cell are swept up: a cell near by that
  /// holds the material takes it and gives as much of another. Larger: cells
  /// become pure sooner, and interfaces move by that much.
  double sliver = 1e-5;
  /// The material that comes in over open boundaries, by marker.
  std::vector<int> inflow = {};
};

/// What was to be mended; counts and volumes are of all ranks.
struct MaterialReport
{
  /// Parts that regions, each cut for itself, would have emptied beyond what
  /// was there; other materials of their cells took their place.
  std::int64_t capped = 0;
  double capped_volume = 0;
  std::int64_t slivers = 0; ///< parts swept up
  double sliver_volume = 0;
  std::int64_t slivers_left = 0; ///< at the end: nobody near could take them
};
} // namespace remap
