// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: slots as control volumes: the cells of a mesh, of which only the
// pure ones matter, and behind them the parts of mixed cells. Every scheme then
// works within a material, because a slot's neighbours are the slots of the
// same material in the cells around. Only cells at an interface have rows of
// their own, all others keep the mesh's.
#pragma once

#include "remap/materials/materials.h"
#include "remap/transport/cell_volumes.h"

#include <vector>

namespace remap
{
/// Neighbours of slots: a copy of those of cells, in which rows of cells at an
/// interface are put elsewhere, and rows of parts are added.
class SlotRows
{
public:
  explicit SlotRows(const Adjacency& cells)
      : _cells(&cells), _entries(cells.entries)
  {
    for (std::int32_t c = 0; c < cells.size(); ++c)
      _bounds.push_back({cells.offsets[c], cells.offsets[c + 1]});
  }

  /// Start anew: rows of cells are the mesh's, slots behind them have none.
  /// @param[in] num slots
  void reset(std::int32_t num)
  {
    for (std::int32_t c : _moved)
      _bounds[c] = {_cells->offsets[c], _cells->offsets[c + 1]};
    _moved.clear();
    _entries.resize(_cells->entries.size());
    _bounds.resize(_cells->size());
    _bounds.resize(num, Pair{0, 0});
  }

  /// Give a slot a row of its own: the slots of a material in the cells around.
  /// @param[in] use which slots count: use(slot)
  template <class Use>
  void add(std::int32_t slot, std::int32_t cell, std::int32_t material,
           const Materials& materials, const Use& use)
  {
    const auto begin = static_cast<std::int32_t>(_entries.size());
    for (std::int32_t d : (*_cells)[cell])
      if (const std::int32_t s = materials.slot(d, material); s >= 0 and use(s))
        _entries.push_back(s);
    _bounds[slot] = {begin, static_cast<std::int32_t>(_entries.size())};
    if (slot < _cells->size())
      _moved.push_back(slot);
  }

  /// As they stand now.
  [[nodiscard]] Rows rows() const
  {
    Rows out;
    out.bounds = _bounds.data()->data();
    out.stride = 2;
    out.entries = _entries.data();
    return out;
  }

private:
  const Adjacency* _cells;
  std::vector<std::int32_t> _entries;
  std::vector<Pair> _bounds;
  std::vector<std::int32_t> _moved; // cells whose row is elsewhere
};

/// Cells at an interface: around nodes whose cells are not all of one material.
class NearCells
{
public:
  explicit NearCells(const Mesh& mesh) : _mesh(&mesh), _cell(mesh.num_cells())
  {
  }

  void find(const Materials& materials)
  {
    for (std::int32_t c : _list)
      _cell[c] = 0;
    _list.clear();
    for (std::int32_t i = 0; i < _mesh->num_nodes(); ++i)
    {
      const auto around = _mesh->node_cells()[i];
      const std::int32_t first =
          around.empty() ? -1 : materials.pure(around[0]);
      bool same = first >= 0;
      for (std::int32_t c : around)
        same &= materials.pure(c) == first;
      if (not same)
        for (std::int32_t c : around)
          take(c);
    }
  }

  void take(std::int32_t c)
  {
    if (_cell[c] != 0)
      return;
    _cell[c] = 1;
    _list.push_back(c);
  }

  [[nodiscard]] std::span<const std::int32_t> list() const { return _list; }

private:
  const Mesh* _mesh;
  std::vector<std::uint8_t> _cell;
  std::vector<std::int32_t> _list;
};
} // namespace remap
