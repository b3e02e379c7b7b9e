// SPDX-License-Identifier: LGPL-3.0-or-later
//
// On which side of a line does a point lie? The exact answer for coordinates
// that neither overflow nor underflow when multiplied, so that rings that touch
// are told from rings that cross.
#pragma once

#include "remap/geometry/measure.h"

#include <array>
#include <cmath>
#include <limits>

namespace remap::orientation
{
/// A number as a sum of numbers that do not overlap, the smallest first.
class Expansion
{
public:
  void add(double x)
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < _size; ++i)
    {
      // Exact sum of two: x stays the larger part (Knuth).
      const double sum = x + _part[i];
      const double b = sum - x;
      const double rest = (x - (sum - b)) + (_part[i] - b);
      x = sum;
      if (rest != 0)
        _part[kept++] = rest;
    }
    if (x != 0)
      _part[kept++] = x;
    _size = kept;
  }
  void add_product(double a, double b)
  {
    const double p = a * b;
    add(std::fma(a, b, -p));
    add(p);
  }
  [[nodiscard]] int sign() const
  {
    return _size == 0 ? 0 : _part[_size - 1] > 0 ? 1 : -1;
  }

private:
  std::array<double, 12> _part{}; ///< six products
  std::size_t _size = 0;
};

/// 1 if c lies to the left of the way from a to b, -1 to the right, 0 on the
/// line.
/// @source the filter and the expansions of Shewchuk (1997). Departure: six
/// products of the coordinates themselves, no stages in between; it is rare.
inline int side(Point a, Point b, Point c)
{
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  constexpr double eps = std::numeric_limits<double>::epsilon() / 2;
  if (std::abs(det) > (3 + 16 * eps) * eps * (std::abs(left) + std::abs(right)))
    return det > 0 ? 1 : -1;
  Expansion e;
  e.add_product(a.x, b.y);
  e.add_product(-a.x, c.y);
  e.add_product(-c.x, b.y);
  e.add_product(-a.y, b.x);
  e.add_product(a.y, c.x);
  e.add_product(c.y, b.x);
  return e.sign();
}
} // namespace remap::orientation
