// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/volume_transport.h"

#include "remap/geometry/position.h"
#include "remap/materials/ghosts.h"
#include "remap/materials/slivers.h"
#include "remap/materials/sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

using namespace remap;
using namespace remap::position;

namespace
{
bool all_finite(std::span<const double> x)
{
  double sum = 0;
  for (double v : x)
    sum += 0 * v;
  return sum == 0;
}

} // namespace

VolumeTransport::VolumeTransport(const Mesh& mesh, VolumeOptions options)
    : _mesh(&mesh), _options(std::move(options)), _walk(mesh), _back(mesh)
{
  if (not(_options.sliver >= 0 and _options.sliver < 1e-2))
    throw std::invalid_argument("sliver: from 0 to below 1e-2");
  const auto n = static_cast<std::size_t>(mesh.num_cells());
  _status.assign(n, unseen);
  _pure_of.assign(n, -1);
  _front_of.assign(n, -1);
}

void VolumeTransport::fail(Outcome outcome, std::int32_t c)
{
  _outcome = std::max(_outcome, outcome);
  _report.worst_cell = std::max(_report.worst_cell, _mesh->cell_ids()[c]);
}

void VolumeTransport::reset()
{
  for (std::int32_t c : _listed)
    _status[c] = unseen;
  for (const Front& f : _fronts)
    _front_of[f.cell] = -1;
  _listed.clear();
  _queue.clear();
  _fronts.clear();
  _given.clear();
  _results.clear();
  _shares.clear();
  _spread = 0;
}

void VolumeTransport::put(std::int32_t c)
{
  if (_status[c] >= waiting or c >= _mesh->owned_cells())
    return;
  _status[c] = waiting;
  _queue.push_back(c);
  _listed.push_back(c);
}

/// Does the body gain or lose anything along a facet of its outline?
template <Geometry G>
bool VolumeTransport::outline_moved(std::int32_t f) const
{
  const auto [a, b] = _mesh->facet(f);
  const Point p0 = point(_call.x_old, a), q0 = point(_call.x_old, b);
  const Point p1 = point(_call.x_new, a), q1 = point(_call.x_new, b);
  const double square = dot(q0 - p0, q0 - p0);
  const double off =
      std::abs(twice_area(p0, q0, p1)) + std::abs(twice_area(p0, q0, q1));
  if (off > round_off * square)
    return true;
  return not _call.facet_volumes.empty()
         and std::abs(_call.facet_volumes[f])
                 > round_off * square
                       * (G == Geometry::plane ? 1 : std::max(p0.x, q0.x));
}

template <Geometry G>
void VolumeTransport::add_front(std::int32_t c)
{
  if (_front_of[c] >= 0)
    return;
  _front_of[c] = static_cast<std::int32_t>(_fronts.size());
  const Triangle t = _walk.place(_call.x_old, c, {});
  const std::int32_t row = _call.materials->row(c);
  const auto count =
      row < 0 ? 1
              : static_cast<std::int32_t>(_call.materials->parts(row).size());
  const double whole = about_first<G>(t).v;
  _fronts.push_back({c, static_cast<std::int32_t>(_given.size()), count, whole,
                     longest_edge(t)});
  _given.resize(_given.size() + count);
  if (not(whole > 0))
    fail(Outcome::inverted_start, c);
}

template void VolumeTransport::add_front<Geometry::plane>(std::int32_t);
template void VolumeTransport::add_front<Geometry::axisymmetric>(std::int32_t);

/// Mixed cells; pure ones beside another material; cells whose outline moved.
template <Geometry G>
void VolumeTransport::find_fronts()
{
  const Materials& m = *_call.materials;
  _outline_moved = false;
  for (std::int32_t c : m.mixed())
    add_front<G>(c);
  for (std::int32_t f = 0; f < _mesh->num_facets(); ++f)
  {
    const auto [left, right] = _mesh->facet_cells(f);
    if (right < 0)
      continue;
    const std::int32_t a = m.pure(left), b = m.pure(right);
    if (a != b and a >= 0 and b >= 0)
      add_front<G>(left), add_front<G>(right);
  }
  for (std::int32_t f : _walk.outline())
    if (outline_moved<G>(f))
    {
      _outline_moved = true;
      add_front<G>(_mesh->facet_cells(f)[0]);
    }
  if (_call.host->cell_halo)
  {
    _flags.assign(_mesh->num_cells(), 0);
    for (const Front& f : _fronts)
      _flags[f.cell] = 1;
    _call.host->update_cells(_flags, 1);
    for (std::int32_t c = _mesh->owned_cells(); c < _mesh->num_cells(); ++c)
      if (_flags[c] > 0)
        add_front<G>(c);
  }
  for (std::size_t i = 0; i < _fronts.size(); ++i)
  {
    put(_fronts[i].cell);
    for (std::int32_t d : _mesh->cell_cells()[_fronts[i].cell])
      put(d);
  }
}

