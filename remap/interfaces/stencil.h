// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: a mixed cell and the cells that share a vertex with it, for
// reconstructions that look at volumes alone.
#pragma once

#include "remap/interfaces/turning.h"
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
  /// One cell, seen from the centre of the mixed one.
  struct Cell
  {
    Triangle t;
    Point centre;     ///< mean of the vertices
    double value = 0; ///< fraction of what is taken
  };

  /// @param[in] mesh kept by reference: must outlive this
  explicit Stencil(const Mesh& mesh) : _mesh(&mesh)
  {
    std::size_t most = 0;
    for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
      most = std::max(most, mesh.cell_cells()[c].size());
    _around.resize(most);
  }

  /// Look at a cell. @param[in] x shape (num_nodes, 2) [m]
  void load(std::int32_t c, std::span<const double> x)
  {
    const Triple& v = _mesh->cell(c);
    const Triangle t = {point(x, v[0]), point(x, v[1]), point(x, v[2])};
    _origin = 1.0 / 3 * (t[0] + t[1] + t[2]);
    _cell.t = {t[0] - _origin, t[1] - _origin, t[2] - _origin};
    _cell.centre = {};
    _numbers = _mesh->cell_cells()[c];
    for (std::size_t j = 0; j < _numbers.size(); ++j)
    {
      const Triple& w = _mesh->cell(_numbers[j]);
      Cell& to = _around[j];
      to.t = {point(x, w[0]) - _origin, point(x, w[1]) - _origin,
              point(x, w[2]) - _origin};
      to.centre = 1.0 / 3 * (to.t[0] + to.t[1] + to.t[2]);
    }
  }

  /// Take the fractions of some materials together.
  /// @param[in] parts  of the mixed cell
  /// @param[in] wanted a bit for each of these parts
  void take(const Materials& materials, std::span<const Part> parts,
            unsigned wanted)
  {
    const auto sum = [&](auto&& fraction)
    {
      double out = 0;
      for (unsigned w = wanted; w != 0; w &= w - 1)
        out += fraction(std::countr_zero(w));
      return out;
    };
    _cell.value = sum([&](int k) { return parts[k].fraction; });
    for (std::size_t j = 0; j < _numbers.size(); ++j)
      _around[j].value =
          sum([&](int k)
              { return materials.fraction(_numbers[j], parts[k].material); });
  }

  /// The mixed cell's centre: coordinates are measured from it.
  [[nodiscard]] Point origin() const { return _origin; }
  [[nodiscard]] const Cell& cell() const { return _cell; }
  [[nodiscard]] std::span<const Cell> around() const
  {
    return {_around.data(), _numbers.size()};
  }
  [[nodiscard]] std::span<const std::int32_t> numbers() const
  {
    return _numbers;
  }

private:
  const Mesh* _mesh;
  std::span<const std::int32_t> _numbers;
  Point _origin;
  Cell _cell;
  std::vector<Cell> _around;
};
} // namespace remap
