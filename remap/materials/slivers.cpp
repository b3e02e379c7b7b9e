// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/slivers.h"

#include "remap/materials/ghosts.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

using namespace remap;

namespace
{
/// Who takes part has so many times a sliver of it: all neighbours of a cell
/// may ask it at once.
constexpr double plenty = 64;

/// A cell gives all it has of one material and gets another for it.
struct Swap
{
  std::int32_t cell, with;
  std::int32_t gives, gets;
  double volume;
};

using Volume = std::function<double(std::int32_t)>;

/// Volume of a material that both cells hold as much of, at least.
double largest_common(const Materials& m, const Volume& volume, std::int32_t c,
                      std::int32_t d, std::int32_t but, std::int32_t& material)
{
  double best = 0;
  for (const Part& p : m.parts(m.row(c)))
    if (const double v = std::min(p.fraction * volume(c),
                                  m.fraction(d, p.material) * volume(d));
        p.material != but and v > best)
    {
      best = v;
      material = p.material;
    }
  return best;
}

/// The exchange that rids a cell of its smallest part, with the neighbour that
/// has most of what it needs; `with` < 0: none has.
Swap swap_of(const Mesh& mesh, const Materials& m, const Volume& volume,
             std::int32_t c, double least)
{
  const auto parts = m.parts(m.row(c));
  const Part& p = *std::min_element(parts.begin(), parts.end(),
                                    [](const Part& a, const Part& b)
                                    { return a.fraction < b.fraction; });
  Swap out{c, -1, p.material, -1, p.fraction * volume(c)};
  double best = plenty * least * volume(c);
  for (std::int32_t d : mesh.cell_cells()[c])
  {
    if (m.row(d) < 0)
      continue; // it has nothing else to give
    std::int32_t gets = -1;
    const double has =
        std::min(m.fraction(d, p.material) * volume(d),
                 largest_common(m, volume, c, d, p.material, gets));
    if (has > best)
    {
      best = has;
      out.with = d;
      out.gets = gets;
    }
  }
  return out;
}

Part& part_of(Materials& m, std::int32_t c, std::int32_t material)
{
  const auto parts = m.parts(m.row(c));
  return *std::find_if(parts.begin(), parts.end(), [material](const Part& p)
                       { return p.material == material; });
}

/// Rows without their empty parts.
void drop_empty(Materials& m)
{
  struct Row
  {
    std::int32_t cell = -1;
    int count = 0;
    std::array<Part, most_parts> parts;
  };
  std::vector<Row> rows;
  for (std::int32_t c : m.mixed())
  {
    if (m.row(c) < 0)
      continue;
    Row& row = rows.emplace_back();
    row.cell = c;
    for (const Part& p : m.parts(m.row(c)))
      if (p.fraction > 0)
        row.parts[row.count++] = p;
  }
  m.drop_rows();
  for (const Row& row : rows)
    if (row.count > 1)
      m.add_row(row.cell, {row.parts.data(), std::size_t(row.count)});
    else
      m.set_pure(row.cell, row.parts[0].material);
}

/// Exchanges that all ranks' cells want, as far as this rank sees them.
std::vector<Swap> exchanged(const Mesh& mesh, const std::vector<Swap>& ours,
                            const Host& host)
{
  if (not host.cell_halo)
    return ours;
  std::vector<double> table(std::size_t(5) * mesh.num_cells());
  for (const Swap& s : ours)
  {
    double* at = &table[std::size_t(5) * s.cell];
    at[0] = 1, at[1] = static_cast<double>(mesh.cell_ids()[s.with]);
    at[2] = s.gives, at[3] = s.gets, at[4] = s.volume;
  }
  host.update_cells(table, 5);
  std::vector<Swap> out = ours;
  for (std::int32_t c = mesh.owned_cells(); c < mesh.num_cells(); ++c)
  {
    const double* at = &table[std::size_t(5) * c];
    if (at[0] == 0)
      continue;
    // Only neighbours of ours matter.
    for (std::int32_t d : mesh.cell_cells()[c])
      if (static_cast<double>(mesh.cell_ids()[d]) == at[1])
        out.push_back({c, d, static_cast<std::int32_t>(at[2]),
                       static_cast<std::int32_t>(at[3]), at[4]});
  }
  return out;
}
} // namespace

SliverReport
remap::sweep_slivers(const Mesh& mesh, Materials& materials, double least,
                     const std::function<double(std::int32_t)>& volume,
                     const Host& host)
{
  SliverReport report;
  std::vector<Swap> swaps;
  for (std::int32_t c : materials.mixed())
  {
    if (materials.row(c) < 0 or c >= mesh.owned_cells())
      continue;
    const auto parts = std::as_const(materials).parts(materials.row(c));
    if (std::all_of(parts.begin(), parts.end(),
                    [least](const Part& p) { return p.fraction >= least; }))
      continue;
    const Swap s = swap_of(mesh, materials, volume, c, least);
    if (s.with < 0)
    {
      ++report.kept;
      continue;
    }
    ++report.swept;
    report.volume += s.volume;
    swaps.push_back(s);
  }
  if (not(host.max(swaps.empty() ? 0.0 : 1.0) > 0))
    return report;
  for (const Swap& s : exchanged(mesh, swaps, host))
  {
    Part& gives = part_of(materials, s.cell, s.gives);
    part_of(materials, s.cell, s.gets).fraction += gives.fraction;
    gives.fraction = 0;
    const double part = s.volume / volume(s.with);
    part_of(materials, s.with, s.gives).fraction += part;
    part_of(materials, s.with, s.gets).fraction -= part;
  }
  drop_empty(materials);
  update_ghosts(mesh, materials, host);
  return report;
}
