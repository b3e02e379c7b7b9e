// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: many parts from volumes alone: cut off one after the other, in an
// order that geometry gives.
#pragma once

#include "remap/interfaces/placement.h"
#include "remap/interfaces/sort.h"
#include "remap/interfaces/stencil.h"

#include <array>

namespace remap
{
/// Parts as they are cut off, the last is what remains.
using Order = std::array<int, most_parts>;

/// Order in which parts are cut off: by where each material lies on average, in
/// the cell and around it, along the axis on which these places differ most;
/// from the end at which the material stands further apart from the next.
inline Order chain_order(Stencil& s, const Materials& materials,
                         std::span<const Part> parts)
{
  const int n = static_cast<int>(parts.size());
  std::array<Point, most_parts> at;
  Order order{};
  Point mean;
  for (int k = 0; k < n; ++k)
  {
    order[k] = k;
    s.take(materials, parts, 1u << k);
    const auto volume = [](const Stencil::Cell& c)
    { return c.value * twice_area(c.t[0], c.t[1], c.t[2]); };
    double sum = volume(s.cell());
    Point moment;
    for (const Stencil::Cell& c : s.around())
    {
      sum += volume(c);
      moment = moment + volume(c) * c.centre;
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

/// The order that a chain of cuts was made in.
inline Order order_of(const Partition& p)
{
  Order out{};
  for (int k = 0; k < p.count; ++k)
    out[k] = ~p.cuts[k].in;
  out[p.count] = ~p.cuts[p.count - 1].out;
  return out;
}

/// Cuts of a row, each part off what is left of the cell.
///
/// @param[in] s      has looked at the cell
/// @param[in] normal called with the number of the cut and the parts cut off by
///                   then, a bit each; out of them, any length
template <Geometry G, class Normal>
void chain(const Stencil& s, std::span<const Part> parts, const Order& order,
           Normal&& normal, Partition& out)
{
  const int n = static_cast<int>(parts.size());
  const Point origin = s.origin();
  Piece rest;
  double left = 1;
  unsigned off = 0;
  for (int k = 0; k + 1 < n; ++k)
  {
    off |= 1u << order[k];
    const Point up = normal(k, off);
    const double fraction = parts[order[k]].fraction;
    const bool last = k + 2 == n;
    HalfPlane plane;
    if (k == 0)
    {
      if constexpr (G == Geometry::plane)
        plane = place(s.cell().t, up, fraction, 1 - fraction);
      else
        plane = place_fraction<G>(Polygon<3>(s.cell().t), up, fraction,
                                  1 - fraction, origin.x);
    }
    else if (rest.size < 3) // lost to round-off
      plane = {out.cuts[k - 1].plane.normal, out.cuts[k - 1].plane.at - origin};
    else
    {
      const double part = std::min(1.0, fraction / left);
      plane = place_fraction<G>(rest, up, part, 1 - part, origin.x);
    }
    out.cuts[k] = {{plane.normal, plane.at + origin},
                   static_cast<std::int8_t>(~order[k]),
                   static_cast<std::int8_t>(last ? ~order[k + 1] : k + 1)};
    out.count = k + 1;
    if (last)
      break;
    Piece in, behind;
    if (k == 0)
      for (const Point& v : s.cell().t)
        rest.push(v);
    split(rest, plane, in, behind);
    rest = behind;
    left -= fraction;
  }
}
} // namespace remap
