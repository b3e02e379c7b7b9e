// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Ranks in one process: a thread each, halos by copying between their arrays.
// Cells are dealt out as told; each rank gets all cells that share a vertex
// with its own, ghosts in a shuffled order.
#pragma once

#include "remap/host.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <barrier>
#include <functional>
#include <map>
#include <set>
#include <thread>

namespace ranks
{
/// One rank's part of a mesh.
struct Part
{
  meshes::Data data;
  std::vector<std::int64_t> cells, nodes; ///< global numbers, owned first
  std::size_t owned_cells = 0, owned_nodes = 0;

  [[nodiscard]] remap::Mesh mesh() const
  {
    remap::MeshInput in = data.input();
    in.owned_cells = owned_cells;
    in.owned_nodes = owned_nodes;
    in.cell_ids = cells;
    in.node_ids = nodes;
    return remap::Mesh(in);
  }

  /// Local numbers from global ones: rows of `block`.
  [[nodiscard]] static std::vector<double>
  take(std::span<const double> all, std::span<const std::int64_t> ids,
       int block)
  {
    std::vector<double> out;
    for (std::int64_t i : ids)
      out.insert(out.end(), all.begin() + block * i,
                 all.begin() + block * (i + 1));
    return out;
  }
};

/// Owner of each node: the smallest rank among its cells'.
inline std::vector<int> node_owners(const meshes::Data& data,
                                    std::span<const int> owner)
{
  std::vector<int> out(data.x.size() / 2, 1 << 20);
  for (std::size_t k = 0; k < data.cells.size(); ++k)
    out[data.cells[k]] = std::min(out[data.cells[k]], owner[k / 3]);
  return out;
}

/// Cells to ranks: in stripes, in blocks, or one by one at random.
inline std::vector<int> deal(const meshes::Data& data, int size, int how)
{
  std::vector<int> out;
  std::mt19937 engine(99);
  for (std::size_t c = 0; c < data.cells.size() / 3; ++c)
  {
    const double x = data.x[2 * data.cells[3 * c]];
    const double y = data.x[2 * data.cells[3 * c] + 1];
    const double at = how == 0   ? x
                      : how == 1 ? std::fmod(3 * x + 2 * y, 1.0)
                                 : std::generate_canonical<double, 32>(engine);
    out.push_back(std::min(size - 1, static_cast<int>(at * size)));
  }
  return out;
}

inline Part cut(const meshes::Data& all, std::span<const int> owner, int rank)
{
  Part out;
  const auto node_owner = node_owners(all, owner);
  std::vector<std::uint8_t> mine(all.x.size() / 2);
  for (std::size_t k = 0; k < all.cells.size(); ++k)
    if (owner[k / 3] == rank)
      mine[all.cells[k]] = 1;
  std::vector<std::int64_t> ghosts;
  for (std::size_t c = 0; c < owner.size(); ++c)
    if (owner[c] == rank)
      out.cells.push_back(static_cast<std::int64_t>(c));
    else if (mine[all.cells[3 * c]] or mine[all.cells[3 * c + 1]]
             or mine[all.cells[3 * c + 2]])
      ghosts.push_back(static_cast<std::int64_t>(c));
  out.owned_cells = out.cells.size();
  std::mt19937 engine(rank);
  std::shuffle(out.cells.begin(), out.cells.end(), engine);
  std::shuffle(ghosts.begin(), ghosts.end(), engine);
  out.cells.insert(out.cells.end(), ghosts.begin(), ghosts.end());

  std::set<std::int64_t> near;
  for (std::int64_t c : out.cells)
    near.insert(all.cells.begin() + 3 * c, all.cells.begin() + 3 * c + 3);
  for (std::int64_t i : near)
    if (node_owner[i] == rank)
      out.nodes.push_back(i);
  out.owned_nodes = out.nodes.size();
  std::shuffle(out.nodes.begin(), out.nodes.end(), engine);
  for (std::int64_t i : near)
    if (node_owner[i] != rank)
      out.nodes.push_back(i);

  std::map<std::int64_t, std::int32_t> local;
  for (std::int64_t i : out.nodes)
    local.emplace(i, static_cast<std::int32_t>(local.size()));
  for (std::int64_t c : out.cells)
    for (int k = 0; k < 3; ++k)
      out.data.cells.push_back(local.at(all.cells[3 * c + k]));
  out.data.x = Part::take(all.x, out.nodes, 2);
  for (std::size_t k = 0; k < all.markers.size(); ++k)
    if (local.count(all.marked[2 * k]) and local.count(all.marked[2 * k + 1]))
    {
      out.data.marked.push_back(local.at(all.marked[2 * k]));
      out.data.marked.push_back(local.at(all.marked[2 * k + 1]));
      out.data.markers.push_back(all.markers[k]);
    }
  return out;
}

/// All ranks, and what they see of each other.
class World
{
public:
  World(const meshes::Data& all, std::vector<int> owner, int size)
      : _barrier(size), _shared(size)
  {
    for (int r = 0; r < size; ++r)
      parts.push_back(cut(all, owner, r));
    for (const Part& p : parts)
    {
      const int r = static_cast<int>(&p - parts.data());
      for (std::size_t i = 0; i < p.owned_cells; ++i)
        _cell_at[p.cells[i]] = {r, i};
      for (std::size_t i = 0; i < p.owned_nodes; ++i)
        _node_at[p.nodes[i]] = {r, i};
    }
  }

