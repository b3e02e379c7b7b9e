// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/fields.h"
#include <cstdint>
#include <dolfinx/fem/DofMap.h>
#include <span>
#include <vector>

/// Values at points and along lines of the mesh as it stands.
namespace mmale::output
{
/// Where a point lies: in one cell of one rank.
struct Spot
{
  bool found = false;              ///< in any cell of any rank
  std::int32_t cell = -1;          ///< local cell if this rank has it, else -1
  std::array<double, 3> weights{}; ///< barycentric, by the P1 dofs of the cell
};

/// Finds points in triangles and samples fields there.
class Probe
{
public:
  /// Collective.
  /// @param[in] mesh triangles of degree 1; read anew at each `locate`
  explicit Probe(std::shared_ptr<dolfinx::mesh::Mesh<double>> mesh);

  /// Collective. A point between cells goes to one of them, the same whatever
  /// the number of calls; up to 1e-9 of a cell outside counts as inside.
  ///
  /// @param[in] points same on all ranks [m]
  std::vector<Spot> locate(std::span<const scene::Point> points) const;

  /// Values at spots, on all ranks. Collective.
  ///
  /// @return shape (spots, components); NaN where no cell is
  std::vector<double> sample(std::span<const Spot> spots,
                             const NamedField& field) const;

private:
  std::shared_ptr<dolfinx::mesh::Mesh<double>> _mesh;
  std::shared_ptr<const dolfinx::fem::DofMap> _nodes; // P1, scalar
};

/// Sample fields along the lines of a scene into `lines/<name>_<k>.csv`.
///
/// Columns: s (distance from the start [m]), x, y [m], fields by name, vectors
/// as name_x, name_y, tensors as name_xx ... name_xy. Points outside the body
/// have nan. Collective.
///
/// @param[in] folder of the run
/// @param[in] k      number of the output
/// @throws std::runtime_error on all ranks naming the file and the cause
void write_lines(const Probe& probe, MPI_Comm comm,
                 const std::filesystem::path& folder, int k,
                 const std::map<std::string, scene::Line>& lines,
                 std::span<const NamedField> fields);
} // namespace mmale::output
