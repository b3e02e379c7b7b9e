// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "remap/materials/materials.h"

/// Which materials cells hold, as the remap library keeps it.
namespace mmale::bridge
{
using ::remap::Materials;
using ::remap::Part;
} // namespace mmale::bridge
