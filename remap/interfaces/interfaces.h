// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: interfaces in all mixed cells, reconstructed from fractions and
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

/// What `moment_of_fluid` met in this rank's own cells at the last call.
struct InterfaceReport
{
  std::int32_t filaments = 0;  ///< seen, and resolved by two cuts
  std::int32_t unresolved = 0; ///< seen, and not resolved: corners, mostly
  /// Largest root of Σ fraction · distance² of centroids [m].
  double residual = 0;
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
  /// Those of all rows, maybe with some behind that mean nothing.
  [[nodiscard]] std::span<const Partition> partitions() const
  {
    return _partitions;
  }

  [[nodiscard]] const InterfaceReport& report() const { return _report; }

private:
  template <Geometry G, class Method>
  void cells(const Method& method, std::span<const double> x,
             const Materials& materials);
  template <Geometry G, class Method>
  void sweep(std::span<const double> x, const Materials& materials);
  void fill_ghosts(const Materials& materials, const Host& host);

  const Mesh* _mesh;
  InterfaceOptions _options;
  InterfaceReport _report;
  std::vector<Partition> _partitions, _last;
  Stencil _stencil;
  std::vector<double> _halo; // cuts of all cells, for methods that look around
};
} // namespace remap
