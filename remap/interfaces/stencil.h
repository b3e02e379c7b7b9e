// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: a mixed cell and the cells that share a vertex with it, for
// reconstructions that look at volumes alone.
#pragma once

#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <span>
#include <vector>

namespace remap
{
/// Fractions around a cell. Room is made once, for the widest stencil.
class Stencil
{
public:
  /// @param[in] mesh kept by reference: must outlive this
  explicit Stencil(const Mesh& mesh) : _mesh(&mesh)
  {
    std::size_t most = 0;
    for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
      most = std::max(most, mesh.cell_cells()[c].size());
    _cells.resize(most);
    _values.resize(most);
  }

  /// Look at a cell. @param[in] x shape (num_nodes, 2) [m]
  void load(std::int32_t c, std::span<const double> x)
  {
    _around = _mesh->cell_cells()[c];
    _cell = triangle(c, x);
    for (std::size_t j = 0; j < _around.size(); ++j)
      _cells[j] = triangle(_around[j], x);
  }
  /// Take the fractions of some materials together.
  /// @param[in] wanted which materials: a bit for each part of the row of c
  void take(const Materials& materials, std::span<const Part> parts,
            unsigned wanted)
  {
    for (std::size_t j = 0; j < _around.size(); ++j)
    {
      _values[j] = 0;
      for (unsigned w = wanted; w != 0; w &= w - 1)
        _values[j] +=
            materials.fraction(_around[j], parts[std::countr_zero(w)].material);
    }
    _value = 0;
    for (unsigned w = wanted; w != 0; w &= w - 1)
      _value += parts[std::countr_zero(w)].fraction;
  }

  [[nodiscard]] std::size_t size() const { return _around.size(); }
  [[nodiscard]] const Triangle& cell() const { return _cell; }
  [[nodiscard]] double value() const { return _value; }
  [[nodiscard]] const Triangle& cell(std::size_t j) const { return _cells[j]; }
  [[nodiscard]] double value(std::size_t j) const { return _values[j]; }
  [[nodiscard]] std::int32_t number(std::size_t j) const { return _around[j]; }

private:
  [[nodiscard]] Triangle triangle(std::int32_t c,
                                  std::span<const double> x) const
  {
    const Triple& v = _mesh->cell(c);
    return {point(x, v[0]), point(x, v[1]), point(x, v[2])};
  }

  const Mesh* _mesh;
  std::span<const std::int32_t> _around;
  Triangle _cell;
  double _value = 0;
  std::vector<Triangle> _cells;
  std::vector<double> _values;
};

inline Point centroid(const Triangle& t)
{
  return 1.0 / 3 * (t[0] + t[1] + t[2]);
}
} // namespace remap
