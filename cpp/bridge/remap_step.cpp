// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap_step.h"

#include "effective.h"
#include "foot.h"
#include "history_fields.h"
#include "mesh/corners.h"
#include "mixture.h"
#include "output/archive.h"
#include "placement.h"
#include "point_layout.h"
#include "remap/quality/quality.h"
#include "remap/remap.h"
#include "remap/smoothing/relax.h"
#include "remap/smoothing/smooth.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mmale::bridge
{
namespace
{
using Nodes = std::array<int, 3>;

::remap::Host make_host(const mesh::Domain& domain)
{
  ::remap::Host host;
  int size = 1;
  MPI_Comm_size(domain.comm, &size);
  if (size == 1)
    return host;
  host.cell_halo = [&domain](std::span<double> v, int block)
  { domain.cell_halo->update(v, block); };
  host.node_halo = [&domain](std::span<double> v, int block)
  { domain.node_halo->update(v, block); };
  const auto reduce = [&domain](MPI_Op op)
  {
    return [&domain, op](std::span<double> v)
    {
      MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()),
                    MPI_DOUBLE, op, domain.comm);
    };
  };
  host.global_max = reduce(MPI_MAX);
  host.global_sum = reduce(MPI_SUM);
  return host;
}

::remap::Mesh make_mesh(const mesh::Domain& domain)
{
  std::vector<std::int32_t> cells, marked, markers;
  for (const Nodes& c : domain.cells)
    cells.insert(cells.end(), c.begin(), c.end());
  for (const mesh::Facet& f : domain.facets)
  {
    marked.insert(marked.end(), {f.a, f.b});
    markers.push_back(f.boundary);
  }
  return ::remap::Mesh(
      {.cells = cells,
       .x = domain.initial_x,
       .owned_cells = static_cast<std::size_t>(domain.num_owned_cells),
       .owned_nodes = static_cast<std::size_t>(domain.num_owned_nodes),
       .cell_ids = domain.cell_id,
       .node_ids = domain.node_id,
       .marked = marked,
       .markers = markers});
}

::remap::Geometry geometry(const scene::Scene& scene)
{
  return scene.symmetry == scene::Symmetry::axisymmetric
             ? ::remap::Geometry::axisymmetric
             : ::remap::Geometry::plane;
}

/// Number of the material that flows in over a boundary, or -1.
int inflow(const scene::Scene& scene, const std::string& boundary)
{
  const auto table = scene.boundary.find(boundary);
  if (table == scene.boundary.end() or table->second.inflow.empty())
    return -1;
  return static_cast<int>(std::distance(
      scene.material.begin(), scene.material.find(table->second.inflow)));
}

/// Likewise of every boundary.
std::vector<int> inflows(const scene::Scene& scene, const mesh::Domain& domain)
{
  std::vector<int> out;
  for (const std::string& name : domain.boundary_names)
    out.push_back(inflow(scene, name));
  return out;
}

bool among(const std::vector<std::string>& list, const std::string& name)
{
  return std::ranges::find(list, name) != list.end();
}

/// What the remapper is to be ready for.
::remap::Options transport_options(const mesh::Domain& domain,
                                   const scene::Scene& scene,
                                   std::span<const material::AnyLaw> laws,
                                   int history,
                                   const ::remap::PointMesh* points)
{
  const int widest = std::max(laws.empty() ? 1 : 4, history);
  ::remap::Options o;
  o.geometry = geometry(scene);
  o.scheme = *::remap::find<::remap::Schemes>(scene.remap.transport);
  o.nodal_scheme = o.scheme;
  o.max_loss = scene.remap.max_loss;
  for (const std::string& name : domain.boundary_names)
    o.boundaries.push_back(
        among(scene.remap.open, name) or inflow(scene, name) >= 0
            ? ::remap::Boundary::open
        : among(scene.remap.surface, name) ? ::remap::Boundary::free_surface
                                           : ::remap::Boundary::closed);
  o.points = points;
  o.cell_components = points ? 1 : widest;
  o.point_components = points ? widest : 0;
  o.per_mass = std::ranges::any_of(scene.stage, [](const auto& stage)
                                   { return stage.dynamics.has_value(); });
  o.nodal_components = scene.motion ? 0 : o.per_mass ? 2 : 1;
  if (laws.size() > 1)
  {
    o.materials.number = static_cast<int>(laws.size());
    o.materials.components = 4;
    for (const std::string& name : domain.boundary_names)
      o.materials.inflow.push_back(std::max(0, inflow(scene, name)));
    // the library's own has settings that suit transport
    if (scene.remap.interfaces != "moment_of_fluid")
      o.materials.reconstruction =
          *::remap::find<::remap::Reconstructions>(scene.remap.interfaces);
  }
  return o;
}

