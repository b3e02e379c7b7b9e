// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: volumes and centroids of materials carried to a moved mesh, on
// 131 072 triangles (256² squares cut in two) with inner nodes moved by up to a
// quarter of a square, against the number of mixed cells: discs of growing
// radius, and many of them.

#include "remap/benchmark/square.h"
#include "remap/interfaces/interfaces.h"
#include "remap/materials/volume_transport.h"
#include "remap/tests/shapes.h"

#include <benchmark/benchmark.h>

using namespace remap;

namespace
{
/// Discs in a row of squares.
/// @param[in] state arguments: discs along a side; radius in parts of 1000 of
/// their square
void carry_volumes(benchmark::State& state)
{
  const Square& b = Square::get();
  const auto side = static_cast<int>(state.range(0));
  const double r = 1e-3 * static_cast<double>(state.range(1)) / side;
  const Materials one = [&]
  {
    const auto at = [side](int i) { return (i + 0.5) / side; };
    return shapes::lay(
        b.mesh, b.data.x,
        {[=](const shapes::Outline& cell, Point about)
         {
           const auto place = [side](double v)
           { return std::min(side - 1, static_cast<int>(v * side)); };
           const Point centre{at(place(cell[0].x)), at(place(cell[0].y))};
           return shapes::disc(centre, r)(cell, about);
         }});
  }();
  Interfaces interfaces(b.mesh, {});
  interfaces.reconstruct(b.data.x, one, {});
  VolumeTransport transport(b.mesh, {});
  MaterialLedger ledger;
  for (auto _ : state)
  {
    state.PauseTiming();
    Materials now = one;
    state.ResumeTiming();
    if (transport.carry(b.data.x, b.to, {}, interfaces.partitions(), now, {},
                        ledger)
        != Outcome::ok)
      state.SkipWithError("carry failed");
  }
  const auto mixed = static_cast<double>(one.mixed().size());
  state.counters["mixed"] = mixed;
  state.counters["zone"] = transport.report().zone;
  state.counters["each"] =
      benchmark::Counter(mixed, benchmark::Counter::kIsIterationInvariantRate
                                    | benchmark::Counter::kInvert);
}
} // namespace

BENCHMARK(carry_volumes)
    ->Args({1, 20})
    ->Args({1, 80})
    ->Args({1, 320})
    ->Args({4, 320})
    ->Args({16, 320})
    ->Unit(benchmark::kMillisecond);
