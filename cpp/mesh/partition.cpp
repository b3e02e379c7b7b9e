// SPDX-License-Identifier: LGPL-3.0-or-later
#include "partition.h"

#include "compat.h"
#include <algorithm>
#include <numeric>

namespace mmale::mesh
{
namespace
{
using Pair = std::array<std::int64_t, 2>; // vertex, rank

/// All ranks at each vertex, sorted; gathered on every rank, which is small
/// change for the meshes of a plane problem.
std::vector<Pair> gather_ranks_at_vertices(MPI_Comm comm,
                                           std::vector<Pair> mine)
{
  std::ranges::sort(mine);
  mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  int size = 0;
  MPI_Comm_size(comm, &size);
  const int count = static_cast<int>(2 * mine.size());
  std::vector<int> counts(size), offsets(size + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end(), offsets.begin() + 1);
  std::vector<Pair> all(offsets.back() / 2);
  MPI_Allgatherv(mine.data(), count, MPI_INT64_T, all.data(), counts.data(),
                 offsets.data(), MPI_INT64_T, comm);
  std::ranges::sort(all);
  return all;
}
} // namespace

dolfinx::mesh::CellPartitionFunction vertex_halo_partitioner()
{
  return [](MPI_Comm comm, int num_parts,
            const std::vector<dolfinx::mesh::CellType>& types,
            const std::vector<std::span<const std::int64_t>>& cells)
             -> dolfinx::graph::AdjacencyList<std::int32_t>
  {
    const auto owner = compat::cell_partitioner(dolfinx::mesh::GhostMode::none)(
        comm, num_parts, types, cells);
    const std::span<const std::int64_t> vertices = cells[0];
    const int num_cells = static_cast<int>(vertices.size() / 3);
    std::vector<Pair> mine;
    for (int c = 0; c < num_cells; ++c)
      for (int v = 0; v < 3; ++v)
        mine.push_back({vertices[3 * c + v], owner.links(c)[0]});
    const auto at = gather_ranks_at_vertices(comm, std::move(mine));

    std::vector<std::int32_t> destinations, offsets{0}, ghosts;
    for (int c = 0; c < num_cells; ++c)
    {
      const std::int32_t own = owner.links(c)[0];
      ghosts.clear();
      for (int v = 0; v < 3; ++v)
        for (auto it =
                 std::ranges::lower_bound(at, Pair{vertices[3 * c + v], -1});
             it != at.end() and (*it)[0] == vertices[3 * c + v]; ++it)
          if ((*it)[1] != own)
            ghosts.push_back(static_cast<std::int32_t>((*it)[1]));
      std::ranges::sort(ghosts);
      ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
      destinations.push_back(own);
      destinations.insert(destinations.end(), ghosts.begin(), ghosts.end());
      offsets.push_back(static_cast<std::int32_t>(destinations.size()));
    }
    return {std::move(destinations), std::move(offsets)};
  };
}
} // namespace mmale::mesh