template <Geometry G>
void VolumeTransport::work_off()
{
  for (std::size_t i = 0; i < _queue.size() and _outcome == Outcome::ok; ++i)
    carry_cell<G>(_queue[i]);
  _queue.clear();
}

/// Cells of other ranks that were carried, and what they met.
template <Geometry G>
void VolumeTransport::exchange_status()
{
  if (not _call.host->cell_halo)
    return;
  _flags.assign(_mesh->num_cells(), 0);
  for (std::int32_t c : _listed)
    _flags[c] = _status[c] == mixed  ? 1
                : _status[c] == pure ? 2 + _pure_of[c]
                                     : 0;
  _call.host->update_cells(_flags, 1);
  for (std::int32_t c = _mesh->owned_cells(); c < _mesh->num_cells(); ++c)
  {
    if (_flags[c] == 0 or _status[c] >= mixed)
      continue;
    _status[c] = _flags[c] == 1 ? mixed : pure;
    _pure_of[c] = static_cast<std::int32_t>(_flags[c]) - 2;
    _listed.push_back(c);
    if (_status[c] == mixed)
      carry_cell<G>(c);
  }
}

/// Cells next to those carried join them if they may have changed: those that
/// border on another material now, or whose middle came to lie in one.
bool VolumeTransport::spread_zone()
{
  const Materials& m = *_call.materials;
  // Those listed on the way are not carried yet.
  for (const std::size_t end = _listed.size(); _spread < end; ++_spread)
  {
    const std::int32_t d = _listed[_spread];
    if (_status[d] < mixed)
      continue;
    for (std::int32_t e : _mesh->cell_cells()[d])
    {
      if (_status[e] >= waiting or e >= _mesh->owned_cells())
        continue;
      if (_status[d] == pure)
      {
        if (_pure_of[d] != m.pure(e))
          put(e);
        continue;
      }
      if (_outline_moved)
      {
        put(e);
        continue;
      }
      if (_status[e] == looked)
        continue;
      const Triangle t = _walk.place(_call.x_new, e, {});
      const std::int32_t at =
          _walk.locate(_call.x_old, e, 1.0 / 3 * (t[0] + t[1] + t[2]));
      if (_front_of[at] >= 0 or m.pure(at) != m.pure(e))
        put(e);
      else
      {
        _status[e] = looked;
        _listed.push_back(e);
      }
    }
  }
  return not _queue.empty();
}

/// Old cells that are not all found: new cells that meet them and were not
/// carried join.
bool VolumeTransport::search_missing()
{
  const bool ranks = static_cast<bool>(_call.host->cell_halo);
  if (ranks)
    _flags.assign(_mesh->num_cells(), 0);
  const auto search = [this](std::int32_t c)
  {
    const Triangle t = _walk.place(_call.x_old, c, {});
    Polygon<6> p;
    for (const Point& v : t)
      p.push(v - t[0]);
    _back.meet(_call.x_new, p, {p[0], p[1], p[2]}, t[0], c);
    for (const auto& [d, cuts] : _back.met())
    {
      put(d);
      for (std::int32_t e : _mesh->cell_cells()[d])
        put(e);
    }
  };
  for (Front& f : _fronts)
  {
    if (f.done or f.cell >= _mesh->owned_cells()
        or not(missing(f) > round_off * f.length * f.length))
      continue;
    f.done = true;
    search(f.cell);
    if (ranks)
      _flags[f.cell] = 1;
  }
  if (ranks)
  {
    _call.host->update_cells(_flags, 1);
    for (std::int32_t c = _mesh->owned_cells(); c < _mesh->num_cells(); ++c)
      if (_flags[c] > 0)
        search(c);
  }
  return not _queue.empty();
}

