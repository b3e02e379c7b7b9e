// SPDX-License-Identifier: LGPL-3.0-or-later
#include "conditions.h"

#include <algorithm>
#include <stdexcept>

namespace mmale::lagrangian
{
namespace
{
constexpr int in_place = -1;

double at(const std::optional<scene::TimeSeries>& series, double t)
{
  return series ? (*series)(t) : 0.0;
}

/// On which side of a wall a boundary lies: the mean of its nodes tells.
/// Collective.
Wall make_wall(const mesh::Domain& domain, int boundary,
               const scene::Wall& given)
{
  const int normal = given.x ? 0 : 1;
  const double at = given.x ? *given.x : *given.y;
  double sum = 0;
  for (int n : domain.boundary_nodes(boundary))
    if (n < domain.num_owned_nodes)
      sum += domain.initial_x[2 * n + normal] - at;
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, domain.comm);
  const auto& velocity = given.x ? given.velocity_y : given.velocity_x;
  return {boundary,
          normal,
          at,
          sum >= 0 ? 1.0 : -1.0,
          given.grip == "rough",
          velocity.value_or(scene::TimeSeries{{}, {0.0}})};
}
} // namespace

Conditions::Conditions(const mesh::Domain& domain, const scene::Stage& stage)
    : _holder(3 * domain.num_nodes(), -1), _gravity(stage.gravity)
{
  // Prescribed motion first: where a punch meets a roller, the node is the
  // punch's, and so is its reaction.
  for (const bool prescribed : {true, false})
    for (const auto& [name, c] : stage.boundary)
    {
      const int b = domain.boundary(name);
      const auto nodes = domain.boundary_nodes(b);
      const auto extends = domain.extends(b);
      if (c.roller and extends[0] and extends[1])
        throw std::runtime_error("a roller cannot hold boundary '" + name
                                 + "', which is slanted or curved");
      for (int d = 0; d < 2; ++d)
      {
        const auto& u = d == 0 ? c.displacement_x : c.displacement_y;
        const auto& v = d == 0 ? c.velocity_x : c.velocity_y;
        if (prescribed and (u or v))
        {
          _series.push_back({u ? *u : *v, not u});
          hold(nodes, d, b, static_cast<int>(_series.size()) - 1);
        }
        if (not prescribed and (c.fixed or (c.roller and extends[1 - d])))
          hold(nodes, d, b, in_place);
      }
      if (prescribed
          and (c.traction_x or c.traction_y or c.pressure or c.absorbing))
        _loaded.push_back(
            {b, c.traction_x, c.traction_y, c.pressure, c.absorbing});
      if (prescribed and c.absorbing)
        _absorbing_nodes.insert(_absorbing_nodes.end(), nodes.begin(),
                                nodes.end());
      if (prescribed and c.wall)
        _walls.push_back(make_wall(domain, b, *c.wall));
    }
}

void Conditions::hold(std::span<const int> nodes, int direction, int boundary,
                      int series)
{
  for (int n : nodes)
    if (const int unknown = 3 * n + direction; _holder[unknown] < 0)
    {
      _holder[unknown] = boundary;
      _held.push_back({unknown, series});
    }
}

void Conditions::increments(double t0, double t1, std::span<double> g) const
{
  std::ranges::fill(g, 0.0);
  std::vector<double> value(_series.size());
  for (std::size_t i = 0; i < _series.size(); ++i)
  {
    const auto& [f, rate] = _series[i];
    value[i] =
        rate ? f.integral(t1) - f.integral(t0) : f(t1) - (t0 > 0 ? f(t0) : 0.0);
  }
  for (const auto& [unknown, series] : _held)
    g[unknown] = series == in_place ? 0.0 : value[series];
}

std::vector<Load> Conditions::loads(double t) const
{
  std::vector<Load> out;
  for (const auto& [boundary, x, y, pressure, absorbing] : _loaded)
    out.push_back({boundary, {at(x, t), at(y, t)}, at(pressure, t), absorbing});
  return out;
}

std::array<double, 2> Conditions::gravity(double t) const
{
  if (not _gravity)
    return {0, 0};
  return {(*_gravity)[0](t), (*_gravity)[1](t)};
}
} // namespace mmale::lagrangian
