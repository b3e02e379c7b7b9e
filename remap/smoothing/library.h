// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The list of smoothers. A new one is one file and one name here; the
// conformance tests walk this list.
#pragma once

#include "remap/choice.h"
#include "remap/smoothing/average.h"
#include "remap/smoothing/optimise.h"

namespace remap
{
using Smoothers = std::tuple<smoother::Average, smoother::Optimise>;
using SmootherChoice = Choice<Smoothers>;
} // namespace remap
