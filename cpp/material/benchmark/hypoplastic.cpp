// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: updates of hypoplastic sand over a batch of 4096 points, at states
// that random strains of 2e-3 led to from 10 to 1000 kPa, for random strains of
// a given size. `point` and `substep` are seconds; `substeps` of a point.

#include "material/drive.h"
#include "material/library.h"

#include <benchmark/benchmark.h>
#include <random>

using namespace mmale;
using namespace mmale::material;

namespace
{
struct Batch
{
  Hypoplastic law;
  std::vector<Voigt> s;
  std::vector<double> p;
  std::vector<std::array<double, 5>> q;
  std::vector<Voigt> way; ///< deviators of unit size, engineering shear
  std::size_t num_history;

  explicit Batch(bool grains)
      : law(std::get<Hypoplastic>(make_law(
            {.law = "hypoplastic",
             .parameters = {{"grain_density", 2650}, {"void_ratio", 0.7}},
             .texts = {{"sand", "hochstetten"},
                       {"intergranular_strain", grains ? "on" : "off"}}}))),
        num_history(grains ? 5 : 1)
  {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> draw(-1, 1);
    const auto deviator = [&]
    {
      const double x = draw(engine), y = draw(engine);
      const Voigt d(x, y, -x - y, 2 * draw(engine));
      return Voigt(d / norm(d));
    };
    while (p.size() < 4096)
    {
      const double start = 1e5 * std::pow(10, draw(engine));
      std::array<double, 5> history{}, next;
      law.begin({.p = start}, {history.data(), num_history});
      history[0] += 0.1 * draw(engine);
      next = history;
      Response a;
      if (law.update({Voigt::Zero(), start, {history.data(), num_history}},
                     {2e-3 * deviator(), 5e-4 * draw(engine), 1},
                     TangentKind::robust, {next.data(), num_history}, a)
          != Outcome::ok)
        continue;
      s.push_back(a.s);
      p.push_back(a.p);
      q.push_back(next);
      way.push_back(deviator());
    }
  }
};

void update(benchmark::State& state, bool grains, TangentKind kind)
{
  static const Batch batches[] = {Batch(false), Batch(true)};
  const Batch& b = batches[grains];
  const double strain = 1e-6 * static_cast<double>(state.range(0));
  Effort effort;
  for (auto _ : state)
    for (std::size_t i = 0; i < b.p.size(); ++i)
    {
      std::array<double, 5> next = b.q[i];
      Response a;
      if (b.law.update({b.s[i], b.p[i], {b.q[i].data(), b.num_history}},
                       {strain * b.way[i], 0.1 * strain, 1}, kind,
                       {next.data(), b.num_history}, a)
          != Outcome::ok)
        state.SkipWithError("a step was refused");
      effort += a.effort;
      benchmark::DoNotOptimize(a);
    }
  const auto points = static_cast<double>(
      b.p.size() * static_cast<std::size_t>(state.iterations()));
  const auto each = [](double n)
  {
    return benchmark::Counter(n, benchmark::Counter::kIsRate
                                     | benchmark::Counter::kInvert);
  };
  state.counters["point"] = each(points);
  state.counters["substep"] = each(static_cast<double>(effort.substeps));
  state.counters["substeps"] = static_cast<double>(effort.substeps) / points;
  state.counters["rejected"] = static_cast<double>(effort.rejected) / points;
}

/// As the solver asks: by pressure, that of a hundredth of a stiff response.
void driven(benchmark::State& state, bool grains)
{
  const Batch b(grains);
  const double strain = 1e-6 * static_cast<double>(state.range(0));
  Effort effort;
  for (auto _ : state)
    for (std::size_t i = 0; i < b.p.size(); ++i)
    {
      std::array<double, 5> next = b.q[i];
      Driven a;
      if (drive(b.law, {b.s[i], b.p[i], {b.q[i].data(), b.num_history}},
                strain * b.way[i], 1.01 * b.p[i], 1, std::nan(""),
                TangentKind::consistent, {next.data(), b.num_history}, a)
          != Outcome::ok)
        state.SkipWithError("a step was refused");
      effort += a.effort;
      benchmark::DoNotOptimize(a);
    }
  const auto points = static_cast<double>(
      b.p.size() * static_cast<std::size_t>(state.iterations()));
  state.counters["point"] = benchmark::Counter(
      points, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["substeps"] = static_cast<double>(effort.substeps) / points;
}
} // namespace

BENCHMARK_CAPTURE(update, basic, false, TangentKind::robust)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(update, basic_tangent, false, TangentKind::consistent)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(update, grains, true, TangentKind::robust)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(update, grains_tangent, true, TangentKind::consistent)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(driven, basic, false)->Arg(100);
BENCHMARK_CAPTURE(driven, grains, true)->Arg(100);
BENCHMARK_MAIN();
