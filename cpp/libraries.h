// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/parameter.h"

namespace mmale
{
/// Laws, smoothers, transport schemes and fields that a scene may name, as
/// the libraries of this program list them.
scene::Libraries libraries();
} // namespace mmale
