// SPDX-License-Identifier: LGPL-3.0-or-later
#include "foot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace mmale::bridge
{
namespace
{
/// Off the side's line by less, in parts of its length, is on it. Walls hold
/// nodes to round-off.
constexpr double in_line = 1e-9;

/// Boundary edges of the whole body: global nodes, and the boundary.
using Edge = std::array<std::int64_t, 3>;

std::vector<Edge> all_edges(const mesh::Domain& domain)
{
  std::vector<std::int64_t> own;
  for (const mesh::Facet& f : domain.facets)
    if (f.cell < domain.num_owned_cells)
      own.insert(own.end(),
                 {domain.node_id[f.a], domain.node_id[f.b], f.boundary});
  int size = 1;
  MPI_Comm_size(domain.comm, &size);
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(size), starts(size, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, domain.comm);
  for (int r = 1; r < size; ++r)
    starts[r] = starts[r - 1] + counts[r - 1];
  std::vector<std::int64_t> all(starts.back() + counts.back());
  MPI_Allgatherv(own.data(), count, MPI_INT64_T, all.data(), counts.data(),
                 starts.data(), MPI_INT64_T, domain.comm);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < all.size(); i += 3)
    edges.push_back({all[i], all[i + 1], all[i + 2]});
  return edges;
}
} // namespace

Foot::Foot(const mesh::Domain& domain, const std::vector<std::string>& surfaces)
    : _domain(domain)
{
  if (surfaces.empty())
    return;
  std::map<std::int64_t, std::array<std::int64_t, 2>> after[2];
  for (const auto& [a, b, boundary] : all_edges(domain))
  {
    after[0][a] = {b, boundary}; // the body on the left
    after[1][b] = {a, boundary};
  }
  std::map<std::int64_t, int> local;
  for (int n = 0; n < domain.num_owned_nodes; ++n)
    local[domain.node_id[n]] = n;
  const auto number = [&local](std::int64_t id)
  {
    const auto at = local.find(id);
    return at == local.end() ? -1 : at->second;
  };
  const auto surface = [&](std::int64_t boundary)
  {
    return std::ranges::find(surfaces, domain.boundary_names[boundary])
           != surfaces.end();
  };
  for (const mesh::Side& side : domain.sides)
    for (int end = 0; end < 2 and not surface(side.boundary); ++end)
    {
      auto& next = after[1 - end];
      const std::int64_t last = side.end_nodes[end];
      Way way{number(side.end_nodes[1 - end]), {number(last)}};
      for (auto at = next.find(last);
           at != next.end() and surface(at->second[1]);
           at = next.find(at->second[0]))
        way.nodes.push_back(number(at->second[0]));
      if (way.nodes.size() > 2)
        _ways.push_back(std::move(way));
    }
}

int Foot::move(std::span<const std::uint8_t> at_wall, std::span<double> x) const
{
  // every way: x, y and whether at a wall, from the other end of its side on
  std::vector<double> all;
  const auto put = [&](int n)
  {
    const bool ours = n >= 0;
    all.insert(all.end(), {ours ? x[2 * n] : 0.0, ours ? x[2 * n + 1] : 0.0,
                           ours and at_wall[n] ? 1.0 : 0.0});
  };
  for (const Way& way : _ways)
  {
    put(way.from);
    std::ranges::for_each(way.nodes, put);
  }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()),
                MPI_DOUBLE, MPI_SUM, _domain.comm);
  int moved = 0;
  const double* at = all.data();
  for (const Way& way : _ways)
  {
    const double *from = at, *first = at + 3;
    at += 3 * (way.nodes.size() + 1);
    const double along[2] = {first[0] - from[0], first[1] - from[1]};
    const double length2 = along[0] * along[0] + along[1] * along[1];
    // how far beyond the side's end, in its lengths
    double reached = 0;
    std::size_t last = 0;
    for (std::size_t k = 1; k + 1 < way.nodes.size(); ++k)
    {
      const double* p = first + 3 * k;
      const double d[2] = {p[0] - first[0], p[1] - first[1]};
      const double beyond = (d[0] * along[0] + d[1] * along[1]) / length2;
      const double off = (along[0] * d[1] - along[1] * d[0]) / length2;
      if (p[2] == 0 or std::abs(off) > in_line or not(beyond > reached))
        break;
      reached = beyond;
      last = k;
    }
    if (last == 0)
      continue;
    moved += static_cast<int>(last);
    const double *foot = first + 3 * last, *free = foot + 3;
    for (std::size_t k = 0; k <= last; ++k)
      for (int d = 0; d < 2; ++d)
        if (const int n = way.nodes[k]; n >= 0)
          x[2 * n + d] = foot[d]
                         + static_cast<double>(k)
                               / static_cast<double>(last + 1)
                               * (free[d] - foot[d]);
  }
  if (moved > 0)
    _domain.node_halo->update(x, 2);
  return moved;
}
} // namespace mmale::bridge
