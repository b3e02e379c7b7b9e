// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: coordinates in which a polygon is round, for searches in slivers.
#pragma once

#include "remap/geometry/polygon.h"

#include <cmath>

namespace remap
{
/// x = L y, L lower triangular, L Lᵀ the mean square of the vertices about
/// their middle. The first coordinate is only scaled: a radius stays one.
class Round
{
public:
  Round() = default; ///< as it is
  template <int N>
  explicit Round(const Polygon<N>& p)
  {
    Point mean;
    for (int i = 0; i < p.size; ++i)
      mean = mean + 1.0 / p.size * p[i];
    double xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < p.size; ++i)
    {
      const Point d = p[i] - mean;
      xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    _xx = std::sqrt(xx / p.size);
    _yx = xy / p.size / _xx;
    _yy = std::sqrt(std::max((xx * yy - xy * xy) / (xx * p.size), 0.0));
    if (not(_xx > 0 and _yy > 0)) // no area
      _xx = _yy = 1, _yx = 0;
  }
  [[nodiscard]] Point back(Point y) const
  {
    return {_xx * y.x, _yx * y.x + _yy * y.y};
  }
  [[nodiscard]] Point to(Point x) const
  {
    const double y = x.x / _xx;
    return {y, (x.y - _yx * y) / _yy};
  }
  /// Normal of a line, any length.
  [[nodiscard]] Point normal(Point n) const
  {
    const double y = n.y / _yy;
    return {(n.x - _yx * y) / _xx, y};
  }
  [[nodiscard]] double scaled(double radius) const { return radius / _xx; }

private:
  double _xx = 1, _yx = 0, _yy = 1;
};
} // namespace remap
