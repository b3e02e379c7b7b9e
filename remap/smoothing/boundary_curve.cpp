// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/boundary_curve.h"

#include <algorithm>
#include <cmath>

using namespace remap;

namespace
{
double length(Point d)
{
  return std::sqrt(dot(d, d));
}

/// The cubic from a to b with tangents u and v there, times the chord.
struct Cubic
{
  Point a, b, u, v;

  Point at(double s) const
  {
    const double r = 1 - s;
    return r * r * (1 + 2 * s) * a + s * s * (3 - 2 * s) * b + (r * r * s) * u
           - (r * s * s) * v;
  }
  Point first(double s) const
  {
    const double r = 1 - s;
    return (6 * r * s) * (b - a) + (r * (1 - 3 * s)) * u
           + (s * (3 * s - 2)) * v;
  }
  Point second(double s) const
  {
    return (6 - 12 * s) * (b - a) + (6 * s - 4) * u + (6 * s - 2) * v;
  }

  /// Nearest place to p, by Newton from the chord's.
  Guide::Foot foot(Point p) const
  {
    const Point chord = b - a;
    const auto hold = [](double s) { return std::min(std::max(s, 0.0), 1.0); };
    double s = hold(dot(p - a, chord) / dot(chord, chord));
    // Facets turn by less than a right angle: three digits a step at least.
    for (int k = 0; k < 6; ++k)
    {
      const Point gap = at(s) - p;
      const Point d = first(s);
      const double slope = dot(d, d) + dot(gap, second(s));
      if (not(slope > 0))
        break;
      const double next = hold(s - dot(gap, d) / slope);
      if (next == s)
        break;
      s = next;
    }
    return {at(s), first(s)};
  }
};
} // namespace

BoundaryCurve::BoundaryCurve(const Mesh& mesh)
    : _mesh(&mesh), _x(2 * static_cast<std::size_t>(mesh.num_nodes())),
      _tangent(2 * static_cast<std::size_t>(mesh.num_nodes()))
{
}

void BoundaryCurve::follow(std::span<const double> x,
                           std::span<const Kind> kinds, const Host& host)
{
  std::copy(x.begin(), x.end(), _x.begin());
  std::fill(_tangent.begin(), _tangent.end(), 0.0);
  for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
  {
    const auto [in, out] = _mesh->boundary_facets(i);
    if (kinds[i] != Kind::curve or in < 0 or out < 0)
      continue;
    // Tangent of the parabola through the node and its two neighbours.
    const Point d = point(x, i) - point(x, _mesh->facet(in)[0]);
    const Point e = point(x, _mesh->facet(out)[1]) - point(x, i);
    const double h = length(d), k = length(e);
    const Point t = (k / h) * d + (h / k) * e;
    _tangent[2 * i] = t.x / length(t);
    _tangent[2 * i + 1] = t.y / length(t);
  }
  host.update_nodes(_tangent, 2);
}

Guide::Foot BoundaryCurve::foot(std::int32_t node, Point p) const
{
  const auto [in, out] = _mesh->boundary_facets(node);
  if (in < 0 or out < 0)
    return {point(_x, node), {1, 0}};
  const auto cubic = [&](std::int32_t a, std::int32_t b)
  {
    Cubic c{point(_x, a), point(_x, b), point(_tangent, a), point(_tangent, b)};
    const Point chord = c.b - c.a;
    const double h = length(chord);
    c.u = h * c.u;
    c.v = h * c.v;
    // At the end of a curve, and if the other is a corner too: the parabola
    // that has the tangent of its first node.
    if (c.u == Point{})
      c.u = 2 * chord - c.v;
    if (c.v == Point{})
      c.v = 2 * chord - c.u;
    return c.foot(p);
  };
  const Foot before = cubic(_mesh->facet(in)[0], node);
  const Foot after = cubic(node, _mesh->facet(out)[1]);
  const auto gap = [p](const Foot& f) { return dot(f.at - p, f.at - p); };
  return gap(after) < gap(before) ? after : before;
}
