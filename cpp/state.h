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
} // namespace mmale
