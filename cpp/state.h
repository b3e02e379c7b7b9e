// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

namespace mmale
{
/// All that a run carries from step to step (stress layout `mean`: one state a
/// cell). Nodal arrays and cell arrays hold owned entries, then ghosts.
struct State
{
  double time = 0;
  std::vector<double> x; ///< nodes, shape (n, 2) [m]
  std::vector<double> p; ///< nodal total pressure, shape (n) [Pa]
  std::vector<double> v; ///< displacement increment / step, (n, 2) [m/s]

  std::vector<double> s;       ///< deviator xx yy zz xy, shape (m, 4) [Pa]
  std::vector<double> P;       ///< pressure of the cell, shape (m) [Pa]
  std::vector<double> density; ///< shape (m) [kg/m3]
  std::vector<double> history; ///< the law's numbers, shape (m, h)
  std::map<std::string, std::vector<double>> tracer; ///< shape (m) each
};

/// What an array has a row for.
enum class Entity
{
  node,
  cell
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
  visit("v", Entity::node, state.v);
  visit("s", Entity::cell, state.s);
  visit("P", Entity::cell, state.P);
  visit("density", Entity::cell, state.density);
  visit("history", Entity::cell, state.history);
  for (auto& [name, values] : state.tracer)
    visit("tracer_" + name, Entity::cell, values);
}
} // namespace mmale
