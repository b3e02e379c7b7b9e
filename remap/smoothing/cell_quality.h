// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: quality of a mesh's cell, for the files of this folder.
#pragma once

#include "remap/mesh.h"
#include "remap/smoothing/patch.h"

#include <span>

namespace remap
{
inline quality::Target target_of(std::span<const quality::Target> targets,
                                 std::int32_t c)
{
  return targets.empty() ? quality::equilateral : targets[c];
}

inline double quality_of(const Mesh& mesh, std::span<const double> x,
                         Measure measure,
                         std::span<const quality::Target> targets,
                         std::int32_t cell)
{
  const Triple& n = mesh.cell(cell);
  const Point a = point(x, n[0]);
  const Point b = point(x, n[1]);
  const Point c = point(x, n[2]);
  return measure == Measure::radius_ratio
             ? quality::radius_ratio(a, b, c)
             : quality::shape(target_of(targets, cell), a, b, c);
}
} // namespace remap
