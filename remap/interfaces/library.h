// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The list of reconstructions. A new one is one file and one name here; the
// conformance tests walk this list.
#pragma once

#include "remap/choice.h"
#include "remap/interfaces/moment_of_fluid.h"
#include "remap/interfaces/youngs.h"

namespace remap
{
using Reconstructions =
    std::tuple<reconstruction::MomentOfFluid, reconstruction::Youngs>;
using Reconstruction = Choice<Reconstructions>;
} // namespace remap
