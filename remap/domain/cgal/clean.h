// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: domains from rings that cross, by exact arrangements of CGAL. Those
// are under the GPL: a program that links `remap::cgal` is too, as a whole.
// Nothing else of the library needs it (CMake option REMAP_CGAL).
#pragma once

#include "remap/domain/domain.h"

#include <span>
#include <vector>

namespace remap
{
/// A domain, or what is left to be said against it.
struct Cleaned
{
  Domain domain;
  std::vector<Fault> faults; ///< empty: the domain may be used
};

/// What shapes fill by their rules, whether or not their rings cross, touch or
/// lie on each other. The arrangement is exact; its vertices are rounded to
/// doubles in the end. Faults are those of single rings (not finite, too few
/// points), and crossings that rounding has made, of rings of the result.
[[nodiscard]] Cleaned clean(std::span<const Shape> shapes);
} // namespace remap
