// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3, order 1: a swept region carries the mean value of its donor.
#pragma once

#include "remap/transport/limiter.h"

#include <string_view>

namespace remap::scheme
{
struct DonorCell
{
  static constexpr std::string_view name = "donor_cell";
  static constexpr bool linear = false; ///< uses gradients?
  static constexpr bool bounded = true; ///< keeps bounds?
  using limiter = remap::limiter::none;
};
} // namespace remap::scheme
