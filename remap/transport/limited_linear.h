// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3, order 2: least-squares gradient over the neighbours, limited,
// value at the centroid of the swept region.
#pragma once

#include "remap/transport/limiter.h"

#include <string_view>

namespace remap::scheme
{
struct LimitedLinear
{
  static constexpr std::string_view name = "limited_linear";
  static constexpr bool linear = true;
  static constexpr bool bounded = true;
  using limiter = remap::limiter::barth_jespersen;
};
} // namespace remap::scheme
