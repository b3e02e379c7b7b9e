// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, averaging: the plain mean of the neighbours. The cheapest; cells
// crowd where few neighbours are, and without acceptance it inverts cells of
// domains that are not convex.
#pragma once

#include "remap/smoothing/patch.h"

#include <string_view>

namespace remap::smoother
{
struct Laplace
{
  static constexpr std::string_view name = "laplace";

  static Point propose(const Patch& patch)
  {
    double count = 0;
    Point sum{};
    each_neighbour(patch.cells,
                   [&](Point a)
                   {
                     ++count;
                     sum = sum + (a - patch.x);
                   });
    return on_line(patch, patch.x + (1 / count) * sum);
  }
};
} // namespace remap::smoother
