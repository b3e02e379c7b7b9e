// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The least that carries a field by an overlay, for tests: order 1, order 2
// with given or least-squares gradients, limited at the places used.
#pragma once

#include "remap/geometry/volumes.h"
#include "remap/host.h"
#include "remap/transport/overlay.h"

#include <algorithm>
#include <vector>

namespace carry
{
using remap::Point;

/// What the pieces mean to one mesh.
struct Carrier
{
  const remap::Mesh& mesh;
  std::vector<double> before, after; ///< volumes
  std::vector<double> centroid;      ///< before, shape (num, 2)

  Carrier(const remap::Mesh& m, remap::Geometry geometry,
          std::span<const double> x_old, std::span<const double> x_new)
      : mesh(m), before(m.num_cells()), after(m.num_cells()),
        centroid(std::size_t(2) * m.num_cells())
  {
    remap::cell_volumes(m, geometry, x_old, before, centroid);
    remap::cell_volumes(m, geometry, x_new, after);
  }

  /// Least-squares gradients, limited so that no value at a piece or at what
  /// stays leaves the range of the neighbours.
  [[nodiscard]] std::vector<Point> limited(const remap::Overlay& overlay,
                                           std::span<const double> u,
                                           const remap::Host& host) const
  {
    const auto n = static_cast<std::size_t>(mesh.num_cells());
    std::vector<Point> g(n);
    std::vector<double> lo(u.begin(), u.end()), hi = lo, phi(n, 1.0);
    for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
    {
      double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
      for (std::int32_t d : mesh.cell_cells()[c])
      {
        const Point e = at(d) - at(c);
        const double du = u[d] - u[c];
        xx += e.x * e.x, xy += e.x * e.y, yy += e.y * e.y;
        bx += e.x * du, by += e.y * du;
        lo[c] = std::min(lo[c], u[d]);
        hi[c] = std::max(hi[c], u[d]);
      }
      const double det = xx * yy - xy * xy;
      g[c] = {(yy * bx - xy * by) / det, (xx * by - xy * bx) / det};
    }
    const auto look = [&](std::int32_t c, Point p)
    {
      const double du = dot(g[c], p - at(c));
      if (du > hi[c] - u[c])
        phi[c] = std::min(phi[c], (hi[c] - u[c]) / du);
      if (du < lo[c] - u[c])
        phi[c] = std::min(phi[c], (lo[c] - u[c]) / du);
    };
    for (const auto& p : overlay.pieces())
      if (p.from >= 0 and p.from < mesh.owned_cells())
        look(p.from, p.at);
    for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
    {
      if (overlay.rest(c).volume > 0)
        look(c, overlay.rest(c).at);
      g[c] = phi[c] * g[c];
    }
    host.update_cells(std::span(&g[0].x, 2 * n), 2);
    return g;
  }

  /// New means: content of the donor falls, that of the receiver rises. What is
  /// gained has the value of its cell. Cells that did not move stay.
  [[nodiscard]] std::vector<double> apply(const remap::Overlay& overlay,
                                          std::span<const double> u,
                                          std::span<const Point> g) const
  {
    std::vector<double> content(u.begin(), u.end());
    std::vector<std::uint8_t> changed(u.size());
    for (std::size_t c = 0; c < u.size(); ++c)
      content[c] *= before[c];
    for (const auto& p : overlay.pieces())
    {
      const std::int32_t c = p.from >= 0 ? p.from : p.to;
      double value = u[c];
      if (p.from >= 0 and not g.empty())
        value += dot(g[c], p.at - at(c));
      for (std::int32_t end : {p.from, p.to})
        if (end >= 0)
        {
          content[end] += (end == p.from ? -1 : 1) * p.volume * value;
          changed[end] = 1;
        }
    }
    std::vector<double> out(u.begin(), u.end());
    for (std::size_t c = 0; c < u.size(); ++c)
      if (changed[c] != 0 and c < std::size_t(mesh.owned_cells()))
        out[c] = content[c] / after[c];
    return out;
  }

  [[nodiscard]] Point at(std::int32_t c) const
  {
    return {centroid[2 * c], centroid[2 * c + 1]};
  }
  [[nodiscard]] double mass(std::span<const double> volume,
                            std::span<const double> u) const
  {
    double sum = 0;
    for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
      sum += volume[c] * u[c];
    return sum;
  }
};

/// Cells with a node that moved.
inline std::vector<std::int32_t> touched(const remap::Mesh& mesh,
                                         std::span<const double> x_old,
                                         std::span<const double> x_new)
{
  std::vector<std::int32_t> out;
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    if (std::any_of(
            mesh.cell(c).begin(), mesh.cell(c).end(), [&](std::int32_t i)
            { return not(remap::point(x_old, i) == remap::point(x_new, i)); }))
      out.push_back(c);
  return out;
}

/// Overlay with the geometry chosen at run time.
inline remap::Outcome intersect(remap::Overlay& overlay,
                                remap::Geometry geometry,
                                std::span<const double> x_old,
                                std::span<const double> x_new,
                                std::span<const std::int32_t> cells)
{
  return geometry == remap::Geometry::plane
             ? overlay.intersect<remap::Geometry::plane>(x_old, x_new, cells)
             : overlay.intersect<remap::Geometry::axisymmetric>(x_old, x_new,
                                                                cells);
}
} // namespace carry
