// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "grid.h"
#include "sides.h"
#include <dolfinx/fem/FunctionSpace.h>
#include <dolfinx/mesh/Mesh.h>
#include <map>
#include <memory>
#include <mpi.h>
#include <span>
#include <string>
#include <vector>

namespace mmale::mesh
{
/// A boundary edge of a local cell.
struct Facet
{
  int cell;     ///< local cell
  int local;    ///< opposite this local vertex
  int a, b;     ///< local nodes, the body on the left going from a to b
  int boundary; ///< index into Domain::boundary_names
  int side;     ///< index into Domain::sides
};

/// Fills the ghosts of arrays over the entities of one index map.
class Halo
{
public:
  explicit Halo(std::shared_ptr<const dolfinx::common::IndexMap> map);
  ~Halo();

  /// From their owners. Collective; the pattern of a width is made once.
  /// @param[in,out] v shape (owned + ghosts, width)
  void update(std::span<double> v, int width);

private:
  struct Impl;
  std::unique_ptr<Impl> _impl;
};

/// The distributed mesh as the solver sees it.
///
/// Owned entities come first, then ghosts; each rank holds every cell that
/// shares a vertex with one of its own, so that all patches around its cells
/// are complete. Nodal arrays follow the index map of a P1 space, cell arrays
/// that of the topology. Coordinates live in the solver's own array; the
/// DOLFINx geometry is written only for output.
struct Domain
{
  MPI_Comm comm;
  std::shared_ptr<dolfinx::mesh::Mesh<double>> mesh;
  std::shared_ptr<const dolfinx::fem::FunctionSpace<double>> space; ///< P1
  std::vector<std::array<int, 3>> cells;   ///< nodes, counter-clockwise
  std::vector<std::int64_t> cell_id;       ///< number in the grid
  std::vector<std::int64_t> node_id;       ///< number in the grid
  std::vector<Facet> facets;               ///< of local cells, ghosts too
  std::vector<std::string> boundary_names; ///< tables, then the grid's names
  std::vector<Side> sides;                 ///< all of the body, on all ranks
  std::vector<double> initial_x;           ///< nodes, shape (n, 2) [m]
  std::shared_ptr<Halo> node_halo, cell_halo;
  int num_owned_cells = 0;
  int num_owned_nodes = 0;

  int num_cells() const { return static_cast<int>(cells.size()); }
  int num_nodes() const { return static_cast<int>(node_id.size()); }
  int boundary(const std::string& name) const;
  /// Nodes of a boundary, ghosts too, each once, ascending.
  std::vector<int> boundary_nodes(int boundary) const;
  /// Is any side of a boundary longer along x (along y) than 1e-9 of its
  /// length? Both: slanted or curved.
  std::array<bool, 2> extends(int boundary) const;
  const dolfinx::common::IndexMap& nodes() const;
  const dolfinx::common::IndexMap& cell_map() const;
  /// Write coordinates, shape (n, 2), into the DOLFINx geometry.
  void put_geometry(std::span<const double> x);
};

/// Distribute a grid and name its boundary. Collective; the grid is read on
/// rank 0 only.
///
/// @param[in] boundary named parts of the grid's own sides
Domain make_domain(MPI_Comm comm, const Grid& grid,
                   const std::map<std::string, scene::Boundary>& boundary);
} // namespace mmale::mesh
