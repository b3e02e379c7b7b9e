// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mixture.h"

#include "mesh/domain.h"
#include "output/archive.h"
#include <algorithm>
#include <array>

namespace mmale::mixture
{
void clear(State& state)
{
  const auto slots = static_cast<std::size_t>(state.materials->num_slots());
  for (const std::int32_t c : state.materials->mixed())
    for (std::vector<double>* field :
         {&state.s, &state.P, &state.density, &state.history})
    {
      const std::size_t width = field->size() / slots;
      std::fill_n(field->begin() + width * c, width, 0.0);
    }
}

void fill(State& state)
{
  clear(state);
  const bridge::Materials& materials = *state.materials;
  const auto mixed = materials.mixed();
  for (std::size_t row = 0; row < mixed.size(); ++row)
  {
    const auto c = static_cast<std::size_t>(mixed[row]);
    auto slot = static_cast<std::size_t>(
        materials.first_slot(static_cast<std::int32_t>(row)));
    for (const bridge::Part& part :
         materials.parts(static_cast<std::int32_t>(row)))
    {
      for (int i = 0; i < 4; ++i)
        state.s[4 * c + i] += part.fraction * state.s[4 * slot + i];
      state.P[c] += part.fraction * state.P[slot];
      state.density[c] += part.fraction * state.density[slot];
      ++slot;
    }
  }
}

namespace
{
using bridge::Materials;
using bridge::Part;

/// Calls visit(part, slot) for what a cell holds; a pure one is one part.
void each_part(const Materials& materials, std::int32_t c, auto&& visit)
{
  if (const std::int32_t k = materials.pure(c); k >= 0)
    return visit(Part{k, 1, {0, 0}}, c);
  std::int32_t slot = materials.first_slot(materials.row(c));
  for (const Part& part : materials.parts(materials.row(c)))
    visit(part, slot++);
}

/// Arrays over slots.
std::array<std::vector<double>*, 4> fields(State& state)
{
  return {&state.s, &state.P, &state.density, &state.history};
}

/// A row for each cell: number of parts, then what is known of each.
std::vector<double> rows_of(State& state, std::int32_t cells,
                            std::span<const std::size_t, 4> width, int most)
{
  const std::size_t part = 4 + width[0] + width[1] + width[2] + width[3];
  const std::size_t row = 1 + part * most;
  std::vector<double> rows(row * cells, 0);
  for (std::int32_t c = 0; c < cells; ++c)
  {
    double* to = rows.data() + row * c + 1;
    each_part(*state.materials, c,
              [&](const Part& p, std::int32_t slot)
              {
                ++rows[row * c];
                for (double x : {static_cast<double>(p.material), p.fraction,
                                 p.centroid.x, p.centroid.y})
                  *to++ = x;
                for (int i = 0; i < 4; ++i)
                  to = std::copy_n(fields(state)[i]->begin() + width[i] * slot,
                                   width[i], to);
              });
  }
  return rows;
}

void take_rows(State& state, std::span<const double> rows, std::int32_t cells,
               std::span<const std::size_t, 4> width)
{
  Materials& materials = *state.materials;
  const std::size_t row = rows.size() / cells;
  const std::size_t part = 4 + width[0] + width[1] + width[2] + width[3];
  materials.drop_rows();
  for (std::int32_t c = 0; c < cells; ++c)
  {
    const double* at = rows.data() + row * c;
    const auto n = static_cast<std::size_t>(at[0]);
    std::vector<Part> parts;
    for (std::size_t i = 0; i < n; ++i)
    {
      const double* p = at + 1 + part * i;
      parts.push_back({static_cast<std::int32_t>(p[0]), p[1], {p[2], p[3]}});
    }
    if (n == 1)
      materials.set_pure(c, parts[0].material);
    else
      materials.add_row(c, parts);
  }
  for (int i = 0; i < 4; ++i)
    fields(state)[i]->assign(width[i] * materials.num_slots(), 0);
  for (std::int32_t c = 0; c < cells; ++c)
  {
    const double* from = rows.data() + row * c + 1;
    each_part(materials, c,
              [&](const Part&, std::int32_t slot)
              {
                from += 4;
                for (int i = 0; i < 4; from += width[i++])
                  std::copy_n(from, width[i],
                              fields(state)[i]->begin() + width[i] * slot);
              });
  }
}
} // namespace

void keep(output::Archive& archive, const mesh::Domain& domain, State& state)
{
  const std::int32_t cells = domain.num_cells();
  const auto slots = static_cast<std::size_t>(state.materials->num_slots());
  std::array<std::size_t, 4> width;
  for (int i = 0; i < 4; ++i)
    width[i] = fields(state)[i]->size() / slots;
  int most = 1;
  for (std::size_t r = 0; r < state.materials->mixed().size(); ++r)
    most = std::max(
        most, static_cast<int>(
                  state.materials->parts(static_cast<std::int32_t>(r)).size()));
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_INT, MPI_MAX, domain.comm);
  auto rows = archive.loading() ? std::vector<double>()
                                : rows_of(state, cells, width, most);
  archive("state/materials", Entity::cell, rows);
  if (not archive.loading())
    return;
  take_rows(state, rows, cells, width);
  fill(state);
}
} // namespace mmale::mixture
