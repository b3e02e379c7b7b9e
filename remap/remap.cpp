// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/remap.h"

#include "remap/materials/sound.h"

#include <algorithm>
#include <cmath>

using namespace remap;

void Remapper::find_touched(std::span<const double> x_old,
                            std::span<const double> x_new)
{
  for (std::int32_t i : _moved_nodes)
    _moved[i] = 0;
  _moved_nodes.clear();
  for (std::int32_t i = 0; i < _mesh->num_nodes(); ++i)
    if (not(point(x_old, i) == point(x_new, i)))
    {
      _moved[i] = 1;
      _moved_nodes.push_back(i);
    }
  _cells.clear();
  _nodes.clear();
  for (std::int32_t i : _moved_nodes)
    for (std::int32_t c : _mesh->node_cells()[i])
      _cells.touch(c);
  _cells.order();
  _cells.find_facets(_moved);
  if (_dual)
  {
    for (std::int32_t c : _cells.touched)
      for (std::int32_t i : _mesh->cell(c))
        _nodes.touch(i);
    _nodes.order();
  }
  if (_fine)
    touch_points();
  _report.moved_nodes = static_cast<std::int32_t>(_moved_nodes.size());
  _report.touched_cells = static_cast<std::int32_t>(_cells.touched.size());
}

/// All points of a cell change when one of its nodes moves: its centroid does.
void Remapper::touch_points()
{
  CellVolumes& v = _points->volumes;
  const int points = _options.points->points();
  v.clear();
  std::fill(_points->moved.begin(), _points->moved.end(), std::uint8_t(0));
  place_points(_cells.touched, _x_old, _points->x);
  place_points(_cells.touched, _x_new, _points->y);
  for (std::int32_t c : _cells.touched)
    for (std::int32_t q = points * c; q < points * (c + 1); ++q)
    {
      v.touch(q);
      for (std::int32_t i : v.mesh->cell(q))
        _points->moved[i] = not(point(_points->x, i) == point(_points->y, i));
    }
  v.find_facets(_points->moved);
}

void Remapper::place_points(std::span<const std::int32_t> cells,
                            std::span<const double> from,
                            std::vector<double>& to)
{
  for (std::int32_t c : cells)
    _options.points->place(c, from, to);
}

/// A ghost node may change because of a cell that we do not see; its owner must
/// know that we need the centroids around it, and we that it changes.
void Remapper::exchange_touched(const Host& host)
{
  if (_dual)
  {
    for (std::size_t i = 0; i < _flags.size(); ++i)
      _flags[i] = _nodes.mark[i];
    host.update_nodes(_flags, 1);
    for (std::int32_t i = _mesh->owned_nodes(); i < _mesh->num_nodes(); ++i)
      if (_flags[i] > 0)
        _nodes.touch(i);
    _nodes.close_rings(rings_of(_options.nodal_scheme));
  }
  const int rings = rings_of(_options.scheme);
  _cells.close_rings(rings);
  if (not _fine)
    return;
  _points->volumes.close_rings(rings);
  place_points(_cells.ring, _x_old, _points->x);
}

template <Geometry G>
void Remapper::measure(bool with_ring, const Host& host)
{
  const auto both = [with_ring](auto& volumes, std::span<const double> x)
  {
    volumes.template measure<G>(volumes.touched, x);
    if (with_ring)
      volumes.template measure<G>(volumes.ring, x);
  };
  both(_cells, _x);
  if (_fine)
    both(_points->volumes, _points->x);
  if (_dual)
  {
    both(_nodes, _x);
    _nodes.update_centroids(host);
  }
}

/// Volumes at y.
template <Geometry G>
void Remapper::measure_next(std::span<const double> y)
{
  _cells.measure_next<G>(y);
  if (_fine)
    _points->volumes.measure_next<G>(_points->y);
  if (_dual)
    _nodes.measure_next<G>(y);
}

/// Does a cell of any rank have no positive volume? Then the report names it.
bool Remapper::inverted(bool at_end, const Host& host)
{
  const double worst = _cells.inverted(at_end ? _cells.next : _cells.volume);
  _report.worst_cell = static_cast<std::int64_t>(host.max(worst));
  return _report.worst_cell >= 0;
}

