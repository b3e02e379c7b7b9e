// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Meshes filled with materials, for tests: the plane is told apart by straight
// cuts, so fractions, centroids and what fields hold are exact.
#pragma once

#include "remap/geometry/volumes.h"
#include "remap/interfaces/partition.h"
#include "remap/materials/materials.h"
#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <functional>

namespace filled
{
using namespace remap;

/// Fill cells as straight cuts through the plane tell.
/// @param[in] material of each part of the partition
/// @param[in] smallest fraction that becomes a part of its own
inline Materials fill(const Mesh& mesh, Geometry geometry,
                      std::span<const double> x, const Partition& plane,
                      std::span<const int> material, int num_materials,
                      double smallest = 1e-13)
{
  Materials out(mesh.num_cells(), num_materials);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const auto& n = mesh.cell(c);
    const Polygon<3> t(
        Triangle{point(x, n[0]), point(x, n[1]), point(x, n[2])});
    std::array<Moments, most_parts> found{}, of{};
    if (geometry == Geometry::plane)
      add_moments<Geometry::plane>(t, plane, found);
    else
      add_moments<Geometry::axisymmetric>(t, plane, found);
    double all = 0;
    for (std::size_t k = 0; k < material.size(); ++k)
    {
      of[material[k]] += found[k];
      all += found[k].v;
    }
    std::vector<Part> parts;
    double sum = 0;
    for (int k = 0; k < num_materials; ++k)
      if (of[k].v > smallest * all)
      {
        parts.push_back({k, of[k].v, of[k].centroid()});
        sum += of[k].v;
      }
    for (Part& p : parts)
      p.fraction /= sum;
    if (parts.size() == 1)
      out.set_pure(c, parts[0].material);
    else
      out.add_row(c, parts);
  }
  return out;
}

/// One cut: material 0 where normal · (x − at) <= 0, 1 elsewhere.
inline Partition line(Point normal, Point at)
{
  Partition out;
  out.add({{normal, at}, ~0, ~1});
  return out;
}

/// Sectors around a point, as many as angles; each less than half a turn.
inline Partition sectors(Point at, std::span<const double> angles)
{
  // Chain of cuts: sector k lies left of ray k and right of ray k + 1; a first
  // cut along ray 0 keeps half-planes apart.
  Partition out;
  const auto ray = [&](std::size_t k) -> HalfPlane
  {
    const Point d = {std::cos(angles[k]), std::sin(angles[k])};
    return {{d.y, -d.x}, at}; // left of the ray
  };
  // Left of ray 0 are sectors up to half a turn on, right of it the rest.
  std::size_t half = 1;
  while (half < angles.size() and angles[half] - angles[0] < std::numbers::pi)
    ++half;
  const auto chain = [&](std::size_t first, std::size_t last)
  {
    // Sectors first … last by rays first + 1 … last; number of the first cut.
    int begin = ~static_cast<int>(last);
    for (std::size_t k = last; k > first; --k)
      begin = out.add({ray(k), static_cast<std::int8_t>(begin),
                       static_cast<std::int8_t>(~static_cast<int>(k - 1))});
    return begin;
  };
  out.add({ray(0), 0, 0});
  const int left = chain(0, half - 1);
  // The sector before `half` reaches over to the right side.
  int right = ~static_cast<int>(angles.size() - 1);
  for (std::size_t k = angles.size() - 1; k >= half and k < angles.size(); --k)
    right = out.add({ray(k), static_cast<std::int8_t>(right),
                     static_cast<std::int8_t>(~static_cast<int>(k - 1))});
  out.cuts[0].in = static_cast<std::int8_t>(left);
  out.cuts[0].out = static_cast<std::int8_t>(right);
  return out;
}

/// A function of place and material.
using Value = std::function<double(Point, int)>;

/// Means over slots of a function linear in each material.
inline std::vector<double> values(const Mesh& mesh, Geometry geometry,
                                  std::span<const double> x, const Materials& m,
                                  const Value& f)
{
  std::vector<double> v(mesh.num_cells()),
      at(std::size_t(2) * mesh.num_cells()), out(m.num_slots());
  cell_volumes(mesh, geometry, x, v, at);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    out[c] = m.pure(c) >= 0 ? f(point(at, c), m.pure(c)) : 0;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const auto row = static_cast<std::int32_t>(r);
    for (std::size_t k = 0; k < m.parts(row).size(); ++k)
    {
      const Part& p = m.parts(row)[k];
      out[m.first_slot(row) + static_cast<std::int32_t>(k)] =
          f(p.centroid, p.material);
    }
  }
  return out;
}

/// Calls with every slot of owned cells: slot, material, volume, centroid.
template <class Call>
void each_slot(const Mesh& mesh, Geometry geometry, std::span<const double> x,
               const Materials& m, const Call& call)
{
  std::vector<double> v(mesh.num_cells()),
      at(std::size_t(2) * mesh.num_cells());
  cell_volumes(mesh, geometry, x, v, at);
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
    if (m.pure(c) >= 0)
      call(c, m.pure(c), v[c], point(at, c));
    else
      for (std::size_t k = 0; k < m.parts(m.row(c)).size(); ++k)
      {
        const Part& p = m.parts(m.row(c))[k];
        call(m.first_slot(m.row(c)) + static_cast<std::int32_t>(k), p.material,
             p.fraction * v[c], p.centroid);
      }
}

/// Integral over each material; of 1 without values.
inline std::vector<double>
integrals(const Mesh& mesh, Geometry geometry, std::span<const double> x,
          const Materials& m, std::span<const double> u = {},
          std::size_t components = 1, std::size_t k = 0)
{
  std::vector<double> out(m.num_materials());
  each_slot(mesh, geometry, x, m,
            [&](std::int32_t s, int material, double v, Point)
            {
              out[material] +=
                  v * (u.empty() ? 1.0 : u[components * std::size_t(s) + k]);
            });
  return out;
}

/// Largest error of fractions' sums, and of fractions beyond [0, 1].
inline double unsound(const Materials& m)
{
  double out = 0;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    double sum = 0;
    for (const Part& p : m.parts(static_cast<std::int32_t>(r)))
    {
      sum += p.fraction;
      out = std::max({out, -p.fraction, p.fraction - 1});
    }
    out = std::max(out, std::abs(sum - 1));
  }
  return out;
}
} // namespace filled
