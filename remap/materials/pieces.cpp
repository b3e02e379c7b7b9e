// SPDX-License-Identifier: LGPL-3.0-or-later
//
// From what cells exchange to what slots exchange: shares held to what is
// there, then put in the pieces' places; and back.

#include "remap/materials/transport.h"

#include "remap/geometry/position.h"

#include <algorithm>

using namespace remap;

namespace
{
/// A part that keeps less than this part of itself leaves wholly.
constexpr double wholly = 1e-12;
/// Neighbours nearer than the root of this, in lengths of the cell, are none:
/// slivers at a common corner.
constexpr double same_place = 1e-16;
} // namespace

/// Make room for slots.
void MaterialTransport::grow()
{
  const auto num =
      _materials->num_slots() + static_cast<std::int32_t>(_newcomers.size());
  _cv->hold(num);
  _cv->first_new = _materials->num_slots();
  _cv->cell_of_part.resize(num - _cv->first_part);
  _kinds.resize(num);
}

/// What a slot behind the cells holds before the sub-cycle.
void MaterialTransport::set_slot(std::int32_t slot, std::int32_t c,
                                 std::int32_t material, double volume, Point at)
{
  ControlVolumes& cv = *_cv;
  cv.cell_of_part[slot - cv.first_part] = c;
  _kinds[slot] = material;
  cv.volume[slot] = cv.next[slot] = volume;
  cv.centroid[slot] = at;
  cv.leaving[slot] = 0;
  cv.remains[slot] = {};
  if (cv.mark[c] == 1)
    cv.touched.push_back(slot);
  else if (cv.mark[c] == 2)
    cv.ring.push_back(slot);
}

/// @param[in] volume of cells
void MaterialTransport::set_parts(const std::vector<double>& volume)
{
  const Materials& m = *_materials;
  grow();
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const std::int32_t c = m.mixed()[r];
    std::int32_t slot = m.first_slot(static_cast<std::int32_t>(r));
    for (const Part& part : m.parts(static_cast<std::int32_t>(r)))
      set_slot(slot++, c, part.material, part.fraction * volume[c],
               part.centroid);
    _cv->leaving[c] = 0;
    _cv->remains[c] = {};
  }
}

void MaterialTransport::set_newcomers()
{
  grow();
  std::int32_t slot = _materials->num_slots();
  for (const Newcomer& n : _newcomers)
    set_slot(slot++, n.cell, n.material, 0, _cv->centroid[n.cell]);
  _moment.resize(_cv->num - _cv->first_part);
  for (std::int32_t s = _cv->first_part; s < _cv->num; ++s)
    _moment[s - _cv->first_part] =
        _cv->volume[s] * (_cv->centroid[s] - _cv->centroid[cell_of(s)]);
}

/// No part gives more than it has: a scale for what it gives, and its share in
/// what others cannot give.
void MaterialTransport::cap(const Host& host)
{
  ControlVolumes& cv = *_cv;
  const std::int32_t num = cv.num;
  std::vector<double>& out = _buffer;
  out.assign(num - cv.first_part, 0);
  for (const Share& s : _shares)
    if (s.from >= cv.first_part)
      out[s.from - cv.first_part] += s.volume;
  bool any = false;
  double sums[2] = {0, 0};
  const auto begin = [this](std::size_t r)
  { return _materials->first_slot(static_cast<std::int32_t>(r)); };
  const auto over = [&](std::int32_t slot)
  { return out[slot - cv.first_part] > cv.volume[slot]; };
  _caps.clear();
  for (std::size_t r = 0; r < _materials->mixed().size(); ++r)
  {
    if (_materials->mixed()[r] >= cv.owned)
      continue;
    const std::int32_t first = begin(r);
    const auto last =
        first
        + static_cast<std::int32_t>(
            _materials->parts(static_cast<std::int32_t>(r)).size());
    double missing = 0, room = 0;
    for (std::int32_t s = first; s < last; ++s)
    {
      const double more = out[s - cv.first_part] - cv.volume[s];
      (more > 0 ? missing : room) += std::abs(more);
    }
    if (not(missing > 0))
      continue;
    if (_caps.empty())
      _caps.assign(std::size_t(2) * num, 0);
    any = true;
    for (std::int32_t s = first; s < last; ++s)
    {
      const double gives = out[s - cv.first_part];
      // What is given is stored as what is taken away: 0 where nothing is.
      _caps[std::size_t(2) * s] = over(s) ? 1 - cv.volume[s] / gives : 0;
      _caps[std::size_t(2) * s + 1] =
          over(s) or not(room > 0) ? 0 : (cv.volume[s] - gives) / room;
      if (over(s) and gives > (1 + 1e-12) * cv.volume[s])
        ++sums[0];
    }
    sums[1] += missing;
  }
  double all[3] = {any ? 1.0 : 0.0, sums[0], sums[1]};
  host.sum(all);
  if (not(all[0] > 0))
    return;
  _report.capped += static_cast<std::int64_t>(all[1]);
  _report.capped_volume += all[2];
  _caps.resize(std::size_t(2) * num, 0);
  update(_caps, 2, host);
  apply_caps();
}