::remap::SmoothingOptions smoothing_options(const scene::Scene& scene)
{
  ::remap::SmoothingOptions o;
  o.geometry = geometry(scene);
  o.smoother = *::remap::find<::remap::Smoothers>(scene.remap.smoother);
  o.measure = scene.remap.target == "initial" ? ::remap::Measure::shape
                                              : ::remap::Measure::radius_ratio;
  o.threshold = scene.remap.quality_below;
  o.sweeps = scene.remap.sweeps;
  return o;
}
} // namespace

std::vector<std::string> smoothers()
{
  return ::remap::names<::remap::Smoothers>();
}

std::vector<std::string> interfaces()
{
  return ::remap::names<::remap::Reconstructions>();
}

std::vector<std::string> transports()
{
  return ::remap::names<::remap::Schemes>();
}

double worst_quality(const mesh::Domain& domain, const State& state)
{
  double worst = 1;
  for (int c = 0; c < domain.num_owned_cells; ++c)
  {
    const auto [i, j, k] = domain.cells[c];
    worst = std::min(
        worst, ::remap::quality::radius_ratio(::remap::point(state.x, i),
                                              ::remap::point(state.x, j),
                                              ::remap::point(state.x, k)));
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MIN, domain.comm);
  return worst;
}

struct RemapStep::Impl
{
  Impl(const mesh::Domain& domain, const scene::Scene& scene,
       std::span<const material::AnyLaw> laws, output::Clock& clock);

  bool smooth(const State& state, std::span<const std::uint8_t> at_wall,
              std::vector<double>& x, RemapLog& log);
  bool transport(State& state, std::span<const double> x, RemapLog& log);
  void add_stress(State& state, std::vector<::remap::Field>& fields);
  std::vector<double> boundary_velocity(const State& state) const;
  void add_materials(State& state, std::vector<::remap::MaterialField>& fields);
  void make_admissible(State& state, RemapLog& log);
  bool several() const { return laws.size() > 1; }
  void exchange_of_materials(Exchange& out) const;

  const mesh::Domain& domain;
  const scene::Scene& scene;
  std::span<const material::AnyLaw> laws;
  output::Clock& clock;
  ::remap::Host host;
  ::remap::Mesh mesh;
  HistoryFields travelling;
  std::optional<::remap::PointMesh> points; // with layout `quadrature`
  ::remap::Remapper remapper;
  std::optional<::remap::Smoothing> smoothing; // Eulerian meshes need none
  std::vector<double> inflow_density;          // by boundary
  std::vector<double> unstressed;              // likewise, four numbers each
  std::span<const double> nothing() const
  {
    return std::span(unstressed).first(domain.boundary_names.size());
  }
  std::vector<std::uint8_t> solid; // materials with a stress: not the void
  ::remap::Ledger ledger;

  std::optional<Placement> placement;
  std::optional<Foot> foot;
  std::vector<double> spacing;
  std::vector<::remap::quality::Target> targets;
  std::vector<std::uint8_t> flags;
  bool whole = false;       // this remap is of the whole mesh
  std::vector<double> home; // nodes after the last remap
};

namespace
{
std::optional<::remap::PointMesh>
make_points(const mesh::Domain& domain, const scene::Scene& scene,
            std::span<const material::AnyLaw> laws, const ::remap::Mesh& mesh)
{
  if (laws.empty() or scene.solver.layout != scene::Layout::quadrature)
    return std::nullopt;
  return ::remap::PointMesh(mesh, point_layout(scene.solver.points),
                            domain.initial_x);
}
} // namespace

