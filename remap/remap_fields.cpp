// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What a remap does with its fields, once the pieces of a sub-cycle are known:
// carry them, put them back into their ranges, keep the book.

#include "remap/remap.h"

#include <algorithm>

using namespace remap;

/// All fields over one kind of volumes; returns the next entry of the book.
std::size_t Remapper::carry_all(ControlVolumes& volumes,
                                std::span<const Field> fields,
                                const Scheme& scheme, const Halo& halo,
                                const Host& host, std::size_t entry,
                                int with_amounts)
{
  for (std::size_t k = 0; k < fields.size(); ++k)
  {
    const auto n = static_cast<std::size_t>(fields[k].components);
    const bool noted = static_cast<int>(k) == with_amounts;
    carry_field(volumes, fields[k],
                {.scheme = scheme,
                 .boundaries = _options.boundaries,
                 .halo = halo,
                 .host = host,
                 .amounts = noted ? &_amounts : nullptr},
                std::span(_book).subspan(entry, n));
    entry += n;
  }
  return entry;
}

/// Fields per mass, after the density has travelled.
template <Geometry G>
void Remapper::carry_masses(const Fields& fields, std::size_t entry,
                            const Host& host)
{
  _cells.split(_x, _y, _amounts.inner, _amounts.outer, _nodes.passing);
  std::span<const double> rho = _mixture;
  const auto jump = [this](bool there)
  {
    for (const auto& [c, corner, mass] : _materials->jumps())
    {
      double& at = _nodes.jump[static_cast<std::size_t>(3 * c + corner)];
      at = there ? at + mass : 0;
    }
  };
  if (mixture(fields))
  {
    for (std::int32_t c : _cells.touched)
      _mixture[c] = _materials->mixture(c);
    jump(true);
  }
  else
    rho = fields.cells[fields.density].values;
  _nodes.find_flows<G>(_cells.touched, _mesh->owned_cells(), rho, _x, _y, host);
  _nodes.exchange_masses<G>(_cells.touched, _moved, _x, _y);
  if (mixture(fields))
    jump(false);
  _report.mass_loss =
      std::max(_report.mass_loss, host.max(_nodes.largest_loss()));
  for (const Field& field : fields.per_mass)
  {
    const auto n = static_cast<std::size_t>(field.components);
    const double part = carry_field(_nodes, field,
                                    {.scheme = _options.nodal_scheme,
                                     .boundaries = _options.boundaries,
                                     .halo = _node_halo,
                                     .host = host,
                                     .kinetic = true},
                                    std::span(_book).subspan(entry, n));
    _report.kinetic_part = std::min(_report.kinetic_part, part);
    entry += n;
  }
}

/// One sub-cycle for all fields.
template <Geometry G>
void Remapper::carry(const Fields& fields, const Host& host)
{
  const auto book_volume = [this](const ControlVolumes& cv, Exchange& book)
  {
    for (std::size_t p = 0; p < cv.outer.count; ++p)
    {
      const bool in = cv.outer.from[p] < 0;
      const Boundary kind = kind_of(_options.boundaries, cv.marker[p]);
      if ((in ? cv.outer.to[p] : cv.outer.from[p]) < cv.owned)
        book[std::size_t(way(kind, in))] +=
            in ? cv.outer.volume[p] : -cv.outer.volume[p];
    }
  };
  book_volume(_cells, _book[0]);
  if (_dual)
    book_volume(_nodes, _book[1]);
  if (_masses)
    _nodes.keep_density<G>(_cells.touched,
                           mixture(fields)
                               ? std::span<const double>(_mixture)
                               : fields.cells[fields.density].values,
                           _x);
  const Options& o = _options;
  std::size_t entry =
      carry_all(_cells, fields.cells, o.scheme, _cell_halo, host, 2,
                _masses and not mixture(fields) ? fields.density : -1);
  if (_fine)
    entry = carry_all(_points->volumes, fields.points, o.scheme, _point_halo,
                      host, entry);
  entry =
      carry_all(_nodes, fields.nodes, o.nodal_scheme, _node_halo, host, entry);
  if (fields.materials)
    _materials->carry<G>(_x, _y, _report.overlaid, o.scheme, host,
                         _masses and mixture(fields) ? &_amounts : nullptr,
                         std::span(_book).last(_materials->entries()));
  if (_masses)
    carry_masses<G>(fields, entry, host);
}

/// Values back into their ranges.
template <Geometry G>
void Remapper::repair(const Fields& fields, const Host& host)
{
  double repaired = 0;
  const auto all = [&](std::span<const Field> list, const ControlVolumes& cv,
                       const Halo& halo)
  {
    for (const Field& field : list)
      for (int k = 0; not field.least.empty() and k < field.components; ++k)
      {
        std::int64_t number = 0;
        const double left = _repair.run(field, k, cv, halo, host, number);
        repaired += static_cast<double>(number);
        _report.unrepaired = std::max(_report.unrepaired, left);
      }
  };
  all(fields.cells, _cells, _cell_halo);
  if (_fine)
    all(fields.points, _points->volumes, _point_halo);
  all(fields.per_mass, _nodes, _node_halo);
  // Fields per mass leave masses where volumes were.
  if (_masses and not fields.nodes.empty())
    _nodes.measure_next<G>(_x_new);
  all(fields.nodes, _nodes, _node_halo);
  if (fields.materials)
    _materials->repair(_x_new, _repair, host, repaired, _report.unrepaired);
  host.sum(std::span(&repaired, 1));
  _report.repaired = static_cast<std::int64_t>(repaired);
}

/// Add this call's book to the ledger, summed over ranks.
void Remapper::settle(const Fields& fields, const Host& host, Ledger& ledger)
{
  host.sum(std::span(_book[0].data(), _book.size() * num_ways));
  const auto add = [](Exchange& to, const Exchange& from)
  {
    for (std::size_t k = 0; k < num_ways; ++k)
      to[k] += from[k];
  };
  add(ledger.cell_volume, _book[0]);
  add(ledger.node_volume, _book[1]);
  std::size_t entry = 2;
  const auto all = [&](std::span<const Field> list, std::vector<Exchange>& to)
  {
    std::size_t n = 0;
    for (const Field& field : list)
      n += static_cast<std::size_t>(field.components);
    to.resize(n);
    for (Exchange& e : to)
      add(e, _book[entry++]);
  };
  all(fields.cells, ledger.cells);
  all(fields.points, ledger.points);
  all(fields.nodes, ledger.nodes);
  all(fields.per_mass, ledger.per_mass);
  if (not fields.materials)
    return;
  const auto number = static_cast<std::size_t>(_options.materials.number);
  ledger.material_volume.resize(number);
  for (Exchange& e : ledger.material_volume)
    add(e, _book[entry++]);
  ledger.of_materials.resize(_book.size() - entry);
  for (Exchange& e : ledger.of_materials)
    add(e, _book[entry++]);
}

template void Remapper::carry<Geometry::plane>(const Fields&, const Host&);
template void Remapper::carry<Geometry::axisymmetric>(const Fields&,
                                                      const Host&);
template void Remapper::repair<Geometry::plane>(const Fields&, const Host&);
template void Remapper::repair<Geometry::axisymmetric>(const Fields&,
                                                       const Host&);
