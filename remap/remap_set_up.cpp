// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The remap before its first call: options, room, and do the arrays fit?

#include "remap/remap.h"

#include <algorithm>
#include <stdexcept>

using namespace remap;

std::vector<std::string> Options::complaints() const
{
  std::vector<std::string> out;
  if (not(max_loss > 0))
    out.push_back("max_loss: must be positive");
  if (materials.number > 0 and max_loss > 1)
    out.push_back("max_loss: at most 1 with materials, which cannot give more "
                  "than a cell has");
  if (max_cycles < 1)
    out.push_back("max_cycles: must be at least 1");
  if (cell_components < 0 or nodal_components < 0 or point_components < 0)
    out.push_back("cell_components, point_components, nodal_components: must "
                  "not be negative");
  if (point_components > 0 and not points)
    out.push_back("point_components: points are needed");
  if (per_mass and (nodal_components < 1 or cell_components < 1))
    out.push_back("per_mass: cell_components and nodal_components are needed");
  if (materials.number < 0 or materials.number > most_parts
      or materials.components < 0)
    out.push_back("materials: at most " + std::to_string(most_parts)
                  + ", and no negative number of components");
  if (std::any_of(materials.inflow.begin(), materials.inflow.end(),
                  [this](int m) { return m < 0 or m >= materials.number; }))
    out.push_back("materials: inflow names a material that is not there");
  if (not(materials.sliver >= 0 and materials.sliver < 0.1))
    out.push_back("materials: sliver must be in [0, 0.1)");
  if (method == Method::overlay and per_mass)
    out.push_back("per_mass: fields per mass need method swept");
  return out;
}

Remapper::Remapper(const Mesh& mesh, Options options)
    : _mesh(&mesh), _options(std::move(options))
{
  if (const auto all = _options.complaints(); not all.empty())
  {
    std::string text;
    for (const std::string& line : all)
      text += line + "\n";
    throw std::invalid_argument(text);
  }
  const Options& o = _options;
  const bool sides = looks_at_sides(o.scheme);
  const auto nodes = static_cast<std::size_t>(mesh.num_nodes());
  const bool mixed = o.materials.number > 0;
  _cells.reserve(mesh, sides, o.per_mass or mixed,
                 widest_block(std::max(o.cell_components,
                                       mixed ? o.materials.components : 0)));
  if (mixed)
    _materials = std::make_unique<MaterialTransport>(
        mesh, _cells, o.geometry, o.materials, _options.boundaries);
  if (o.point_components > 0)
  {
    const Mesh& fine = o.points->mesh();
    if (&o.points->cells() != &mesh)
      throw std::invalid_argument("points: they are of another mesh\n");
    _points = std::make_unique<Points>();
    _points->volumes.reserve(fine, sides, false,
                             widest_block(o.point_components));
    _points->x.resize(std::size_t(2) * fine.num_nodes());
    _points->y.resize(_points->x.size());
    _points->moved.resize(fine.num_nodes());
  }
  if (o.nodal_components > 0)
  {
    _nodes.reserve(mesh, o.per_mass, widest_block(o.nodal_components));
    _flags.resize(nodes);
  }
  if (o.overlay_ready or o.method == Method::overlay)
    _overlap = std::make_unique<Overlap>(
        mesh, o.point_components > 0 ? o.points : nullptr);
  if (o.per_mass)
  {
    if (mixed)
    {
      _mixture.resize(mesh.num_cells());
      _nodes.jump.assign(std::size_t(3) * mesh.num_cells(), 0);
    }
    _amounts.inner.resize(_cells.inner.from.size());
    _amounts.outer.resize(_cells.outer.from.size());
  }
  _x.resize(2 * nodes);
  _y.resize(2 * nodes);
  _moved.assign(nodes, 0);
  _moved_nodes.reserve(nodes);
}

bool Remapper::sizes_fit(std::span<const double> x_old,
                         std::span<const double> x_new,
                         const Fields& fields) const
{
  const Options& o = _options;
  const auto all_fit =
      [&o](std::span<const Field> all, std::int32_t num, int components)
  {
    const auto volumes = static_cast<std::size_t>(num);
    return std::all_of(
        all.begin(), all.end(), [&](const Field& f)
        { return remap::fits(f, volumes, components, o.boundaries); });
  };
  const auto density = static_cast<std::size_t>(fields.density);
  return x_old.size() == _x.size() and x_new.size() == _x.size()
         and all_fit(fields.cells, _mesh->num_cells(), o.cell_components)
         and all_fit(fields.points, _points ? _points->volumes.num : 0,
                     o.point_components)
         and all_fit(fields.nodes, _mesh->num_nodes(), o.nodal_components)
         and all_fit(fields.per_mass, _mesh->num_nodes(), o.nodal_components)
         and (not fields.materials or (_materials and _materials->fits(fields)))
         and (fields.materials or fields.of_materials.empty())
         and (fields.per_mass.empty() or not mixture(fields)
              or (o.per_mass and fields.materials
                  and fields.material_density
                          < static_cast<int>(fields.of_materials.size())
                  and fields.of_materials[fields.material_density].components
                          == 1))
         and (fields.per_mass.empty() or mixture(fields)
              or (o.per_mass and fields.density >= 0
                  and density < fields.cells.size()
                  and fields.cells[density].components == 1));
}
