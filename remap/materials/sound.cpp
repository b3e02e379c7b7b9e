// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/sound.h"

#include "remap/geometry/position.h"

#include <cmath>

namespace
{
/// Off by more than this, fractions do not add up: what is missing would be
/// made when they are used.
constexpr double sum_slack = 1e-12;
/// Off by more than this, in lengths of the cell, a part is outside.
constexpr double outside_slack = 1e-9;
} // namespace

bool remap::sound(const Mesh& mesh, const Materials& m,
                  std::span<const double> x)
{
  for (std::int32_t c = 0; c < m.num_cells(); ++c)
    if (m.pure(c) >= m.num_materials())
      return false;
  for (std::size_t r = 0; r < m.mixed().size(); ++r)
  {
    const Triple& n = mesh.cell(m.mixed()[r]);
    const Triangle t = {point(x, n[0]), point(x, n[1]), point(x, n[2])};
    const double size = position::longest_edge(t);
    double sum = 0;
    std::int32_t last = -1;
    for (const Part& p : m.parts(static_cast<std::int32_t>(r)))
    {
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k)
        inside = inside
                 and position::depth(t[k], t[(k + 1) % 3], p.centroid)
                         >= -outside_slack * size * size;
      if (not(p.fraction > 0 and p.fraction <= 1) or not inside
          or p.material <= last or p.material >= m.num_materials())
        return false;
      last = p.material;
      sum += p.fraction;
    }
    if (not(std::abs(sum - 1) <= sum_slack))
      return false;
  }
  return true;
}
