// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mmale::bridge
{
/// Feet of free surfaces (METHOD.md, step 2): where a surface has come to lie
/// on a wall in line with the straight side that it begins at, as a slope that
/// runs out on its base. The side's end goes on to where the surface leaves
/// the wall; the nodes on the way go up the surface. The outline stays as it
/// is, so neither area nor volume changes.
class Foot
{
public:
  /// Collective.
  /// @param[in] surfaces boundaries that are free surfaces
  Foot(const mesh::Domain& domain, const std::vector<std::string>& surfaces);

  /// Collective.
  ///
  /// @param[in]     at_wall 1 for nodes that a wall holds, shape (nodes)
  /// @param[in,out] x       nodes, ghosts up to date, shape (nodes, 2) [m]
  /// @return nodes that came off their wall, of all feet
  int move(std::span<const std::uint8_t> at_wall, std::span<double> x) const;

private:
  /// Nodes from one end of a straight side along the surface; local numbers
  /// where this rank owns them, else -1.
  struct Way
  {
    int from; ///< other end of the side
    std::vector<int> nodes;
  };
  const mesh::Domain& _domain;
  std::vector<Way> _ways; ///< the same on all ranks
};
} // namespace mmale::bridge
