// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "bridge/materials.h"
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mmale
{
/// Work done since the start [J/m or J/rad].
struct Work
{
  double internal = 0; ///< against stresses and gravity, by damping too
  double external = 0; ///< by loads and by what moves the boundary
  double remap = 0;    ///< kinetic energy that remaps have added
};

/// All that a run carries from step to step. Nodal arrays and cell arrays hold
/// owned entries, then ghosts. What a scene does not use is empty.
///
/// With several materials, s, P, history and density have a row for each slot
/// of `materials`: first the cells, a mixed one with the means of its parts
/// (`mixture.h`), then the parts.
struct State
{
  double time = 0;
  int points = 1;        ///< stress states a cell
  std::vector<double> x; ///< nodes, shape (n, 2) [m]
  std::vector<double> p; ///< nodal total pressure, shape (n) [Pa]
  std::vector<double>
      p_w;               ///< nodal pore pressure, with seepage, shape (n) [Pa]
  std::vector<double> v; ///< velocity; in statics displacement increment /
                         ///< step, shape (n, 2) [m/s]

  std::optional<bridge::Materials> materials; ///< where there are several

  std::vector<double> s; ///< deviator xx yy zz xy, shape (m, points, 4) [Pa]
  std::vector<double> P; ///< pressure of the points, shape (m, points) [Pa]
  std::vector<double> history; ///< the law's numbers, then those of the water,
                               ///< shape (m, points, h)
  std::vector<double> density; ///< of the cells, shape (m) [kg/m3]
  std::vector<double> apex; ///< steps that met the law's zero-stress floor, of
                            ///< laws that have one, shape (m)
  std::map<std::string, std::vector<double>> tracer; ///< shape (m) each

  // of dynamic stages
  std::vector<double> a; ///< acceleration, shape (n, 2) [m/s2]
  std::vector<double>
      force; ///< residual less inertia, shape (n, 2) [N/m or N/rad]
  std::vector<double>
      inner; ///< its part from the cells, shape (n, 2) [N/m or N/rad]
  std::vector<double> p_rate;    ///< dp/dt, with damping, NaN before the first
                                 ///< step, shape (n) [Pa/s]
  std::vector<double> held_back; ///< what an absorbing boundary carries at
                                 ///< rest, shape (n, 2) [N/m or N/rad]
  Work work;
};

/// What an array has a row for.
enum class Entity
{
  node,
  cell,
  slot ///< a cell, and behind all cells a part of one (`State::materials`)
};

/// Names every array of a state once: what is not named here does not live
/// through a checkpoint. Rows follow from the entity, the width from the size;
/// arrays that the scene does not have are empty.
///
/// @tparam S     State or const State
/// @param visit  called as visit(name, entity, array) for each array
template <class S, class Visit>
void for_each_field(S& state, Visit&& visit)
{
  visit("x", Entity::node, state.x);
  visit("p", Entity::node, state.p);
  visit("p_w", Entity::node, state.p_w);
  visit("v", Entity::node, state.v);
  visit("s", Entity::slot, state.s);
  visit("P", Entity::slot, state.P);
  visit("density", Entity::slot, state.density);
  visit("history", Entity::slot, state.history);
  visit("apex", Entity::cell, state.apex);
  visit("a", Entity::node, state.a);
  visit("force", Entity::node, state.force);
  visit("inner", Entity::node, state.inner);
  visit("p_rate", Entity::node, state.p_rate);
  visit("held_back", Entity::node, state.held_back);
  for (auto& [name, values] : state.tracer)
    visit("tracer_" + name, Entity::cell, values);
}
} // namespace mmale