/// Regions swept between _x and _y.
template <Geometry G>
void Remapper::sweep()
{
  _cells.sweep_all<G>(_x, _y);
  if (_fine)
    _points->volumes.sweep_all<G>(_points->x, _points->y);
  if (_dual)
    _nodes.sweep_all<G>(_cells.touched, _moved, _x, _y);
}

/// Moved nodes at part `at` of their way, into _y; exact at the end.
void Remapper::place(double at)
{
  for (std::int32_t i : _moved_nodes)
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t k = 2 * static_cast<std::size_t>(i) + d;
      _y[k] = at < 1 ? _x_old[k] + at * (_x_new[k] - _x_old[k]) : _x_new[k];
    }
  if (_fine)
    place_points(_cells.touched, _y, _points->y);
}

/// Divide what is left of the way until no volume loses too much in the next
/// sub-cycle. A volume that grows from nearly nothing needs short steps only at
/// first: the last step's loss tells how many of its kind are left.
///
/// @param[in]     at   part of the way done
/// @param[in,out] left equal sub-cycles for the rest
/// @param[in,out] loss of the last sub-cycle, and of this one
template <Geometry G>
Outcome Remapper::choose_cycle(double at, double& left, double& loss,
                               const Host& host)
{
  // Round-off of a loss must not decide on the number of sub-cycles: ranks cut
  // differently would disagree with themselves.
  constexpr double slack = 1e-9;
  constexpr double shortest = 1e13;
  const auto needed = [this](double steps, double lost)
  {
    return std::max(1.0, std::ceil(steps * lost / _options.max_loss - slack));
  };
  left = needed(left, loss);
  while (true)
  {
    place(left == 1 ? 1 : at + (1 - at) / left);
    sweep<G>();
    loss = _cells.largest_loss();
    if (_fine)
      loss = std::max(loss, _points->volumes.largest_loss());
    if (_dual)
      loss = std::max(loss, _nodes.largest_loss());
    loss = host.max(loss);
    if (_report.cycles == 0 and left == 1)
      _report.loss = loss;
    const bool good = loss <= (1 + slack) * _options.max_loss;
    const bool last = _report.cycles + 1 >= _options.max_cycles;
    if (last and not(good and left == 1))
      return Outcome::too_many_cycles;
    if (good)
      return Outcome::ok;
    left = std::max(needed(left, loss), left + 1.0);
    if (not(left < shortest))
      return Outcome::too_many_cycles;
  }
}

template <Geometry G>
Outcome Remapper::run(const Fields& fields, const Host& host, Ledger& ledger)
{
  exchange_touched(host);
  std::copy(_x_old.begin(), _x_old.end(), _x.begin());
  std::copy(_x_old.begin(), _x_old.end(), _y.begin());
  measure<G>(true, host);
  if (inverted(false, host))
    return Outcome::inverted_start;
  measure_next<G>(_x_new);
  if (inverted(true, host))
    return Outcome::inverted_target;

  Outcome out = Outcome::ok;
  if (_options.method == Method::swept)
    out = sweep_on<G>(fields, host);
  const bool too_far =
      out == Outcome::too_many_cycles or out == Outcome::inverted_path;
  if (_options.method == Method::overlay
      or (too_far and _overlap and not _masses))
    out = overlay_on<G>(fields, host);
  if (out != Outcome::ok)
    return out;
  repair<G>(fields, host);
  if (fields.materials)
  {
    _materials->count(host);
    _report.materials = _materials->report();
  }
  settle(fields, host, ledger);
  return Outcome::ok;
}

/// All the way by swept regions, or until one of its ends is told.
template <Geometry G>
Outcome Remapper::sweep_on(const Fields& fields, const Host& host)
{
  double at = 0, left = 1, loss = 0;
  while (at < 1)
  {
    if (_report.cycles > 0)
      measure<G>(false, host);
    if (const Outcome o = choose_cycle<G>(at, left, loss, host);
        o != Outcome::ok)
      return o;
    // In one cycle the volumes at the end are known and good.
    if (_report.cycles > 0 or left > 1)
    {
      measure_next<G>(_y);
      if (inverted(true, host))
        return Outcome::inverted_path;
    }
    at = left == 1 ? 1 : at + (1 - at) / left;
    left = std::max(left - 1, 1.0);
    carry<G>(fields, host);
    ++_report.cycles;
    for (std::int32_t i : _moved_nodes)
    {
      _x[2 * i] = _y[2 * i];
      _x[2 * i + 1] = _y[2 * i + 1];
    }
    if (_fine)
      place_points(_cells.touched, _x, _points->x);
  }
  return Outcome::ok;
}

