// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/materials/walk.h"

#include "remap/geometry/position.h"

#include <limits>

using namespace remap;

namespace
{
/// Steps of a search for the cell at a place.
constexpr int max_steps = 2000;

/// How a polygon lies to a triangle's half-planes.
struct Position
{
  bool apart = false; ///< do they have nothing in common?
  unsigned cuts = 0;  ///< those, a bit each, that part of it is outside of
};

Position position_of(const Reach& reach, const Triangle& t)
{
  const Polygon<6>& p = *reach.polygon;
  Position out;
  for (int k = 0; k < 3; ++k)
  {
    const Point a = t[k], along = t[k == 2 ? 0 : k + 1] - a;
    double least = 0, most = 0;
    for (int i = 0; i < p.size; ++i)
    {
      const double depth = along.x * (p.y[i] - a.y) - along.y * (p.x[i] - a.x);
      least = std::min(least, depth);
      most = std::max(most, depth);
    }
    out.apart = out.apart or not(most > 0);
    out.cuts |= static_cast<unsigned>(least < 0) << k;
  }
  for (int k = 0; k < 3; ++k)
  {
    const Point n = reach.normal[k];
    const double nearest =
        std::min(std::min(dot(n, t[0]), dot(n, t[1])), dot(n, t[2]));
    out.apart = out.apart or not(nearest < reach.far[k]);
  }
  return out;
}
} // namespace

Reach::Reach(const Polygon<6>& p, const Triangle& nodes) : polygon(&p)
{
  for (int k = 0; k < 3; ++k)
  {
    const Point along = nodes[(k + 1) % 3] - nodes[k];
    normal[k] = {along.y, -along.x};
    far[k] = dot(normal[k], p[0]);
    for (int i = 1; i < p.size; ++i)
      far[k] = std::max(far[k], dot(normal[k], p[i]));
  }
}

CellWalk::CellWalk(const Mesh& mesh) : _mesh(&mesh), _outline(mesh.outline())
{
  _seen.assign(mesh.num_cells(), 0);
  _is_outline.assign(mesh.num_facets(), 0);
  for (std::int32_t f : _outline)
    _is_outline[f] = 1;
}

std::int32_t CellWalk::locate(std::span<const double> x, std::int32_t from,
                              Point target) const
{
  std::int32_t at = from, before = -1;
  for (int step = 0; step < max_steps; ++step)
  {
    const Triangle t = place(x, at, target);
    std::int32_t next = -1;
    bool inside = true;
    for (int k = 0; k < 3 and next < 0; ++k)
    {
      if (not(position::depth(t[k], t[(k + 1) % 3], {}) < 0))
        continue;
      inside = false;
      if (beside(at, k) != before)
        next = beside(at, k);
    }
    if (inside or next < 0)
      return at;
    before = at;
    at = next;
  }
  return at;
}

void CellWalk::spread(std::span<const double> x, const Reach& p, Point origin)
{
  for (std::size_t i = 0; i < _queue.size(); ++i)
  {
    const std::int32_t e = _queue[i];
    const auto [apart, cuts] = position_of(p, place(x, e, origin));
    if (apart)
      continue;
    _met.push_back({e, cuts});
    for (int k = 0; k < 3; ++k)
    {
      if ((cuts >> k & 1u) == 0)
        continue;
      const std::int32_t next = beside(e, k);
      if (next < 0)
        _edges.push_back(_mesh->cell_facets(e)[k]);
      else if (_seen[next] != _walk)
      {
        _seen[next] = _walk;
        _queue.push_back(next);
      }
    }
  }
}

void CellWalk::meet(std::span<const double> x, const Polygon<6>& p,
                    const Triangle& nodes, Point origin, std::int32_t start)
{
  _met.clear();
  _edges.clear();
  const Reach reach(p, nodes);
  // From the cell in its middle: others may seem to be met, and lead nowhere.
  const Point g = 1.0 / 3 * (nodes[0] + nodes[1] + nodes[2]);
  const std::int32_t middle = locate(x, start, origin + g);
  ++_walk;
  _queue.assign(1, middle);
  _seen[middle] = _walk;
  spread(x, reach, origin);
  if (_seen[start] == _walk)
    return;
  _queue.assign(1, start);
  _seen[start] = _walk;
  spread(x, reach, origin);
}

void CellWalk::meet_everywhere(std::span<const double> x, const Polygon<6>& p,
                               const Triangle& nodes, Point origin)
{
  _met.clear();
  _edges.clear();
  ++_walk;
  const Reach reach(p, nodes);
  for (std::int32_t c = 0; c < _mesh->num_cells(); ++c)
  {
    if (_seen[c] == _walk or position_of(reach, place(x, c, origin)).apart)
      continue;
    _seen[c] = _walk;
    _queue.assign(1, c);
    spread(x, reach, origin);
  }
}

std::int32_t CellWalk::nearest_outline(std::span<const double> x, Point p) const
{
  double best = std::numeric_limits<double>::infinity();
  std::int32_t nearest = -1;
  for (std::int32_t f : _outline)
  {
    const auto [a, b] = _mesh->facet(f);
    const Point d = p - middle(point(x, a), point(x, b));
    if (dot(d, d) < best)
    {
      best = dot(d, d);
      nearest = f;
    }
  }
  return nearest;
}
