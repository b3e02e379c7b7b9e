// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Domains as CGAL's exact kernel has them. The headers of Boolean operations
// are under the GPL: so is a program that includes this.
#pragma once

#include "remap/domain/domain.h"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>
#include <span>

namespace exact_domain
{
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using Set = CGAL::Polygon_set_2<Kernel>;

inline Polygon exact(std::span<const remap::Point> ring)
{
  Polygon out;
  for (const remap::Point p : ring)
    out.push_back({p.x, p.y});
  return out;
}

/// Rings that do not cross bound what an odd number of them runs around.
inline Set exact(const remap::Domain& domain)
{
  Set out;
  for (const remap::Ring& ring : domain.rings())
  {
    Polygon p = exact(ring);
    if (p.is_clockwise_oriented())
      p.reverse_orientation();
    out.symmetric_difference(p);
  }
  return out;
}
} // namespace exact_domain
