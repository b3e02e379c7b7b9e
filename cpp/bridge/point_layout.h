// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "remap/points.h"

namespace mmale::bridge
{
/// The triangles that the points of layout `quadrature` stand for (METHOD.md,
/// step 3), by the points' places in the cell.
/// @param[in] points of a cell, 3 or 6
::remap::PointLayout point_layout(int points);
} // namespace mmale::bridge
