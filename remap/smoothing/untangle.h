// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: where an inverted cell is at a node, the node goes where the
// smallest area of its patch is largest: a linear programme, as every area is
// linear in the node's place. Positive there if any place is good. Where no
// place is, since neighbours are in the way, all go down a distortion whose
// barrier has been softened, so that it is finite for inverted cells too.
#pragma once

#include "remap/smoothing/patch.h"

#include <array>
#include <cmath>
#include <limits>

namespace remap
{
/// Smallest 2A around a node put at x.
inline double smallest_area(std::span<const PatchCell> cells, Point x)
{
  double least = std::numeric_limits<double>::infinity();
  for (const PatchCell& c : cells)
    least = std::min(least, twice_area(x, c.a, c.b));
  return least;
}

/// Mean 2A of a patch; around an inner node it does not depend on its place.
inline double mean_area(const Patch& patch)
{
  double sum = 0;
  for (const PatchCell& c : patch.cells)
    sum += twice_area(patch.x, c.a, c.b);
  return sum / static_cast<double>(patch.cells.size());
}

/// Place of the largest smallest area; the patch's own place if there is none
/// better, or the areas grow without bound. A maximum of the least of n planes
/// lies where three of them meet, on a line where two do: all are tried, a
/// patch has few cells.
/// @source Freitag & Plassmann (2000); they solve the programme by simplex
inline Point untangled(const Patch& patch)
{
  const auto& cells = patch.cells;
  Point best = patch.x;
  double most = smallest_area(cells, best);
  const auto look = [&](Point x)
  {
    const double least = smallest_area(cells, x);
    if (least > most)
      most = least, best = x;
  };
  // 2A of a cell with the node at x + d is `area + d·slope`.
  const auto area = [&](std::size_t i)
  { return twice_area(patch.x, cells[i].a, cells[i].b); };
  const auto slope = [&](std::size_t i) -> Point
  {
    const Point e = cells[i].b - cells[i].a;
    return {-e.y, e.x};
  };
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t j = i + 1; j < cells.size(); ++j)
    {
      const Point u = slope(i) - slope(j);
      const double c = area(j) - area(i);
      if (patch.along)
      {
        if (const double ut = dot(u, *patch.along); ut != 0)
          look(patch.x + (c / ut) * *patch.along);
        continue;
      }
      for (std::size_t k = j + 1; k < cells.size(); ++k)
      {
        const Point v = slope(i) - slope(k);
        const double d = area(k) - area(i);
        if (const double det = cross(u, v); det != 0)
          look(patch.x
               + (1 / det) * Point{c * v.y - d * u.y, u.x * d - v.x * c});
      }
    }
  return best;
}

/// One Newton step from the patch's place down Σ N/h(D), h = (D + √(D² +
/// 4δ²))/2 in the place of D (see `distortion`), δ a part of the mean area; the
/// Hessian without what may be negative, halved until the sum falls.
/// @source Escobar et al. (2003), simultaneous untangling and smoothing
inline Point softened(const Patch& patch, double part)
{
  const double delta = part * std::abs(mean_area(patch));
  if (not(delta > 0))
    return patch.x;
  const auto barrier = [delta](double d)
  { return 0.5 * (d + std::sqrt(d * d + 4 * delta * delta)); };
  const auto value = [&](Point x)
  {
    double f = 0;
    for (const PatchCell& c : patch.cells)
      f += quality::squares(c.target, c.a - x, c.b - x)
           / barrier(twice_area(x, c.a, c.b));
    return f;
  };
  const Point x = patch.x;
  Point g{};
  double xx = 0, xy = 0, yy = 0;
  for (const PatchCell& c : patch.cells)
  {
    const quality::Target& w = c.target;
    const double d = twice_area(x, c.a, c.b);
    const double h = barrier(d);
    const double slope = h / std::sqrt(d * d + 4 * delta * delta);
    const Point p = c.a - x, m = c.b - x - w.r * p;
    const double n = quality::squares(w, p, c.b - x);
    const double rest = w.rest * (1 - w.r);
    const Point gn = (-2 / h) * (w.own * p + rest * m);
    const Point gh = (slope / h) * Point{c.a.y - c.b.y, c.b.x - c.a.x};
    const double kappa = 2 / h * (w.own + rest * (1 - w.r));
    const double two = 2 * n / h;
    g = g + gn - (n / h) * gh;
    xx += kappa + two * gh.x * gh.x;
    yy += kappa + two * gh.y * gh.y;
    xy += two * gh.x * gh.y;
  }
  Point step{};
  if (patch.along)
  {
    const Point t = *patch.along;
    const double curve = xx * t.x * t.x + 2 * xy * t.x * t.y + yy * t.y * t.y;
    step = (-dot(g, t) / curve) * t;
  }
  else
  {
    const double det = xx * yy - xy * xy;
    step = {(xy * g.y - yy * g.x) / det, (xy * g.x - xx * g.y) / det};
  }
  const double now = value(x);
  for (double size : {1.0, 0.5, 0.25, 0.125})
    if (value(x + size * step) < now)
      return x + size * step;
  return x;
}
} // namespace remap
