// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: a body's curved boundary as a guide: the cubics through its nodes
// as they were when `follow` was called. In: positions; out: where a node that
// slides belongs. Facets of length h of a smooth boundary: off by O(h⁴) where
// they are even, by O(h³) where their lengths jump.
#pragma once

#include "remap/host.h"
#include "remap/mesh.h"
#include "remap/smoothing/guide.h"
#include "remap/smoothing/kind.h"

namespace remap
{
/// Each node of kind `curve` moves on the two cubics that end where it was; it
/// does not pass its neighbours' old places. Corners are nodes of other kinds:
/// the curve ends there.
class BoundaryCurve : public Guide
{
public:
  /// @param[in] mesh kept by reference: must outlive this
  explicit BoundaryCurve(const Mesh& mesh);

  /// Take the boundary as it is now. Collective; allocates nothing.
  ///
  /// @param[in] x     shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in] kinds shape (num_nodes), ghosts up to date
  void follow(std::span<const double> x, std::span<const Kind> kinds,
              const Host& host);

  [[nodiscard]] Foot foot(std::int32_t node, Point p) const override;

private:
  const Mesh* _mesh;
  std::vector<double> _x;       // nodes as they were
  std::vector<double> _tangent; // length 1; 0 where a curve ends
};
} // namespace remap
