// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How much materials cost: the remap of remap.cpp with one field, of cells, or
// of two materials in strips, so that some part in a thousand of the cells is
// mixed.

#include "remap/benchmark/square.h"
#include "remap/remap.h"

#include <benchmark/benchmark.h>

using namespace remap;

namespace
{
/// Strips of two materials across the square, with so many borders.
Materials strips(const Square& b, int borders)
{
  const Point normal = {0.8, 0.6};
  const double breadth = 1.4 / (borders + 1);
  Materials out(b.mesh.num_cells(), 2);
  for (std::int32_t c = 0; c < b.mesh.num_cells(); ++c)
  {
    const auto& v = b.mesh.cell(c);
    const Triangle t = {point(b.data.x, v[0]), point(b.data.x, v[1]),
                        point(b.data.x, v[2])};
    double lo = dot(normal, t[0]), hi = lo;
    for (const Point& p : t)
    {
      lo = std::min(lo, dot(normal, p));
      hi = std::max(hi, dot(normal, p));
    }
    const int strip = std::min(borders, static_cast<int>(lo / breadth));
    const double border = (strip + 1) * breadth;
    out.set_pure(c, strip % 2);
    if (strip == borders or hi <= border)
      continue;
    const Moments all = moments<Geometry::plane>(Polygon<3>(t));
    const Moments in =
        clipped<Geometry::plane>(t, HalfPlane::below(normal, border));
    const Moments rest = all - in;
    Part parts[2] = {{strip % 2, in.v / all.v, in.centroid()},
                     {1 - strip % 2, rest.v / all.v, rest.centroid()}};
    if (not(parts[0].fraction > 1e-12 and parts[1].fraction > 1e-12))
      continue;
    if (strip % 2 == 1)
      std::swap(parts[0], parts[1]);
    out.add_row(c, parts);
  }
  return out;
}

void materials(benchmark::State& state, int borders, Method method)
{
  const Square& b = Square::get();
  const bool single = borders < 0;
  Options options{.method = method,
                  .max_loss = 0.999,
                  .boundaries = std::vector(4, Boundary::closed)};
  if (not single)
    options.materials.number = 2;
  Remapper remapper(b.mesh, options);
  Materials m = strips(b, std::max(borders, 0));
  std::vector<double> u(m.num_slots());
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = 1 + 1e-6 * static_cast<double>(i);
  const Field in_cells{.values = u};
  const MaterialField in_materials{.values = u};
  Fields fields;
  if (single)
    fields.cells = {&in_cells, 1};
  else
  {
    fields.materials = &m;
    fields.of_materials = {&in_materials, 1};
  }
  Ledger ledger;
  bool there = true;
  for (auto _ : state)
  {
    if (remapper.remap(there ? b.data.x : b.to, there ? b.to : b.data.x, fields,
                       {}, ledger)
        != Outcome::ok)
      state.SkipWithError("remap failed");
    there = not there;
  }
  state.counters["cells/s"] = benchmark::Counter(
      b.mesh.num_cells(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["mixed"] =
      static_cast<double>(m.mixed().size()) / b.mesh.num_cells();
}

void swept(benchmark::State& state)
{
  materials(state, static_cast<int>(state.range(0)), Method::swept);
}
void overlaid(benchmark::State& state)
{
  materials(state, static_cast<int>(state.range(0)), Method::overlay);
}
} // namespace

// Borders; -1: a remap that knows of no materials.
BENCHMARK(swept)->Arg(-1)->Arg(0)->Arg(3)->Arg(28)->Unit(
    benchmark::kMillisecond);
BENCHMARK(overlaid)->Arg(-1)->Arg(0)->Arg(3)->Arg(28)->Unit(
    benchmark::kMillisecond);
