// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: a mixed cell and the cells that share a vertex with it, for
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

  /// Look at a cell alone. @param[in] x shape (num_nodes, 2) [m]
  void load_cell(std::int32_t c, std::span<const double> x)
  {
    const Triple& v = _mesh->cell(c);
    const Triangle t = {point(x, v[0]), point(x, v[1]), point(x, v[2])};
    _origin = 1.0 / 3 * (t[0] + t[1] + t[2]);
    _cell.t = {t[0] - _origin, t[1] - _origin, t[2] - _origin};
    _cell.centre = {};
    _numbers = _mesh->cell_cells()[c];
  }
  /// And at those around it.
  void load(std::int32_t c, std::span<const double> x)
  {
    load_cell(c, x);
    for (std::size_t j = 0; j < _numbers.size(); ++j)
    {
      const Triple& w = _mesh->cell(_numbers[j]);
      Cell& to = _around[j];
      to.t = {point(x, w[0]) - _origin, point(x, w[1]) - _origin,
              point(x, w[2]) - _origin};
      to.centre = 1.0 / 3 * (to.t[0] + to.t[1] + to.t[2]);
    }
  }

  /// Take the fractions of some materials together. Materials that the cell
  /// itself does not hold count with those of its parts, taken or not, on
  /// whose side they lie.
  /// @param[in] parts  of the mixed cell
  /// @param[in] wanted a bit for each of these parts
  void take(const Materials& materials, std::span<const Part> parts,
            unsigned wanted)
  {
    const auto is = [&](std::int32_t material)
    {
      for (std::size_t k = 0; k < parts.size(); ++k)
        if (parts[k].material == material)
          return static_cast<int>(wanted >> k & 1u);
      return other;
    };
    _cell.value = 0;
    for (std::size_t k = 0; k < parts.size(); ++k)
      _cell.value += (wanted >> k & 1u) != 0 ? parts[k].fraction : 0;
    bool others = false;
    for (std::size_t j = 0; j < _numbers.size(); ++j)
    {
      double& value = _around[j].value;
      if (const std::int32_t m = materials.pure(_numbers[j]); m >= 0)
      {
        const int side = is(m);
        others = others or side == other;
        value = side == 1;
        continue;
      }
      value = 0;
      for (const Part& p : materials.parts(materials.row(_numbers[j])))
      {
        const int side = is(p.material);
        others = others or side == other;
        value += side == 1 ? p.fraction : 0;
      }
    }
    if (others)
      take_others(materials, is);
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
  static constexpr int other = 2;

  template <class Use>
  void each_part(const Materials& materials, Use&& use) const
  {
    for (std::size_t j = 0; j < _numbers.size(); ++j)
      if (const std::int32_t m = materials.pure(_numbers[j]); m >= 0)
        use(j, m, 1.0);
      else
        for (const Part& p : materials.parts(materials.row(_numbers[j])))
          use(j, p.material, p.fraction);
  }

  /// @param[in] is 1: taken, 0: not, `other`
  template <class Is>
  void take_others(const Materials& materials, Is&& is)
  {
    // Where each side lies on average, and where the material does.
    std::array<Moments, 2> sides;
    each_part(materials,
              [&](std::size_t j, std::int32_t m, double f)
              {
                if (const int side = is(m); side != other)
                  sides[side] += volume(j, f);
              });
    const auto mean = [](const Moments& m)
    { return m.v > 0 ? m.centroid() : Point{}; };
    const Point from = mean(sides[1]), axis = mean(sides[0]) - from;
    for (std::int32_t m = 0; m < materials.num_materials(); ++m)
    {
      if (is(m) != other)
        continue;
      Moments all;
      each_part(materials, [&](std::size_t j, std::int32_t of, double f)
                { all += of == m ? volume(j, f) : Moments{}; });
      if (all.v > 0 and dot(mean(all) - from, axis) < 0.5 * dot(axis, axis))
        each_part(materials, [&](std::size_t j, std::int32_t of, double f)
                  { _around[j].value += of == m ? f : 0; });
    }
  }
  [[nodiscard]] Moments volume(std::size_t j, double fraction) const
  {
    const Cell& c = _around[j];
    const double v = fraction * twice_area(c.t[0], c.t[1], c.t[2]);
    return {v, v * c.centre.x, v * c.centre.y};
  }

  const Mesh* _mesh;
  std::span<const std::int32_t> _numbers;
  Point _origin;
  Cell _cell;
  std::vector<Cell> _around;
};
} // namespace remap
