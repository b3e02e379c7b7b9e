// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Sorting of a handful: no recursion, no allocation, equals stay in order.
#pragma once

#include <utility>

namespace remap
{
template <class T, class Less>
void sort_few(T* values, int count, Less&& less)
{
  for (int i = 1; i < count; ++i)
    for (int k = i; k > 0 and less(values[k], values[k - 1]); --k)
      std::swap(values[k], values[k - 1]);
}
} // namespace remap
