// SPDX-License-Identifier: LGPL-3.0-or-later
#include "monitor.h"

#include "mesh/corners.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace mmale
{
namespace
{
double sum(MPI_Comm comm, double x)
{
  MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_SUM, comm);
  return x;
}

/// Root of the mean square over all ranks. Collective.
double rms(MPI_Comm comm, std::span<const double> v)
{
  double total[2] = {0, static_cast<double>(v.size())};
  for (double x : v)
    total[0] += x * x;
  MPI_Allreduce(MPI_IN_PLACE, total, 2, MPI_DOUBLE, MPI_SUM, comm);
  return std::sqrt(total[0] / total[1]);
}

/// Boundaries that some stage holds or loads, or whose curve is asked for.
std::vector<int> watched(const Simulation& sim)
{
  std::vector<int> out;
  for (std::size_t b = 0; b < sim.domain.boundary_names.size(); ++b)
  {
    const auto& name = sim.domain.boundary_names[b];
    if (std::ranges::any_of(sim.scene.stage, [&](const auto& stage)
                            { return stage.boundary.contains(name); })
        or std::ranges::any_of(sim.scene.output.curve, [&](const auto& curve)
                               { return curve.second.boundary == name; }))
      out.push_back(static_cast<int>(b));
  }
  return out;
}
} // namespace

Monitor::Monitor(Simulation& sim)
    : _sim(sim), _probe(sim.domain.mesh), _names{"time", "step"},
      _watched(watched(sim)), _moved(sim.domain.boundary_names.size(), {0, 0})
{
  for (const auto& [name, curve] : sim.scene.output.curve)
  {
    Column c{.curve = curve};
    if (curve.point)
    {
      c.point = static_cast<int>(_points.size());
      _points.push_back(*curve.point);
      _displacement.push_back({0, 0});
    }
    if (not curve.boundary.empty())
      c.boundary = sim.domain.boundary(curve.boundary);
    c.divide_by = curve.divide_by * breadth(curve);
    _names.push_back(name);
    _columns.push_back(c);
  }
  for (int b : _watched)
    for (const char* what :
         {".reaction_x", ".reaction_y", ".displacement_x", ".displacement_y"})
      _names.push_back(sim.domain.boundary_names[b] + what);
  if (sim.problem)
    for (const char* name : {"iterations", "pressure_gap", "volume_gap"})
      _names.emplace_back(name);
  if (has_void_ratio())
    for (const char* name : {"grain_gap", "grain_gap_patch"})
      _names.emplace_back(name);
  if (sim.remap)
    for (const char* name : {"quality", "cycles", "clipped"})
      _names.emplace_back(name);
  _spots = _probe.locate(_points);
  _reactions.assign(sim.domain.boundary_names.size(), {0, 0});
  if (not sim.state.p_w.empty())
    _discharge.assign(sim.domain.boundary_names.size(), 0);
  _start = ledger();
  _volume = volume();
}

/// The extent of the curve's boundary, as it says; 1 if it says nothing.
double Monitor::breadth(const scene::Curve& curve) const
{
  if (curve.breadth.empty())
    return 1;
  const auto& d = _sim.domain;
  const int b = d.boundary(curve.boundary);
  const auto line = mesh::common_line(d.sides, b);
  const double dx = line[1][0] - line[0][0], dy = line[1][1] - line[0][1];
  double out = std::hypot(dx, dy);
  if (not(out > 0))
    throw std::runtime_error("the breadth of '" + curve.boundary
                             + "' is not known: it is not straight");
  if (curve.breadth == "nominal")
    return out;
  // half of the first edges of other boundaries in line beyond the two ends
  const double nominal = out;
  constexpr double none = std::numeric_limits<double>::max();
  double beyond[2] = {none, none};
  for (const mesh::Facet& f : d.facets)
  {
    if (f.boundary == b)
      continue;
    double along[2]; // from the start of the line
    bool in_line = true;
    for (int i = 0; i < 2; ++i)
    {
      const double* x = &d.initial_x[2 * (i == 0 ? f.a : f.b)];
      const double p = x[0] - line[0][0], q = x[1] - line[0][1];
      along[i] = (p * dx + q * dy) / nominal;
      in_line =
          in_line and std::abs(p * dy - q * dx) / nominal < 1e-9 * nominal;
    }
    const auto [low, high] = std::minmax(along[0], along[1]);
    const double h = high - low;
    if (in_line and std::abs(high) < 1e-9 * h)
      beyond[0] = h;
    if (in_line and std::abs(low - nominal) < 1e-9 * h)
      beyond[1] = h;
  }
  MPI_Allreduce(MPI_IN_PLACE, beyond, 2, MPI_DOUBLE, MPI_MIN, d.comm);
  for (double h : beyond)
    if (h < none)
      out += 0.5 * h;
  return out;
}

