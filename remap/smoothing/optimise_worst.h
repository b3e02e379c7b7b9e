// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, optimisation of the worst cells: minimise Σ (|T|²/(2 det T))⁸
// over the patch, as `optimise` does with the first power. The worst cell gets
// better than there, the mean a little worse.
#pragma once

#include "remap/smoothing/optimise.h"

namespace remap::smoother
{
struct OptimiseWorst : Newton<8>
{
  static constexpr std::string_view name = "optimise_worst";
  /// Distortion above which the first power goes first: a Newton step on a
  /// barrier 1/D⁸ makes D larger by an eighth, on 1/D twice as large.
  static constexpr double bad = 2;

  static Point propose(const Patch& patch)
  {
    Patch from = patch;
    for (const PatchCell& c : patch.cells)
      if (quality::distortion(c.target, c.a - patch.x, c.b - patch.x) > bad)
      {
        from.x = Newton<1>::propose(patch);
        break;
      }
    return Newton<8>::propose(from);
  }
};
} // namespace remap::smoother
