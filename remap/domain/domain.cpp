// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/domain.h"

#include "remap/domain/order.h"

#include "remap/domain/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

namespace remap
{
namespace
{
using orientation::side;

/// A ring without points that repeat the one before, and where they came from.
struct Clean
{
  Ring ring;
  std::vector<std::size_t> vertex;
  std::size_t shape = 0;
};

Clean clean(std::span<const Point> ring)
{
  Clean out;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (out.ring.empty() or ring[i] != out.ring.back())
    {
      out.ring.push_back(ring[i]);
      out.vertex.push_back(i);
    }
  while (out.ring.size() > 1 and out.ring.front() == out.ring.back())
  {
    out.ring.pop_back();
    out.vertex.pop_back();
  }
  return out;
}

std::vector<Clean> clean(std::span<const Shape> shapes)
{
  std::vector<Clean> out;
  for (std::size_t s = 0; s < shapes.size(); ++s)
    for (const Ring& ring : shapes[s].rings)
    {
      out.push_back(clean(ring));
      out.back().shape = s;
    }
  return out;
}

std::string words(Point p)
{
  char text[64];
  std::snprintf(text, sizeof text, "(%.6g, %.6g)", p.x, p.y);
  return text;
}

/// An edge of a ring, and where to find it.
struct Edge
{
  Point a, b;
  std::size_t ring, vertex; ///< a is this vertex of this ring
};

/// Finds where edges cross or lie on each other. All decisions are exact. Two
/// ways through a common vertex cross if the ends of one lie on both sides of
/// the other.
class Crossings
{
public:
  explicit Crossings(const std::vector<Clean>& rings) : _rings(rings)
  {
    for (std::size_t r = 0; r < rings.size(); ++r)
      for (std::size_t i = 0; i < rings[r].ring.size(); ++i)
        _edges.push_back({at(r, i), at(r, i + 1), r, i});
  }

  /// Sorted by their least x: only edges whose boxes meet are looked at.
  std::vector<Fault> find()
  {
    std::ranges::sort(_edges, {},
                      [](const Edge& e) { return std::min(e.a.x, e.b.x); });
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < _edges.size(); ++i)
    {
      const Edge& e = _edges[i];
      const double from = std::min(e.a.x, e.b.x);
      std::erase_if(active, [&](std::size_t j)
                    { return std::max(_edges[j].a.x, _edges[j].b.x) < from; });
      for (const std::size_t j : active)
      {
        const Edge& f = _edges[j];
        if (std::max(f.a.y, f.b.y) >= std::min(e.a.y, e.b.y)
            and std::min(f.a.y, f.b.y) <= std::max(e.a.y, e.b.y))
          look(e, f);
      }
      active.push_back(i);
    }
    return std::move(_faults);
  }

private:
  Point at(std::size_t ring, std::size_t i) const
  {
    const Ring& points = _rings[ring].ring;
    return points[i % points.size()];
  }
  Point before(const Edge& e) const
  {
    const std::size_t n = _rings[e.ring].ring.size();
    return at(e.ring, e.vertex + n - 1);
  }

  /// At the later ring of two, the earlier vertex of one.
  void complain(const Edge& e, const Edge& f, const char* how, Point where)
  {
    const bool one = e.ring == f.ring;
    const bool at_e = one ? e.vertex < f.vertex : e.ring > f.ring;
    const Edge &at = at_e ? e : f, &other = at_e ? f : e;
    const std::string what =
        one ? "the ring " + std::string(how) + " itself"
            : std::string(how) + " ring " + std::to_string(other.ring + 1);
    _faults.push_back({at.ring, _rings[at.ring].vertex[at.vertex],
                       what + " near " + words(where), true});
  }

  void look(const Edge& e, const Edge& f)
  {
    const int fa = side(e.a, e.b, f.a), fb = side(e.a, e.b, f.b);
    const int ea = side(f.a, f.b, e.a), eb = side(f.a, f.b, e.b);
    if (fa * fb < 0 and ea * eb < 0)
    {
      // Near enough for words; the decision was exact.
      const Point d = e.b - e.a, g = f.b - f.a;
      const double t = cross(f.a - e.a, g) / cross(d, g);
      return complain(e, f, "crosses", e.a + t * d);
    }
    if (fa == 0 and fb == 0)
      return overlap(e, f);
    if (fa == 0)
      touch(e, f);
    else if (ea == 0)
      touch(f, e);
  }

  /// Both on one line.
  void overlap(const Edge& e, const Edge& f)
  {
    const bool along_x = std::abs(e.b.x - e.a.x) >= std::abs(e.b.y - e.a.y);
    const auto range = [&](const Edge& s)
    {
      const double p = along_x ? s.a.x : s.a.y, q = along_x ? s.b.x : s.b.y;
      return std::pair(std::min(p, q), std::max(p, q));
    };
    const auto [e0, e1] = range(e);
    const auto [f0, f1] = range(f);
    if (std::max(e0, f0) < std::min(e1, f1))
      complain(e, f, "lies on an edge of", f.a);
    else if (e.a == f.a or on(e, f.a))
      touch(e, f);
    else if (on(f, e.a))
      touch(f, e);
  }

