// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Bodies with straight interfaces: a partition of the whole plane laid over a
// mesh, and how far a reconstruction is from it.
#pragma once

#include "remap/interfaces/interfaces.h"
#include "remap/materials/materials.h"
#include "remap/tests/meshes.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace partitions
{
using namespace remap;

inline Triangle triangle_of(const Mesh& mesh, std::span<const double> x,
                            std::int32_t c)
{
  const Triple& v = mesh.cell(c);
  return {point(x, v[0]), point(x, v[1]), point(x, v[2])};
}

/// Line at an angle through a point; what lies behind its normal.
inline HalfPlane line(double angle, Point at)
{
  return {{std::cos(angle), std::sin(angle)}, at};
}

/// Two parts beside a line.
inline Partition straight(double angle, Point at)
{
  Partition out;
  out.add({line(angle, at), ~0, ~1});
  return out;
}

/// Parts 0, 1 beside a line, cut off at a second one by part 2.
inline Partition tee(double angle, Point at)
{
  Partition out;
  out.add({line(angle, at), 1, ~2});
  out.add({line(angle + 1.1, at + Point{0.02, 0.01}), ~0, ~1});
  return out;
}

/// Three layers.
inline Partition layers(double angle, Point at, double width)
{
  Partition out;
  const Point n = {std::cos(angle), std::sin(angle)};
  out.add({line(angle, at), ~0, 1});
  out.add({line(angle, at + width * n), ~1, ~2});
  return out;
}

/// Three wedges about a point.
inline Partition wye(Point at, double angle)
{
  const Junction y = {at, {angle, angle + 2.0, angle + 4.4}};
  Partition out;
  if (not y.cuts(out))
    throw std::logic_error("rays in order");
  return out;
}

/// Volumes and moments of parts in a polygon, about a point of it.
template <Geometry G, int N>
std::vector<Moments> moments_of(const Polygon<N>& p, const Partition& by,
                                int num)
{
  std::vector<Moments> out(num);
  add_moments<G>(p, by, out);
  return out;
}

/// Materials by exact fractions and centroids. Fractions below `least` are left
/// out: clipping knows volumes to some eps only.
template <Geometry G>
Materials lay(const Mesh& mesh, std::span<const double> x, const Partition& by,
              int num, double least = 1e-10)
{
  Materials out(mesh.num_cells(), num);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Triangle t = triangle_of(mesh, x, c);
    const auto m = moments_of<G>(Polygon<3>(t), by, num);
    double whole = 0;
    for (const Moments& k : m)
      whole += k.v;
    std::vector<Part> parts;
    double kept = 0;
    for (int k = 0; k < num; ++k)
      if (m[k].v > least * whole)
      {
        parts.push_back({k, m[k].v, m[k].centroid()});
        kept += m[k].v;
      }
    for (Part& p : parts)
      p.fraction /= kept;
    if (parts.size() == 1)
      out.set_pure(c, parts[0].material);
    else
      out.add_row(c, parts);
  }
  return out;
}

/// What a reconstruction has elsewhere than the partition: largest volume in a
/// cell, over the cell's. And how far its volumes are from the fractions.
struct Misfit
{
  double elsewhere = 0, fractions = 0, centroids = 0;
};

template <Geometry G>
Misfit misfit(const Mesh& mesh, std::span<const double> x,
              const Materials& materials, const Interfaces& interfaces,
              const Partition& by)
{
  Misfit out;
  for (std::int32_t row = 0;
       row < static_cast<std::int32_t>(materials.mixed().size()); ++row)
  {
    const Triangle t = triangle_of(mesh, x, materials.mixed()[row]);
    const double whole = moments<G>(Polygon<3>(t)).v;
    const auto parts = materials.parts(row);
    std::vector<Moments> found(parts.size());
    double wrong = 0;
    split(Polygon<3>(t), interfaces.partition(row),
          [&](int part, const Piece& p)
          {
            const Moments m = moments<G>(p);
            found[part] += m;
            const auto real = moments_of<G>(p, by, materials.num_materials());
            wrong += m.v - real[parts[part].material].v;
          });
    out.elsewhere = std::max(out.elsewhere, wrong / whole);
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
      // Written so that NaN fails.
      const double miss = std::abs(found[k].v / whole - parts[k].fraction);
      if (not(miss <= out.fractions))
        out.fractions = miss;
      const Point off = found[k].centroid() - parts[k].centroid;
      const double far = std::sqrt(dot(off, off) / whole);
      if (parts[k].fraction > 1e-6 and not(far <= out.centroids))
        out.centroids = far;
    }
  }
  return out;
}
} // namespace partitions
