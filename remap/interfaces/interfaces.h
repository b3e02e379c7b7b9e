// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: interfaces in all mixed cells, reconstructed from fractions and
// centroids.
#pragma once

#include "remap/host.h"
#include "remap/interfaces/library.h"
#include "remap/interfaces/partition.h"
#include "remap/materials/materials.h"
#include "remap/mesh.h"

#include <span>
#include <vector>

namespace remap
{
/// How interfaces are found.
struct InterfaceOptions
{
  Geometry geometry = Geometry::plane;
  Reconstruction method = reconstruction::MomentOfFluid{};
};

/// The interfaces of one mesh.
class Interfaces
{
public:
  /// @param[in] mesh kept by reference: must outlive this
  Interfaces(const Mesh& mesh, InterfaceOptions options);

  /// Reconstruct all mixed cells, ghosts too; collective. Fractions (to
  /// round-off) are those of `materials`. Nothing is allocated unless there are
  /// more mixed cells than ever before.
  ///
  /// @param[in] x         shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in] materials ghosts up to date
  void reconstruct(std::span<const double> x, const Materials& materials,
                   const Host& host);

  /// Partition of a row of `materials`.
  [[nodiscard]] const Partition& partition(std::int32_t row) const
  {
    return _partitions[row];
  }

private:
  template <Geometry G, class Method>
  void cells(std::span<const double> x, const Materials& materials);
  void fill_ghosts(const Materials& materials, const Host& host);

  const Mesh* _mesh;
  InterfaceOptions _options;
  std::vector<Partition> _partitions;
  Stencil _stencil;
  std::vector<double> _halo; // cuts of all cells, for methods that look around
};
} // namespace remap
