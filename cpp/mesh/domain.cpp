// SPDX-License-Identifier: LGPL-3.0-or-later
#include "domain.h"

#include "compat.h"
#include "partition.h"
#include <algorithm>
#include <dolfinx/common/MPI.h>
#include <dolfinx/la/Vector.h>
#include <iterator>
#include <stdexcept>
#include <type_traits>

namespace mmale::mesh
{
namespace
{
namespace dx = dolfinx;

std::shared_ptr<dx::mesh::Mesh<double>> distribute(MPI_Comm comm,
                                                   const Grid& grid)
{
  const bool root = dx::MPI::rank(comm) == 0;
  const std::vector<std::int64_t> cells =
      root ? grid.cells : std::vector<std::int64_t>();
  const std::vector<double> x = root ? grid.x : std::vector<double>();
  const dx::mesh::CellPartitionFunction partitioner =
      dx::MPI::size(comm) > 1 ? vertex_halo_partitioner() : nullptr;
  return std::make_shared<dx::mesh::Mesh<double>>(
      compat::create_mesh(comm, cells, x, partitioner));
}

/// Copy the mesh's numbering into plain arrays, cells counter-clockwise.
void fill_arrays(Domain& d)
{
  const auto& geometry = d.mesh->geometry();
  const auto dofs = d.space->dofmap()->map();
  const auto points = geometry.dofmap();
  const auto& original = d.mesh->topology()->original_cell_index[0];
  const int num_cells = static_cast<int>(points.extent(0));
  const int num_nodes = d.nodes().size_local() + d.nodes().num_ghosts();
  d.num_owned_cells = d.cell_map().size_local();
  d.num_owned_nodes = d.nodes().size_local();
  d.node_id.assign(num_nodes, -1);
  d.initial_x.assign(2 * num_nodes, 0);
  d.cells.resize(num_cells);
  d.cell_id.assign(original.begin(), original.begin() + num_cells);
  for (int c = 0; c < num_cells; ++c)
  {
    for (int v = 0; v < 3; ++v)
    {
      const int n = dofs(c, v);
      d.cells[c][v] = n;
      d.node_id[n] = geometry.input_global_indices()[points(c, v)];
      for (int k = 0; k < 2; ++k)
        d.initial_x[2 * n + k] = geometry.x()[3 * points(c, v) + k];
    }
    auto& [i, j, k] = d.cells[c];
    const auto* x = d.initial_x.data();
    if ((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
        < (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1]))
      std::swap(j, k);
  }
}

/// A boundary edge, as all ranks know it.
struct Edge
{
  std::int64_t a, b; ///< numbers in the grid
  int boundary, side;
};

/// Plain data of rank 0 on all ranks.
template <class T>
void broadcast(MPI_Comm comm, std::vector<T>& v)
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::int64_t n = v.size();
  MPI_Bcast(&n, 1, MPI_INT64_T, 0, comm);
  v.resize(n);
  MPI_Bcast(v.data(), static_cast<int>(n * sizeof(T)), MPI_BYTE, 0, comm);
}

/// Index of the boundary that an edge of the grid belongs to.
int name_edge(const Domain& d,
              const std::map<std::string, scene::Boundary>& boundary,
              const Grid& grid, const std::array<std::int64_t, 3>& edge)
{
  const auto& name = grid.names[edge[2]];
  const int k = name == "bottom" or name == "top" ? 0 : 1;
  const double at = (grid.x[2 * edge[0] + k] + grid.x[2 * edge[1] + k]) / 2;
  for (const auto& [part, b] : boundary)
    if (b.side == name and at > b.from and at < b.to)
      return d.boundary(part);
  return d.boundary(name);
}

/// Names, sides and boundary edges: rank 0 finds them, all get them.
std::vector<Edge>
name_boundary(Domain& d, const Grid& grid,
              const std::map<std::string, scene::Boundary>& boundary)
{
  std::vector<Edge> edges;
  std::vector<char> words; // the names, each with a 0 behind it
  if (dx::MPI::rank(d.comm) == 0)
  {
    for (const auto& [name, b] : boundary)
      d.boundary_names.push_back(name);
    std::ranges::copy(grid.names, std::back_inserter(d.boundary_names));
    std::vector<std::array<std::int64_t, 3>> named = grid.edges;
    for (auto& edge : named)
      edge[2] = name_edge(d, boundary, grid, edge);
    const auto side = find_sides(grid.x, named, d.sides);
    for (std::size_t i = 0; i < named.size(); ++i)
      edges.push_back(
          {named[i][0], named[i][1], static_cast<int>(named[i][2]), side[i]});
    for (const auto& name : d.boundary_names)
      words.insert(words.end(), name.c_str(), name.c_str() + name.size() + 1);
  }
  broadcast(d.comm, words);
  broadcast(d.comm, d.sides);
  broadcast(d.comm, edges);
  d.boundary_names.clear();
  for (auto it = words.begin(); it != words.end();)
  {
    const auto end = std::find(it, words.end(), 0);
    d.boundary_names.emplace_back(it, end);
    it = end + 1;
  }
  return edges;
}
} // namespace