double Monitor::integral(std::span<const double> density) const
{
  double out = 0;
  const bool axisymmetric =
      _sim.scene.symmetry == scene::Symmetry::axisymmetric;
  for (int c = 0; c < _sim.domain.num_owned_cells; ++c)
    out += (density.empty() ? 1 : density[c])
           * mesh::cell_volume(_sim.domain, _sim.state.x, c, axisymmetric);
  return (axisymmetric ? 2 * std::numbers::pi : 1) * sum(_sim.domain.comm, out);
}

double Monitor::volume() const
{
  return integral({});
}

double Monitor::tracer(const scene::Curve& c) const
{
  const auto& values = _sim.state.tracer.at(c.tracer);
  if (c.quantity == "tracer_total")
    return integral(values);
  const auto owned = std::span(values).first(_sim.domain.num_owned_cells);
  const double sign = c.quantity == "tracer_max" ? 1 : -1;
  double out = -std::numeric_limits<double>::infinity();
  for (double v : owned)
    out = std::max(out, sign * v);
  MPI_Allreduce(MPI_IN_PLACE, &out, 1, MPI_DOUBLE, MPI_MAX, _sim.domain.comm);
  return sign * out;
}

double Monitor::boundary_mean(int boundary, std::span<const double> nodal,
                              int size, int component) const
{
  double total[2] = {0, 0};
  for (int n : _sim.domain.boundary_nodes(boundary))
    if (n < _sim.domain.num_owned_nodes)
    {
      total[0] += nodal[size * n + component];
      total[1] += 1;
    }
  MPI_Allreduce(MPI_IN_PLACE, total, 2, MPI_DOUBLE, MPI_SUM, _sim.domain.comm);
  return total[0] / total[1];
}

double Monitor::largest_place(int boundary, int direction) const
{
  double out = -std::numeric_limits<double>::infinity();
  for (int n : _sim.domain.boundary_nodes(boundary))
    out = std::max(out, _sim.state.x[2 * n + direction]);
  MPI_Allreduce(MPI_IN_PLACE, &out, 1, MPI_DOUBLE, MPI_MAX, _sim.domain.comm);
  return out;
}

void Monitor::after_step(double dt)
{
  const auto& state = _sim.state;
  std::vector<double> turned;
  std::span<const double> motion;
  if (_sim.problem)
    motion = _sim.problem->motion();
  else
  {
    turned = state.v;
    for (double& u : turned)
      u *= dt;
    motion = turned;
  }
  for (int b : _watched)
    for (int d = 0; d < 2; ++d)
      _moved[b][d] += boundary_mean(b, motion, 2, d);
  if (not _points.empty())
  {
    const auto u = sample(motion, 2);
    for (std::size_t i = 0; i < _points.size(); ++i)
      for (int d = 0; d < 2; ++d)
      {
        _points[i][d] += u[2 * i + d];
        _displacement[i][d] += u[2 * i + d];
      }
  }
  if (_sim.problem)
  {
    double end = 0;
    for (int c = 0; c < _sim.domain.num_owned_cells; ++c)
      end += _sim.problem->element().volume(c);
    const double turn = _sim.scene.symmetry == scene::Symmetry::axisymmetric
                            ? 2 * std::numbers::pi
                            : 1;
    _lagrangian_volume += turn * sum(_sim.domain.comm, end) - _volume;
    if (not _sim.state.p_w.empty())
      _seeped +=
          turn * sum(_sim.domain.comm, _sim.problem->element().water_gained());
    _volume = volume();
    _reactions = _sim.problem->reactions();
    _discharge = _sim.problem->discharge();
  }
  if (not _points.empty())
  {
    // the probe reads the geometry of the DOLFINx mesh
    _sim.domain.put_geometry(state.x);
    _spots = _probe.locate(_points);
  }
}

