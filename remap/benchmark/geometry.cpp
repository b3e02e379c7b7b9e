// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How fast: cuts and overlaps of random triangles, always cut or overlapping,
// with volume and first moments; beside them CGAL's overlap with area in its
// three kernels, where CGAL is installed (headers under LGPL). And the overlay
// of 131 072 triangles (256² squares cut in two) with inner nodes moved by up
// to a quarter of a square.

#include "remap/geometry/polygon.h"
#include "remap/tests/carry.h"
#include "remap/tests/meshes.h"
#include "remap/transport/overlay.h"

#include <benchmark/benchmark.h>

#ifdef REMAP_CGAL
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_2/Triangle_2_Triangle_2.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Simple_cartesian.h>
#endif

using namespace remap;

namespace
{
constexpr std::size_t num_pairs = 1
                                  << 15; // too many to learn branches by heart

struct Pairs
{
  std::vector<Triangle> a, b;
  std::vector<HalfPlane> cuts; ///< through a point of a

  static const Pairs& get()
  {
    static const Pairs pairs;
    return pairs;
  }

private:
  Pairs()
  {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> draw(0, 1);
    const auto triangle = [&]
    {
      while (true)
      {
        Triangle t;
        for (Point& p : t)
          p = {draw(engine), draw(engine)};
        if (twice_area(t[0], t[1], t[2]) > 0.02)
          return t;
      }
    };
    while (a.size() < num_pairs)
    {
      const Triangle s = triangle(), t = triangle();
      if (not(overlap<Geometry::plane>(s, t).v > 1e-6))
        continue;
      a.push_back(s);
      b.push_back(t);
      double p = draw(engine), q = draw(engine);
      if (p + q > 1)
        p = 1 - p, q = 1 - q;
      const double angle = 2 * std::numbers::pi * draw(engine);
      cuts.push_back({{std::cos(angle), std::sin(angle)},
                      s[0] + p * (s[1] - s[0]) + q * (s[2] - s[0])});
    }
  }
};

/// Time one call a pair.
template <class F>
void each(benchmark::State& state, F&& call)
{
  const Pairs& pairs = Pairs::get();
  for (auto _ : state)
    for (std::size_t i = 0; i < num_pairs; ++i)
      benchmark::DoNotOptimize(call(pairs, i));
  state.counters["each"] = benchmark::Counter(
      num_pairs, benchmark::Counter::kIsIterationInvariantRate
                     | benchmark::Counter::kInvert);
}

template <Geometry G>
void clip_triangle(benchmark::State& state)
{
  each(state, [](const Pairs& p, std::size_t i)
       { return clipped<G>(p.a[i], p.cuts[i]); });
}

template <Geometry G>
void triangle_overlap(benchmark::State& state)
{
  each(state, [](const Pairs& p, std::size_t i)
       { return overlap<G>(p.a[i], p.b[i]); });
}

#ifdef REMAP_CGAL
/// Overlap with area; the triangles are made beforehand.
template <class Kernel>
void cgal(benchmark::State& state)
{
  using T = typename Kernel::Triangle_2;
  std::vector<T> a, b;
  const auto convert = [](const Triangle& t)
  { return T({t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}); };
  for (std::size_t i = 0; i < num_pairs; ++i)
  {
    a.push_back(convert(Pairs::get().a[i]));
    b.push_back(convert(Pairs::get().b[i]));
  }
  each(state,
       [&](const Pairs&, std::size_t i)
       {
         const auto common = CGAL::intersection(a[i], b[i]);
         if (not common)
           return 0.0;
         if (const T* t = std::get_if<T>(&*common))
           return CGAL::to_double(t->area());
         if (const auto* points =
                 std::get_if<std::vector<typename Kernel::Point_2>>(&*common))
         {
           typename Kernel::FT area = 0;
           for (std::size_t k = 2; k < points->size(); ++k)
             area += CGAL::area((*points)[0], (*points)[k - 1], (*points)[k]);
           return CGAL::to_double(area);
         }
         return 0.0;
       });
}
#endif

void overlay_cells(benchmark::State& state)
{
  constexpr int n = 256;
  const meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto to = meshes::shaken(data.x, 0.25 / n, 1);
  const auto touched = carry::touched(mesh, data.x, to);
  Overlay overlay(mesh);
  bool there = true;
  for (auto _ : state)
  {
    if (overlay.intersect<Geometry::plane>(there ? data.x : to,
                                           there ? to : data.x, touched)
        != Outcome::ok)
      state.SkipWithError("overlay failed");
    there = not there;
  }
  state.counters["cells/s"] = benchmark::Counter(
      mesh.num_cells(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["pieces"] =
      static_cast<double>(overlay.pieces().size()) / mesh.num_cells();
}
} // namespace

BENCHMARK(clip_triangle<Geometry::plane>);
BENCHMARK(clip_triangle<Geometry::axisymmetric>);
BENCHMARK(triangle_overlap<Geometry::plane>);
BENCHMARK(triangle_overlap<Geometry::axisymmetric>);
#ifdef REMAP_CGAL
BENCHMARK(cgal<CGAL::Simple_cartesian<double>>);
BENCHMARK(cgal<CGAL::Exact_predicates_inexact_constructions_kernel>);
BENCHMARK(cgal<CGAL::Exact_predicates_exact_constructions_kernel>);
#endif
BENCHMARK(overlay_cells)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