  /// Between the ends of e, whose line it is on.
  static bool on(const Edge& e, Point p)
  {
    return p != e.a and p != e.b and std::min(e.a.x, e.b.x) <= p.x
           and p.x <= std::max(e.a.x, e.b.x) and std::min(e.a.y, e.b.y) <= p.y
           and p.y <= std::max(e.a.y, e.b.y);
  }

  /// The first end of f lies on the line of e: its ring goes through e there,
  /// or comes back?
  void touch(const Edge& e, const Edge& f)
  {
    if (on(e, f.a))
    {
      const int in = side(e.a, e.b, before(f)), out = side(e.a, e.b, f.b);
      if (in * out < 0)
        complain(e, f, "crosses", f.a);
    }
    else if (f.a == e.a)
    {
      // Four ways leave the vertex; e's two part the plane in two.
      const Point v = e.a;
      const auto left = [&](Point p)
      {
        const int turn = side(before(e), v, e.b);
        const int one = side(before(e), v, p), two = side(v, e.b, p);
        return turn > 0 ? one > 0 and two > 0 : one > 0 or two > 0;
      };
      if (left(before(f)) != left(f.b))
        complain(e, f, "crosses", v);
    }
  }

  const std::vector<Clean>& _rings;
  std::vector<Edge> _edges;
  std::vector<Fault> _faults;
};

std::vector<Fault> faults_of(std::span<const Shape> shapes,
                             const std::vector<Clean>& rings)
{
  std::vector<Fault> out;
  if (rings.empty())
    out.push_back({0, 0, "there are no rings"});
  std::size_t r = 0;
  for (const Shape& shape : shapes)
    for (const Ring& given : shape.rings)
    {
      const std::size_t points = rings[r].ring.size();
      const auto bad = std::ranges::find_if(
          given, [](Point p)
          { return not(std::isfinite(p.x) and std::isfinite(p.y)); });
      if (bad != given.end())
        out.push_back({r, static_cast<std::size_t>(bad - given.begin()),
                       "a coordinate is not finite"});
      else if (points < 3)
        out.push_back({r, 0,
                       "has " + std::to_string(points)
                           + (points == 1 ? " point" : " points")
                           + "; a ring needs 3 that differ"});
      ++r;
    }
  if (not out.empty())
    return out;
  const std::vector<Fault> found = Crossings(rings).find();
  for (const std::size_t i :
       order_by(found.size(), [&found](std::size_t k)
                { return std::pair(found[k].ring, found[k].vertex); }))
    out.push_back(found[i]);
  return out;
}

/// Does one ring of valid ones run around another? 1, -1: counter-clockwise,
/// clockwise; 0: not.
int around(const Ring& outer, const Ring& inner)
{
  const auto on_it = [&](Point p)
  {
    for (std::size_t i = 0; i < outer.size(); ++i)
    {
      const Point a = outer[i], b = outer[(i + 1) % outer.size()];
      if (side(a, b, p) == 0 and std::min(a.x, b.x) <= p.x
          and p.x <= std::max(a.x, b.x) and std::min(a.y, b.y) <= p.y
          and p.y <= std::max(a.y, b.y))
        return true;
    }
    return false;
  };
  // They may touch in points, never along an edge.
  for (const Point p : inner)
    if (not on_it(p))
      return rings::winding(outer, p);
  return rings::winding(outer, middle(inner[0], inner[1]));
}

struct Box
{
  Point low, high;

  [[nodiscard]] bool holds(const Box& b) const
  {
    return low.x <= b.low.x and low.y <= b.low.y and high.x >= b.high.x
           and high.y >= b.high.y;
  }
};

Box box_of(std::span<const Point> ring)
{
  Box b{ring[0], ring[0]};
  for (const Point p : ring)
  {
    b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y)};
    b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y)};
  }
  return b;
}

double twice_area(std::span<const Point> ring)
{
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += twice_area(ring[0], ring[i], ring[i + 1]);
  return sum;
}
} // namespace

int rings::winding(std::span<const Point> ring, Point p)
{
  int out = 0;
  Point a = ring.back();
  for (const Point b : ring)
  {
    // The way to the right of p crosses the edge upwards, or downwards.
    if (a.y <= p.y and b.y > p.y)
      out += side(a, b, p) > 0;
    else if (a.y > p.y and b.y <= p.y)
      out -= side(a, b, p) < 0;
    a = b;
  }
  return out;
}

