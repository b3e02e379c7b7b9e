// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: cells a second of a remap on 131 072 triangles (256² squares cut in
// two), inner nodes moved at random by up to a quarter of a square, and the
// memory bandwidth of the same machine in the same run.

#include "remap/remap.h"
#include "remap/benchmark/square.h"

#include <benchmark/benchmark.h>

using namespace remap;

namespace
{
/// Remap `components` numbers a cell, over swept regions with the fewest
/// sub-cycles that keep the bounds, or over the overlay.
void remap_cells(benchmark::State& state, const Scheme& scheme,
                 Method method = Method::swept)
{
  const Square& b = Square::get();
  const auto components = static_cast<int>(state.range(0));
  Remapper remapper(b.mesh, {.method = method,
                             .scheme = scheme,
                             .max_loss = 0.999,
                             .boundaries = std::vector(4, Boundary::closed),
                             .cell_components = components});
  std::vector<double> u(std::size_t(components) * b.mesh.num_cells());
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = 1 + 1e-6 * static_cast<double>(i);
  const Field field{.values = u, .components = components};
  Ledger ledger;
  bool there = true;
  int cycles = 0;
  for (auto _ : state)
  {
    if (remapper.remap(there ? b.data.x : b.to, there ? b.to : b.data.x,
                       {&field, 1}, {}, {}, ledger)
        != Outcome::ok)
      state.SkipWithError("remap failed");
    there = not there;
    cycles = remapper.report().cycles;
  }
  state.counters["cells/s"] = benchmark::Counter(
      b.mesh.num_cells(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["cycles"] = cycles;
}

void donor_cell(benchmark::State& state)
{
  remap_cells(state, scheme::DonorCell{});
}
void limited_linear(benchmark::State& state)
{
  remap_cells(state, scheme::LimitedLinear{});
}

void overlay_donor_cell(benchmark::State& state)
{
  remap_cells(state, scheme::DonorCell{}, Method::overlay);
}
void overlay_limited_linear(benchmark::State& state)
{
  remap_cells(state, scheme::LimitedLinear{}, Method::overlay);
}

/// Only a patch in the middle moves, so many cells in a thousand: cost follows
/// the patch.
void local(benchmark::State& state)
{
  const Square& b = Square::get();
  Remapper remapper(b.mesh, {.max_loss = 0.999,
                             .boundaries = std::vector(4, Boundary::closed)});
  const auto side = std::min(
      n - 1, static_cast<int>(std::lround(
                 n * std::sqrt(static_cast<double>(state.range(0)) / 1000))));
  auto to = b.data.x;
  for (int j = (n - side) / 2 + 1; j <= (n + side) / 2; ++j)
    for (int i = (n - side) / 2 + 1; i <= (n + side) / 2; ++i)
      for (int k = 0; k < 2; ++k)
      {
        const auto at = static_cast<std::size_t>(2 * (j * (n + 1) + i) + k);
        to[at] = b.to[at];
      }
  std::vector<double> u(b.mesh.num_cells(), 1.0);
  const Field field{.values = u};
  Ledger ledger;
  bool there = true;
  for (auto _ : state)
  {
    if (remapper.remap(there ? b.data.x : to, there ? to : b.data.x,
                       {&field, 1}, {}, {}, ledger)
        != Outcome::ok)
      state.SkipWithError("remap failed");
    there = not there;
  }
  state.counters["touched"] = remapper.report().touched_cells;
}

/// Further fields over the same regions, each a field of its own. Bytes are
/// what each must move at least: its values in and out, the volumes before and
/// after, and of each region donor, receiver and volume.
void donor_cell_fields(benchmark::State& state)
{
  const Square& b = Square::get();
  const auto number = static_cast<std::size_t>(state.range(0));
  Remapper remapper(b.mesh, {.scheme = scheme::DonorCell{},
                             .max_loss = 0.999,
                             .boundaries = std::vector(4, Boundary::closed)});
  std::vector<std::vector<double>> u(
      number, std::vector<double>(b.mesh.num_cells(), 1.0));
  std::vector<Field> fields;
  for (auto& one : u)
    fields.push_back({.values = one});
  Ledger ledger;
  bool there = true;
  for (auto _ : state)
  {
    if (remapper.remap(there ? b.data.x : b.to, there ? b.to : b.data.x, fields,
                       {}, {}, ledger)
        != Outcome::ok)
      state.SkipWithError("remap failed");
    there = not there;
  }
  const double regions = 1.5 * b.mesh.num_cells();
  state.SetBytesProcessed(static_cast<std::int64_t>(
      static_cast<double>(state.iterations()) * remapper.report().cycles
      * static_cast<double>(number)
      * (32.0 * b.mesh.num_cells() + 16 * regions)));
}

void nodal(benchmark::State& state)
{
  const Square& b = Square::get();
  Remapper remapper(b.mesh, {.max_loss = 0.999,
                             .boundaries = std::vector(4, Boundary::closed),
                             .nodal_components = 3});
  std::vector<double> w(std::size_t(3) * b.mesh.num_nodes(), 1.0);
  const Field field{.values = w, .components = 3, .group = 3};
  Ledger ledger;
  bool there = true;
  for (auto _ : state)
  {
    if (remapper.remap(there ? b.data.x : b.to, there ? b.to : b.data.x, {},
                       {&field, 1}, {}, ledger)
        != Outcome::ok)
      state.SkipWithError("remap failed");
    there = not there;
  }
  state.counters["nodes/s"] = benchmark::Counter(
      b.mesh.num_nodes(), benchmark::Counter::kIsIterationInvariantRate);
}

/// a = b + s c over arrays far larger than the caches.
void bandwidth(benchmark::State& state)
{
  const std::size_t size = 1 << 24;
  std::vector<double> a(size, 0.0), b(size, 1.0), c(size, 2.0);
  for (auto _ : state)
  {
    for (std::size_t i = 0; i < size; ++i)
      a[i] = b[i] + 3 * c[i];
    benchmark::DoNotOptimize(a.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * 3
                                                    * size * sizeof(double)));
}
} // namespace

BENCHMARK(bandwidth)->Unit(benchmark::kMillisecond);
BENCHMARK(donor_cell_fields)
    ->Arg(1)
    ->Arg(9)
    ->Arg(17)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(donor_cell)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK(limited_linear)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK(overlay_donor_cell)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(overlay_limited_linear)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(local)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(
    benchmark::kMillisecond);
BENCHMARK(nodal)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