double Monitor::value(const Column& c) const
{
  const auto& q = c.curve.quantity;
  if (q.starts_with("tracer"))
    return tracer(c.curve);
  const int d = q.ends_with("_y") ? 1 : 0;
  if (q.starts_with("reaction"))
    return _reactions[c.boundary][d];
  if (q.starts_with("displacement"))
    return c.point >= 0 ? _displacement[c.point][d] : _moved[c.boundary][d];
  const auto& state = _sim.state;
  if (q.starts_with("velocity"))
    return c.boundary >= 0 ? boundary_mean(c.boundary, state.v, 2, d)
                           : sample(state.v, 2)[2 * c.point + d];
  if (q.ends_with("_energy") or q.ends_with("_work"))
    return energy(q);
  if (q.starts_with("stress"))
    return stress(c.point, q.substr(7), cell_stress());
  if (q.starts_with("effective_stress"))
    return stress(c.point, q.substr(17), effective_stress());
  if (q == "x_max" or q == "y_max")
    return largest_place(c.boundary, q == "x_max" ? 0 : 1);
  if (q == "covered_length")
    return covered_length(c.boundary, c.curve.material);
  if (q == "discharge")
    return _discharge[c.boundary];
  if (q == "pore_pressure")
  {
    const auto p_w = pore_pressure();
    return c.boundary >= 0 ? boundary_mean(c.boundary, p_w, 1, 0)
                           : sample(p_w, 1)[c.point];
  }
  return c.boundary >= 0 ? boundary_mean(c.boundary, state.p, 1, 0)
                         : sample(state.p, 1)[c.point];
}

/// Nodal values at the points of curves, shape (points, size).
std::vector<double> Monitor::sample(std::span<const double> nodal,
                                    int size) const
{
  return _probe.sample(_spots, {.name = "",
                                .location = output::Location::nodal,
                                .components = size,
                                .values = nodal});
}

double Monitor::energy(const std::string& quantity) const
{
  const double turn = _sim.scene.symmetry == scene::Symmetry::axisymmetric
                          ? 2 * std::numbers::pi
                          : 1;
  const Work& work = _sim.state.work;
  if (quantity == "internal_work")
    return turn * work.internal;
  if (quantity == "external_work")
    return turn * work.external;
  // in statics v is no velocity
  const auto& state = _sim.state;
  const bool moves =
      not state.a.empty() or (state.time == 0 and _sim.scene.stage[0].dynamics);
  const double kinetic = moves ? turn * _sim.problem->kinetic_energy(state) : 0;
  return quantity == "kinetic_energy" ? kinetic
                                      : kinetic + turn * work.internal;
}

/// Component xx, yy, zz or xy of a cells' stress, at a point.
double Monitor::stress(int point, const std::string& component,
                       std::span<const double> all) const
{
  const std::vector<std::string> names{"xx", "yy", "zz", "xy"};
  const auto at = std::ranges::find(names, component) - names.begin();
  return _probe.sample(_spots, {.name = "",
                                .location = output::Location::cell,
                                .components = 4,
                                .values = all})[4 * point + at];
}

