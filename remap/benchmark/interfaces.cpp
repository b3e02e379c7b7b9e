// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: reconstruction of all mixed cells of a circle, R = 0.25 about
// (0.51, 0.507), on N² squares cut by alternating diagonals; a mixed cell in
// `us`. `symdiff` is the area on the wrong side. Then the same in axisymmetry,
// cells of three and four materials, and moment of fluid without its driver.

#include "remap/interfaces/interfaces.h"
#include "remap/tests/fuzz/cells.h"
#include "remap/tests/partitions.h"
#include "remap/tests/shapes.h"

#include <benchmark/benchmark.h>

using namespace remap;

namespace
{
/// The first square is cut like /.
meshes::Data squares(int n)
{
  return meshes::rectangle(n + 1, n, meshes::Diagonal::crossed, -1.0 / n, 0,
                           1 + 1.0 / n, 1);
}

struct Circle
{
  explicit Circle(int n)
      : data(squares(n)), mesh(data.mesh()),
        body(shapes::disc({0.51, 0.507}, 0.25)),
        materials(shapes::lay(mesh, data.x, {body}))
  {
  }

  [[nodiscard]] double symmetric_difference(const Interfaces& found) const
  {
    double sum = 0;
    for (std::int32_t row = 0;
         row < static_cast<std::int32_t>(materials.mixed().size()); ++row)
      split(Polygon<3>(
                partitions::triangle_of(mesh, data.x, materials.mixed()[row])),
            found.partition(row),
            [&](int part, const Piece& p)
            {
              shapes::Outline o;
              for (int i = 0; i < p.size; ++i)
                o.push(p[i]);
              const double in = body(o, o[0]).v;
              sum += materials.parts(row)[part].material == 1
                         ? moments<Geometry::plane>(p).v - in
                         : in;
            });
    return sum;
  }

  meshes::Data data;
  Mesh mesh;
  shapes::Body body;
  Materials materials;
};

void count(benchmark::State& state, double cells)
{
  state.counters["us"] = benchmark::Counter(
      cells * 1e-6, benchmark::Counter::kIsIterationInvariantRate
                        | benchmark::Counter::kInvert);
}

template <class Method, Geometry G = Geometry::plane>
void circle(benchmark::State& state)
{
  const Circle circle(static_cast<int>(state.range(0)));
  Interfaces interfaces(circle.mesh, {.geometry = G, .method = Method{}});
  const Host host;
  for (auto _ : state)
    interfaces.reconstruct(circle.data.x, circle.materials, host);
  count(state, static_cast<double>(circle.materials.mixed().size()));
  if (G == Geometry::plane)
    state.counters["symdiff"] = circle.symmetric_difference(interfaces);
}

/// Moment of fluid of one cell after the other, cells and moments at hand.
void kernel_moment_of_fluid(benchmark::State& state)
{
  const Circle circle(128);
  struct Problem
  {
    Triangle t;
    Target in, out;
  };
  std::vector<Problem> problems;
  for (std::int32_t row = 0;
       row < static_cast<std::int32_t>(circle.materials.mixed().size()); ++row)
  {
    const auto parts = circle.materials.parts(row);
    problems.push_back({partitions::triangle_of(circle.mesh, circle.data.x,
                                                circle.materials.mixed()[row]),
                        {parts[0].fraction, parts[0].centroid},
                        {parts[1].fraction, parts[1].centroid}});
  }
  for (auto _ : state)
    for (const Problem& p : problems)
      benchmark::DoNotOptimize(best_cut(p.t, p.in, p.out));
  count(state, static_cast<double>(problems.size()));
}

/// Cells of the fuzz: kind, number of materials.
template <Geometry G>
void cells_moment_of_fluid(benchmark::State& state)
{
  std::vector<fuzz::MixedCell> cells;
  for (std::uint64_t k = 0; cells.size() < 200; ++k)
    if (const auto cell = fuzz::mixed_cell<G>(k);
        cell.kind == state.range(0)
        and cell.parts.size() == static_cast<std::size_t>(state.range(1)))
      cells.push_back(cell);
  const reconstruction::MomentOfFluid method;
  Partition out;
  for (auto _ : state)
    for (const fuzz::MixedCell& cell : cells)
      benchmark::DoNotOptimize(method.solve<G>(cell.t, cell.parts, out));
  count(state, static_cast<double>(cells.size()));
  state.SetLabel(fuzz::cell_kinds[state.range(0)]);
}
} // namespace

BENCHMARK(circle<reconstruction::Youngs>)->Name("youngs")->Arg(128)->Arg(512);
BENCHMARK(circle<reconstruction::Swartz>)->Name("swartz")->Arg(128);
BENCHMARK(circle<reconstruction::Lvira>)->Name("lvira")->Arg(128)->Arg(512);
BENCHMARK(circle<reconstruction::MomentOfFluid>)
    ->Name("moment_of_fluid")
    ->Arg(128)
    ->Arg(512);
BENCHMARK(kernel_moment_of_fluid);
BENCHMARK(circle<reconstruction::Lvira, Geometry::axisymmetric>)
    ->Name("lvira_axisymmetric")
    ->Arg(128);
BENCHMARK(circle<reconstruction::MomentOfFluid, Geometry::axisymmetric>)
    ->Name("moment_of_fluid_axisymmetric")
    ->Arg(128);
BENCHMARK(cells_moment_of_fluid<Geometry::plane>)
    ->Name("moment_of_fluid_cells")
    ->Args({0, 3})
    ->Args({0, 4})
    ->Args({0, 5})
    ->Args({3, 3})
    ->Args({4, 2});
BENCHMARK(cells_moment_of_fluid<Geometry::axisymmetric>)
    ->Name("moment_of_fluid_cells_axisymmetric")
    ->Args({0, 2})
    ->Args({0, 3});
BENCHMARK_MAIN();
