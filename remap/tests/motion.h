// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Bodies in motion on a mesh that stays, and back where they were at the end:
// for tests and studies of interfaces. What differs from the start is the error
// of the steps.
#pragma once

#include "remap/remap.h"
#include "remap/tests/eulerian.h"
#include "remap/tests/meshes.h"
#include "remap/tests/shapes.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>

namespace motion
{
using namespace remap;

/// What moves, and how.
struct Case
{
  std::vector<shapes::Body> bodies;
  eulerian::Flow flow;
  double time = 1;
  double fastest = 1; ///< velocity in the square
  bool open = false;  ///< does the flow cross the outline?
};

/// LeVeque's vortex, one turn of Zalesak's disc or of a whole one, a disc that
/// goes along a straight line and back.
///
/// @param[in] name vortex, quarters (the vortex with a disc of four materials),
/// zalesak, turn (a disc), shift
/// @param[in] time period of a vortex and of `shift`
inline Case find_case(const std::string& name, double time)
{
  const Point at{0.5, 0.75}, middle{0.5, 0.5};
  constexpr double r = 0.15;
  const double corner = std::numbers::pi * std::sqrt(2.0);
  if (name == "vortex")
    return {{shapes::disc(at, r)}, eulerian::vortex(time), time, 1};
  if (name == "quarters")
    return {shapes::quarters(at, r), eulerian::vortex(time), time, 1};
  if (name == "zalesak")
    return {{shapes::zalesak()}, eulerian::rotation(middle), 1, corner, true};
  if (name == "turn")
    return {{shapes::disc(at, r)}, eulerian::rotation(middle), 1, corner, true};
  // To (0.75, 0.53) and back.
  auto there = eulerian::translation({1, 0.37});
  there.pace = [time](double t)
  { return std::cos(std::numbers::pi * t / time); };
  return {{shapes::disc({0.75 - time / std::numbers::pi,
                         0.53 - 0.37 * time / std::numbers::pi},
                        r)},
          there,
          time,
          std::hypot(1, 0.37),
          true};
}

/// What came of a run.
struct Result
{
  Outcome outcome = Outcome::ok;
  std::int32_t cells = 0;
  int steps = 0;
  double error = 0;    ///< Σ |f − f at the start| V of the bodies, halved if
                       ///< there are several
  double relative = 0; ///< over their volume
  double drift = 0;  ///< largest change of a material's volume but what passed
                     ///< the outline
  double beyond = 0; ///< farthest fraction out of [0, 1]
  double mixed = 0;  ///< mixed cells, mean over steps
  double spread = 0; ///< volume of the cells at the end that hold more than
                     ///< 1e-6 of a body and of the rest, over the start's
  int pieces = 0;    ///< bodies at half time, by cells with more than 0.05
  std::int64_t swept = 0, kept = 0; ///< slivers
  eulerian::Seconds seconds;
};

/// How many bodies the cells with more than 0.05 of material 1 make.
inline int count_bodies(const Mesh& mesh, const Materials& materials)
{
  std::vector<std::uint8_t> left(mesh.num_cells());
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    left[c] = materials.fraction(c, 1) > 0.05;
  int count = 0;
  std::vector<std::int32_t> queue;
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    if (left[c] == 0)
      continue;
    ++count;
    left[c] = 0;
    queue.assign(1, c);
    while (not queue.empty())
    {
      const std::int32_t d = queue.back();
      queue.pop_back();
      for (std::int32_t e : mesh.cell_cells()[d])
        if (left[e] != 0)
        {
          left[e] = 0;
          queue.push_back(e);
        }
    }
  }
  return count;
}

/// Volume of cells with more than 1e-6 of a body and of the rest.
inline double spread(std::span<const double> volumes,
                     const std::function<double(std::int32_t)>& fraction)
{
  double sum = 0;
  for (std::size_t c = 0; c < volumes.size(); ++c)
    if (const double f = fraction(static_cast<std::int32_t>(c));
        f > 1e-6 and f < 1 - 1e-6)
      sum += volumes[c];
  return sum;
}

/// How a run goes.
struct Setting
{
  int squares = 32;
  meshes::Diagonal diagonal = meshes::Diagonal::crossed;
  double courant = 0.5; ///< fastest velocity · step · squares along a side
  Reconstruction method = reconstruction::MomentOfFluid{};
  bool bend = true;
  double sliver = 1e-10;
  double height = 1; ///< of the rectangle, as broad as 1
  /// Called at half time and at the end, with interfaces ready.
  std::function<void(bool end, const eulerian::Run&)> look = {};
};

inline int steps_of(const Case& what, const Setting& how)
{
  const double steps = what.time * what.fastest * how.squares / how.courant;
  return 2 * std::max(1, static_cast<int>(std::ceil(steps / 2 - 1e-9)));
}

