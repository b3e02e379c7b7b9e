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
void Interfaces::cells(std::span<const double> x, const Materials& materials)
{
  const auto mixed = materials.mixed();
  for (std::size_t row = 0; row < mixed.size(); ++row)
  {
    const std::int32_t c = mixed[row];
    const auto parts = materials.parts(static_cast<std::int32_t>(row));
    if constexpr (Method::uses_centroids)
    {
      const Triple& v = _mesh->cell(c);
      Method::template solve<G>(
          {point(x, v[0]), point(x, v[1]), point(x, v[2])}, parts,
          _partitions[row]);
    }
    else if (c < _mesh->owned_cells())
    {
      _stencil.load(c, x);
      chain<G>(
          _stencil, materials, parts,
          [](const Stencil& s) { return Method::normal(s); }, _partitions[row]);
    }
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
      [&]<class Method>(const Method&)
      {
        if (_options.geometry == Geometry::plane)
          cells<Geometry::plane, Method>(x, materials);
        else
          cells<Geometry::axisymmetric, Method>(x, materials);
        if constexpr (not Method::uses_centroids)
          fill_ghosts(materials, host);
      },
      _options.method);
}
} // namespace remap
