// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3, order 2 without a limiter: exact for linear fields, oscillates at
// jumps. For smooth fields and for tests.
#pragma once

#include "remap/transport/limiter.h"

#include <string_view>

namespace remap::scheme
{
struct Linear
{
  static constexpr std::string_view name = "linear";
  static constexpr bool linear = true;
  static constexpr bool bounded = false;
  using limiter = remap::limiter::none;
};
} // namespace remap::scheme