void MaterialTransport::apply_caps()
{
  const std::size_t last = _shares.size();
  for (std::size_t i = 0; i < last;)
  {
    const std::int32_t p = _shares[i].piece;
    double missing = 0;
    std::size_t end = i;
    for (; end < last and _shares[end].piece == p; ++end)
      if (Share& s = _shares[end]; s.from >= _cv->first_part)
      {
        const double less = _caps[std::size_t(2) * s.from] * s.volume;
        s.volume -= less;
        missing += less;
      }
    const std::size_t begin = i;
    i = end;
    if (not(missing > 0))
      continue;
    const std::int32_t c = cell_of(_shares[begin].from);
    const Point at = p >= 0 ? _cv->inner.at[p] : _cv->outer.at[~p];
    const std::int32_t row = _materials->row(c);
    std::int32_t slot = _materials->first_slot(row);
    for (const Part& part : _materials->parts(row))
    {
      const double more = _caps[std::size_t(2) * slot + 1] * missing;
      const std::int32_t d = p >= 0 ? _cv->inner.to[p] : -1;
      if (more > 0)
        share(p, slot, d < 0 ? -1 : slot_for(d, part.material), false, more,
              at);
      ++slot;
    }
  }
}

/// Put a share among the pieces.
void MaterialTransport::write(const Share& s)
{
  ControlVolumes& cv = *_cv;
  const bool outer = s.piece < 0;
  Pieces& pieces = outer ? cv.outer : cv.inner;
  const std::int32_t parent = outer ? ~s.piece : s.piece;
  auto p = static_cast<std::size_t>(parent);
  if (s.first)
    _saved.push_back({s.piece, pieces.from[p], pieces.to[p], pieces.volume[p],
                      pieces.at[p]});
  else
  {
    cv.make_room();
    p = pieces.count++;
    (outer ? _outer_parent : _parent).push_back(parent);
    if (outer)
    {
      cv.facet[p] = cv.facet[parent];
      cv.marker[p] = cv.marker[parent];
    }
  }
  pieces.from[p] = s.from;
  pieces.to[p] = s.to;
  pieces.volume[p] = s.volume;
  pieces.at[p] = s.at;
}

/// What leaves each part, and where what remains lies: in the cell. Where the
/// pieces' places say otherwise, because interfaces are not quite where the
/// centroids were, or because regions were cut each for itself, the pieces of a
/// part are shifted together. So a part that leaves wholly takes its first
/// moment along, and all that a linear function makes of it.
void MaterialTransport::leave_parts(std::span<const double> x, const Host& host)
{
  ControlVolumes& cv = *_cv;
  for (const Share& s : _shares)
    if (s.from >= cv.first_part)
      cv.leave(s.from, s.volume, s.at);
  double any = 0;
  _shift.assign(std::size_t(2) * cv.num, 0);
  for (std::size_t i = _touched; i < cv.touched.size(); ++i)
  {
    const std::int32_t slot = cv.touched[i];
    if (not cv.ours(slot))
      continue;
    const double rest = cv.volume[slot] - cv.leaving[slot];
    const bool some = rest > wholly * cv.volume[slot]
                      and rest > round_off * cv.volume[cell_of(slot)];
    // First moments of what remains, as pieces say and as it shall be.
    const Point told = cv.remains[slot];
    Point held;
    if (some)
    {
      const Triple& n = _mesh->cell(cell_of(slot));
      const Point own = cv.centroid[slot], at = own + (1 / rest) * told;
      const Point in =
          held_inside({point(x, n[0]), point(x, n[1]), point(x, n[2])}, at);
      cv.remains[slot] = in - own;
      held = in == at ? told : rest * (in - own);
    }
    else
      cv.remains[slot] = {};
    if (cv.leaving[slot] > 0 and not(held == told))
    {
      const Point shift = (1 / cv.leaving[slot]) * (told - held);
      _shift[std::size_t(2) * slot] = shift.x;
      _shift[std::size_t(2) * slot + 1] = shift.y;
      any = 1;
    }
  }
  if (not(host.max(any) > 0))
    return;
  update(_shift, 2, host);
  for (Share& s : _shares)
    if (s.from >= cv.first_part)
      s.at = s.at
             + Point{_shift[std::size_t(2) * s.from],
                     _shift[std::size_t(2) * s.from + 1]};
}

