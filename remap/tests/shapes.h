// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Bodies with exact volumes and centroids in any cell: discs, their sectors,
// Zalesak's disc with a slot. Plane.
#pragma once

#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace shapes
{
using remap::HalfPlane;
using remap::Moments;
using remap::Point;
using Outline = remap::Polygon<24>;

/// Area and first moments, about the disc's centre, of the part of a polygon in
/// a disc: triangles to the centre where an edge is inside, sectors where it is
/// not.
inline Moments in_disc(const Outline& polygon, Point centre, double r)
{
  Moments sum;
  const auto triangle = [&sum](Point a, Point b)
  {
    const double w = remap::cross(a, b);
    sum += {w / 2, w / 6 * (a.x + b.x), w / 6 * (a.y + b.y)};
  };
  const auto sector = [&sum, r](Point a, Point b)
  {
    const double turn = std::atan2(remap::cross(a, b), remap::dot(a, b));
    const double from = std::atan2(a.y, a.x), to = from + turn;
    sum += {r * r / 2 * turn, r * r * r / 3 * (std::sin(to) - std::sin(from)),
            r * r * r / 3 * (std::cos(from) - std::cos(to))};
  };
  for (int i = 0; i < polygon.size; ++i)
  {
    const Point a = polygon[i] - centre,
                b = polygon[(i + 1) % polygon.size] - centre;
    const Point d = b - a;
    const double dd = remap::dot(d, d), ad = remap::dot(a, d);
    const double root = ad * ad - dd * (remap::dot(a, a) - r * r);
    if (not(root > 0))
    {
      sector(a, b);
      continue;
    }
    const double s = std::max(0.0, (-ad - std::sqrt(root)) / dd);
    const double e = std::min(1.0, (-ad + std::sqrt(root)) / dd);
    if (s >= e)
    {
      sector(a, b);
      continue;
    }
    const Point p = a + s * d, q = a + e * d;
    if (s > 0)
      sector(a, p);
    triangle(p, q);
    if (e < 1)
      sector(q, b);
  }
  return sum;
}

/// Moments of a body in a cell, about a given point.
using Body = std::function<Moments(const Outline& cell, Point about)>;

inline Body disc(Point centre, double r)
{
  return [=](const Outline& cell, Point about)
  {
    const Moments m = in_disc(cell, centre, r);
    const Point by = centre - about;
    return Moments{m.v, m.x + m.v * by.x, m.y + m.v * by.y};
  };
}

/// Part of a body in some half-planes.
inline Body part_in(const Body& body, std::vector<HalfPlane> planes)
{
  return [=](const Outline& cell, Point about)
  {
    Outline now = cell;
    for (const HalfPlane& h : planes)
    {
      Outline next;
      remap::clip(now, h, next);
      now = next;
    }
    return now.size < 3 ? Moments{} : body(now, about);
  };
}

inline Body without(const Body& body, const Body& part)
{
  return [=](const Outline& cell, Point about)
  { return body(cell, about) - part(cell, about); };
}

/// Radius 0.15 about (0.5, 0.75), with a slot of breadth 0.05 from below up to
/// y = 0.85.
inline Body zalesak()
{
  const Body whole = disc({0.5, 0.75}, 0.15);
  return without(whole, part_in(whole, {{{-1, 0}, {0.475, 0}},
                                        {{1, 0}, {0.525, 0}},
                                        {{0, 1}, {0, 0.85}}}));
}

/// A disc in four quarters.
inline std::vector<Body> quarters(Point centre, double r)
{
  std::vector<Body> out;
  for (const double sx : {1.0, -1.0})
    for (const double sy : {1.0, -1.0})
      out.push_back(
          part_in(disc(centre, r), {{{sx, 0}, centre}, {{0, sy}, centre}}));
  return out;
}

/// All there is; with `part_in`, half-planes and what they have in common.
template <remap::Geometry G>
Moments everything(const Outline& cell, Point about)
{
  return remap::polygon::shifted(remap::moments<G>(cell), {-about.x, -about.y});
}

/// Materials 1, 2, … are bodies that do not overlap, 0 is what is left.
/// @param[in] least smaller fractions are none
template <remap::Geometry G = remap::Geometry::plane>
remap::Materials lay(const remap::Mesh& mesh, std::span<const double> x,
                     const std::vector<Body>& bodies, double least = 1e-11)
{
  const int num = static_cast<int>(bodies.size()) + 1;
  remap::Materials out(mesh.num_cells(), num);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    Outline cell;
    for (std::int32_t i : mesh.cell(c))
      cell.push(remap::point(x, i));
    const Point about = cell[0];
    const Moments whole = everything<G>(cell, about);
    Moments rest = whole;
    std::vector<remap::Part> parts;
    const auto add = [&](int material, const Moments& m)
    {
      // Less is round-off of differences of sectors.
      if (m.v > least * whole.v)
        parts.push_back({material, m.v / whole.v, about + m.centroid()});
    };
    std::vector<remap::Part> others;
    for (int k = 1; k < num; ++k)
    {
      const Moments m = bodies[k - 1](cell, about);
      rest = rest - m;
      add(k, m);
    }
    others.swap(parts);
    add(0, rest);
    parts.insert(parts.end(), others.begin(), others.end());
    if (parts.size() == 1)
      out.set_pure(c, parts[0].material);
    else
      out.add_row(c, parts);
  }
  return out;
}
} // namespace shapes
