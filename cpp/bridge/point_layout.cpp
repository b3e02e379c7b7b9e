// SPDX-License-Identifier: LGPL-3.0-or-later
#include "point_layout.h"

#include "lagrangian/kernel.h"
#include <algorithm>
#include <array>
#include <functional>

namespace mmale::bridge
{
namespace
{
/// Vertices in the order of a point's shares of them, the largest first.
std::array<int, 3> ranked(const std::array<double, 3>& point)
{
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, std::greater{}, [&](int v) { return point[v]; });
  return order;
}
} // namespace

::remap::PointLayout point_layout(int points)
{
  ::remap::PointLayout out;
  if (points == 3) // the facet across the farthest vertex
    for (const auto& point : lagrangian::points<3>())
      out.push_back({(ranked(point)[2] + 1) % 3, (ranked(point)[2] + 2) % 3});
  else // the nearest vertex, and the middle of the nearest facet
    for (const auto& point : lagrangian::points<6>())
      out.push_back({ranked(point)[0], ranked(point)[1]});
  return out;
}
} // namespace mmale::bridge
