// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: many parts from volumes alone: cut off one after the other, by an
// order that geometry gives.
#pragma once

#include "remap/interfaces/placement.h"
#include "remap/interfaces/sort.h"
#include "remap/interfaces/stencil.h"

#include <array>

namespace remap
{
/// Order in which parts are cut off: where each material lies on average, in
/// the cell and around it, along the axis on which these places differ most;
/// from the end at which the material stands further apart from the next.
inline std::array<int, most_parts>
chain_order(Stencil& s, const Materials& materials, std::span<const Part> parts)
{
  const int n = static_cast<int>(parts.size());
  std::array<Point, most_parts> at;
  std::array<int, most_parts> order{};
  const Point origin = centroid(s.cell());
  Point mean;
  for (int k = 0; k < n; ++k)
  {
    order[k] = k;
    s.take(materials, parts, 1u << k);
    double sum = s.value() * twice_area(s.cell()[0], s.cell()[1], s.cell()[2]);
    Point moment;
    for (std::size_t j = 0; j < s.size(); ++j)
    {
      const Triangle& t = s.cell(j);
      const double part = s.value(j) * twice_area(t[0], t[1], t[2]);
      sum += part;
      moment = moment + part * (centroid(t) - origin);
    }
    at[k] = 1 / sum * moment;
    mean = mean + 1.0 / n * at[k];
  }
  double xx = 0, xy = 0, yy = 0;
  for (int k = 0; k < n; ++k)
  {
    const Point d = at[k] - mean;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const Point axis = {std::cos(angle), std::sin(angle)};
  sort_few(order.data(), n,
           [&](int a, int b) { return dot(axis, at[a]) < dot(axis, at[b]); });
  const auto gap = [&](int i)
  { return dot(axis, at[order[i + 1]] - at[order[i]]); };
  if (gap(n - 2) > gap(0))
    std::reverse(order.begin(), order.begin() + n);
  return order;
}

/// Cuts of a row, each part off what is left of the cell.
///
/// @param[in] normal called with the stencil of what is cut off in all so far;
///                   out of it, any length
template <Geometry G, class Normal>
void chain(Stencil& s, const Materials& materials, std::span<const Part> parts,
           Normal&& normal, Partition& out)
{
  const int n = static_cast<int>(parts.size());
  out.count = 0;
  std::array<int, most_parts> order = {0, 1};
  if (n > 2)
    order = chain_order(s, materials, parts);
  const Point origin = centroid(s.cell());
  Piece rest;
  double left = 1;
  unsigned off = 0;
  for (const Point& v : s.cell())
    rest.push(v - origin);
  for (int k = 0; k + 1 < n; ++k)
  {
    off |= 1u << order[k];
    s.take(materials, parts, off);
    Point up = normal(s);
    const double length = std::sqrt(dot(up, up));
    up = length > 0 ? 1 / length * up : Point{1, 0};
    const double fraction = parts[order[k]].fraction;
    HalfPlane plane;
    if (rest.size < 3) // lost to round-off
      plane = out.cuts[k - 1].plane;
    else if (G == Geometry::plane and k == 0)
      plane = place(s.cell(), up, fraction, 1 - fraction);
    else
    {
      const double radius = G == Geometry::plane ? 0 : origin.x;
      const double whole =
          polygon::fan<G>(rest.x.data(), rest.y.data(), rest.size, radius).v;
      const double part = std::min(1.0, fraction / left);
      // Counted from the side of the smaller part.
      const Chord c =
          part <= 0.5 ? place<G>(rest, up, part * whole, radius)
                      : place<G>(rest, -1.0 * up, (1 - part) * whole, radius);
      plane = {up, middle(c.a, c.b) + origin};
    }
    out.add(
        {.plane = plane,
         .in = static_cast<std::int8_t>(~order[k]),
         .out = static_cast<std::int8_t>(k + 2 < n ? k + 1 : ~order[k + 1])});
    if (k + 2 == n)
      break;
    Piece in, behind;
    split(rest, HalfPlane{plane.normal, plane.at - origin}, in, behind);
    rest = behind;
    left -= fraction;
  }
}
} // namespace remap
