// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "scene/scene.h"
#include <dolfinx/la/Vector.h>
#include <span>
#include <vector>

/// Pore pressure as an unknown of the nodes (METHOD.md, Water).
///
/// Says where it is held, keeps trial values and residual apart from the
/// mechanical ones, and knows what flows out. A scene without seepage has none
/// of this.
namespace mmale::lagrangian
{
class PorePressure
{
public:
  PorePressure(const mesh::Domain& domain, scene::Symmetry symmetry,
               const scene::Water& water);

  const scene::Water& water() const { return _water; }

  /// What holds on the boundaries of a stage.
  void set_stage(const scene::Stage& stage);

  /// Held nodes when a Newton run begins: on a seepage face those without
  /// suction.
  /// @param[in] p_w at the start of the step, shape (nodes) [Pa]
  /// @param[in] t1  its end, from the start of the stage [s]
  /// @param[in] dt  its length [s]
  /// @param[in] length of a cell [m]
  void begin(std::span<const double> p_w, double t1, double dt, double length);

  /// Hold or free nodes of seepage faces by the water that flows out and by
  /// their pressure, at a solution of Newton's. Collective.
  /// @return has any rank changed the set?
  bool update();

  /// A node of this rank that changed at the last `update`, or -1.
  int unsettled() const { return _unsettled; }
  bool has_face() const { return _has_face; }

  /// Boundary that holds a node, or -1; owned and ghosts.
  std::span<const int> holder() const { return _holder; }
  /// Pressure that a held node has [Pa].
  double prescribed(int node) const { return _prescribed[node]; }

  /// Trial values, owned and ghosts [Pa].
  std::span<double> trial() { return _p_w.mutable_array(); }
  std::span<const double> trial() const { return _p_w.array(); }
  void send_trial() { _p_w.scatter_fwd(); }

  /// Residual: volume that a node's surroundings lack [m3/m or m3/rad].
  std::span<double> residual() { return _residual.mutable_array(); }
  std::span<const double> residual() const { return _residual.array(); }
  void gather_residual() { _residual.scatter_rev(std::plus<double>()); }

  /// Water that left through each named boundary in the last step, over its
  /// length: [m3/s/m], or of the whole circumference [m3/s]. Collective.
  std::vector<double> discharge() const;

private:
  struct Held
  {
    int node, boundary;
    int series; ///< index into _series; of a face -1
  };
  const mesh::Domain& _domain;
  scene::Symmetry _symmetry;
  const scene::Water& _water;
  std::vector<scene::TimeSeries> _series;
  std::vector<Held> _held; ///< a node once, prescribed pressures first
  bool _has_face = false;
  std::vector<int> _holder;
  std::vector<double> _prescribed;
  double _dt = 0;
  double _little_pressure = 0, _little_flow = 0; ///< not worth a change
  double _exchange = 0; ///< that makes a pressure a volume [m2/Pa]
  int _unsettled = -1;
  dolfinx::la::Vector<double> _p_w, _residual;
};
} // namespace mmale::lagrangian
