// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What a new cell takes from old ones, and what of old ones nobody takes.

#include "remap/geometry/position.h"
#include "remap/materials/volume_transport.h"

#include <algorithm>
#include <limits>

using namespace remap;
using namespace remap::position;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

template <Geometry G>
double scale_of(const Triangle& place, double length, double other)
{
  return length * std::max(length, other) * weight<G>(place);
}

/// Part of a polygon in a triangle, with room for two polygons.
/// @param[in] cuts half-planes of the triangle, a bit each, that cut it
const bent::Region* clip_to(const Polygon<6>& p, const Triangle& t,
                            unsigned cuts, bent::Region (&room)[2])
{
  int at = 0;
  room[0].size = p.size;
  std::copy_n(p.x.begin(), p.size, room[0].x.begin());
  std::copy_n(p.y.begin(), p.size, room[0].y.begin());
  for (int k = 0; k < 3 and room[at].size > 0; ++k)
    if ((cuts >> k & 1u) != 0)
    {
      bent::clip(room[at], HalfPlane::left_of(t[k], t[(k + 1) % 3]),
                 room[1 - at]);
      at = 1 - at;
    }
  return &room[at];
}
} // namespace

/// Do all cells that were met hold one material, far from interfaces?
bool VolumeTransport::alone(std::int32_t& material) const
{
  const auto met = _walk.met();
  if (met.empty())
    return false;
  material = _call.materials->pure(met[0].cell);
  for (const auto& [c, cuts] : met)
    if (_front_of[c] >= 0 or _call.materials->pure(c) != material)
      return false;
  return std::all_of(_walk.edges().begin(), _walk.edges().end(),
                     [this](std::int32_t f) { return _walk.is_outline(f); });
}

void VolumeTransport::share(std::int32_t material, const Moments& m)
{
  for (std::size_t i = _first; i < _shares.size(); ++i)
    if (_shares[i].material == material)
    {
      _shares[i].moments += m;
      return;
    }
  _shares.push_back({material, m});
}

/// The one material of all met cells without an interface; -1 if there are two,
/// or if old cells may not fill the new one.
std::int32_t VolumeTransport::material_of_rest() const
{
  if (_outline_moved or not _walk.edges().empty())
    return -1;
  std::int32_t material = -1;
  for (const auto& [c, cuts] : _walk.met())
  {
    if (_front_of[c] >= 0)
      continue;
    const std::int32_t here = _call.materials->pure(c);
    if (material >= 0 and here != material)
      return -1;
    material = here;
  }
  return material;
}

/// Overlaps of a new cell with the old ones that it met, by material.
/// @param[in] count_only for a cell of another rank: only what our fronts give
template <Geometry G>
void VolumeTransport::gather(const bent::Cell& target, bool count_only)
{
  const Materials& m = *_call.materials;
  // Cells without an interface are of one material, mostly: it has the rest.
  const std::int32_t rest = count_only ? -1 : material_of_rest();
  Moments others;
  for (const auto& [c, cuts] : _walk.met())
  {
    const std::int32_t s = _front_of[c];
    if (count_only and (s < 0 or c >= _mesh->owned_cells()))
      continue;
    if (rest >= 0 and s < 0)
      continue;
    const Triangle t = _walk.place(_call.x_old, c, target.origin);
    bent::Region room[2];
    const bent::Region* piece = clip_to(target.outline, t, cuts, room);
    if (piece->size < 3)
      continue;
    ++_report.pieces;
    _other = std::max(_other, longest_edge(t));
    const auto use = [&](int part, const Moments& got)
    {
      if (not(got.v > 0))
        return;
      if (s >= 0)
      {
        _given[_fronts[s].first + part] += got.v;
        _fronts[s].length = std::max(_fronts[s].length, target.length);
        _taken.emplace_back(_fronts[s].first + part, got.v);
      }
      others += got;
      if (not count_only)
        share(m.row(c) < 0 ? m.pure(c) : m.parts(m.row(c))[part].material, got);
    };
    if (m.row(c) < 0)
      use(0, bent::moments<G>(*piece, target.origin));
    else
    {
      const Partition& by = _call.partitions[m.row(c)];
      bent::split_by<G>(*piece, by, by.count > 0 ? 0 : ~0, target.origin, use);
    }
  }
  if (rest >= 0)
    if (const Moments left = target.whole - others; left.v > 0)
      share(rest, left);
}

/// The longest part of an outline inside a place, by its facet, or -1.
/// @param[out] halo does what this rank sees of the mesh end there?
std::int32_t VolumeTransport::edge_inside(const CellWalk& walk,
                                          std::span<const double> x,
                                          Point origin, const Triangle& place,
                                          bool& halo) const
{
  double longest = 0;
  std::int32_t facet = -1;
  halo = false;
  for (std::int32_t f : walk.edges())
  {
    const auto [a, b] = _mesh->facet(f);
    const double length =
        length_inside(point(x, a) - origin, point(x, b) - origin, place);
    if (length > 0 and not walk.is_outline(f))
      halo = true;
    else if (length > longest)
    {
      longest = length;
      facet = f;
    }
  }
  return facet;
}

