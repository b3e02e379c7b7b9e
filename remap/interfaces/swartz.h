// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the interface lies along the middles of the interfaces around it:
// the line through the cell's own middle from which they are least off. From
// Youngs', a few sweeps over all mixed cells. A middle stays where it is, to
// first order, when its interface turns, so sweeps square the error, and
// straight interfaces become exact. The cheap one that is.
//
// @source Swartz (1989), Mosso, Swartz, Kothe & Clancy (1996). Departure: one
// least-squares line through all middles around, instead of a mean of normals.
#pragma once

#include "remap/interfaces/youngs.h"

namespace remap::reconstruction
{
struct Swartz
{
  static constexpr std::string_view name = "swartz";
  static constexpr bool uses_centroids = false;
  static constexpr bool exact = true; ///< for straight interfaces
  /// Each costs about what Youngs' does; with fewer, straight interfaces are
  /// not exact.
  static constexpr int sweeps = 5;

  template <Geometry G>
  static Point normal(const Stencil& s)
  {
    return Youngs::normal<G>(s);
  }

  /// Ways from the cell's own middle to those around, summed up.
  struct Ways
  {
    double xx = 0, xy = 0, yy = 0;
    Point side;
    /// @param[in] trust  small where an interface is short, and its direction
    ///                   poor to start with
    /// @param[in] normal of the interface there
    void add(Point d, double trust, Point normal)
    {
      side = side + trust * normal;
      const double w = trust / dot(d, d);
      if (not(w < 1e300))
        return;
      xx += w * d.x * d.x;
      xy += w * d.x * d.y;
      yy += w * d.y * d.y;
    }
    /// Normal of the line with the least squares, on the side of the others.
    [[nodiscard]] Point normal(Point old) const
    {
      if (not(xx + yy > 0))
        return old;
      // Along the eigenvector of the larger eigenvalue.
      const double half = 0.5 * (xx - yy),
                   root = std::sqrt(half * half + xy * xy);
      const Point along =
          half > 0 ? Point{half + root, xy} : Point{xy, root - half};
      const Point n = {-along.y, along.x};
      return dot(n, side) < 0 ? -1.0 * n : n;
    }
  };
};
} // namespace remap::reconstruction
