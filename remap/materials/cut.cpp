// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What the parts of cells give to each other: the pieces that cells exchange,
// cut by interfaces.

#include "remap/materials/transport.h"

#include <algorithm>

using namespace remap;

namespace
{
/// Parts of a piece below this part of it go with its largest.
constexpr double smallest_part = 1e-14;
} // namespace

/// Slot of a material in a cell; a newcomer's, if it was not there.
std::int32_t MaterialTransport::slot_for(std::int32_t c, std::int32_t material)
{
  if (const std::int32_t s = _materials->slot(c, material); s >= 0)
    return s;
  for (std::int32_t k = _head[c]; k >= 0; k = _newcomers[k].next)
    if (_newcomers[k].material == material)
      return _materials->num_slots() + k;
  if (_head[c] < 0)
    _guests.push_back(c);
  _newcomers.push_back({c, material, _head[c]});
  _head[c] = static_cast<std::int32_t>(_newcomers.size()) - 1;
  return _materials->num_slots() + _head[c];
}

/// Does an outer piece bring a given material in?
bool MaterialTransport::given(std::int32_t p) const
{
  return _cv->outer.from[p] < 0
         and kind_of(_boundaries, _cv->marker[p]) == Boundary::open;
}

void MaterialTransport::share(std::int32_t p, std::int32_t from,
                              std::int32_t to, bool first, double v, Point at)
{
  _shares.push_back({p, from, to, first, v, at});
}

/// A piece from a mixed cell c to d: a share for each part. They add up to it.
void MaterialTransport::share_piece(std::int32_t p, std::int32_t c,
                                    std::int32_t d, double v, Point at,
                                    const ByPart& parts)
{
  const std::int32_t row = _materials->row(c);
  const auto of = _materials->parts(row);
  double total = 0;
  for (const Moments& m : parts)
    total += std::max(m.v, 0.0);
  // Of a region of round-off size nobody knows what it holds.
  const bool known = total > 0.5 * v and total < 2 * v;
  const double scale = known ? v / total : 0;
  std::size_t largest = 0;
  for (std::size_t k = 1; k < of.size(); ++k)
    if (known ? parts[k].v > parts[largest].v
              : of[k].fraction > of[largest].fraction)
      largest = k;
  const auto give = [&](std::size_t k, bool first, double volume, Point place)
  {
    const std::int32_t slot =
        _materials->first_slot(row) + static_cast<std::int32_t>(k);
    if (p >= 0)
      share(p, slot, slot_for(d, of[k].material), first, volume, place);
    else
      share(p, d < 0 ? slot : -1, d < 0 ? -1 : slot, first, volume, place);
  };
  double rest = v;
  for (std::size_t k = 0; known and k < of.size(); ++k)
    if (const double part = scale * parts[k].v;
        k != largest and part > smallest_part * v)
      rest -= part;
  give(largest, true, rest, known ? parts[largest].centroid() : at);
  for (std::size_t k = 0; known and k < of.size(); ++k)
    if (const double part = scale * parts[k].v;
        k != largest and part > smallest_part * v)
      give(k, false, part, parts[k].centroid());
}

/// What a facet sweeps out of, or into, its left cell, by the parts of cell c.
template <Geometry G>
ByPart MaterialTransport::by_parts(const Motion& m, bool out,
                                   std::int32_t c) const
{
  return remap::cut_swept<G>(m, out ? 1 : -1,
                             _interfaces.partition(_materials->row(c)));
}

/// Regions swept by facets beside which not all is of one material.
template <Geometry G>
void MaterialTransport::cut_swept(std::span<const double> x,
                                  std::span<const double> y)
{
  const auto motion = [&](std::int32_t f) -> Motion
  {
    const auto [p, q] = _mesh->facet(f);
    return {point(x, p), point(x, q), point(y, p), point(y, q)};
  };
  const Pieces& inner = _cv->inner;
  for (std::size_t k = 0; k < _cv->facets.size(); ++k)
  {
    const std::int32_t f = _cv->facets[k];
    const auto [left, right] = _mesh->facet_cells(f);
    const std::int32_t material = _materials->pure(left);
    if (material >= 0 and material == _materials->pure(right))
      continue;
    for (std::int32_t p = _cv->pieces_of[k][0]; p < _cv->pieces_of[k][1]; ++p)
    {
      const std::int32_t c = inner.from[p], d = inner.to[p];
      if (const std::int32_t m = _materials->pure(c); m >= 0)
        share(p, c, slot_for(d, m), true, inner.volume[p], inner.at[p]);
      else
        share_piece(p, c, d, inner.volume[p], inner.at[p],
                    by_parts<G>(motion(f), c == left, c));
    }
  }
  for (std::size_t p = 0; p < _cv->outer.count; ++p)
  {
    const std::int32_t f = _cv->facet[p];
    const bool out = _cv->outer.from[p] >= 0;
    const std::int32_t c = out ? _cv->outer.from[p] : _cv->outer.to[p];
    ByPart parts{};
    if (_materials->row(c) >= 0 and not given(static_cast<std::int32_t>(p)))
      parts = by_parts<G>(motion(f), out, c);
    cut_boundary(static_cast<std::int32_t>(p), parts);
  }
}

