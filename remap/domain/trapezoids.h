// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Closed lines of a few points to convex pieces for pictures: trapezoids
// between two edges, from one height at which something begins or ends to the
// next. Lines may run to and fro along each other; what has no breadth is left
// out.
#pragma once

#include "remap/domain/domain.h"

#include <functional>
#include <span>

namespace remap
{
/// @param[in] rings what is inside they run around counter-clockwise
/// @param[in] least area of a piece that is worth having [m2], >= 0
/// @param[in] emit  called for each piece, 3 or 4 vertices, counter-clockwise
void trapezoids(std::span<const Ring> rings, double least,
                const std::function<void(std::span<const Point>)>& emit);
} // namespace remap
