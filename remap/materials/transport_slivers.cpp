// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Slivers: a part below a stated fraction goes to a cell near by that holds its
// material, and as much of another material comes back. Volumes of cells, of
// materials and integrals of fields stay. What each cell does hangs on the
// state before only, so ranks that see it agree.

#include "remap/materials/transport.h"

#include <algorithm>

using namespace remap;

namespace
{
/// Who takes a sliver has so many times as much of both materials.
constexpr double plenty = 64;
/// What a cell chooses: global number of the partner, part, material given
/// back.
constexpr int choice_size = 3;
} // namespace

/// The smallest sliver of each cell of ours, and who shall take it.
bool MaterialTransport::choose(std::span<const double> volume)
{
  const Materials& m = *_materials;
  const auto held = [&](std::int32_t c, std::int32_t material)
  { return volume[c] * m.fraction(c, material); };
  bool any = false;
  _choice.assign(std::size_t(choice_size) * _mesh->num_cells(), -1);
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const std::int32_t c = m.mixed()[r];
    if (c >= _mesh->owned_cells() or _cv->mark[c] != 1)
      continue;
    const auto parts = m.parts(static_cast<std::int32_t>(r));
    const auto least = std::min_element(parts.begin(), parts.end(),
                                        [](const Part& a, const Part& b)
                                        { return a.fraction < b.fraction; });
    if (not(least->fraction < _options.sliver))
      continue;
    double best = plenty * least->fraction * volume[c];
    for (std::int32_t d : _mesh->cell_cells()[c])
    {
      if (_cv->mark[d] != 1 or m.row(d) < 0)
        continue;
      const double takes = held(d, least->material);
      for (const Part& back : parts)
        if (const double room = std::min(takes, held(d, back.material));
            back.material != least->material
            and back.fraction >= _options.sliver and room > best)
        {
          best = room;
          double* out = &_choice[std::size_t(choice_size) * c];
          out[0] = static_cast<double>(_mesh->cell_ids()[d]);
          out[1] = static_cast<double>(least - parts.begin());
          out[2] = back.material;
          any = true;
        }
    }
  }
  return any;
}

/// A parcel of one slot for another; its values are those of now.
void MaterialTransport::send(std::int32_t from, std::int32_t to, double v)
{
  const Materials& m = *_materials;
  const Point at = m.part(from).centroid;
  for (const bool out : {true, false})
    _parcels.push_back({out ? from : to, out ? -v : v, at,
                        static_cast<std::int32_t>(_parcel_values.size())});
  for (const MaterialField& field : _fields)
  {
    const auto n = static_cast<std::size_t>(field.components);
    const auto* first = &field.values[n * static_cast<std::size_t>(from)];
    _parcel_values.insert(_parcel_values.end(), first, first + n);
  }
}

/// Both sides of every exchange that this rank sees.
void MaterialTransport::collect_parcels(std::span<const double> volume)
{
  const Materials& m = *_materials;
  _parcels.clear();
  _parcel_values.clear();
  std::size_t number = 0;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const std::int32_t c = m.mixed()[r];
    const double* choice = &_choice[std::size_t(choice_size) * c];
    if (not(choice[0] >= 0))
      continue;
    std::int32_t d = -1;
    for (std::int32_t e : _mesh->cell_cells()[c])
      if (_mesh->cell_ids()[e] == static_cast<std::int64_t>(choice[0]))
        d = e;
    if (d < 0)
      continue;
    const auto back = static_cast<std::int32_t>(choice[2]);
    const std::int32_t sliver = m.first_slot(static_cast<std::int32_t>(r))
                                + static_cast<std::int32_t>(choice[1]);
    const double v = m.part(sliver).fraction * volume[c];
    const std::int32_t takes = m.slot(d, m.part(sliver).material);
    const std::int32_t gives = m.slot(d, back);
    const std::int32_t gets = m.slot(c, back);
    if (takes < 0 or gives < 0 or gets < 0)
      continue; // two ghosts that this rank sees in part
    send(sliver, takes, v);
    send(gives, gets, v);
    if (_density >= 0)
    {
      const std::vector<double>& rho = _fields[_density].values;
      note_jump(c, d, v * (rho[sliver] - rho[gives]));
    }
    if (c < _mesh->owned_cells())
    {
      ++number;
      _swept_volume += v;
    }
  }
  _swept_number += static_cast<double>(number);
}

/// A mass goes from cell c to d, at a node of both.
void MaterialTransport::note_jump(std::int32_t c, std::int32_t d, double mass)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (_mesh->cell(c)[i] == _mesh->cell(d)[j])
      {
        _jumps.push_back({c, i, mass});
        _jumps.push_back({d, j, -mass});
        return;
      }
}

/// Put parcels into their slots.
void MaterialTransport::deliver(std::span<const double> volume,
                                std::span<const double> y)
{
  Materials& m = *_materials;
  for (const Parcel& p : _parcels)
  {
    const std::int32_t c = m.cell(p.slot);
    Part& part = m.part(p.slot);
    const double before = part.fraction * volume[c];
    const double after = before + p.volume;
    const bool emptied = -p.volume >= before;
    part.fraction = emptied ? 0 : after / volume[c];
    const double weight = emptied ? 0 : p.volume / after;
    if (p.volume > 0)
    {
      const Triple& n = _mesh->cell(c);
      part.centroid =
          held_inside({point(y, n[0]), point(y, n[1]), point(y, n[2])},
                      part.centroid + weight * (p.at - part.centroid));
    }
    const double* from = _parcel_values.data() + p.values;
    for (const MaterialField& field : _fields)
    {
      const auto n = static_cast<std::size_t>(field.components);
      double* to = &field.values[n * static_cast<std::size_t>(p.slot)];
      for (std::size_t k = 0; k < n; ++k)
        to[k] += weight * (*from++ - to[k]);
    }
  }
}

/// Sweep up slivers in the cells that changed.
/// @param[in] volume of cells, now
void MaterialTransport::sweep_slivers(std::span<const double> volume,
                                      std::span<const double> y,
                                      const Host& host)
{
  _jumps.clear();
  if (not(_options.sliver > 0))
    return;
  // A cell gives up one sliver at a time.
  for (int round = 0; round < most_parts; ++round)
  {
    if (not(host.max(choose(volume) ? 1.0 : 0.0) > 0))
      return;
    host.update_cells(_choice, choice_size);
    collect_parcels(volume);
    deliver(volume, y);
    _entries.clear();
    for (std::size_t r = 0; r < _materials->mixed().size(); ++r)
      if (_materials->mixed()[r] < _mesh->owned_cells())
        keep_row(static_cast<std::int32_t>(r));
    std::erase_if(_entries,
                  [](const Entry& e) { return not(e.part.fraction > 0); });
    exchange_entries(host);
    assign();
    for (const MaterialField& field : _fields)
      update(field.values, field.components, host);
  }
}

/// Totals of the call, and slivers that nobody took.
void MaterialTransport::count(const Host& host)
{
  const Materials& m = *_materials;
  double all[3] = {_swept_number, _swept_volume, 0};
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
    if (m.mixed()[r] < _mesh->owned_cells())
      for (const Part& part : m.parts(static_cast<std::int32_t>(r)))
        all[2] += part.fraction < _options.sliver ? 1 : 0;
  host.sum(all);
  _report.slivers = static_cast<std::int64_t>(all[0]);
  _report.sliver_volume = all[1];
  _report.slivers_left = static_cast<std::int64_t>(all[2]);
}
