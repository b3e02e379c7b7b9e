// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace remap
{
/// Numbers from 0 to n − 1 in the order of key(number), equal keys as they
/// were.
template <class Key>
[[nodiscard]] std::vector<std::size_t> order_by(std::size_t n, const Key& key)
{
  std::vector<std::size_t> out(n);
  std::iota(out.begin(), out.end(), std::size_t(0));
  std::ranges::sort(out, {},
                    [&key](std::size_t i) { return std::pair(key(i), i); });
  return out;
}
} // namespace remap
