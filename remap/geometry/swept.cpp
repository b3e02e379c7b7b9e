// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The one loop of the library that is bound by arithmetic: it is compiled for
// wider vectors too, and the machine's own is chosen when the program starts.
// This file alone has flags that say: no NaN, no signed zero, no traps (see
// CMakeLists.txt); coordinates are checked before. No fused operations: all
// machines give the same digits.

#include "remap/geometry/swept.h"

#if defined(__x86_64__) and defined(__GNUC__) and not defined(__clang__)       \
    and not defined(__SANITIZE_ADDRESS__) and not defined(__SANITIZE_THREAD__)
#define REMAP_FOR_EACH_MACHINE __attribute__((target_clones("avx2", "default")))
#else
#define REMAP_FOR_EACH_MACHINE
#endif

namespace remap
{
namespace
{
template <Geometry G>
[[gnu::always_inline]] inline void loop(SweptBatch& b)
{
  for (int k = 0; k < b.count; ++k)
  {
    double v[2], x[2], y[2];
    detail::swept_parts<G>(b.p0x[k], b.p0y[k], b.q0x[k], b.q0y[k], b.p1x[k],
                           b.p1y[k], b.q1x[k], b.q1y[k], v, x, y);
    b.v[0][k] = v[0], b.v[1][k] = v[1];
    b.x[0][k] = x[0], b.x[1][k] = x[1];
    b.y[0][k] = y[0], b.y[1][k] = y[1];
  }
}

REMAP_FOR_EACH_MACHINE void plane(SweptBatch& batch)
{
  loop<Geometry::plane>(batch);
}

REMAP_FOR_EACH_MACHINE void axisymmetric(SweptBatch& batch)
{
  loop<Geometry::axisymmetric>(batch);
}
} // namespace

template <>
void SweptBatch::sweep<Geometry::plane>()
{
  plane(*this);
}

template <>
void SweptBatch::sweep<Geometry::axisymmetric>()
{
  axisymmetric(*this);
}
} // namespace remap
