// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, averaging: the mean of the neighbours, each weighted with its
// distance. Long edges pull more: evens out edge lengths.
#pragma once

#include "remap/smoothing/patch.h"

#include <string_view>

namespace remap::smoother
{
struct AverageLength
{
  static constexpr std::string_view name = "average_length";

  static Point propose(const Patch& patch)
  {
    double length = 0;
    Point sum{};
    each_neighbour(patch.cells,
                   [&](Point a)
                   {
                     const Point d = a - patch.x;
                     const double w = std::sqrt(dot(d, d));
                     length += w;
                     sum = sum + w * d;
                   });
    return on_line(patch, patch.x + (1 / length) * sum);
  }
};
} // namespace remap::smoother