  std::vector<Part> parts;

  /// Run one function on every rank at once.
  void run(const std::function<void(int, const Part&, const remap::Host&)>& f)
  {
    std::vector<std::thread> threads;
    for (int r = 0; r < static_cast<int>(parts.size()); ++r)
      threads.emplace_back([this, r, &f] { f(r, parts[r], host(r)); });
    for (std::thread& t : threads)
      t.join();
  }

private:
  using Place = std::pair<int, std::size_t>;

  void halo(int rank, std::span<double> values, int block,
            const std::vector<std::int64_t>& ids, std::size_t owned,
            const std::map<std::int64_t, Place>& at)
  {
    _shared[rank] = values;
    _barrier.arrive_and_wait();
    for (std::size_t i = owned; i < ids.size(); ++i)
    {
      const auto [r, j] = at.at(ids[i]);
      for (int k = 0; k < block; ++k)
        values[block * i + k] = _shared[r][block * j + k];
    }
    _barrier.arrive_and_wait();
  }

  template <class Op>
  void reduce(int rank, std::span<double> values, Op op)
  {
    _shared[rank] = values;
    _barrier.arrive_and_wait();
    std::vector<double> out(_shared[0].begin(), _shared[0].end());
    for (std::size_t r = 1; r < _shared.size(); ++r)
      for (std::size_t k = 0; k < out.size(); ++k)
        out[k] = op(out[k], _shared[r][k]);
    _barrier.arrive_and_wait();
    std::copy(out.begin(), out.end(), values.begin());
    _barrier.arrive_and_wait();
  }

  remap::Host host(int r)
  {
    remap::Host out;
    out.cell_halo = [this, r](std::span<double> v, int block)
    { halo(r, v, block, parts[r].cells, parts[r].owned_cells, _cell_at); };
    out.node_halo = [this, r](std::span<double> v, int block)
    { halo(r, v, block, parts[r].nodes, parts[r].owned_nodes, _node_at); };
    out.global_max = [this, r](std::span<double> v)
    { reduce(r, v, [](double a, double b) { return std::max(a, b); }); };
    out.global_sum = [this, r](std::span<double> v)
    { reduce(r, v, [](double a, double b) { return a + b; }); };
    return out;
  }

  std::barrier<> _barrier;
  std::vector<std::span<double>> _shared;
  std::map<std::int64_t, Place> _cell_at, _node_at;
};
} // namespace ranks