/// Pieces of slots, and what they leave.
void MaterialTransport::write_shares()
{
  ControlVolumes& cv = *_cv;
  for (const Share& s : _shares)
  {
    write(s);
    for (const std::int32_t slot : {s.from, s.to})
    {
      if (slot < cv.first_part)
        continue;
      const double v = slot == s.from ? -s.volume : s.volume;
      cv.next[slot] += v;
      Point& m = _moment[slot - cv.first_part];
      m = m + v * (s.at - cv.centroid[cell_of(slot)]);
    }
  }
  // What newcomers take of a pure cell.
  _guests_next.clear();
  for (std::int32_t c : _guests)
  {
    _guests_next.push_back(cv.next[c]);
    for (std::int32_t k = _head[c]; k >= 0; k = _newcomers[k].next)
      cv.next[c] -= cv.next[_materials->num_slots() + k];
  }
}

/// Neighbours of the slots at interfaces.
void MaterialTransport::find_rows(std::span<const double> x)
{
  CellVolumes& cv = *_cv;
  const Materials& m = *_materials;
  _rows.reset(cv.num);
  const bool sides = cv.across.size() > 0;
  if (sides)
    _sides.reset(cv.num);
  const auto add = [&](std::int32_t slot, std::int32_t c, std::int32_t material)
  {
    const Point at = cv.centroid[slot];
    const Triple& n = _mesh->cell(c);
    const double edge = position::longest_edge(
        {point(x, n[0]), point(x, n[1]), point(x, n[2])});
    const auto use = [&](std::int32_t other)
    {
      const Point d = cv.centroid[other] - at;
      return dot(d, d) > same_place * edge * edge;
    };
    _rows.add(slot, c, material, m, use);
    if (sides)
      _sides.add(slot, c, material, m, use);
  };
  for (std::int32_t c : _near.list())
    if (cv.mark[c] != 0)
    {
      const std::int32_t row = m.row(c);
      if (row < 0)
        add(c, c, m.pure(c));
      else
        for (std::size_t k = 0; k < m.parts(row).size(); ++k)
          add(m.first_slot(row) + static_cast<std::int32_t>(k), c,
              m.parts(row)[k].material);
    }
  for (std::size_t k = 0; k < _newcomers.size(); ++k)
    _rows.add(m.num_slots() + static_cast<std::int32_t>(k), _newcomers[k].cell,
              _newcomers[k].material, m, [](std::int32_t) { return true; });
  cv.neighbours = _rows.rows();
  if (sides)
    cv.beside = _sides.rows();
  cv.fitted = cv.nobody;
}

/// Cells again as they were before.
void MaterialTransport::restore()
{
  CellVolumes& cv = *_cv;
  for (const Saved& s : _saved)
  {
    Pieces& pieces = s.piece < 0 ? cv.outer : cv.inner;
    const auto p = static_cast<std::size_t>(s.piece < 0 ? ~s.piece : s.piece);
    pieces.from[p] = s.from;
    pieces.to[p] = s.to;
    pieces.volume[p] = s.volume;
    pieces.at[p] = s.at;
  }
  cv.inner.count = _inner;
  cv.outer.count = _outer;
  cv.touched.resize(_touched);
  cv.ring.resize(_ring);
  for (std::size_t k = 0; k < _guests.size(); ++k)
  {
    cv.next[_guests[k]] = _guests_next[k];
    _head[_guests[k]] = -1;
  }
  cv.num = cv.first_new = cv.first_part;
  cv.neighbours = _mesh->cell_cells();
  cv.beside = cv.across;
  cv.fitted = cv.nobody;
  cv.kinds.swap(_kinds);
}

/// Keep what of the cells must come back.
void MaterialTransport::begin()
{
  _inner = _cv->inner.count;
  _outer = _cv->outer.count;
  _touched = _cv->touched.size();
  _ring = _cv->ring.size();
  _shares.clear();
  _saved.clear();
  _parent.clear();
  _outer_parent.clear();
  _newcomers.clear();
  _guests.clear();
  _near.find(*_materials);
}

/// From cells to slots.
template <Geometry G>
void MaterialTransport::open(std::span<const double> x,
                             std::span<const double> y, bool overlaid,
                             const Host& host)
{
  CellVolumes& cv = *_cv;
  begin();
  _interfaces.reconstruct(x, *_materials, host);
  if (overlaid)
    cut_overlaid<G>(x, y);
  else
    cut_swept<G>(x, y);
  set_parts(cv.volume);
  cap(host);
  set_newcomers();
  leave_parts(x, host);
  write_shares();
  find_rows(x);
  cv.kinds.swap(_kinds);
}

template void MaterialTransport::open<Geometry::plane>(std::span<const double>,
                                                       std::span<const double>,
                                                       bool, const Host&);
template void MaterialTransport::open<Geometry::axisymmetric>(
    std::span<const double>, std::span<const double>, bool, const Host&);
