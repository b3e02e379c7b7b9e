// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "remap/smoothing/smooth.h"
#include <span>
#include <string>
#include <vector>

namespace mmale::bridge
{
/// What nodes may do in a remap (METHOD.md, step 2), and where smoothing of
/// the whole mesh starts.
class Placement
{
public:
  /// Collective.
  /// @param[in] surfaces boundaries that are free surfaces
  Placement(const mesh::Domain& domain,
            const std::vector<std::string>& surfaces);

  /// For patches: nodes slide along their boundary, stay on a free surface,
  /// and stay with the material where two boundaries meet; shape (nodes).
  std::span<const ::remap::Kind> kinds() const { return _kinds; }

  /// For the whole mesh: boundary nodes are where `start` has put them.
  std::span<const ::remap::Kind> kinds_placed() const { return _placed; }

  /// Along the boundary, for sliding nodes; shape (nodes, 2).
  std::span<const double> direction() const { return _direction; }

  /// Start for the whole mesh, so that it follows the boundary and does not
  /// drift with the flow: inner nodes where they were after the last remap; on
  /// straight boundaries, the first mesh's spacing between the ends as they
  /// are now; all others with the material. Collective.
  ///
  /// @param[in] moved nodes after the Lagrangian step, shape (nodes, 2) [m]
  /// @param[in] home  nodes after the last remap, shape (nodes, 2) [m]
  std::vector<double> start(std::span<const double> moved,
                            std::span<const double> home) const;

private:
  /// A boundary that is straight at first.
  struct Side
  {
    std::vector<int> nodes;   ///< local, without the two ends
    std::vector<double> part; ///< of the way between the ends, at first
    int ends[2] = {-1, -1};   ///< where this rank owns them
  };
  void add_side(int boundary);
  std::vector<std::array<double, 4>> ends(std::span<const double> x) const;

  const mesh::Domain& _domain;
  std::vector<::remap::Kind> _kinds, _placed;
  std::vector<double> _direction;
  std::vector<Side> _sides;
};
} // namespace mmale::bridge
