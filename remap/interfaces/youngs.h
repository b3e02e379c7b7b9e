// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the interface is normal to the gradient of the fraction. On
// triangles: by least squares over the cells that share a vertex. The fastest,
// and not exact for straight interfaces (order 1).
//
// @source Youngs (1982), whose stencil is that of squares.
#pragma once

#include "remap/interfaces/stencil.h"

#include <string_view>

namespace remap::reconstruction
{
struct Youngs
{
  static constexpr std::string_view name = "youngs";
  static constexpr bool uses_centroids = false;
  static constexpr bool exact = false; ///< for straight interfaces
  static constexpr int sweeps = 0;

  /// Normal out of what is taken, any length; 0 if there is no gradient.
  template <Geometry G>
  static Point normal(const Stencil& s)
  {
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
    for (const Stencil::Cell& c : s.around())
    {
      const Point d = c.centre;
      const double weight = 1 / dot(d, d);
      const double f = weight * (s.cell().value - c.value);
      xx += weight * d.x * d.x;
      xy += weight * d.x * d.y;
      yy += weight * d.y * d.y;
      x += f * d.x;
      y += f * d.y;
    }
    return {x * yy - y * xy, y * xx - x * xy};
  }
};
} // namespace remap::reconstruction