/// From where the fields are now, at _x, to the end.
template <Geometry G>
Outcome Remapper::overlay_on(const Fields& fields, const Host& host)
{
  place(1);
  measure<G>(_report.cycles == 0, host);
  measure_next<G>(_x_new);
  Outcome out = _overlap->cells<G>(_cells, _x, _y);
  const std::int64_t worst = _overlap->worst_cell();
  if (_fine and out == Outcome::ok)
    out = _overlap->points<G>(_points->volumes, _points->x, _points->y);
  if (_dual and out == Outcome::ok)
    out = _overlap->nodes<G>(_nodes, _cells.touched, _x, _y);
  // All ranks end alike.
  double all[2] = {static_cast<double>(out), static_cast<double>(worst)};
  host.max(all);
  out = static_cast<Outcome>(static_cast<int>(all[0]));
  if (out != Outcome::ok)
  {
    _report.worst_cell = static_cast<std::int64_t>(all[1]);
    return out;
  }
  _report.overlaid = true;
  carry<G>(fields, host);
  return Outcome::ok;
}

/// What the halos of this call do.
void Remapper::prepare_halos(const Host& host)
{
  _cell_halo = [&host](std::span<double> v, int block)
  { host.update_cells(v, block); };
  _node_halo = [&host](std::span<double> v, int block)
  { host.update_nodes(v, block); };
  if (_fine)
    _point_halo = [&host, points = _options.points->points()](
                      std::span<double> v, int block)
    { host.update_cells(v, points * block); };
}

/// Has a node of ours only void around it?
bool Remapper::some_node_is_massless() const
{
  for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
  {
    const auto around = _mesh->node_cells()[i];
    if (std::none_of(around.begin(), around.end(),
                     [this](std::int32_t c) { return _mixture[c] > 0; }))
      return true;
  }
  return false;
}

Outcome Remapper::remap(std::span<const double> x_old,
                        std::span<const double> x_new, const Fields& fields,
                        const Host& host, Ledger& ledger)
{
  const auto finite = [](std::span<const double> x)
  {
    return std::all_of(x.begin(), x.end(),
                       [](double v) { return std::isfinite(v); });
  };
  _report = {};
  // All ranks learn of the worst trouble of any, and that some node moved.
  const bool fit = sizes_fit(x_old, x_new, fields);
  const bool good = fit and finite(x_old) and finite(x_new);
  _masses = not fields.per_mass.empty();
  _dual = not fields.nodes.empty() or _masses;
  _fine = not fields.points.empty();
  _x_old = x_old;
  _x_new = x_new;
  const bool sound = not good or not fields.materials
                     or remap::sound(*_mesh, *fields.materials, x_old);
  if (good)
    find_touched(x_old, x_new);
  double state[4] = {fit ? 0.0 : 1.0, good ? 0.0 : 1.0, sound ? 0.0 : 1.0,
                     good and not _moved_nodes.empty() ? 1.0 : 0.0};
  host.max(std::span(state, 4));
  if (state[0] > 0)
    return Outcome::wrong_size;
  if (state[1] > 0)
    return Outcome::not_finite;
  if (state[2] > 0)
    return Outcome::bad_materials;
  if (_materials)
    _materials->start(fields);
  if (_masses and mixture(fields))
  {
    for (std::int32_t c = 0; c < _mesh->num_cells(); ++c)
      _mixture[c] = _materials->mixture(c);
    if (host.max(some_node_is_massless() ? 1.0 : 0.0) > 0)
      return Outcome::no_mass;
  }
  std::size_t entries = 2;
  for (const auto& list :
       {fields.cells, fields.points, fields.nodes, fields.per_mass})
    for (const Field& field : list)
      entries += static_cast<std::size_t>(field.components);
  if (_materials)
    entries += _materials->entries();
  _book.assign(entries, {});
  if (not(state[3] > 0))
  {
    settle(fields, {}, ledger);
    return Outcome::ok;
  }
  prepare_halos(host);
  return _options.geometry == Geometry::plane
             ? run<Geometry::plane>(fields, host, ledger)
             : run<Geometry::axisymmetric>(fields, host, ledger);
}
