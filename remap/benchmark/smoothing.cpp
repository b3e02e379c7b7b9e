// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: nodes a second of each smoother on 66 049 nodes (256² squares cut
// in two, inner nodes moved at random by up to a quarter of a square), over all
// of them and over a hundredth; of untangling and of a rezone in part. Beside
// gmsh: studies/smoothing.

#include "remap/smoothing/relax.h"
#include "remap/smoothing/smooth.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <benchmark/benchmark.h>

using namespace remap;

namespace
{
constexpr int n = 256;

/// The mesh, built once.
struct Bench
{
  meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  Mesh mesh = data.mesh();
  std::vector<double> shaken = meshes::shaken(data.x, 0.25 / n, 1);
  std::vector<Kind> kinds = all_kinds();

  [[nodiscard]] std::vector<Kind> all_kinds() const
  {
    std::vector<Kind> out;
    for (std::size_t i = 0; i < data.x.size(); i += 2)
      out.push_back(meshes::on_outline({data.x[i], data.x[i + 1]})
                        ? Kind::fixed
                        : Kind::free);
    return out;
  }

  static const Bench& get()
  {
    static const Bench bench;
    return bench;
  }
};

/// Calls of `smooth` from the same start, and the nodes that a second visits.
void run(benchmark::State& state, const SmoothingOptions& options,
         std::span<const double> start, std::span<const std::uint8_t> flags)
{
  const Bench& b = Bench::get();
  Smoothing smoothing(b.mesh, options, {});
  std::vector<double> x(start.begin(), start.end());
  for (auto _ : state)
  {
    state.PauseTiming();
    std::copy(start.begin(), start.end(), x.begin());
    state.ResumeTiming();
    if (smoothing.smooth(x, flags, {.kinds = b.kinds}, {}) != Outcome::ok)
      state.SkipWithError("smoothing failed");
  }
  state.counters["nodes/s"] = benchmark::Counter(
      static_cast<double>(options.sweeps)
          * static_cast<double>(std::count(flags.begin(), flags.end(), 1)),
      benchmark::Counter::kIsIterationInvariantRate);
}

/// All nodes; the argument is the number of sweeps: the first ones have the
/// long way to go.
template <class S>
void smooth(benchmark::State& state)
{
  const std::vector<std::uint8_t> flags(Bench::get().kinds.size(), 1);
  run(state, {.smoother = S{}, .sweeps = static_cast<int>(state.range(0))},
      Bench::get().shaken, flags);
}

/// A patch with a hundredth of the nodes.
void smooth_one_per_cent(benchmark::State& state)
{
  std::vector<std::uint8_t> flags(Bench::get().kinds.size(), 0);
  for (int j = 100; j < 126; ++j)
    for (int i = 100; i < 126; ++i)
      flags[static_cast<std::size_t>(j * (n + 1) + i)] = 1;
  run(state, {.sweeps = 1}, Bench::get().shaken, flags);
}

/// Inner nodes shaken by up to 0.7 squares: an eighth of the cells is inverted.
void untangle(benchmark::State& state)
{
  const std::vector<std::uint8_t> flags(Bench::get().kinds.size(), 1);
  run(state, {.sweeps = 1}, meshes::shaken(Bench::get().data.x, 0.7 / n, 1),
      flags);
}

void relax_half(benchmark::State& state)
{
  const Bench& b = Bench::get();
  auto x = b.shaken;
  for (auto _ : state)
  {
    state.PauseTiming();
    x = b.shaken;
    state.ResumeTiming();
    benchmark::DoNotOptimize(
        relax(b.mesh, Geometry::plane, 0.3, b.data.x, x, {}));
  }
  state.counters["cells/s"] = benchmark::Counter(
      b.mesh.num_cells(), benchmark::Counter::kIsIterationInvariantRate);
}
} // namespace

BENCHMARK(smooth<smoother::Laplace>)
    ->Arg(1)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smooth<smoother::AverageArea>)
    ->Arg(1)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smooth<smoother::AverageLength>)
    ->Arg(1)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smooth<smoother::Optimise>)
    ->Arg(1)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smooth<smoother::OptimiseWorst>)
    ->Arg(1)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smooth_one_per_cent)->Unit(benchmark::kMillisecond);
BENCHMARK(untangle)->Unit(benchmark::kMillisecond);
BENCHMARK(relax_half)->Unit(benchmark::kMillisecond);
