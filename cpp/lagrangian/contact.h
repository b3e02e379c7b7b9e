// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "conditions.h"

namespace mmale::lagrangian
{
/// Nodes of free surfaces at rigid walls: an active set (METHOD.md, step 1c).
///
/// A node at a wall is held by prescribing its normal displacement, so that it
/// never passes; the reaction tells when a smooth wall lets go. What touches a
/// rough wall goes with it, both ways, from then on.
class Contact
{
public:
  /// Collective.
  Contact(const mesh::Domain& domain, const Conditions& conditions);

  /// Nodes that stand at a wall when a step begins.
  ///
  /// @param[in] x     nodes, shape (n, 2) [m]
  /// @param[in] t0,t1 step, from the start of the stage [s]
  void begin_step(std::span<const double> x, double t0, double t1);

  /// Hold or free nodes by their distance and their reaction, in the midst of
  /// Newton: a node is held while reaction / stiffness exceeds its distance
  /// from the wall. At a solution this is: no gap and a push, or a gap and no
  /// force. Collective.
  ///
  /// @param[in] x         at the start of the step, shape (n, 2) [m]
  /// @param[in] z         unknowns now, shape (n, 3)
  /// @param[in] force     residual, owned entries, shape (n, 3)
  /// @param[in] stiffness that makes a force a length [Pa]
  /// @return has any rank changed the set?
  /// @source Hüeber & Wohlmuth, Comput. Methods Appl. Mech. Engng 194 (2005)
  bool update(std::span<const double> x, std::span<const double> z,
              std::span<const double> force, double stiffness);

  /// A node of this rank that changed at the last `update`, or -1.
  int unsettled() const { return _unsettled; }

  /// Add what is held now to the unknowns' holders and increments.
  ///
  /// @param[in,out] holder    boundary that holds an unknown, shape (n, 3)
  /// @param[in,out] increment prescribed, shape (n, 3) [m]
  void apply(std::span<const double> x, std::span<int> holder,
             std::span<double> increment) const;

  /// 1 for nodes that are held, shape (n), ghosts too; empty without walls.
  std::vector<std::uint8_t> at_wall() const;

  bool empty() const { return _walls.empty(); }

private:
  struct Candidate
  {
    int node;
    int wall; ///< index into _walls
    bool held = false;
  };
  const mesh::Domain& _domain;
  std::vector<Wall> _walls;
  std::vector<Candidate> _candidates; ///< owned and ghost
  std::vector<double> _way;           ///< of each wall in this step [m]
  double _gap;                        ///< closer than this is touching [m]
  double _reach;                      ///< the same for a rough wall [m]
  int _unsettled = -1;
};
} // namespace mmale::lagrangian
