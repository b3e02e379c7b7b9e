// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The list of smoothers. A new one is one file and one name here; the
// conformance tests walk this list.
#pragma once

#include "remap/choice.h"
#include "remap/smoothing/average_area.h"
#include "remap/smoothing/average_length.h"
#include "remap/smoothing/laplace.h"
#include "remap/smoothing/optimise.h"
#include "remap/smoothing/optimise_worst.h"

namespace remap
{
using Smoothers = std::tuple<smoother::Laplace, smoother::AverageArea,
                             smoother::AverageLength, smoother::Optimise,
                             smoother::OptimiseWorst>;
using SmootherChoice = Choice<Smoothers>;
} // namespace remap