std::vector<Fault> Domain::faults(std::span<const Shape> shapes)
{
  return faults_of(shapes, clean(shapes));
}

Domain::Domain(std::span<const Shape> shapes)
{
  const std::vector<Clean> cleaned = clean(shapes);
  if (const auto faults = faults_of(shapes, cleaned); not faults.empty())
  {
    std::string text;
    for (const Fault& f : faults)
      text += (text.empty() ? "ring " : "\nring ") + std::to_string(f.ring + 1)
              + ", vertex " + std::to_string(f.vertex + 1) + ": " + f.what;
    throw std::invalid_argument(text);
  }
  std::vector<Box> boxes;
  for (const Clean& c : cleaned)
    boxes.push_back(box_of(c.ring));
  for (std::size_t i = 0; i < cleaned.size(); ++i)
  {
    // How often each shape's rings run around, just outside of the ring.
    std::vector<int> times(shapes.size(), 0);
    for (std::size_t j = 0; j < cleaned.size(); ++j)
      if (j != i and boxes[j].holds(boxes[i]))
        times[cleaned[j].shape] += around(cleaned[j].ring, cleaned[i].ring);
    const auto filled = [&]
    {
      for (std::size_t s = 0; s < shapes.size(); ++s)
        if (shapes[s].rule == FillRule::nonzero ? times[s] != 0
                                                : times[s] % 2 != 0)
          return true;
      return false;
    };
    const bool outside = filled();
    const int turn = twice_area(cleaned[i].ring) > 0 ? 1 : -1;
    times[cleaned[i].shape] += turn;
    const bool inside = filled();
    if (outside == inside)
      continue;
    Ring ring = cleaned[i].ring;
    if ((turn > 0) != inside)
      std::ranges::reverse(ring);
    if (_rings.empty())
      _low = boxes[i].low, _high = boxes[i].high;
    _low = {std::min(_low.x, boxes[i].low.x), std::min(_low.y, boxes[i].low.y)};
    _high = {std::max(_high.x, boxes[i].high.x),
             std::max(_high.y, boxes[i].high.y)};
    _rings.push_back(std::move(ring));
  }
}

Domain::Domain(std::vector<Ring> rings, FillRule rule)
{
  const Shape shape{std::move(rings), rule};
  *this = Domain(std::span(&shape, 1));
}

Domain Domain::rectangle(Point low, Point high)
{
  return polygon({low, {high.x, low.y}, high, {low.x, high.y}});
}

Domain Domain::polygon(Ring ring)
{
  std::vector<Ring> rings;
  rings.push_back(std::move(ring));
  return Domain(std::move(rings));
}

Domain Domain::circle(Point centre, double radius, double tolerance)
{
  if (not(radius > 0 and tolerance > 0))
    throw std::invalid_argument("circle: radius and tolerance must be > 0");
  constexpr double pi = std::numbers::pi;
  // With the disc's area, edges are inside and vertices outside of the circle,
  // each by less than the sagitta of a step, r (1 − cos(π/n)).
  const double step =
      std::acos(std::max(0.5, 1 - std::min(tolerance / radius, 0.5)));
  const int n = std::max(8, static_cast<int>(std::ceil(pi / step)));
  const double out = radius * std::sqrt(2 * pi / (n * std::sin(2 * pi / n)));
  Ring ring;
  for (int i = 0; i < n; ++i)
  {
    const double angle = 2 * pi * i / n;
    ring.push_back(centre + out * Point{std::cos(angle), std::sin(angle)});
  }
  return polygon(std::move(ring));
}

Domain Domain::half_plane(const HalfPlane& half, Point low, Point high)
{
  if (not(low.x < high.x and low.y < high.y))
    throw std::invalid_argument("half-plane: the box has no area");
  Polygon<4> box;
  for (const Point p : {low, {high.x, low.y}, high, {low.x, high.y}})
    box.push(p);
  Polygon<5> part;
  clip(box, half, part);
  Ring ring;
  for (int i = 0; i < part.size; ++i)
    ring.push_back(part[i]);
  ring = clean(std::span<const Point>(ring)).ring;
  return ring.size() < 3 ? Domain() : polygon(std::move(ring));
}

bool Domain::holds(Point p) const
{
  int n = 0;
  for (const Ring& ring : _rings)
    n += rings::winding(ring, p);
  return n > 0;
}

template <Geometry G>
Moments Domain::moments() const
{
  if (_rings.empty())
    return {};
  const Point o = middle(_low, _high);
  rings::Sums<G> sums(o);
  Ring local;
  for (const Ring& ring : _rings)
  {
    local = ring;
    for (Point& p : local)
      p = p - o;
    sums.add(local);
  }
  return polygon::shifted(sums.local(), o);
}

template Moments Domain::moments<Geometry::plane>() const;
template Moments Domain::moments<Geometry::axisymmetric>() const;
} // namespace remap