/// Facet of the outline that a new cell reaches over; -1 if it does not, or the
/// call has failed. Looks again for cells that no walk finds.
template <Geometry G>
std::int32_t VolumeTransport::facet_beyond(std::int32_t d,
                                           const bent::Cell& target,
                                           double scale)
{
  bool halo = false;
  std::int32_t facet =
      edge_inside(_walk, _call.x_old, target.origin, target.nodes, halo);
  if (facet >= 0 or halo)
  {
    if (halo)
      fail(Outcome::beyond_halo, d);
    return halo ? -1 : facet;
  }
  double found = 0;
  for (std::size_t i = _first; i < _shares.size(); ++i)
    found += _shares[i].moments.v;
  if (not(target.whole.v - found > gap_size * scale))
    return -1;
  for (const auto& [at, volume] : _taken)
    _given[at] -= volume;
  _taken.clear();
  _shares.resize(_first);
  _walk.meet_everywhere(_call.x_old, target.outline, target.nodes,
                        target.origin);
  gather<G>(target, false);
  facet = edge_inside(_walk, _call.x_old, target.origin, target.nodes, halo);
  if (facet < 0 and _mesh->num_cells() > _mesh->owned_cells())
    halo = true;
  if (halo)
  {
    fail(Outcome::beyond_halo, d);
    return -1;
  }
  return facet >= 0
             ? facet
             : _walk.nearest_outline(
                   _call.x_old, target.origin
                                    + 1.0 / 3
                                          * (target.nodes[0] + target.nodes[1]
                                             + target.nodes[2]));
}

/// What lies outside the old mesh is of the material beyond, or as what the
/// cell found inside.
void VolumeTransport::gain(std::int32_t d, const bent::Cell& target,
                           std::int32_t facet)
{
  Moments found;
  for (std::size_t i = _first; i < _shares.size(); ++i)
    found += _shares[i].moments;
  const Moments gap = target.whole - found;
  if (not(gap.v > 0))
    return;
  const std::int32_t marker = _mesh->marker(facet);
  const Boundary kind = kind_of(_options.boundaries, marker);
  const bool given = kind != Boundary::closed and marker >= 0
                     and marker < std::ssize(_options.beyond)
                     and _options.beyond[marker] >= 0;
  if (given or _shares.size() == _first)
  {
    const Materials& m = *_call.materials;
    const std::int32_t own =
        m.row(d) < 0 ? m.pure(d) : m.parts(m.row(d))[0].material;
    const std::int32_t material = given ? _options.beyond[marker] : own;
    share(material, gap);
    book(material, facet, true, gap.v);
    return;
  }
  for (std::size_t i = _first; i < _shares.size(); ++i)
    book(_shares[i].material, facet, true,
         gap.v * _shares[i].moments.v / found.v);
}

void VolumeTransport::book(std::int32_t material, std::int32_t facet,
                           bool inwards, double volume)
{
  const Boundary kind = kind_of(_options.boundaries, _mesh->marker(facet));
  const auto at = static_cast<std::size_t>(way(kind, inwards));
  _passed[material][at] += inwards ? volume : -volume;
}

/// Shares of a new cell, all found, add up to it.
void VolumeTransport::settle(std::int32_t d, const bent::Cell& target)
{
  const auto begin = _shares.begin() + static_cast<std::ptrdiff_t>(_first);
  const auto volume = [](const Share& s) { return s.moments.v; };
  const auto larger = [&](const Share& a, const Share& b)
  { return volume(a) > volume(b); };
  // Dust of round-off is none.
  std::sort(begin, _shares.end(), larger);
  while (_shares.size() > _first + 1
         and volume(_shares.back()) < 4 * eps * target.whole.v)
    _shares.pop_back();
  while (_shares.size() > _first + most_parts)
  {
    _report.merged_volume += volume(_shares.back());
    _shares[_first].moments += _shares.back().moments;
    _shares.pop_back();
  }
  std::sort(begin, _shares.end(), [](const Share& a, const Share& b)
            { return a.material < b.material; });
  _results.push_back({d, static_cast<std::int32_t>(_first),
                      static_cast<std::int32_t>(_shares.size() - _first),
                      target.origin, target.length});
}

template <Geometry G>
void VolumeTransport::close(std::int32_t d, const bent::Cell& target)
{
  double found = 0;
  for (std::size_t i = _first; i < _shares.size(); ++i)
    found += _shares[i].moments.v;
  const Triangle place = _walk.place(_call.x_new, d, {});
  const double scale = scale_of<G>(place, target.length, _other);
  if (target.whole.v - found > round_off * scale)
  {
    const std::int32_t facet = facet_beyond<G>(d, target, scale);
    if (facet >= 0)
      gain(d, target, facet);
    if (_outcome == Outcome::ok and _shares.size() == _first)
      fail(Outcome::inverted_start, d);
  }
  else if (not(target.whole.v - found > -gap_size * scale))
    fail(Outcome::inverted_start, d);
  if (_outcome == Outcome::ok)
    settle(d, target);
}

