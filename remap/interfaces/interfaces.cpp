// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/interfaces/interfaces.h"

#include "remap/interfaces/chain.h"

namespace remap
{
namespace
{
constexpr int doubles_per_cut = 6;

/// Do two cuts of chains, numbers k and m, tell the same materials apart? What
/// is cut off by then and what is not must have something in common, and
/// nothing may stand on the other side.
/// @return 1; −1 if they cut off each other's remainders; or 0
int same_interface(std::span<const Part> a, const Order& order_a, int k,
                   std::span<const Part> b, const Order& order_b, int m)
{
  bool same[2][2] = {};
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      if (a[order_a[i]].material == b[order_b[j]].material)
        same[static_cast<int>(i) <= k][static_cast<int>(j) <= m] = true;
  const bool straight = same[0][0] and same[1][1];
  const bool crossed = same[0][1] and same[1][0];
  if (straight and not same[0][1] and not same[1][0])
    return 1;
  return crossed and not same[0][0] and not same[1][1] ? -1 : 0;
}
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
    _stencil.load_cell(c, x);
    chain<G>(
        _stencil, parts, order,
        [&](int k, unsigned)
        {
          const HalfPlane& own = old.cuts[k].plane;
          typename Method::Ways ways;
          for (const std::int32_t j : _stencil.numbers())
            if (const std::int32_t r = materials.row(j); r >= 0)
            {
              const Order theirs = order_of(_last[r]);
              double f = 0;
              for (int q = 0; q < _last[r].count; ++q)
              {
                f += materials.parts(r)[theirs[q]].fraction;
                const HalfPlane& there = _last[r].cuts[q].plane;
                if (const int sign = same_interface(
                        parts, order, k, materials.parts(r), theirs, q))
                  ways.add(there.at - own.at, f * (1 - f),
                           static_cast<double>(sign) * there.normal);
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
