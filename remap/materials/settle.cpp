// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What cells hold after a sub-cycle: new parts, their fields in new slots, and
// the same on all ranks that see them.

#include "remap/materials/transport.h"

#include "remap/geometry/position.h"

#include <algorithm>
#include <cmath>

using namespace remap;

/// Fill ghosts of an array over slots, of which the parts are not newcomers:
/// cells first, then first parts of mixed cells, second parts and so on.
void MaterialTransport::update(std::span<double> values, int block,
                               const Host& host)
{
  if (not host.cell_halo)
    return;
  const auto width = static_cast<std::size_t>(block);
  const auto cells = static_cast<std::size_t>(_mesh->num_cells());
  host.update_cells(values.first(cells * width), block);
  const Materials& m = *_materials;
  double most = 0;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
    most = std::max(most, static_cast<double>(
                              m.parts(static_cast<std::int32_t>(r)).size()));
  const auto parts = static_cast<std::size_t>(host.max(most));
  _sent.resize(cells * width);
  for (std::size_t k = 0; k < parts; ++k)
    for (const bool out : {true, false})
    {
      for (std::size_t r = 0; r < m.mixed().size(); ++r)
      {
        const auto row = static_cast<std::int32_t>(r);
        if (k >= m.parts(row).size())
          continue;
        double* slot =
            &values[width * (static_cast<std::size_t>(m.first_slot(row)) + k)];
        double* cell = &_sent[width * static_cast<std::size_t>(m.mixed()[r])];
        if (out)
          std::copy_n(slot, width, cell);
        else if (m.mixed()[r] >= _mesh->owned_cells())
          std::copy_n(cell, width, slot);
      }
      if (out)
        host.update_cells(_sent, block);
    }
}

/// What one of our cells holds at y.
template <Geometry G>
void MaterialTransport::collect_cell(std::int32_t c, std::span<const double> y)
{
  const ControlVolumes& cv = *_cv;
  const Triple& n = _mesh->cell(c);
  const Triangle t = {point(y, n[0]), point(y, n[1]), point(y, n[2])};
  const Point from = cv.centroid[c];
  const std::size_t begin = _entries.size();
  double sum = 0, whole = 0;
  const auto add =
      [&](std::int32_t slot, std::int32_t material, double v, Point moment)
  {
    _entries.push_back({c, slot, {material, v, from + (1 / v) * moment}});
    whole += std::max(v, 0.0);
  };
  const std::int32_t row = _materials->row(c);
  if (row >= 0)
  {
    std::int32_t slot = _materials->first_slot(row);
    for (const Part& part : _materials->parts(row))
    {
      add(slot, part.material, cv.next[slot], _moment[slot - cv.first_part]);
      ++slot;
    }
  }
  Moments own = cell_moments<G>(*_mesh, c, y);
  own.x -= own.v * from.x;
  own.y -= own.v * from.y;
  for (std::int32_t k = _head[c]; k >= 0; k = _newcomers[k].next)
  {
    const std::int32_t slot = _materials->num_slots() + k;
    const Point m = _moment[slot - cv.first_part];
    add(slot, _newcomers[k].material, cv.next[slot], m);
    own = own - Moments{cv.next[slot], m.x, m.y};
  }
  if (row < 0)
    add(c, _materials->pure(c), cv.next[c], {own.x, own.y});
  // Round-off goes, the rest fills the cell.
  const auto last = std::remove_if(
      _entries.begin() + static_cast<std::ptrdiff_t>(begin), _entries.end(),
      [&](const Entry& e) { return not(e.part.fraction > round_off * whole); });
  _entries.erase(last, _entries.end());
  for (std::size_t i = begin; i < _entries.size(); ++i)
    sum += _entries[i].part.fraction;
  for (std::size_t i = begin; i < _entries.size(); ++i)
  {
    _entries[i].part.fraction /= sum;
    _entries[i].part.centroid = held_inside(t, _entries[i].part.centroid);
  }
  std::sort(_entries.begin() + static_cast<std::ptrdiff_t>(begin),
            _entries.end(), [](const Entry& a, const Entry& b)
            { return a.part.material < b.part.material; });
}

/// What our cells hold at y: mixed ones, and those that newcomers came to.
template <Geometry G>
void MaterialTransport::collect(std::span<const double> y)
{
  _entries.clear();
  const Materials& m = *_materials;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
    if (const std::int32_t c = m.mixed()[r]; c >= _cv->owned)
      continue;
    else if (_cv->mark[c] == 1)
      collect_cell<G>(c, y);
    else
      keep_row(static_cast<std::int32_t>(r));
  for (std::int32_t c : _guests)
    if (c < _cv->owned and m.row(c) < 0)
      collect_cell<G>(c, y);
}

/// A mixed cell as it is.
void MaterialTransport::keep_row(std::int32_t row)
{
  std::int32_t slot = _materials->first_slot(row);
  for (const Part& part : _materials->parts(row))
    _entries.push_back({_materials->mixed()[row], slot++, part});
}

