// SPDX-License-Identifier: LGPL-3.0-or-later
#include "contact.h"

#include <algorithm>
#include <cmath>

namespace mmale::lagrangian
{
Contact::Contact(const mesh::Domain& domain, const Conditions& conditions)
    : _domain(domain),
      _walls(conditions.walls().begin(), conditions.walls().end())
{
  double box[4] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < domain.initial_x.size(); ++i)
  {
    box[i % 2] = std::max(box[i % 2], domain.initial_x[i]);
    box[2 + i % 2] = std::max(box[2 + i % 2], -domain.initial_x[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, box, 4, MPI_DOUBLE, MPI_MAX, domain.comm);
  const double size = std::max(box[0] + box[2], box[1] + box[3]);
  _gap = 1e-9 * size;
  // The remap moves surface nodes along chords; a curved surface so leaves a
  // rough wall by this much, and is still held.
  _reach = 1e-3 * size;
  for (std::size_t w = 0; w < _walls.size(); ++w)
    for (int n : domain.boundary_nodes(_walls[w].boundary))
      if (conditions.holder()[3 * n + _walls[w].normal] < 0)
        // else a punch's corner, which is the punch's
        _candidates.push_back({n, static_cast<int>(w)});
  _way.resize(_walls.size());
}

void Contact::begin_step(std::span<const double> x, double t0, double t1)
{
  for (std::size_t w = 0; w < _walls.size(); ++w)
    _way[w] = _walls[w].velocity.integral(t1) - _walls[w].velocity.integral(t0);
  for (Candidate& c : _candidates)
  {
    const Wall& wall = _walls[c.wall];
    c.held = wall.sign * (x[2 * c.node + wall.normal] - wall.at)
             <= (wall.rough ? _reach : _gap);
  }
}

bool Contact::update(std::span<const double> x, std::span<const double> z,
                     std::span<const double> force, double stiffness)
{
  // Owners decide; ghosts follow.
  std::vector<double> held(_domain.num_nodes(), 0);
  int changed = 0;
  _unsettled = -1;
  for (const Candidate& c : _candidates)
  {
    if (c.node >= _domain.num_owned_nodes)
      continue;
    const Wall& wall = _walls[c.wall];
    const int i = 3 * c.node + wall.normal;
    const double gap =
        wall.sign * (x[2 * c.node + wall.normal] + z[i] - wall.at);
    const double push = wall.sign * force[i] / stiffness;
    const bool hold =
        wall.rough ? c.held or gap < -_gap : push - gap > -1e-3 * _gap;
    if (hold != c.held)
    {
      changed = 1;
      _unsettled = c.node;
    }
    held[c.node] = hold;
  }
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, _domain.comm);
  if (changed == 0)
    return false;
  _domain.node_halo->update(held, 1);
  for (Candidate& c : _candidates)
    c.held = held[c.node] > 0;
  return true;
}

std::vector<std::uint8_t> Contact::at_wall() const
{
  std::vector<std::uint8_t> out(empty() ? 0 : _domain.num_nodes(), 0);
  for (const Candidate& c : _candidates)
    if (c.held)
      out[c.node] = 1;
  return out;
}

void Contact::apply(std::span<const double> x, std::span<int> holder,
                    std::span<double> increment) const
{
  for (const Candidate& c : _candidates)
  {
    if (not c.held)
      continue;
    const Wall& wall = _walls[c.wall];
    const int normal = 3 * c.node + wall.normal,
              along = 3 * c.node + 1 - wall.normal;
    holder[normal] = wall.boundary;
    increment[normal] = wall.at - x[2 * c.node + wall.normal];
    if (wall.rough)
    {
      holder[along] = wall.boundary;
      increment[along] = _way[c.wall];
    }
  }
}
} // namespace mmale::lagrangian
