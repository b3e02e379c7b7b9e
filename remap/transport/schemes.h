// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the transport schemes. A swept region carries its donor's mean
// (order 1), or the donor's least-squares linear function, limited, taken at
// the region's centroid (order 2). A scheme is a name, an order and a limiter.
#pragma once

#include "remap/transport/limiter.h"

#include <string_view>

namespace remap::scheme
{
/// Order 1, the most diffusive, bounded.
struct DonorCell
{
  static constexpr std::string_view name = "donor_cell";
  static constexpr bool linear = false; ///< uses gradients?
  static constexpr bool bounded = true; ///< keeps bounds?
  using limiter = remap::limiter::none;
};

/// What the schemes of order 2 share.
template <class L, bool keeps_bounds = true>
struct Linear2
{
  static constexpr bool linear = true;
  static constexpr bool bounded = keeps_bounds;
  using limiter = L;
};

/// The sharpest limiter that keeps the neighbours' bounds.
struct LimitedLinear : Linear2<limiter::places>
{
  static constexpr std::string_view name = "limited_linear";
};

/// As LimitedLinear, but it does not clip smooth extrema.
struct SmoothExtrema : Linear2<limiter::smooth>
{
  static constexpr std::string_view name = "smooth_extrema";
};

struct BarthJespersen : Linear2<limiter::barth_jespersen>
{
  static constexpr std::string_view name = "barth_jespersen";
};

struct Venkatakrishnan : Linear2<limiter::venkatakrishnan>
{
  static constexpr std::string_view name = "venkatakrishnan";
};

struct VanLeer : Linear2<limiter::van_leer>
{
  static constexpr std::string_view name = "van_leer";
};

/// The most diffusive of order 2.
struct Minmod : Linear2<limiter::minmod>
{
  static constexpr std::string_view name = "minmod";
};

/// Without a limiter: exact for linear fields, oscillates at jumps.
struct Linear : Linear2<limiter::none, false>
{
  static constexpr std::string_view name = "linear";
};
} // namespace remap::scheme