/// An outer piece, with what a mixed cell gives or takes by parts.
void MaterialTransport::cut_boundary(std::int32_t p, const ByPart& parts)
{
  const Pieces& outer = _cv->outer;
  const std::int32_t from = outer.from[p], to = outer.to[p];
  const std::int32_t own = from >= 0 ? from : to;
  if (given(p))
  {
    const std::int32_t m = _options.inflow[_cv->marker[p]];
    if (_materials->pure(own) != m)
      share(~p, -1, slot_for(own, m), true, outer.volume[p], outer.at[p]);
  }
  else if (_materials->row(own) >= 0)
    share_piece(~p, own, from >= 0 ? -1 : own, outer.volume[p], outer.at[p],
                parts);
}

/// Overlaps of old with new cells.
template <Geometry G>
void MaterialTransport::cut_overlaid(std::span<const double> x,
                                     std::span<const double> y)
{
  const auto place = [this](std::span<const double> at, std::int32_t c)
  {
    const Triple& n = _mesh->cell(c);
    return Triangle{point(at, n[0]), point(at, n[1]), point(at, n[2])};
  };
  const auto cut = [&](std::int32_t c, std::int32_t d)
  {
    return cut_overlap<G>(place(x, c), place(y, d),
                          _interfaces.partition(_materials->row(c)));
  };
  const Pieces &inner = _cv->inner, &outer = _cv->outer;
  _left.assign(_materials->mixed().size(), ByPart{});
  const auto note = [this](std::int32_t row, const ByPart& parts)
  {
    for (std::size_t k = 0; k < parts.size(); ++k)
      _left[row][k] += parts[k];
  };
  for (std::size_t k = 0; k < inner.count; ++k)
  {
    const auto p = static_cast<std::int32_t>(k);
    const std::int32_t c = inner.from[p], d = inner.to[p];
    const std::int32_t m = _materials->pure(c);
    if (m >= 0 and m == _materials->pure(d))
      continue;
    if (m >= 0)
    {
      share(p, c, slot_for(d, m), true, inner.volume[p], inner.at[p]);
      continue;
    }
    const ByPart parts = cut(c, d);
    note(_materials->row(c), parts);
    share_piece(p, c, d, inner.volume[p], inner.at[p], parts);
  }
  for (std::size_t k = 0; k < outer.count; ++k)
  {
    const auto p = static_cast<std::int32_t>(k);
    const std::int32_t c = outer.from[p] >= 0 ? outer.from[p] : outer.to[p];
    const std::int32_t row = _materials->row(c);
    ByPart parts{};
    if (row >= 0 and outer.from[p] < 0)
    {
      // Gained: as much of each part as the cell holds.
      const auto of = _materials->parts(row);
      for (std::size_t i = 0; i < of.size(); ++i)
      {
        const double v = of[i].fraction * outer.volume[p];
        parts[i] = {v, v * outer.at[p].x, v * outer.at[p].y};
      }
    }
    else if (row >= 0)
    {
      // Lost: what neither stays nor goes to another cell.
      note(row, cut(c, c));
      const auto of = _materials->parts(row);
      for (std::size_t i = 0; i < of.size(); ++i)
      {
        const double v = of[i].fraction * _cv->volume[c];
        const Moments m = Moments{v, v * of[i].centroid.x, v * of[i].centroid.y}
                          - _left[row][i];
        if (m.v > 0)
          parts[i] = m;
      }
    }
    cut_boundary(p, parts);
  }
}

template void
    MaterialTransport::cut_swept<Geometry::plane>(std::span<const double>,
                                                  std::span<const double>);
template void MaterialTransport::cut_swept<Geometry::axisymmetric>(
    std::span<const double>, std::span<const double>);
template void
    MaterialTransport::cut_overlaid<Geometry::plane>(std::span<const double>,
                                                     std::span<const double>);
template void MaterialTransport::cut_overlaid<Geometry::axisymmetric>(
    std::span<const double>, std::span<const double>);