int Domain::boundary(const std::string& name) const
{
  const auto it = std::ranges::find(boundary_names, name);
  if (it == boundary_names.end())
    throw std::runtime_error("mesh: no boundary is called '" + name + "'");
  return static_cast<int>(it - boundary_names.begin());
}

std::vector<int> Domain::boundary_nodes(int boundary) const
{
  // A rank may hold a node of the boundary without holding the facet; the
  // owner tells it.
  std::vector<double> mark(num_nodes(), 0);
  for (const Facet& f : facets)
    if (f.boundary == boundary)
      mark[f.a] = mark[f.b] = 1;
  node_halo->update(mark, 1);
  std::vector<int> out;
  for (int n = 0; n < num_nodes(); ++n)
    if (mark[n] > 0)
      out.push_back(n);
  return out;
}

std::array<bool, 2> Domain::extends(int boundary) const
{
  std::array<bool, 2> out = {false, false};
  for (const Side& side : sides)
    for (int k = 0; side.boundary == boundary and k < 2; ++k)
      out[k] = out[k] or side.extends(k);
  return out;
}

const dolfinx::common::IndexMap& Domain::nodes() const
{
  return *space->dofmap()->index_map;
}

const dolfinx::common::IndexMap& Domain::cell_map() const
{
  return *mesh->topology()->index_map(2);
}

void Domain::put_geometry(std::span<const double> x)
{
  auto& geometry = mesh->geometry();
  const auto dofs = space->dofmap()->map();
  const auto points = geometry.dofmap();
  for (int c = 0; c < num_cells(); ++c)
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 2; ++k)
        geometry.x()[3 * points(c, v) + k] = x[2 * dofs(c, v) + k];
}

struct Halo::Impl
{
  std::shared_ptr<const dolfinx::common::IndexMap> map;
  std::map<int, dolfinx::la::Vector<double>> by_width;
};

Halo::Halo(std::shared_ptr<const dolfinx::common::IndexMap> map)
    : _impl(std::make_unique<Impl>(std::move(map)))
{
}

Halo::~Halo() = default;

void Halo::update(std::span<double> v, int width)
{
  auto& [map, by_width] = *_impl;
  if (dolfinx::MPI::size(map->comm()) == 1)
    return;
  auto& w = by_width.try_emplace(width, map, width).first->second;
  std::ranges::copy(v, w.mutable_array().begin());
  w.scatter_fwd();
  std::ranges::copy(w.array(), v.begin());
}

Domain make_domain(MPI_Comm comm, const Grid& grid,
                   const std::map<std::string, scene::Boundary>& boundary)
{
  Domain d;
  d.comm = comm;
  d.mesh = distribute(comm, grid);
  d.space = std::make_shared<const dolfinx::fem::FunctionSpace<double>>(
      compat::lagrange_space(d.mesh, 1));
  d.node_halo = std::make_shared<Halo>(d.space->dofmap()->index_map);
  d.cell_halo = std::make_shared<Halo>(d.mesh->topology()->index_map(2));
  fill_arrays(d);

  const std::vector<Edge> edges = name_boundary(d, grid, boundary);
  std::map<std::array<std::int64_t, 2>, const Edge*> edge_of;
  for (const Edge& e : edges)
    edge_of[{std::min(e.a, e.b), std::max(e.a, e.b)}] = &e;
  for (int c = 0; c < d.num_cells(); ++c)
    for (int k = 0; k < 3; ++k)
    {
      const int a = d.cells[c][(k + 1) % 3], b = d.cells[c][(k + 2) % 3];
      const std::int64_t i = d.node_id[a], j = d.node_id[b];
      const auto it = edge_of.find({std::min(i, j), std::max(i, j)});
      if (it != edge_of.end())
        d.facets.push_back(
            {c, k, a, b, it->second->boundary, it->second->side});
    }
  return d;
}
} // namespace mmale::mesh