RemapStep::Impl::Impl(const mesh::Domain& domain, const scene::Scene& scene,
                      std::span<const material::AnyLaw> laws,
                      output::Clock& clock)
    : domain(domain), scene(scene), laws(laws), clock(clock),
      host(make_host(domain)), mesh(make_mesh(domain)),
      travelling(laws, scene.water.has_value(), inflows(scene, domain)),
      points(make_points(domain, scene, laws, mesh)),
      remapper(mesh,
               transport_options(domain, scene, laws, travelling.numbers(),
                                 points ? &*points : nullptr))
{
  for (const material::AnyLaw& law : laws)
    solid.push_back(not std::holds_alternative<material::Void>(law));
  for (const std::string& name : domain.boundary_names)
  {
    const int k = several() ? inflow(scene, name) : -1;
    inflow_density.push_back(
        k < 0 ? 0
              : std::visit([](const auto& l)
                           { return material::initial_density(l, {}); },
                           laws[k]));
  }
  unstressed.assign(4 * domain.boundary_names.size(), 0);
  if (scene.remap.mode != scene::RemapMode::ale)
    return;
  smoothing.emplace(mesh, smoothing_options(scene), host);
  placement.emplace(domain, mesh, scene.remap.surface);
  foot.emplace(domain, scene.remap.surface);
  home = domain.initial_x;
  flags.resize(mesh.num_nodes());
  spacing = ::remap::facet_lengths(mesh, domain.initial_x);
  if (scene.remap.target == "initial")
    targets = ::remap::shapes(mesh, domain.initial_x);
}

RemapStep::RemapStep(const mesh::Domain& domain, const scene::Scene& scene,
                     std::span<const material::AnyLaw> laws,
                     output::Clock& clock)
    : _impl(std::make_unique<Impl>(domain, scene, laws, clock))
{
}

RemapStep::~RemapStep() = default;

bool RemapStep::due(const State& state, int number)
{
  Impl& m = *_impl;
  const auto& o = m.scene.remap;
  if (o.every > 0 and number % o.every == 0)
  {
    std::ranges::fill(m.flags, std::uint8_t{1});
    m.whole = true;
    return true;
  }
  m.whole = false;
  if (o.quality_below <= 0)
    return false;
  const auto scope = m.clock.scope("2 smooth");
  if (m.smoothing)
    return m.smoothing->flag(state.x, m.targets, m.flags, m.host);
  return worst_quality(m.domain, state) < o.quality_below;
}

bool RemapStep::Impl::smooth(const State& state,
                             std::span<const std::uint8_t> at_wall,
                             std::vector<double>& x, RemapLog& log)
{
  const auto scope = clock.scope("2 smooth");
  if (not smoothing)
  {
    x = domain.initial_x;
    return true;
  }
  ::remap::Constraints constraints{.kinds = placement->kinds(),
                                   .direction = placement->direction(),
                                   .guide = &placement->curve(),
                                   .spacing = spacing,
                                   .targets = targets};
  auto outcome = ::remap::Outcome::inverted_start;
  if (whole)
  {
    x = state.x;
    if (not at_wall.empty())
      foot->move(at_wall, x);
    placement->turn(x);
    // the surface first, so that the body follows it where it will be
    constraints.kinds = placement->kinds_placed();
    outcome = smoothing->smooth(x, placement->on_surface(), constraints, host);
    if (outcome == ::remap::Outcome::ok)
    {
      x = placement->start(x, home);
      outcome = smoothing->smooth(x, flags, constraints, host);
    }
  }
  if (outcome != ::remap::Outcome::ok)
  {
    placement->turn(state.x);
    constraints.kinds = placement->kinds();
    x = state.x;
    outcome = smoothing->smooth(x, flags, constraints, host);
  }
  if (outcome != ::remap::Outcome::ok)
    log.trouble = ::remap::describe(outcome);
  else if (scene.remap.max_turnover > 0)
    ::remap::relax(mesh, geometry(scene), scene.remap.max_turnover, state.x, x,
                   host);
  return outcome == ::remap::Outcome::ok;
}

