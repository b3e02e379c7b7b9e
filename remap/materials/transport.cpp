// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/transport.h"

#include "remap/geometry/position.h"

#include <algorithm>
#include <cmath>

using namespace remap;

namespace
{
/// A field as the schemes know it.
Field over_slots(const MaterialField& field)
{
  return {.values = field.values,
          .components = field.components,
          .group = field.group,
          .bound = field.bound,
          .weights = field.weights,
          .inflow = field.inflow,
          .least = field.least,
          .most = field.most};
}

bool carries(const MaterialField& field, std::int32_t material)
{
  return field.carriers.empty() or field.carriers[material] != 0;
}
} // namespace

MaterialTransport::MaterialTransport(const Mesh& mesh, CellVolumes& cells,
                                     Geometry geometry, MaterialOptions options,
                                     std::span<const Boundary> boundaries)
    : _mesh(&mesh), _cv(&cells), _options(std::move(options)),
      _boundaries(boundaries),
      _interfaces(mesh, {geometry, _options.reconstruction}), _near(mesh),
      _rows(mesh.cell_cells()), _sides(cells.across),
      _head(mesh.num_cells(), -1)
{
}

bool MaterialTransport::fits(const Fields& fields) const
{
  const Materials& m = *fields.materials;
  if (m.num_cells() != _mesh->num_cells()
      or m.num_materials() != _options.number
      or (any_open(_boundaries)
          and _options.inflow.size() != _boundaries.size()))
    return false;
  const auto slots = static_cast<std::size_t>(m.num_slots());
  const auto number = static_cast<std::size_t>(_options.number);
  return std::all_of(
      fields.of_materials.begin(), fields.of_materials.end(),
      [&](const MaterialField& field)
      {
        return remap::fits(field, slots, _options.components, _boundaries)
               and (field.carriers.empty() or field.carriers.size() == number);
      });
}

std::size_t MaterialTransport::entries() const
{
  std::size_t rows = 1;
  for (const MaterialField& field : _fields)
    rows += static_cast<std::size_t>(field.components);
  return _materials ? rows * static_cast<std::size_t>(_options.number) : 0;
}

void MaterialTransport::start(const Fields& fields)
{
  _materials = fields.materials;
  _fields = fields.of_materials;
  _density = fields.material_density;
  _report = {};
  _swept_number = _swept_volume = 0;
  if (not _materials)
    return;
  const Materials& m = *_materials;
  _kinds.resize(m.num_slots());
  for (std::int32_t c = 0; c < m.num_cells(); ++c)
    _kinds[c] = m.pure(c);
  // What nobody carries must not be seen by anybody.
  for (const MaterialField& field : _fields)
  {
    const auto n = static_cast<std::size_t>(field.components);
    const auto clear = [&](std::int32_t slot)
    { std::fill_n(&field.values[n * static_cast<std::size_t>(slot)], n, 0.0); };
    if (std::find(field.carriers.begin(), field.carriers.end(), 0)
        != field.carriers.end())
      for (std::int32_t c = 0; c < m.num_cells(); ++c)
        if (m.pure(c) >= 0 and not carries(field, m.pure(c)))
          clear(c);
    for (std::size_t r = 0; r < m.mixed().size(); ++r)
    {
      const auto row = static_cast<std::int32_t>(r);
      clear(m.mixed()[r]);
      for (std::size_t k = 0; k < m.parts(row).size(); ++k)
        if (not carries(field, m.parts(row)[k].material))
          clear(m.first_slot(row) + static_cast<std::int32_t>(k));
    }
  }
}

/// What passed the boundary, by material.
void MaterialTransport::book_volumes(std::span<Exchange> book) const
{
  const ControlVolumes& cv = *_cv;
  for (std::size_t p = 0; p < cv.outer.count; ++p)
  {
    const bool in = cv.outer.from[p] < 0;
    const std::int32_t own = in ? cv.outer.to[p] : cv.outer.from[p];
    const Boundary kind = kind_of(_boundaries, cv.marker[p]);
    if (cv.ours(own))
      book[cv.kind(own)][std::size_t(way(kind, in))] +=
          in ? cv.outer.volume[p] : -cv.outer.volume[p];
  }
}

/// Newcomers hold what the first that comes brings, but none of it yet.
void MaterialTransport::widen_fields()
{
  const std::int32_t first = _materials->num_slots();
  for (const MaterialField& field : _fields)
  {
    const auto n = static_cast<std::size_t>(field.components);
    field.values.resize(n * static_cast<std::size_t>(_cv->num), 0.0);
    for (const Share& s : _shares)
      if (s.to >= first)
        for (std::size_t k = 0; k < n; ++k)
        {
          double& value = field.values[n * static_cast<std::size_t>(s.to) + k];
          if (s.from >= 0)
            value = field.values[n * static_cast<std::size_t>(s.from) + k];
          else if (not field.inflow.empty())
            value =
                field.inflow[n * static_cast<std::size_t>(_cv->marker[~s.piece])
                             + k];
        }
  }
}

