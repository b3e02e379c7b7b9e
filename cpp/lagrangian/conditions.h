// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "scene/scene.h"
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mmale::lagrangian
{
/// A load on the facets of a boundary at one time.
struct Load
{
  int boundary;
  double traction[2]; ///< on the body [Pa]
  double pressure;    ///< inward [Pa]
  bool absorbing;     ///< with dashpots
};

/// A rigid wall that the nodes of a boundary may touch.
struct Wall
{
  int boundary;
  int normal;                 ///< 0: upright, at an x; 1: level, at a y
  double at;                  ///< [m]
  double sign;                ///< +1: the body lies to the right of it, above
  bool rough;                 ///< what has touched it moves with it
  scene::TimeSeries velocity; ///< of a rough one, along it [m/s]
};

/// What a stage prescribes, unknown by unknown (ux, uy, p a node).
class Conditions
{
public:
  Conditions(const mesh::Domain& domain, const scene::Stage& stage);

  /// Boundary that holds an unknown, or -1 where it is free; shape (nodes, 3).
  std::span<const int> holder() const { return _holder; }

  /// Displacement increments of held unknowns, 0 elsewhere.
  ///
  /// @param[in]  t0,t1 step, counted from the start of the stage [s]
  /// @param[out] g     shape (nodes, 3)
  void increments(double t0, double t1, std::span<double> g) const;

  /// Nodes of absorbing boundaries, ghosts too; empty without one.
  std::span<const int> absorbing_nodes() const { return _absorbing_nodes; }

  /// Loads at time t, boundaries without load left out.
  std::vector<Load> loads(double t) const;

  std::span<const Wall> walls() const { return _walls; }

  /// Gravity at time t [m/s2].
  std::array<double, 2> gravity(double t) const;

private:
  struct Held
  {
    int unknown;
    int series; ///< index into _series, -1: stays in place
  };
  struct Series
  {
    scene::TimeSeries value;
    bool rate; ///< a velocity
  };
  struct Loaded
  {
    int boundary;
    std::optional<scene::TimeSeries> x, y, pressure;
    bool absorbing;
  };
  void hold(std::span<const int> nodes, int direction, int boundary,
            int series);

  std::vector<int> _holder;
  std::vector<Held> _held;
  std::vector<Series> _series;
  std::vector<Loaded> _loaded;
  std::vector<int> _absorbing_nodes;
  std::vector<Wall> _walls;
  std::optional<std::array<scene::TimeSeries, 2>> _gravity;
};
} // namespace mmale::lagrangian