/// The law's arrays: of the cells, or of their points.
void RemapStep::Impl::add_stress(State& state,
                                 std::vector<::remap::Field>& fields)
{
  static constexpr double metric[] = {1, 1, 1, 2}; // xx, yy, zz, xy
  // `admit` has the last word on the yield surface, so order 2 is not given up.
  fields.push_back({.values = state.s,
                    .components = 4,
                    .group = 4,
                    .bound = ::remap::Bound::ball,
                    .weights = metric});
  fields.push_back({.values = state.P});
  travelling.take(state.history);
  travelling.add_to(fields);
}

/// The arrays that each material has for itself; of the void only a trace of
/// density, so that no node is without mass.
void RemapStep::Impl::add_materials(State& state,
                                    std::vector<::remap::MaterialField>& fields)
{
  static constexpr double metric[] = {1, 1, 1, 2}; // xx, yy, zz, xy
  mixture::clear(state);
  fields.push_back({.values = state.density, .inflow = inflow_density});
  fields.push_back({.values = state.s,
                    .components = 4,
                    .group = 4,
                    .bound = ::remap::Bound::ball,
                    .weights = metric,
                    .inflow = unstressed,
                    .carriers = solid});
  fields.push_back({.values = state.P, .inflow = nothing(), .carriers = solid});
  travelling.take(state.history, &*state.materials);
  travelling.add_to(fields);
}

/// Mean velocity of each boundary's nodes: what flows in comes with it.
/// Collective.
std::vector<double> RemapStep::Impl::boundary_velocity(const State& state) const
{
  const auto boundaries = static_cast<int>(domain.boundary_names.size());
  std::vector<double> sum(3 * boundaries, 0);
  for (int b = 0; b < boundaries; ++b)
    for (int n : domain.boundary_nodes(b))
      if (n < domain.num_owned_nodes)
      {
        sum[3 * b] += state.v[2 * n];
        sum[3 * b + 1] += state.v[2 * n + 1];
        sum[3 * b + 2] += 1;
      }
  host.sum(sum);
  std::vector<double> mean;
  for (int b = 0; b < boundaries; ++b)
    for (int d = 0; d < 2; ++d)
      mean.push_back(sum[3 * b + d] / std::max(1.0, sum[3 * b + 2]));
  return mean;
}

bool RemapStep::Impl::transport(State& state, std::span<const double> x,
                                RemapLog& log)
{
  const auto scope = clock.scope("3 transport");
  State copy = state; // a remap that stops half way is taken back
  std::vector<::remap::Field> cells, nodes, at_points, per_mass;
  std::vector<::remap::MaterialField> of_materials;
  std::vector<std::vector<double>> inflow;
  std::vector<double> velocity; // of what flows in, by boundary
  inflow.reserve(state.tracer.size());
  if (not laws.empty())
  {
    if (several())
      add_materials(state, of_materials);
    else
    {
      cells.push_back({.values = state.density});
      add_stress(state, points ? at_points : cells);
    }
    nodes.push_back({.values = state.p, .inflow = nothing()});
    if (not state.p_w.empty())
      nodes.push_back({.values = state.p_w});
  }
  if (not state.a.empty())
  {
    velocity = boundary_velocity(state);
    per_mass.push_back(
        {.values = state.v, .components = 2, .group = 2, .inflow = velocity});
    if (not state.p_rate.empty())
      nodes.push_back({.values = state.p_rate, .inflow = nothing()});
  }
  for (auto& [name, values] : state.tracer)
  {
    inflow.emplace_back(domain.boundary_names.size(),
                        scene.tracer.at(name).outside);
    cells.push_back({.values = values, .inflow = inflow.back()});
  }
  const ::remap::Ledger before = ledger;
  const auto outcome =
      remapper.remap(state.x, x,
                     {.cells = cells,
                      .points = at_points,
                      .nodes = nodes,
                      .per_mass = per_mass,
                      .density = several() ? -1 : 0,
                      .materials = several() ? &*state.materials : nullptr,
                      .of_materials = of_materials,
                      .material_density = several() ? 0 : -1},
                     host, ledger);
  log.cycles = remapper.report().cycles;
  if (outcome != ::remap::Outcome::ok)
  {
    log.trouble = ::remap::describe(outcome);
    state = std::move(copy);
    ledger = before;
    return false;
  }
  if (several())
    travelling.give(state.history, *state.materials);
  else
    travelling.give(state.history);
  std::ranges::copy(x, state.x.begin());
  return true;
}

