// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "output/archive.h"
#include "remap/smoothing/boundary_curve.h"
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
  /// @param[in] mesh     kept by reference: must outlive this
  Placement(const mesh::Domain& domain, const ::remap::Mesh& mesh,
            const std::vector<std::string>& surfaces);

  /// For patches: nodes slide along straight sides and curved boundaries, stay
  /// on a free surface, and stay with the material at corners and where two
  /// boundaries meet; shape (nodes).
  std::span<const ::remap::Kind> kinds() const { return _kinds; }

  /// For the whole mesh: nodes of straight sides are where `start` has put
  /// them.
  std::span<const ::remap::Kind> kinds_placed() const { return _placed; }

  /// 1 for nodes of free surfaces, shape (nodes).
  std::span<const std::uint8_t> on_surface() const { return _on_surface; }

  /// Sliding follows the boundary as it is now; sides that have bent are curved
  /// boundaries, and where one turns by more than 45° at a node this stays with
  /// the material, as does a corner of a free surface until it is blunter than
  /// that or one of its sides has been used up. To be called before `kinds` are
  /// used. Collective.
  /// @param[in] x nodes, shape (nodes, 2) [m]
  void turn(std::span<const double> x);

  /// What nodes of kind `curve` are held to.
  const ::remap::Guide& curve() const { return _curve; }

  /// Along the boundary, for sliding nodes; shape (nodes, 2).
  std::span<const double> direction() const { return _direction; }

  /// Start for the whole mesh, so that it follows the boundary and does not
  /// drift with the flow. Nodes of straight boundaries take the first mesh's
  /// spacing between the ends as they are now, other boundary nodes stay as
  /// given. Inner nodes start from their places after the last remap and
  /// follow the boundary's motion, the closer the stiffer: the motion is
  /// averaged over edges with weights 1 / length², some sweeps a call, from
  /// the last call's. Collective.
  ///
  /// @param[in] moved boundary nodes as they are now, shape (nodes, 2) [m]
  /// @param[in] home  nodes after the last remap, shape (nodes, 2) [m]
  std::vector<double> start(std::span<const double> moved,
                            std::span<const double> home);

  /// The last motion.
  void keep(output::Archive& archive)
  {
    archive("remap/motion", Entity::node, _motion);
  }

private:
  /// A straight stretch of a boundary, with nodes between its ends.
  struct Side
  {
    std::vector<int> nodes;   ///< local, without the two ends
    std::vector<double> part; ///< of the way between the ends, at first
    int ends[2] = {-1, -1};   ///< where this rank owns them
  };
  /// Sweeps of the averaging a call. Doubled: nothing but time once the
  /// boundary moves evenly.
  static constexpr int sweeps = 20;
  void add_corners(std::span<const int> side_of);
  void turn_corners(std::span<const double> x);
  void add_sides(std::span<const int> side_of);
  bool used_up(int node, std::span<const double> x) const;
  ::remap::Kind on_curve(int node, std::span<const double> x) const;
  void place_sides(std::vector<double>& x) const;
  void follow_boundary();
  std::vector<std::array<double, 4>> ends(std::span<const double> x) const;
  std::vector<double> bends(std::span<const double> x,
                            std::span<const std::array<double, 4>> ends) const;

  const mesh::Domain& _domain;
  std::vector<::remap::Kind> _kinds, _placed;
  std::vector<int> _curved;              ///< nodes of curved boundaries
  std::vector<int> _corners;             ///< of free surfaces when first laid
  std::vector<std::uint8_t> _is_surface; ///< of each boundary
  std::vector<std::uint8_t> _on_surface; ///< of each node
  std::vector<double> _direction;
  std::vector<Side> _sides;
  const ::remap::Mesh& _mesh;
  ::remap::BoundaryCurve _curve;
  std::vector<double> _weight; ///< of the mesh's node-to-node entries
  std::vector<double> _motion; ///< of all nodes in the last call, (nodes, 2)
};
} // namespace mmale::bridge
