// SPDX-License-Identifier: LGPL-3.0-or-later
#include "domain.h"

#include "compat.h"
#include "partition.h"
#include <algorithm>
#include <dolfinx/common/MPI.h>
#include <dolfinx/la/Vector.h>
#include <set>
#include <stdexcept>

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

/// The grid's boundary edges on all ranks.
std::vector<std::array<std::int64_t, 3>> all_edges(MPI_Comm comm,
                                                   const Grid& grid)
{
  auto edges = grid.edges;
  std::int64_t n = edges.size();
  MPI_Bcast(&n, 1, MPI_INT64_T, 0, comm);
  edges.resize(n);
  MPI_Bcast(edges.data(), static_cast<int>(3 * n), MPI_INT64_T, 0, comm);
  return edges;
}

/// Index of the boundary that holds an edge with this midpoint.
int name_edge(const Domain& d,
              const std::map<std::string, scene::Boundary>& boundary,
              const std::string_view side, std::array<double, 2> midpoint)
{
  const double at =
      side == "bottom" or side == "top" ? midpoint[0] : midpoint[1];
  for (const auto& [name, b] : boundary)
    if (b.side == side and at > b.from and at < b.to)
      return d.boundary(name);
  return d.boundary(std::string(side));
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

  for (const auto& [name, b] : boundary)
  {
    d.boundary_names.push_back(name);
    d.boundary_sides.push_back(b.side);
  }
  for (const auto side : side_names)
  {
    d.boundary_names.emplace_back(side);
    d.boundary_sides.emplace_back(side);
  }
  std::map<std::array<std::int64_t, 2>, int> side_of;
  for (const auto& [a, b, side] : all_edges(comm, grid))
    side_of[{std::min(a, b), std::max(a, b)}] = static_cast<int>(side);
  for (int c = 0; c < d.num_cells(); ++c)
    for (int k = 0; k < 3; ++k)
    {
      const int a = d.cells[c][(k + 1) % 3], b = d.cells[c][(k + 2) % 3];
      const std::int64_t i = d.node_id[a], j = d.node_id[b];
      const auto it = side_of.find({std::min(i, j), std::max(i, j)});
      if (it == side_of.end())
        continue;
      const auto& x = d.initial_x;
      d.facets.push_back({c, k, a, b,
                          name_edge(d, boundary, side_names[it->second],
                                    {(x[2 * a] + x[2 * b]) / 2,
                                     (x[2 * a + 1] + x[2 * b + 1]) / 2})});
    }
  return d;
}
} // namespace mmale::mesh
