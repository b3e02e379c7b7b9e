// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "output/polygons.h"
#include "remap/domain/domain.h"
#include "scene/outline.h"
#include <cstdint>
#include <mpi.h>
#include <string>
#include <vector>

namespace mmale::bridge
{
/// A domain from its file, placed as the scene says.
struct LoadedDomain
{
  ::remap::Domain domain;
  std::vector<scene::Complaint> complaints; ///< empty: it may be used
};

/// @param[in] key of its table in the scene, for complaints
LoadedDomain load_domain(const std::string& key, const scene::Domain& given);

/// Rings that rank 0 knows, on all ranks; the same on all to the last bit.
/// Collective.
/// @param[in,out] text of `to_text`, on all ranks from rank 0's
::remap::Domain share_domain(MPI_Comm comm, std::string& text);

/// For the scene's checks.
scene::DomainOutline outline_of(const std::string& name,
                                const scene::Domain& given);

/// A domain over the cells (METHOD.md, step 0). Volumes in axisymmetry are
/// those of the whole circumference [m3], in the plane per thickness [m2].
struct LaidDomain
{
  std::string outline; ///< its rings as text, as a scene can read them
  double volume = 0;   ///< of the domain
  double in_cells = 0; ///< sum of the partial volumes
  scene::Point centroid = {0, 0};   ///< of the sum [m]
  std::int64_t mixed = 0, full = 0; ///< cells in part and wholly inside
  std::vector<double> share;        ///< of each local cell, ghosts too
  std::vector<double> centroids;    ///< of the part, or else the cell, shape
                                    ///< (cells, 2) [m]
  /// The parts as convex polygons with data `cell` (its number in the mesh)
  /// and `share`; on the first rank all of them, in order of cells.
  output::Polygons pieces;
};

/// Collective; the file is read on the first rank only.
/// @throws std::runtime_error on all ranks if it has complaints
LaidDomain lay(const mesh::Domain& mesh, const std::string& name,
               const scene::Domain& given, bool axisymmetric);
} // namespace mmale::bridge