std::vector<double> Monitor::row(double step, const StepLog& log)
{
  std::vector<double> out{_sim.state.time, step};
  for (const Column& c : _columns)
    out.push_back(value(c) / c.divide_by);
  for (int b : _watched)
    for (const auto& pair : {_reactions[b], _moved[b]})
      out.insert(out.end(), pair.begin(), pair.end());
  if (_sim.problem)
  {
    out.push_back(log.newton.iterations);
    const auto gap = _sim.problem->mismatch(_sim.state);
    out.insert(out.end(), gap.begin(), gap.end());
  }
  if (has_void_ratio())
  {
    const auto gap = grain_gap();
    const auto n = static_cast<std::size_t>(_sim.domain.num_owned_nodes);
    const auto m = static_cast<std::size_t>(_sim.domain.num_owned_cells);
    const auto patch = corner_mean(gap);
    out.push_back(rms(_sim.domain.comm, std::span(gap).first(m)));
    out.push_back(rms(_sim.domain.comm, std::span(patch).first(n)));
  }
  if (_sim.remap)
    out.insert(out.end(), {bridge::worst_quality(_sim.domain, _sim.state),
                           static_cast<double>(log.remap.cycles),
                           static_cast<double>(log.remap.clipped)});
  return out;
}

output::Ledger Monitor::ledger() const
{
  const bool axisymmetric =
      _sim.scene.symmetry == scene::Symmetry::axisymmetric;
  const double turn = axisymmetric ? 2 * std::numbers::pi : 1;
  const std::string per = axisymmetric ? "" : "/m";
  bridge::Exchange passed;
  if (_sim.remap)
    passed = _sim.remap->exchange();
  output::Ledger out;
  out.push_back({.name = "volume",
                 .unit = "m3" + per,
                 .end = volume(),
                 .through_surface = turn * passed.volume.through,
                 .booked = _lagrangian_volume + turn * passed.volume.at_walls});
  if (not _sim.laws.empty())
    out.push_back({.name = "mass",
                   .unit = "kg" + per,
                   .end = integral(_sim.state.density),
                   .through_surface = turn * passed.mass.through,
                   .booked = _seeped + turn * passed.mass.at_walls});
  for (std::int32_t k = 0; const auto& [name, material] : _sim.scene.material)
  {
    if (not _sim.state.materials)
      break;
    const auto [volume, mass] = amount(k);
    const auto& [v, m] =
        std::pair(passed.material_volume[name], passed.material_mass[name]);
    out.push_back({.name = name + "_volume",
                   .unit = "m3" + per,
                   .end = volume,
                   .through_surface = turn * v.through,
                   .booked = turn * v.at_walls});
    out.push_back({.name = name + "_mass",
                   .unit = "kg" + per,
                   .end = mass,
                   .through_surface = turn * m.through,
                   .booked = turn * m.at_walls});
    ++k;
  }
  for (const auto& [name, values] : _sim.state.tracer)
    out.push_back({.name = name,
                   .unit = "m3" + per,
                   .end = integral(values),
                   .through_surface = turn * passed.tracer[name].through,
                   .booked = turn * passed.tracer[name].at_walls});
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].start = _start.empty() ? out[i].end : _start[i].start;
  return out;
}

void Monitor::keep(output::Archive& archive)
{
  archive("monitor/points", _points);
  archive("monitor/displacement", _displacement);
  archive("monitor/moved", _moved);
  archive("monitor/reactions", _reactions);
  if (not _discharge.empty())
    archive("monitor/discharge", _discharge);
  archive("monitor/volume", _volume);
  archive("monitor/lagrangian_volume", _lagrangian_volume);
  if (not _sim.state.p_w.empty())
    archive("monitor/seeped", _seeped);
  std::vector<double> start;
  for (const auto& entry : _start)
    start.push_back(entry.start);
  archive("monitor/start", start);
  for (std::size_t i = 0; i < _start.size(); ++i)
    _start[i].start = start.at(i);
  if (not archive.loading() or _points.empty())
    return;
  _sim.domain.put_geometry(_sim.state.x);
  _spots = _probe.locate(_points);
}
} // namespace mmale
