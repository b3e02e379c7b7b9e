// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/ghosts.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

using namespace remap;

void remap::update_ghosts(const Mesh& mesh, Materials& materials,
                          const Host& host)
{
  if (not host.cell_halo)
    return;
  const std::int32_t owned = mesh.owned_cells(), all = mesh.num_cells();
  // The material of a pure cell; else -1 - (number of parts).
  std::vector<double> counts(all);
  std::vector<std::int32_t> ours;
  int most = 0;
  for (std::int32_t c = 0; c < owned; ++c)
    counts[c] = materials.pure(c);
  for (std::int32_t c : materials.mixed())
    if (c < owned and materials.row(c) >= 0)
    {
      const auto n = static_cast<int>(materials.parts(materials.row(c)).size());
      counts[c] = -1 - n;
      most = std::max(most, n);
      ours.push_back(c);
    }
  host.update_cells(counts, 1);
  most = static_cast<int>(host.max(most));

  std::vector<double> row(std::size_t(4) * all);
  std::vector<std::array<Part, most_parts>> ghosts(all - owned);
  for (int k = 0; k < most; ++k)
  {
    for (std::int32_t c : ours)
      if (const auto parts = materials.parts(materials.row(c));
          k < std::ssize(parts))
      {
        const Part& p = parts[k];
        double* at = &row[std::size_t(4) * c];
        at[0] = p.material, at[1] = p.fraction;
        at[2] = p.centroid.x, at[3] = p.centroid.y;
      }
    host.update_cells(row, 4);
    for (std::int32_t c = owned; c < all; ++c)
    {
      const double* at = &row[std::size_t(4) * c];
      ghosts[c - owned][k] = {
          static_cast<std::int32_t>(at[0]), at[1], {at[2], at[3]}};
    }
  }

  std::vector<std::array<Part, most_parts>> rows;
  std::vector<int> sizes;
  for (std::int32_t c : ours)
  {
    const auto parts = std::as_const(materials).parts(materials.row(c));
    std::copy(parts.begin(), parts.end(), rows.emplace_back().begin());
    sizes.push_back(static_cast<int>(parts.size()));
  }
  materials.drop_rows();
  for (std::size_t i = 0; i < ours.size(); ++i)
    materials.add_row(ours[i], {rows[i].data(), std::size_t(sizes[i])});
  for (std::int32_t c = owned; c < all; ++c)
    if (counts[c] >= 0)
      materials.set_pure(c, static_cast<std::int32_t>(counts[c]));
    else
      materials.add_row(c, {ghosts[c - owned].data(),
                            static_cast<std::size_t>(-1 - counts[c])});
}
