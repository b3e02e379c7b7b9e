// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "body.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

/// How much nodal values alternate from node to node.
namespace mmale::test
{
/// Roughness of nodal values v: RMS of (I - S)^2 v over the nodes whose
/// neighbours are inner ones; S is the mean over the neighbours. A pattern of
/// alternating signs keeps (1.5)^2 to 4 times its size, a smooth field on n
/// cells 1 / n^4.
inline double roughness(Body& body, const std::vector<double>& v)
{
  std::vector<std::map<int, int>> around(body.num_nodes());
  for (int c = 0; c < body.num_cells(); ++c)
    for (int a : body.cell(c))
      for (int b : body.cell(c))
        if (a != b)
          ++around[a][b];
  const auto inner = [&](int n)
  {
    return std::ranges::all_of(around[n],
                               [](const auto& p) { return p.second == 2; });
  };
  const auto rough = [&](const std::vector<double>& from)
  {
    std::vector<double> to(from.size());
    for (int n = 0; n < body.num_nodes(); ++n)
    {
      to[n] = from[n];
      for (const auto& [m, cells] : around[n])
        to[n] -= from[m] / static_cast<double>(around[n].size());
    }
    return to;
  };
  const auto twice = rough(rough(v));
  double sum = 0, count = 0;
  for (int n = 0; n < body.num_nodes(); ++n)
    if (inner(n)
        and std::ranges::all_of(around[n],
                                [&](const auto& p) { return inner(p.first); }))
    {
      sum += twice[n] * twice[n];
      ++count;
    }
  return std::sqrt(sum / count);
}

inline double root_mean_square(const std::vector<double>& v)
{
  double sum = 0;
  for (double x : v)
    sum += x * x;
  return std::sqrt(sum / static_cast<double>(v.size()));
}
} // namespace mmale::test