/// What ghosts hold, from their owners.
void MaterialTransport::exchange_entries(const Host& host)
{
  if (not host.cell_halo)
    return;
  const std::int32_t cells = _mesh->num_cells(), owned = _mesh->owned_cells();
  // Material of a pure cell, or less the number of parts of a mixed one.
  std::vector<double> code(cells);
  std::vector<std::int32_t> first(cells, -1);
  for (std::int32_t c = 0; c < owned; ++c)
    code[c] = _materials->pure(c);
  for (std::size_t i = 0; i < _entries.size(); ++i)
  {
    const std::int32_t c = _entries[i].cell;
    if (first[c] < 0)
    {
      first[c] = static_cast<std::int32_t>(i);
      code[c] = 0;
    }
    --code[c];
  }
  double most = 0;
  for (std::int32_t c = 0; c < owned; ++c)
  {
    if (code[c] == -1) // mixed no more
      code[c] = _entries[first[c]].part.material;
    most = std::max(most, -code[c]);
  }
  host.update_cells(code, 1);
  const int parts = static_cast<int>(host.max(most));
  constexpr int block = 4;
  std::vector<double> sent(std::size_t(block) * cells);
  std::vector<Entry> ghosts;
  for (int k = 0; k < parts; ++k)
  {
    for (std::int32_t c = 0; c < owned; ++c)
      if (-code[c] > k)
      {
        const Part& p = _entries[first[c] + k].part;
        const double all[block] = {static_cast<double>(p.material), p.fraction,
                                   p.centroid.x, p.centroid.y};
        std::copy_n(all, block, &sent[std::size_t(block) * c]);
      }
    host.update_cells(sent, block);
    for (std::int32_t c = owned; c < cells; ++c)
      if (-code[c] > k)
      {
        const double* p = &sent[std::size_t(block) * c];
        ghosts.push_back(
            {c, -1, {static_cast<std::int32_t>(p[0]), p[1], {p[2], p[3]}}});
      }
  }
  for (std::int32_t c = owned; c < cells; ++c)
    if (code[c] >= 0
        and (_materials->row(c) >= 0
             or _materials->pure(c) != static_cast<std::int32_t>(code[c])))
      ghosts.push_back({c, -1, {static_cast<std::int32_t>(code[c]), 1, {}}});
  std::sort(ghosts.begin(), ghosts.end(),
            [](const Entry& a, const Entry& b)
            {
              return std::pair(a.cell, a.part.material)
                     < std::pair(b.cell, b.part.material);
            });
  _entries.insert(_entries.end(), ghosts.begin(), ghosts.end());
}

/// Cells hold what the entries say; fields move to their new slots.
void MaterialTransport::assign()
{
  Materials& m = *_materials;
  std::vector<std::vector<double>> moved(_fields.size());
  for (std::size_t f = 0; f < _fields.size(); ++f)
  {
    const auto n = static_cast<std::size_t>(_fields[f].components);
    const std::vector<double>& values = _fields[f].values;
    moved[f].resize(n * _entries.size());
    for (std::size_t i = 0; i < _entries.size(); ++i)
      if (const std::int32_t slot = _entries[i].slot; slot >= 0)
        std::copy_n(&values[n * static_cast<std::size_t>(slot)], n,
                    &moved[f][n * i]);
  }
  m.drop_rows();
  std::array<Part, most_parts> parts;
  std::vector<std::int32_t> target(_entries.size());
  for (std::size_t i = 0; i < _entries.size();)
  {
    const std::int32_t c = _entries[i].cell;
    std::size_t size = 0;
    for (; i + size < _entries.size() and _entries[i + size].cell == c; ++size)
      parts[size] = _entries[i + size].part;
    if (size == 1)
      m.set_pure(c, parts[0].material);
    else
      m.add_row(c, std::span(parts.data(), size));
    const std::int32_t slot =
        size == 1
            ? c
            : m.first_slot(static_cast<std::int32_t>(m.mixed().size() - 1));
    for (std::size_t k = 0; k < size; ++k)
      target[i + k] = slot + static_cast<std::int32_t>(k);
    i += size;
  }
  for (std::size_t f = 0; f < _fields.size(); ++f)
  {
    const auto n = static_cast<std::size_t>(_fields[f].components);
    std::vector<double>& values = _fields[f].values;
    values.resize(n * static_cast<std::size_t>(m.num_slots()));
    for (std::int32_t c : m.mixed())
      std::fill_n(&values[n * static_cast<std::size_t>(c)], n, 0.0);
    for (std::size_t i = 0; i < _entries.size(); ++i)
      std::copy_n(&moved[f][n * i], n,
                  &values[n * static_cast<std::size_t>(target[i])]);
  }
  for (const Entry& e : _entries)
    _kinds[e.cell] = m.pure(e.cell);
}

template void
    MaterialTransport::collect<Geometry::plane>(std::span<const double>);
template void
    MaterialTransport::collect<Geometry::axisymmetric>(std::span<const double>);
