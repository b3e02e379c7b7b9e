// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/stars.h"

#include <algorithm>
#include <utility>

using namespace remap;

/// Around each node one cell after the other counter-clockwise, from the
/// boundary; around an inner node from its neighbour with the smallest global
/// number: so sums over a patch do not depend on the number of ranks.
Stars::Stars(const Mesh& mesh)
    : _start(mesh.node_cells().offsets),
      _cells(mesh.node_cells().entries.size())
{
  for (std::int32_t i = 0; i < mesh.owned_nodes(); ++i)
  {
    const auto around = mesh.node_cells()[i];
    const std::span star(_cells.data() + _start[i], around.size());
    _widest = std::max(_widest, star.size());
    for (std::size_t k = 0; k < star.size(); ++k)
    {
      const Triple& n = mesh.cell(around[k]);
      const int v = n[0] == i ? 0 : (n[1] == i ? 1 : 2);
      star[k] = {n[(v + 1) % 3], n[(v + 2) % 3], around[k], v};
    }
    for (std::size_t k = 0; k < star.size(); ++k)
    {
      // The cell after the last one; else the start of a fan; else, in a ring,
      // any: of several the smallest.
      const auto rank = [&](const Cell& c)
      {
        const bool next = k > 0 and star[k - 1].b == c.a;
        const bool starts = std::ranges::none_of(star, [&](const Cell& o)
                                                 { return o.b == c.a; });
        return std::pair(next ? 0 : (starts ? 1 : 2), mesh.node_ids()[c.a]);
      };
      std::swap(star[k], *std::ranges::min_element(star.subspan(k), {}, rank));
    }
  }
}

void Stars::gather(std::int32_t node, std::span<const double> x,
                   std::span<const quality::Target> targets,
                   std::vector<PatchCell>& patch) const
{
  patch.clear();
  for (std::int32_t k = _start[node]; k < _start[node + 1]; ++k)
  {
    const Cell& s = _cells[k];
    quality::Target w = quality::equilateral;
    if (not targets.empty())
    {
      w = targets[s.cell];
      for (std::int32_t v = 0; v < s.vertex; ++v)
        w = w.next();
    }
    patch.push_back({point(x, s.a), point(x, s.b), w});
  }
}