void VolumeTransport::write(Materials& materials)
{
  materials.drop_rows();
  std::array<Part, most_parts> parts;
  for (const Result& r : _results)
  {
    if (r.count < 2)
    {
      materials.set_pure(r.cell,
                         r.count == 0 ? r.first : _shares[r.first].material);
      continue;
    }
    double sum = 0;
    for (std::int32_t k = 0; k < r.count; ++k)
      sum += _shares[r.first + k].moments.v;
    const Triangle place = _walk.place(_call.x_new, r.cell, r.origin);
    for (std::int32_t k = 0; k < r.count; ++k)
    {
      const Share& s = _shares[r.first + k];
      parts[k] = {s.material, s.moments.v / sum,
                  r.origin + held_in(place, s.moments.centroid())};
    }
    materials.add_row(r.cell, {parts.data(), std::size_t(r.count)});
  }
}

template <Geometry G>
Outcome VolumeTransport::run(Materials& materials, MaterialLedger& ledger)
{
  const Host& host = *_call.host;
  const auto any = [&host](bool here)
  { return host.max(here ? 1.0 : 0.0) > 0; };
  find_fronts<G>();
  bool more = true;
  while (more)
  {
    work_off<G>();
    if (host.max(static_cast<double>(_outcome)) > 0)
      break;
    exchange_status<G>();
    more = any(spread_zone());
    if (not more)
      more = any(search_missing());
  }
  if (not(host.max(static_cast<double>(_outcome)) > 0))
    book_all_lost<G>();
  _outcome = static_cast<Outcome>(host.max(static_cast<double>(_outcome)));
  if (_outcome != Outcome::ok)
  {
    reset();
    return _outcome;
  }
  write(materials);
  const auto volume = [this](std::int32_t c)
  {
    return bent::cell<G>(*_mesh, _call.x_old, _call.x_new, _call.facet_volumes,
                         c)
        .whole.v;
  };
  update_ghosts(*_mesh, materials, host);
  const SliverReport swept =
      sweep_slivers(*_mesh, materials, _options.sliver, volume, host);
  _report.slivers_swept = swept.swept;
  _report.slivers_kept = swept.kept;
  _report.sliver_volume = swept.volume;
  std::vector<double> all;
  for (const Exchange& e : _passed)
    all.insert(all.end(), e.begin(), e.end());
  host.sum(all);
  ledger.volume.resize(_passed.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    ledger.volume[k / num_ways][k % num_ways] += all[k];
  reset();
  return Outcome::ok;
}

Outcome VolumeTransport::carry(std::span<const double> x_old,
                               std::span<const double> x_new,
                               std::span<const double> facet_volumes,
                               std::span<const Partition> partitions,
                               Materials& materials, const Host& host,
                               MaterialLedger& ledger)
{
  _report = {};
  _outcome = Outcome::ok;
  _call = {x_old, x_new, facet_volumes, partitions, &materials, &host};
  const auto n = std::size_t(2) * _mesh->num_nodes();
  const bool sizes =
      x_old.size() == n and x_new.size() == n
      and (facet_volumes.empty()
           or facet_volumes.size() == std::size_t(_mesh->num_facets()))
      and partitions.size() >= materials.mixed().size()
      and materials.num_cells() == _mesh->num_cells()
      and std::all_of(_options.beyond.begin(), _options.beyond.end(),
                      [&](std::int32_t m)
                      { return m >= -1 and m < materials.num_materials(); });
  if (host.max(sizes ? 0.0 : 1.0) > 0)
    return Outcome::wrong_size;
  const bool finite =
      all_finite(x_old) and all_finite(x_new) and all_finite(facet_volumes);
  if (host.max(finite ? 0.0 : 1.0) > 0)
    return Outcome::not_finite;
  if (host.max(sound(*_mesh, materials, x_old) ? 0.0 : 1.0) > 0)
    return Outcome::bad_materials;
  _passed.assign(materials.num_materials(), {});
  return _options.geometry == Geometry::plane
             ? run<Geometry::plane>(materials, ledger)
             : run<Geometry::axisymmetric>(materials, ledger);
}
