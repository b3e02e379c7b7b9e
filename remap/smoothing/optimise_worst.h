// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.1, optimisation of the worst cells: minimise Σ (|T|²/(2 det T))⁸
// over the patch, as `optimise` does with the first power. The worst cell gets
// better than there, the mean a little worse.
#pragma once

#include "remap/smoothing/optimise.h"

namespace remap::smoother
{
struct OptimiseWorst : Newton<8>
{
  static constexpr std::string_view name = "optimise_worst";
};
} // namespace remap::smoother