template <Geometry G>
void VolumeTransport::carry_cell(std::int32_t d)
{
  const bent::Cell target =
      bent::cell<G>(*_mesh, _call.x_old, _call.x_new, _call.facet_volumes, d);
  const bool ours = d < _mesh->owned_cells();
  if (not target.good)
    return ours ? fail(Outcome::inverted_target, d) : void();
  _walk.meet(_call.x_old, target.outline, target.nodes, target.origin, d);
  _first = _shares.size();
  _other = 0;
  _taken.clear();
  if (not ours)
    return gather<G>(target, true);
  ++_report.zone;
  if (std::int32_t material = -1; alone(material))
  {
    _status[d] = pure;
    _pure_of[d] = material;
    _results.push_back({d, material, 0, {}, 0});
    return;
  }
  ++_report.clipped;
  _status[d] = mixed;
  gather<G>(target, false);
  close<G>(d, target);
}

double VolumeTransport::missing(const Front& front) const
{
  double found = 0;
  for (std::int32_t p = 0; p < front.count; ++p)
    found += _given[front.first + p];
  return front.whole - found;
}

/// Volume of an old cell that new cells cover, by looking for them.
template <Geometry G>
double VolumeTransport::kept(std::int32_t c)
{
  const Triangle t = _walk.place(_call.x_old, c, {});
  const Triangle from{Point{}, t[1] - t[0], t[2] - t[0]};
  Polygon<6> p;
  for (const Point& v : from)
    p.push(v);
  // A walk may miss some where the body has moved away from under the cell.
  _back.meet_everywhere(_call.x_new, p, from, t[0]);
  double sum = 0;
  for (const auto& [d, cuts] : _back.met())
  {
    const bent::Cell target =
        bent::cell<G>(*_mesh, _call.x_old, _call.x_new, _call.facet_volumes, d);
    bent::Region room[2];
    sum += bent::moments<G>(*clip_to(target.outline,
                                     _walk.place(_call.x_old, c, target.origin),
                                     7, room),
                            target.origin)
               .v;
  }
  return sum;
}

/// What of an old cell is not found has left the body: has it?
template <Geometry G>
bool VolumeTransport::book_lost(const Front& f)
{
  const Materials& m = *_call.materials;
  const Triangle t = _walk.place(_call.x_old, f.cell, {});
  const double lost = missing(f), scale = scale_of<G>(t, f.length, 0);
  if (not(lost > -gap_size * scale))
    fail(Outcome::inverted_target, f.cell);
  if (not(lost > round_off * scale))
    return false;
  const Triangle place{Point{}, t[1] - t[0], t[2] - t[0]};
  Polygon<6> p;
  for (const Point& v : place)
    p.push(v);
  _back.meet(_call.x_new, p, place, t[0], f.cell);
  bool halo = false;
  std::int32_t facet = edge_inside(_back, _call.x_new, t[0], place, halo);
  const bool ghosts = _mesh->num_cells() > _mesh->owned_cells();
  if (halo or (facet < 0 and ghosts and lost > gap_size * scale))
  {
    fail(Outcome::beyond_halo, f.cell);
    return false;
  }
  if (facet < 0)
    facet = _back.nearest_outline(_call.x_new, t[0]);
  const std::int32_t row = m.row(f.cell);
  for (std::int32_t k = 0; k < f.count; ++k)
  {
    const double had = row < 0 ? 1 : m.parts(row)[k].fraction;
    book(row < 0 ? m.pure(f.cell) : m.parts(row)[k].material, facet, false,
         had * f.whole - _given[f.first + k]);
  }
  return true;
}

/// Old cells that have lost something; from them on inwards, since the outline
/// may have moved by more than a cell.
template <Geometry G>
void VolumeTransport::book_all_lost()
{
  const Host& host = *_call.host;
  const std::size_t first = _fronts.size();
  const auto spread = [this](std::int32_t c)
  {
    for (std::int32_t e : _mesh->cell_cells()[c])
      if (e < _mesh->owned_cells())
        add_front<G>(e);
  };
  std::size_t done = 0;
  bool more = true;
  while (more)
  {
    if (host.cell_halo)
      _flags.assign(_mesh->num_cells(), 0);
    for (; done < _fronts.size(); ++done)
    {
      const std::int32_t c = _fronts[done].cell;
      if (c >= _mesh->owned_cells())
        continue;
      if (done >= first)
        _given[_fronts[done].first] = kept<G>(c);
      if (not book_lost<G>(_fronts[done]))
        continue;
      spread(c);
      if (host.cell_halo)
        _flags[c] = 1;
    }
    if (host.cell_halo)
    {
      host.update_cells(_flags, 1);
      for (std::int32_t c = _mesh->owned_cells(); c < _mesh->num_cells(); ++c)
        if (_flags[c] > 0)
          spread(c);
    }
    more = host.max(done < _fronts.size() ? 1.0 : 0.0) > 0;
  }
}

template void VolumeTransport::carry_cell<Geometry::plane>(std::int32_t);
template void VolumeTransport::carry_cell<Geometry::axisymmetric>(std::int32_t);
template void VolumeTransport::book_all_lost<Geometry::plane>();
template void VolumeTransport::book_all_lost<Geometry::axisymmetric>();