template <Geometry G>
void MaterialTransport::carry(std::span<const double> x,
                              std::span<const double> y, bool overlaid,
                              const Scheme& scheme, const Host& host,
                              Amounts* amounts, std::span<Exchange> book)
{
  open<G>(x, y, overlaid, host);
  widen_fields();
  book_volumes(book);
  const Halo halo = [this, &host](std::span<double> values, int block)
  { update(values, block, host); };
  const bool bounded =
      std::visit([]<class S>(const S&) { return S::bounded; }, scheme);
  const bool extends =
      std::visit([]<class S>(const S&) { return S::limiter::extends; }, scheme);
  if (bounded)
    find_thin();
  auto entry = static_cast<std::size_t>(_options.number);
  if (amounts)
  {
    amounts->inner.resize(_cv->inner.count);
    amounts->outer.resize(_cv->outer.count);
  }
  for (std::size_t f = 0; f < _fields.size(); ++f)
  {
    const bool noted = amounts and static_cast<int>(f) == _density;
    const std::size_t size = static_cast<std::size_t>(_options.number)
                             * static_cast<std::size_t>(_fields[f].components);
    if (bounded)
      note_ranges(_fields[f]);
    carry_field(*_cv, over_slots(_fields[f]),
                {.scheme = scheme,
                 .boundaries = _boundaries,
                 .halo = halo,
                 .host = host,
                 .amounts = noted ? amounts : nullptr,
                 .fill_ghosts = false},
                book.subspan(entry, size));
    if (bounded)
      hold_thin(_fields[f], extends);
    entry += size;
  }
  if (amounts)
    add_up(*amounts);
  collect<G>(y);
  exchange_entries(host);
  restore();
  assign();
  for (const MaterialField& field : _fields)
    update(field.values, field.components, host);
  sweep_slivers(_cv->next, y, host);
}

void MaterialTransport::repair(std::span<const double> x, Repair& repair,
                               const Host& host, double& repaired,
                               double& unrepaired)
{
  if (std::all_of(_fields.begin(), _fields.end(),
                  [](const MaterialField& f) { return f.least.empty(); }))
    return;
  CellVolumes& cv = *_cv;
  begin();
  set_parts(cv.next);
  find_rows(x);
  const Halo halo = [this, &host](std::span<double> values, int block)
  { update(values, block, host); };
  const std::vector<std::int32_t> all = cv.touched;
  for (int m = 0; m < _options.number; ++m)
  {
    cv.touched.clear();
    for (const std::int32_t slot : all)
      if (_kinds[slot] == m)
        cv.touched.push_back(slot);
    for (const MaterialField& field : _fields)
      for (int k = 0; not field.least.empty() and carries(field, m)
                      and k < field.components;
           ++k)
      {
        std::int64_t number = 0;
        const double left =
            repair.run(over_slots(field), k, cv, halo, host, number);
        repaired += static_cast<double>(number);
        unrepaired = std::max(unrepaired, left);
      }
  }
  cv.touched = all;
  cv.kinds.swap(_kinds);
  restore();
}

/// What pieces of slots take, for the pieces of cells they are parts of.
void MaterialTransport::add_up(Amounts& amounts) const
{
  for (std::size_t k = 0; k < _parent.size(); ++k)
    amounts.inner[_parent[k]] += amounts.inner[_inner + k];
  for (std::size_t k = 0; k < _outer_parent.size(); ++k)
    amounts.outer[_outer_parent[k]] += amounts.outer[_outer + k];
}

double MaterialTransport::mixture(std::int32_t c) const
{
  const Materials& m = *_materials;
  const std::vector<double>& values = _fields[_density].values;
  const std::int32_t row = m.row(c);
  if (row < 0)
    return values[c];
  std::int32_t slot = m.first_slot(row);
  double rho = 0;
  for (const Part& part : m.parts(row))
    rho += part.fraction * values[slot++];
  return rho;
}

template void MaterialTransport::carry<Geometry::plane>(std::span<const double>,
                                                        std::span<const double>,
                                                        bool, const Scheme&,
                                                        const Host&, Amounts*,
                                                        std::span<Exchange>);
template void MaterialTransport::carry<Geometry::axisymmetric>(
    std::span<const double>, std::span<const double>, bool, const Scheme&,
    const Host&, Amounts*, std::span<Exchange>);
