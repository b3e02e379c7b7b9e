// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/relax.h"

#include "remap/geometry/swept.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace remap;

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

/// One cell on its way.
struct Way
{
  std::array<Point, 3> from, to;

  std::array<Point, 3> at(double part) const
  {
    std::array<Point, 3> out;
    for (int i = 0; i < 3; ++i)
      out[i] = from[i] + part * (to[i] - from[i]);
    return out;
  }

  /// Smallest 2A anywhere on the way up to `part`: a quadratic of it.
  double least_area(double part) const
  {
    const auto m = at(part);
    const Point u = m[1] - m[0], v = m[2] - m[0];
    const Point u0 = from[1] - from[0], v0 = from[2] - from[0];
    const Point du = u - u0, dv = v - v0;
    const double a = cross(du, dv), b = cross(u0, dv) + cross(du, v0);
    double least = std::min(cross(u0, v0), cross(u, v));
    if (const double s = -b / (2 * a); a > 0 and s > 0 and s < 1)
      least = std::min(least, cross(u0, v0) + s * b / 2);
    return least;
  }

  /// What the cell loses up to `part`, over what it has.
  template <Geometry G>
  double loss(double part) const
  {
    if (not(least_area(part) > 0))
      return infinity;
    const auto m = at(part);
    double lost = 0;
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      const SweptParts s = swept_parts<G>({from[i], from[j], m[i], m[j]});
      lost += std::max(s.v[0], 0.0) + std::max(s.v[1], 0.0);
    }
    return lost / triangle<G>(from[0], from[1], from[2]).v;
  }

  /// Largest part with a loss of at most `most`: losses grow with it.
  template <Geometry G>
  double farthest(double most) const
  {
    double good = 0, bad = 1;
    for (int k = 0; k < 40; ++k)
    {
      const double middle = 0.5 * (good + bad);
      (loss<G>(middle) <= most ? good : bad) = middle;
    }
    return good;
  }
};

template <Geometry G>
Relaxation of_cells(const Mesh& mesh, double most,
                    std::span<const double> x_old,
                    std::span<const double> x_new)
{
  Relaxation out;
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
  {
    Way way;
    bool moves = false;
    for (int i = 0; i < 3; ++i)
    {
      way.from[i] = point(x_old, mesh.cell(c)[i]);
      way.to[i] = point(x_new, mesh.cell(c)[i]);
      moves = moves or not(way.from[i] == way.to[i]);
    }
    if (not moves)
      continue;
    const double loss = way.loss<G>(1);
    out.loss = std::max(out.loss, loss);
    if (not(loss <= most) and not(way.loss<G>(out.part) <= most))
      out.part = std::min(out.part, way.farthest<G>(most));
  }
  return out;
}
} // namespace

Relaxation remap::relax(const Mesh& mesh, Geometry geometry, double most,
                        std::span<const double> x_old, std::span<double> x_new,
                        const Host& host)
{
  const Relaxation ours =
      geometry == Geometry::plane
          ? of_cells<Geometry::plane>(mesh, most, x_old, x_new)
          : of_cells<Geometry::axisymmetric>(mesh, most, x_old, x_new);
  double state[2] = {-ours.part, ours.loss};
  host.max(std::span(state, 2));
  const Relaxation out{-state[0], state[1]};
  if (out.part < 1)
    for (std::size_t i = 0; i < x_new.size(); ++i)
      x_new[i] = x_old[i] + out.part * (x_new[i] - x_old[i]);
  return out;
}
