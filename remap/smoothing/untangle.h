// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.1: where an inverted cell is at a node, the node goes where the
// smallest area of its patch is largest: a linear programme, as every area is
// linear in the node's place. Positive there if any place is good.
#pragma once

#include "remap/smoothing/patch.h"

#include <array>
#include <cmath>
#include <limits>

namespace remap
{
/// Smallest 2A around a node put at x.
inline double smallest_area(std::span<const PatchCell> cells, Point x)
{
  double least = std::numeric_limits<double>::infinity();
  for (const PatchCell& c : cells)
    least = std::min(least, twice_area(x, c.a, c.b));
  return least;
}

/// Mean 2A of a patch; around an inner node it does not depend on its place.
inline double mean_area(const Patch& patch)
{
  double sum = 0;
  for (const PatchCell& c : patch.cells)
    sum += twice_area(patch.x, c.a, c.b);
  return sum / static_cast<double>(patch.cells.size());
}

/// Place of the largest smallest area; the patch's own place if there is none
/// better, or the areas grow without bound. A maximum of the least of n planes
/// lies where three of them meet, on a line where two do: all are tried, a
/// patch has few cells.
/// @source Freitag & Plassmann (2000); they solve the programme by simplex
inline Point untangled(const Patch& patch)
{
  const auto& cells = patch.cells;
  Point best = patch.x;
  double most = smallest_area(cells, best);
  const auto look = [&](Point x)
  {
    const double least = smallest_area(cells, x);
    if (least > most)
      most = least, best = x;
  };
  // 2A of a cell with the node at x + d is `area + d·slope`.
  const auto area = [&](std::size_t i)
  { return twice_area(patch.x, cells[i].a, cells[i].b); };
  const auto slope = [&](std::size_t i) -> Point
  {
    const Point e = cells[i].b - cells[i].a;
    return {-e.y, e.x};
  };
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t j = i + 1; j < cells.size(); ++j)
    {
      const Point u = slope(i) - slope(j);
      const double c = area(j) - area(i);
      if (patch.along)
      {
        if (const double ut = dot(u, *patch.along); ut != 0)
          look(patch.x + (c / ut) * *patch.along);
        continue;
      }
      for (std::size_t k = j + 1; k < cells.size(); ++k)
      {
        const Point v = slope(i) - slope(k);
        const double d = area(k) - area(i);
        if (const double det = cross(u, v); det != 0)
          look(patch.x
               + (1 / det) * Point{c * v.y - d * u.y, u.x * d - v.x * c});
      }
    }
  return best;
}
} // namespace remap
