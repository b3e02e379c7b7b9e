// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/zigzag.h"

#include "remap/smoothing/cell_quality.h"
#include "remap/smoothing/surface.h"

#include <algorithm>
#include <cmath>

using namespace remap;

namespace
{
/// Numbers a cell posts: which of its facets has moved (0: none) and where to.
constexpr int width = 5;

/// A number of a facet that no other has, the same on all ranks, in an order
/// that looks like none.
double priority(const Mesh& mesh, std::int32_t cell, std::int32_t local)
{
  const auto id = 3 * static_cast<std::uint64_t>(mesh.cell_ids()[cell])
                  + static_cast<std::uint64_t>(local) + 1;
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15u;
  return static_cast<double>((id * odd) & ((std::uint64_t(1) << 52) - 1));
}

/// How much the way a → b → c turns to the left [sine].
double turn_of(Point a, Point b, Point c)
{
  const Point u = b - a, v = c - b;
  return cross(u, v) / std::sqrt(dot(u, u) * dot(v, v));
}
} // namespace

Zigzag::Zigzag(const Mesh& mesh, const Host& host)
    : _mesh(&mesh), _moves(std::size_t(width) * mesh.num_cells(), 0.0)
{
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    if (std::ranges::any_of(mesh.cell_facets(c), [&](std::int32_t f)
                            { return mesh.facet_cells(f)[1] < 0; }))
      _cells.push_back(c);
  colour(host);
}

/// No two facets of a colour share a cell's nodes with each other's neighbours:
/// what one reads no other one of its colour writes. In each round a facet gets
/// its colour that is the first within reach.
void Zigzag::colour(const Host& host)
{
  std::vector<Pair> waiting;
  for (std::int32_t c : _cells)
    for (std::int32_t k = 0; c < _mesh->owned_cells() and k < 3; ++k)
    {
      const std::int32_t f = _mesh->cell_facets(c)[k];
      if (not _mesh->on_boundary(f))
        continue;
      const auto [a, b] = _mesh->facet(f);
      const std::int32_t in = _mesh->boundary_facets(a)[0];
      const std::int32_t out = _mesh->boundary_facets(b)[1];
      if (in >= 0 and out >= 0)
        waiting.push_back(
            {c, k, _mesh->facet(in)[0], a, b, _mesh->facet(out)[1]});
    }
  const auto rank = [this](const Pair& p)
  { return priority(*_mesh, p.cell, p.local); };
  std::vector<double> cell(_mesh->num_cells()), node(_mesh->num_nodes()),
      near(_mesh->num_nodes());
  _start.push_back(0);
  while (host.max(waiting.empty() ? 0.0 : 1.0) > 0)
  {
    std::ranges::fill(cell, 0.0);
    for (const Pair& p : waiting)
      cell[p.cell] = std::max(cell[p.cell], rank(p));
    host.update_cells(cell, 1);
    const auto spread = [&](const Adjacency& around,
                            const std::vector<double>& from,
                            std::vector<double>& to)
    {
      for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
        for (std::int32_t j : around[i])
          to[i] = std::max(to[i], from[j]);
      host.update_nodes(to, 1);
    };
    std::ranges::fill(node, 0.0);
    spread(_mesh->node_cells(), cell, node);
    near = node;
    spread(_mesh->node_nodes(), node, near);
    const auto done = std::partition(
        waiting.begin(), waiting.end(), [&](const Pair& p)
        { return rank(p) < std::max(near[p.first], near[p.second]); });
    _pairs.insert(_pairs.end(), done, waiting.end());
    waiting.erase(done, waiting.end());
    _start.push_back(static_cast<std::int32_t>(_pairs.size()));
  }
}

bool Zigzag::wanted(const Pair& p, std::span<const double> x,
                    std::span<const std::uint8_t> flags,
                    std::span<const Kind> kinds) const
{
  for (std::int32_t i : {p.first, p.second})
    if (kinds[i] != Kind::surface or flags[i] == 0)
      return false;
  const double s =
      turn_of(point(x, p.before), point(x, p.first), point(x, p.second));
  const double t =
      turn_of(point(x, p.first), point(x, p.second), point(x, p.after));
  return s * t < 0 and std::min(std::abs(s), std::abs(t)) > turn;
}

double Zigzag::worst_around(const Pair& p, std::span<const double> x,
                            const Rules& rules) const
{
  double q = 1;
  for (std::int32_t i : {p.first, p.second})
    for (std::int32_t c : _mesh->node_cells()[i])
      q = std::min(q, quality_of(*_mesh, x, rules.measure, rules.targets, c));
  return q;
}

/// Both nodes of a facet to where its smaller turn is gone, or half as far.
bool Zigzag::move(const Pair& p, std::span<double> x, const Rules& rules) const
{
  const Point a = point(x, p.before), b = point(x, p.first),
              c = point(x, p.second), d = point(x, p.after);
  const surface::Step step = surface::straighten(a, b, c, d);
  const double before = worst_around(p, x, rules);
  const double floor = std::min(before, rules.threshold);
  const auto put = [&](Point first, Point second)
  {
    x[2 * p.first] = first.x, x[2 * p.first + 1] = first.y;
    x[2 * p.second] = second.x, x[2 * p.second + 1] = second.y;
  };
  for (double part : {1.0, 0.5, 0.25})
  {
    const auto [first, second] =
        surface::pair_at(rules.geometry, a, b, c, d, part, step);
    put(first, second);
    const double now = worst_around(p, x, rules);
    if (now > 0 and now >= floor)
      return true;
  }
  put(b, c);
  return false;
}

double Zigzag::remove(std::span<double> x, std::span<const std::uint8_t> flags,
                      std::span<const Kind> kinds, const Rules& rules,
                      const Host& host)
{
  const bool any = std::ranges::any_of(_pairs, [&](const Pair& p)
                                       { return wanted(p, x, flags, kinds); });
  if (host.max(any ? 1.0 : 0.0) == 0)
    return 0;
  double longest = 0;
  for (std::size_t k = 0; k + 1 < _start.size(); ++k)
  {
    for (std::int32_t c : _cells)
      _moves[std::size_t(width) * c] = 0;
    for (std::int32_t i = _start[k]; i < _start[k + 1]; ++i)
    {
      const Pair& p = _pairs[i];
      const Point b = point(x, p.first), c = point(x, p.second);
      if (not wanted(p, x, flags, kinds) or not move(p, x, rules))
        continue;
      const Point first = point(x, p.first), second = point(x, p.second);
      const std::size_t at = std::size_t(width) * p.cell;
      const double post[width] = {p.local + 1.0, first.x, first.y, second.x,
                                  second.y};
      std::copy(post, post + width, _moves.begin() + std::ptrdiff_t(at));
      longest = std::max(
          {longest, dot(first - b, first - b), dot(second - c, second - c)});
    }
    host.update_cells(_moves, width);
    for (std::int32_t c : _cells)
    {
      const double* m = _moves.data() + std::size_t(width) * c;
      if (m[0] == 0)
        continue;
      const std::int32_t f = _mesh->cell_facets(c)[static_cast<int>(m[0]) - 1];
      const auto [first, second] = _mesh->facet(f);
      x[2 * first] = m[1], x[2 * first + 1] = m[2];
      x[2 * second] = m[3], x[2 * second + 1] = m[4];
    }
    host.update_nodes(x, 2);
  }
  return std::sqrt(longest);
}
