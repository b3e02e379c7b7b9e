// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, averaging: the mean of the centroids of the patch's cells, each
// weighted with its plane area. Evens out cell sizes; knows no target shape.
#pragma once

#include "remap/smoothing/patch.h"

#include <string_view>

namespace remap::smoother
{
struct AverageArea
{
  static constexpr std::string_view name = "average_area";

  static Point propose(const Patch& patch)
  {
    double area = 0;
    Point sum{};
    for (const PatchCell& c : patch.cells)
    {
      const double w = twice_area(patch.x, c.a, c.b);
      area += w;
      sum = sum + (w / 3) * (c.a + c.b - patch.x - patch.x);
    }
    return on_line(patch, patch.x + (1 / area) * sum);
  }
};
} // namespace remap::smoother