inline Result run(const Case& what, const Setting& how)
{
  const auto data = meshes::rectangle(how.squares, how.squares, how.diagonal, 0,
                                      0, 1, how.height);
  const Mesh mesh = data.mesh();
  const Materials start = shapes::lay(mesh, data.x, what.bodies);
  eulerian::Options options{.interfaces = {.method = how.method},
                            .volumes = {.sliver = how.sliver},
                            .bend = how.bend};
  if (what.open)
  {
    options.volumes.boundaries = std::vector(4, Boundary::open);
    options.volumes.beyond = {0, 0, 0, 0};
  }
  eulerian::Run run(mesh, data.x, start, options);
  Result out;
  out.cells = mesh.num_cells();
  out.steps = steps_of(what, how);
  const int num = start.num_materials();
  for (int k = 0; k < out.steps and out.outcome == Outcome::ok; ++k)
  {
    out.mixed += static_cast<double>(run.materials.mixed().size()) / out.steps;
    out.outcome =
        run.step(what.flow, k * what.time / out.steps, what.time / out.steps);
    out.swept += run.transport.report().slivers_swept;
    out.kept += run.transport.report().slivers_kept;
    const bool end = k + 1 == out.steps;
    if (2 * (k + 1) == out.steps)
      out.pieces = count_bodies(mesh, run.materials);
    if (how.look and (end or 2 * (k + 1) == out.steps))
    {
      run.interfaces.reconstruct(data.x, run.materials, {});
      how.look(end, run);
    }
  }
  double whole = 0;
  for (int k = 0; k < num; ++k)
  {
    const double before =
        eulerian::volume(mesh, Geometry::plane, data.x, start, k);
    const double now =
        eulerian::volume(mesh, Geometry::plane, data.x, run.materials, k);
    const double passed =
        run.ledger.volume.empty() ? 0 : net(run.ledger.volume[k]);
    out.drift = std::max(out.drift, std::abs(now - before - passed));
    whole += k > 0 ? before : 0;
    if (num == 2 ? k == 1 : true)
      out.error += eulerian::error(mesh, data.x, run.materials, start, k)
                   / (num == 2 ? 1 : 2);
  }
  out.relative = out.error / whole;
  for (std::int32_t c : run.materials.mixed())
    for (const Part& p : run.materials.parts(run.materials.row(c)))
      out.beyond = std::max({out.beyond, -p.fraction, p.fraction - 1});
  std::vector<double> volumes(mesh.num_cells());
  cell_volumes(mesh, Geometry::plane, data.x, volumes);
  const auto fraction = [](const Materials& m)
  { return [&m](std::int32_t c) { return 1 - m.fraction(c, 0); }; };
  out.spread = spread(volumes, fraction(run.materials))
               / spread(volumes, fraction(start));
  out.seconds = run.seconds;
  return out;
}

/// The same with fractions as means over cells, by donor cell: no interface.
///
/// @param[in] see called with means at half time and at the end
inline Result run_donor_cell(
    const Case& what, const Setting& how,
    const std::function<void(bool end, const Mesh&, std::span<const double> x,
                             std::span<const double> f)>& see = {})
{
  const auto data = meshes::rectangle(how.squares, how.squares, how.diagonal, 0,
                                      0, 1, how.height);
  const Mesh mesh = data.mesh();
  const Materials start = shapes::lay(mesh, data.x, what.bodies);
  const Boundary kind = what.open ? Boundary::open : Boundary::closed;
  Remapper remapper(mesh, {.scheme = scheme::DonorCell{},
                           .max_loss = 0.999,
                           .boundaries = std::vector(4, kind)});
  std::vector<double> f(mesh.num_cells()), first, home = data.x, before = home;
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    f[c] = 1 - start.fraction(c, 0);
  first = f;
  const std::vector<double> inflow(4, 0.0);
  Result out;
  out.cells = mesh.num_cells();
  out.steps = steps_of(what, how);
  Ledger ledger;
  const double dt = what.time / out.steps;
  for (int k = 0; k < out.steps and out.outcome == Outcome::ok; ++k)
  {
    for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
    {
      const Point p =
          eulerian::traced_back(what.flow, point(home, i), (k + 1) * dt, dt);
      before[2 * i] = p.x, before[2 * i + 1] = p.y;
    }
    const Field field{.values = f, .inflow = inflow};
    const double begin = static_cast<double>(std::clock());
    out.outcome = remapper.remap(home, before, {&field, 1}, {}, Host{}, ledger);
    out.seconds.carry +=
        (static_cast<double>(std::clock()) - begin) / CLOCKS_PER_SEC;
    if (see and (k + 1 == out.steps or 2 * (k + 1) == out.steps))
      see(k + 1 == out.steps, mesh, home, f);
  }
  std::vector<double> volumes(mesh.num_cells());
  cell_volumes(mesh, Geometry::plane, home, volumes);
  double whole = 0, now = 0;
  for (std::size_t c = 0; c < f.size(); ++c)
  {
    out.error += volumes[c] * std::abs(f[c] - first[c]);
    whole += volumes[c] * first[c];
    now += volumes[c] * f[c];
    out.beyond = std::max({out.beyond, -f[c], f[c] - 1});
  }
  out.drift = std::abs(now - whole);
  out.relative = out.error / whole;
  out.spread = spread(volumes, [&f](std::int32_t c) { return f[c]; })
               / spread(volumes, [&first](std::int32_t c) { return first[c]; });
  return out;
}
} // namespace motion
