// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/interfaces/interfaces.h"

#include "remap/interfaces/chain.h"

namespace remap
{
namespace
{
constexpr int doubles_per_cut = 6;
} // namespace

Interfaces::Interfaces(const Mesh& mesh, InterfaceOptions options)
    : _mesh(&mesh), _options(std::move(options)), _stencil(mesh)
{
}

template <Geometry G, class Method>
void Interfaces::cells(const Method& method, std::span<const double> x,
                       const Materials& materials)
{
  _report = {};
  const auto num = static_cast<std::int32_t>(materials.mixed().size());
  for (std::int32_t row = 0; row < num; ++row)
  {
    const std::int32_t c = materials.mixed()[row];
    const auto parts = materials.parts(row);
    if constexpr (Method::uses_centroids)
    {
      const Triple& v = _mesh->cell(c);
      const Tally tally = method.template solve<G>(
          {point(x, v[0]), point(x, v[1]), point(x, v[2])}, parts,
          _partitions[row]);
      if (c < _mesh->owned_cells())
      {
        _report.filaments += tally.filaments;
        _report.unresolved += tally.unresolved;
        _report.residual = std::max(_report.residual, tally.error);
      }
    }
    else if (c < _mesh->owned_cells())
    {
      _stencil.load(c, x);
      Order order = {0, 1};
      if (parts.size() > 2)
        order = chain_order(_stencil, materials, parts);
      chain<G>(
          _stencil, parts, order,
          [&](int, unsigned off)
          {
            _stencil.take(materials, parts, off);
            return Method::template normal<G>(_stencil);
          },
          _partitions[row]);
    }
  }
  _report.residual = std::sqrt(_report.residual);
}

template <Geometry G, class Method>
void Interfaces::sweep(std::span<const double> x, const Materials& materials)
{
  // All look at what the last sweep left, whatever the order of cells.
  const auto num = static_cast<std::int32_t>(materials.mixed().size());
  _last.resize(_partitions.size());
  for (std::int32_t row = 0; row < num; ++row)
  {
    _last[row].count = _partitions[row].count;
    std::copy_n(_partitions[row].cuts.begin(), _partitions[row].count,
                _last[row].cuts.begin());
  }
  for (std::int32_t row = 0; row < num; ++row)
  {
    const std::int32_t c = materials.mixed()[row];
    if (c >= _mesh->owned_cells())
      continue;
    const auto parts = materials.parts(row);
    const Partition& old = _last[row];
    const Order order = order_of(old);
    _stencil.load(c, x);
    chain<G>(
        _stencil, parts, order,
        [&](int k, unsigned)
        {
          const HalfPlane& own = old.cuts[k].plane;
          typename Method::Ways ways;
          const auto is_out = [&](std::int32_t material)
          {
            for (std::size_t i = k + 1; i < parts.size(); ++i)
              if (parts[order[i]].material == material)
                return true;
            return false;
          };
          for (const std::int32_t j : _stencil.numbers())
            if (const std::int32_t r = materials.row(j); r >= 0)
            {
              // The cuts there that tell the same materials apart.
              const auto theirs = materials.parts(r);
              const Order chained = order_of(_last[r]);
              const std::int32_t in = parts[order[k]].material;
              for (int q = 0; q < _last[r].count; ++q)
              {
                const std::int32_t side = theirs[chained[q]].material;
                bool same = false;
                for (std::size_t i = q + 1; i < theirs.size(); ++i)
                {
                  const std::int32_t other = theirs[chained[i]].material;
                  same = same or (side == in and is_out(other))
                         or (other == in and is_out(side));
                }
                if (same)
                  ways.add(_last[r].cuts[q].plane.at - own.at);
              }
            }
          return ways.normal(own.normal);
        },
        _partitions[row]);
  }
}

void Interfaces::fill_ghosts(const Materials& materials, const Host& host)
{
  if (not host.cell_halo)
    return;
  const auto mixed = materials.mixed();
  int most = 0;
  for (std::size_t row = 0; row < mixed.size(); ++row)
    most = std::max(
        most, static_cast<int>(
                  materials.parts(static_cast<std::int32_t>(row)).size()));
  most = static_cast<int>(host.max(most)) - 1;
  if (most < 1)
    return;
  const std::size_t block = most * doubles_per_cut;
  _halo.resize(std::max(_halo.size(), block * _mesh->num_cells()));
  const auto own = [this](std::int32_t c) { return c < _mesh->owned_cells(); };
  for (std::size_t row = 0; row < mixed.size(); ++row)
    if (own(mixed[row]))
    {
      double* to = &_halo[block * mixed[row]];
      const Partition& p = _partitions[row];
      for (int k = 0; k < p.count; ++k, to += doubles_per_cut)
      {
        const Cut& cut = p.cuts[k];
        const double values[doubles_per_cut] = {
            cut.plane.normal.x, cut.plane.normal.y, cut.plane.at.x,
            cut.plane.at.y,     double(cut.in),     double(cut.out)};
        std::copy_n(values, doubles_per_cut, to);
      }
    }
  host.update_cells({_halo.data(), block * _mesh->num_cells()},
                    static_cast<int>(block));
  for (std::size_t row = 0; row < mixed.size(); ++row)
    if (not own(mixed[row]))
    {
      const double* from = &_halo[block * mixed[row]];
      Partition& p = _partitions[row];
      p.count = static_cast<int>(
                    materials.parts(static_cast<std::int32_t>(row)).size())
                - 1;
      for (int k = 0; k < p.count; ++k, from += doubles_per_cut)
        p.cuts[k] = {{{from[0], from[1]}, {from[2], from[3]}},
                     static_cast<std::int8_t>(from[4]),
                     static_cast<std::int8_t>(from[5])};
    }
}

void Interfaces::reconstruct(std::span<const double> x,
                             const Materials& materials, const Host& host)
{
  _partitions.resize(std::max(_partitions.size(), materials.mixed().size()));
  std::visit(
      [&]<class Method>(const Method& method)
      {
        const bool plane = _options.geometry == Geometry::plane;
        if (plane)
          cells<Geometry::plane, Method>(method, x, materials);
        else
          cells<Geometry::axisymmetric, Method>(method, x, materials);
        if constexpr (not Method::uses_centroids)
        {
          fill_ghosts(materials, host);
          for (int i = 0; i < Method::sweeps; ++i)
          {
            if constexpr (Method::sweeps > 0)
            {
              if (plane)
                sweep<Geometry::plane, Method>(x, materials);
              else
                sweep<Geometry::axisymmetric, Method>(x, materials);
            }
            fill_ghosts(materials, host);
          }
        }
      },
      _options.method);
}
} // namespace remap
