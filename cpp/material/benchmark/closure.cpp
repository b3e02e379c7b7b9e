// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What a mixed cell of two shares costs over a pure one: 4096 cells of one
// pair of materials, each asked once with its tangent. `cell` is seconds;
// `pure` is the mean of its two materials asked alone.

#include "material/closure.h"

#include <benchmark/benchmark.h>
#include <random>

using namespace mmale;
using namespace mmale::material;

namespace
{
constexpr int num_cells = 4096;
constexpr double dt = 1e-3;

AnyLaw law(int which)
{
  switch (which)
  {
  case 0:
    return Elastic{2.06e11, 0.3, 7.8e3};
  case 1:
    return Newtonian{1, 2.2e9, 1e3};
  case 2:
    return J2{2.6e6, 0.3, 2e4, 0, 1e3};
  case 3:
    return make_law({.law = "mohr_coulomb",
                     .parameters = {{"E", 2e7},
                                    {"nu", 0.27},
                                    {"cohesion", 4e3},
                                    {"friction_deg", 31},
                                    {"dilation_deg", 9},
                                    {"density", 1.6e3}}});
  default:
    return make_law(
        {.law = "hypoplastic",
         .parameters = {{"grain_density", 2650}, {"void_ratio", 0.7}},
         .texts = {{"sand", "hochstetten"}, {"intergranular_strain", "off"}}});
  }
}

/// What cells are asked, and room for the history of two shares.
struct Cells
{
  std::array<AnyLaw, 2> laws;
  std::array<std::array<double, 5>, 2> start{}, end{};
  std::vector<Voigt> de;
  std::vector<double> fraction, p;

  Cells(int first, int second) : laws{law(first), law(second)}
  {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (int k = 0; k < 2; ++k)
      std::visit([&](const auto& l)
                 { l.begin({.p = 1e5}, history(start[k], k)); }, laws[k]);
    for (int i = 0; i < num_cells; ++i)
    {
      const double x = draw(engine), y = draw(engine);
      de.push_back(1e-4 * Voigt(x, y, -x - y, 2 * draw(engine)));
      p.push_back(1e5 * (1 + 0.01 * draw(engine)));
      fraction.push_back(0.5 + 0.4 * draw(engine));
    }
  }

  std::span<double> history(std::array<double, 5>& q, int k) const
  {
    return {q.data(), static_cast<std::size_t>(num_history(laws[k]))};
  }
  Share share(int k, double part, std::span<double> from, std::span<double> to)
  {
    return {.law = &laws[k],
            .fraction = part,
            .start = {Voigt::Zero(), 1e5, from},
            .q = to,
            .answer = {}};
  }
};

void report(benchmark::State& state, int cells)
{
  state.counters["cell"] = benchmark::Counter(
      static_cast<double>(cells) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Both materials by themselves, half a cell each.
void pure(benchmark::State& state)
{
  Cells c(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (int k = 0; k < 2; ++k)
    c.history(c.end[k], k);
  const std::array from{c.history(c.start[0], 0), c.history(c.start[1], 1)},
      to{c.history(c.end[0], 0), c.history(c.end[1], 1)};
  for (auto _ : state)
    for (int i = 0; i < num_cells; ++i)
    {
      const int k = i % 2;
      Driven answer;
      const Outcome outcome = std::visit(
          [&](const auto& l)
          {
            return drive(l, {Voigt::Zero(), 1e5, from[k]}, c.de[i], c.p[i], dt,
                         std::nan(""), TangentKind::consistent, to[k], answer);
          },
          c.laws[k]);
      if (outcome != Outcome::ok)
        state.SkipWithError("a step was refused");
      benchmark::DoNotOptimize(answer);
    }
  report(state, num_cells);
}

template <class C>
void mixed(benchmark::State& state)
{
  Cells c(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const std::array from{c.history(c.start[0], 0), c.history(c.start[1], 1)},
      to{c.history(c.end[0], 0), c.history(c.end[1], 1)};
  const Interface interface{{0.6, 0.8}, 1, 0, 1};
  for (auto _ : state)
    for (int i = 0; i < num_cells; ++i)
    {
      std::array shares{c.share(0, c.fraction[i], from[0], to[0]),
                        c.share(1, 1 - c.fraction[i], from[1], to[1])};
      Mixed answer;
      if (C{}(shares, c.de[i], c.p[i], dt, TangentKind::consistent, interface,
              answer)
          != Outcome::ok)
        state.SkipWithError("a step was refused");
      benchmark::DoNotOptimize(answer);
    }
  report(state, num_cells);
}

/// Elastic and liquid, two metals, steel and frictional, steel and hypoplastic
/// sand.
void pairs(benchmark::internal::Benchmark* b)
{
  b->Args({0, 1})->Args({0, 2})->Args({0, 3})->Args({0, 4});
}
} // namespace

BENCHMARK(pure)->Apply(pairs);
BENCHMARK(mixed<EqualPressure>)->Apply(pairs);
BENCHMARK(mixed<EqualStrain>)->Apply(pairs);
BENCHMARK(mixed<Laminate>)->Apply(pairs);
