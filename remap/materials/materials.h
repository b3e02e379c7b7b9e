// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: which materials a cell holds, and how much of each. Parts are
// stored for mixed cells only; a pure cell is one number.
//
// Slots number everything that can carry values: slot c is cell c, if it is
// pure; the parts of mixed cells follow behind all cells, row by row. So
// fields of a scene with one material look as they always did, and the first
// num_cells values of a field are those of the pure cells.
#pragma once

#include "remap/geometry/measure.h"
#include "remap/interfaces/partition.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace remap
{
/// What a mixed cell holds of one material.
struct Part
{
  std::int32_t material = 0;
  double fraction = 0; ///< of the cell's volume, in (0, 1)
  Point centroid;      ///< [m]
};

/// The materials of all cells of a rank, ghosts included.
class Materials
{
public:
  /// All cells hold the same material.
  /// @param[in] num_cells     with ghosts
  /// @param[in] num_materials numbered from 0
  Materials(std::int32_t num_cells, int num_materials, int material = 0)
      : _num_materials(num_materials), _of_cell(num_cells, material)
  {
  }

  [[nodiscard]] int num_materials() const { return _num_materials; }
  [[nodiscard]] std::int32_t num_cells() const
  {
    return static_cast<std::int32_t>(_of_cell.size());
  }

  /// The material of a pure cell, or -1.
  [[nodiscard]] std::int32_t pure(std::int32_t c) const
  {
    return _of_cell[c] >= 0 ? _of_cell[c] : -1;
  }
  /// Row of a mixed cell, or -1.
  [[nodiscard]] std::int32_t row(std::int32_t c) const
  {
    return _of_cell[c] >= 0 ? -1 : ~_of_cell[c];
  }
  /// Mixed cells, row by row.
  [[nodiscard]] std::span<const std::int32_t> mixed() const { return _mixed; }
  /// Parts of a row, by ascending material.
  [[nodiscard]] std::span<const Part> parts(std::int32_t row) const
  {
    return {_parts.data() + _first[row], _parts.data() + _first[row + 1]};
  }
  [[nodiscard]] std::span<Part> parts(std::int32_t row)
  {
    return {_parts.data() + _first[row], _parts.data() + _first[row + 1]};
  }
  /// Slot of the first part of a row; the others follow.
  [[nodiscard]] std::int32_t first_slot(std::int32_t row) const
  {
    return num_cells() + _first[row];
  }
  /// Part at a slot behind the cells, and its cell.
  [[nodiscard]] const Part& part(std::int32_t slot) const
  {
    return _parts[slot - num_cells()];
  }
  [[nodiscard]] Part& part(std::int32_t slot)
  {
    return _parts[slot - num_cells()];
  }
  [[nodiscard]] std::int32_t cell(std::int32_t slot) const
  {
    const auto behind =
        std::upper_bound(_first.begin(), _first.end(), slot - num_cells());
    return _mixed[static_cast<std::size_t>(behind - _first.begin()) - 1];
  }
  /// Material whose values stand at a slot; -1: that of a mixed cell.
  [[nodiscard]] std::int32_t material(std::int32_t slot) const
  {
    return slot < num_cells() ? pure(slot) : part(slot).material;
  }
  /// Number of slots: cells and parts.
  [[nodiscard]] std::int32_t num_slots() const
  {
    return num_cells() + static_cast<std::int32_t>(_parts.size());
  }
  /// Slot of a material in a cell, or -1 if it is not there.
  [[nodiscard]] std::int32_t slot(std::int32_t c, std::int32_t material) const
  {
    if (_of_cell[c] >= 0)
      return _of_cell[c] == material ? c : -1;
    const std::int32_t r = row(c);
    for (std::int32_t i = _first[r]; i < _first[r + 1]; ++i)
      if (_parts[i].material == material)
        return num_cells() + i;
    return -1;
  }
  /// Fraction of a material in a cell.
  [[nodiscard]] double fraction(std::int32_t c, std::int32_t material) const
  {
    const std::int32_t s = slot(c, material);
    return s < 0             ? 0.0
           : s < num_cells() ? 1.0
                             : _parts[s - num_cells()].fraction;
  }

  /// Make a cell pure. Rows of mixed cells stay until `drop_rows`.
  void set_pure(std::int32_t c, std::int32_t material)
  {
    _of_cell[c] = material;
  }
  /// Forget all rows; every mixed cell is to be set again.
  void drop_rows()
  {
    _mixed.clear();
    _parts.clear();
    _first.assign(1, 0);
  }
  /// Make a cell mixed: a new row behind all others.
  /// @param[in] parts two or more, by ascending material, fractions add up to 1
  /// @throws std::invalid_argument with less or more than a cell can hold
  void add_row(std::int32_t c, std::span<const Part> parts)
  {
    if (parts.size() < 2 or parts.size() > most_parts)
      throw std::invalid_argument("parts of a mixed cell: from 2 to 8");
    _of_cell[c] = ~static_cast<std::int32_t>(_mixed.size());
    _mixed.push_back(c);
    _parts.insert(_parts.end(), parts.begin(), parts.end());
    _first.push_back(static_cast<std::int32_t>(_parts.size()));
  }

private:
  int _num_materials;
  std::vector<std::int32_t> _of_cell;     // material, or ~row
  std::vector<std::int32_t> _mixed;       // cell of each row
  std::vector<std::int32_t> _first = {0}; // part of each row, and the end
  std::vector<Part> _parts;
};
} // namespace remap