void RemapStep::Impl::make_admissible(State& state, RemapLog& log)
{
  if (laws.empty())
    return;
  const auto scope = clock.scope("4 admissible");
  const Cut cut = admit(laws, state, domain.num_owned_cells);
  double largest = cut.largest, clipped = static_cast<double>(cut.points);
  host.max(std::span(&largest, 1));
  host.sum(std::span(&clipped, 1));
  log.clipped = static_cast<std::int64_t>(clipped);
  log.clipped_largest = largest;
  if (several())
    mixture::fill(state);
}

void RemapStep::keep(output::Archive& archive)
{
  Impl& m = *_impl;
  archive("remap/home", Entity::node, m.home);
  if (m.placement)
    m.placement->keep(archive);
  archive("remap/cell_volume", m.ledger.cell_volume);
  archive("remap/node_volume", m.ledger.node_volume);
  archive("remap/cells", m.ledger.cells);
  archive("remap/nodes", m.ledger.nodes);
  if (m.several())
  {
    archive("remap/material_volume", m.ledger.material_volume);
    archive("remap/of_materials", m.ledger.of_materials);
  }
}

void RemapStep::run(State& state, std::span<const std::uint8_t> at_wall,
                    RemapLog& log)
{
  std::vector<double> x;
  if (not _impl->smooth(state, at_wall, x, log))
    return;
  // what travels is p' and p_w, so that neither has the other's jumps
  if (_impl->scene.water)
    to_effective(state);
  const bool moved = _impl->transport(state, x, log);
  if (moved)
    _impl->make_admissible(state, log);
  if (_impl->scene.water)
    to_total(state);
  if (not moved)
    return;
  _impl->home = state.x;
  log.quality = worst_quality(_impl->domain, state);
  log.done = true;
}

namespace
{
Passed passed(const ::remap::Exchange& e)
{
  const double walls = e[static_cast<std::size_t>(::remap::Way::closed)];
  return {::remap::net(e) - walls, walls};
}
} // namespace

/// Of each material; none before the first remap.
void RemapStep::Impl::exchange_of_materials(Exchange& out) const
{
  int k = 0;
  for (const auto& [name, material] : scene.material)
  {
    const auto i = static_cast<std::size_t>(k++);
    Passed& mass = out.material_mass[name];
    Passed& volume = out.material_volume[name];
    if (i < ledger.material_volume.size())
      volume = passed(ledger.material_volume[i]);
    if (i < ledger.of_materials.size()) // the density comes first
      mass = passed(ledger.of_materials[i]);
    out.mass.through += mass.through;
    out.mass.at_walls += mass.at_walls;
  }
}

Exchange RemapStep::exchange() const
{
  // components in the order of `transport`; none before the first remap
  const auto& ledger = _impl->ledger;
  const auto at = [&ledger](std::size_t k)
  { return k < ledger.cells.size() ? passed(ledger.cells[k]) : Passed(); };
  Exchange out;
  out.volume = passed(ledger.cell_volume);
  std::size_t k = 0;
  if (_impl->several())
    _impl->exchange_of_materials(out);
  else if (not _impl->laws.empty())
  {
    out.mass = at(0);
    k = _impl->points ? 1 : 6 + _impl->travelling.numbers();
  }
  for (const auto& [name, tracer] : _impl->scene.tracer)
    out.tracer[name] = at(k++);
  return out;
}
} // namespace mmale::bridge
