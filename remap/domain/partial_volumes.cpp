// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/partial_volumes.h"

#include "remap/domain/order.h"

#include "remap/domain/trapezoids.h"
#include "remap/geometry/position.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace remap
{
namespace
{
struct Box
{
  Point low{std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Point high{-std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

  void add(Point p)
  {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// Sides beyond which a point lies, a bit each.
  [[nodiscard]] unsigned beyond(Point p) const
  {
    return static_cast<unsigned>(p.x < low.x)
           | static_cast<unsigned>(p.x > high.x) << 1
           | static_cast<unsigned>(p.y < low.y) << 2
           | static_cast<unsigned>(p.y > high.y) << 3;
  }
};

/// Rings on a stack: those of a box lie on top of those of the box around it.
struct Stack
{
  std::vector<Point> points;
  std::vector<std::size_t> ends; ///< of each ring, in points

  struct Mark
  {
    std::size_t points, rings;
  };
  [[nodiscard]] Mark top() const { return {points.size(), ends.size()}; }
  void pop(Mark to)
  {
    points.resize(to.points);
    ends.resize(to.rings);
  }
  /// Visit the rings between two marks.
  template <class V>
  void each(Mark from, Mark to, V visit) const
  {
    std::size_t begin = from.points;
    for (std::size_t r = from.rings; r < to.rings; ++r)
    {
      visit(std::span(points).subspan(begin, ends[r] - begin));
      begin = ends[r];
    }
  }
};

/// Do the line through a, b and a box have no point in common? On the safe
/// side: false where round-off could decide.
bool misses(Point a, Point b, const Box& box)
{
  const Point d = b - a;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  double size = 0;
  for (const Point p :
       {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}})
  {
    const double left = d.x * (p.y - a.y), right = d.y * (p.x - a.x);
    least = std::min(least, left - right);
    most = std::max(most, left - right);
    size = std::max(size, std::abs(left) + std::abs(right));
  }
  const double noise = 8 * std::numeric_limits<double>::epsilon() * size;
  return least > noise or most < -noise;
}

template <Geometry G>
class Walk
{
public:
  Walk(const Domain& domain, std::span<const std::int32_t> cells,
       std::span<const double> x, DomainPieces* pieces)
      : _cells(cells), _x(x), _wants_pieces(pieces != nullptr),
        _order(cells.size() / 3)
  {
    _out.parts.resize(_order.size());
    std::iota(_order.begin(), _order.end(), 0);
    for (const Ring& ring : domain.rings())
    {
      _stack.points.insert(_stack.points.end(), ring.begin(), ring.end());
      _stack.ends.push_back(_stack.points.size());
    }
    if (not _order.empty())
      visit(_order, {0, 0});
    std::ranges::sort(_out.mixed);
    if (pieces)
      collect(*pieces);
  }

  PartialVolumes result() { return std::move(_out); }

private:
  Triangle place(std::int32_t c) const
  {
    const auto i = static_cast<std::size_t>(c);
    return polygon::turned({point(_x, _cells[3 * i]),
                            point(_x, _cells[3 * i + 1]),
                            point(_x, _cells[3 * i + 2])});
  }

  /// Put the rings between two marks on the top, without what a box cannot
  /// see: of three points in turn that all lie beyond one of its sides, the
  /// one in the middle. The way around the points of the box stays the same.
  ///
  /// @return does an edge come near the box?
  bool thin(Stack::Mark from, Stack::Mark to, const Box& box)
  {
    bool near = false;
    std::size_t begin = from.points;
    for (std::size_t r = from.rings; r < to.rings; ++r)
    {
      const std::size_t start = _stack.points.size();
      const std::size_t end = _stack.ends[r];
      for (std::size_t i = begin; i < end; ++i)
      {
        const Point p = _stack.points[i];
        drop_behind(start, box, p);
        _stack.points.push_back(p);
      }
      begin = end;
      // Where the ring closes.
      while (_stack.points.size() > start + 2
             and (box.beyond(_stack.points[start])
                  & box.beyond(_stack.points.back())
                  & box.beyond(_stack.points[_stack.points.size() - 2]))
                     != 0)
        _stack.points.pop_back();
      const bool seen = any_near(start, box, near);
      if (seen)
        _stack.ends.push_back(_stack.points.size());
      else
        _stack.points.resize(start);
    }
    return near;
  }

  void drop_behind(std::size_t start, const Box& box, Point p)
  {
    auto& points = _stack.points;
    const unsigned out = box.beyond(p);
    while (out != 0 and points.size() >= start + 2
           and (out & box.beyond(points.back())
                & box.beyond(points[points.size() - 2]))
                   != 0)
      points.pop_back();
  }

  /// False if all of a ring lies beyond one side of the box. `near` is set if
  /// an edge comes near it.
  bool any_near(std::size_t start, const Box& box, bool& near) const
  {
    const std::span ring = std::span(_stack.points).subspan(start);
    unsigned common = 15;
    for (const Point p : ring)
      common &= box.beyond(p);
    if (ring.size() < 2 or common != 0)
      return false;
    for (std::size_t i = 0; not near and i < ring.size(); ++i)
    {
      const Point a = ring[i], b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const unsigned p = box.beyond(a), q = box.beyond(b);
      near = p == 0 or q == 0 or ((p & q) == 0 and not misses(a, b, box));
    }
    return true;
  }

  /// Cells that a box holds, with the rings that the box around it sees, those
  /// from a mark to the top.
  void visit(std::span<std::int32_t> cells, Stack::Mark from)
  {
    Box box;
    for (const std::int32_t c : cells)
      for (std::size_t k = 0; k < 3; ++k)
        box.add(point(_x, _cells[3 * static_cast<std::size_t>(c) + k]));
    const Stack::Mark mine = _stack.top();
    if (thin(from, mine, box))
    {
      if (cells.size() == 1)
        cut(cells[0], mine);
      else
        halve(cells, box, mine);
    }
    else if (runs_around(mine, middle(box.low, box.high)))
      for (const std::int32_t c : cells)
        fill(c);
    _stack.pop(mine);
  }

  void halve(std::span<std::int32_t> cells, const Box& box, Stack::Mark mine)
  {
    const bool along_x = box.high.x - box.low.x >= box.high.y - box.low.y;
    const auto at = [&](std::int32_t c)
    {
      const auto i = 3 * static_cast<std::size_t>(c);
      const std::size_t d = along_x ? 0 : 1;
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += _x[2 * static_cast<std::size_t>(_cells[i + k]) + d];
      return sum;
    };
    const std::size_t half = cells.size() / 2;
    std::nth_element(cells.begin(),
                     cells.begin() + static_cast<std::ptrdiff_t>(half),
                     cells.end(), [&](std::int32_t a, std::int32_t b)
                     { return at(a) < at(b); });
    visit(cells.first(half), mine);
    visit(cells.subspan(half), mine);
  }

  bool runs_around(Stack::Mark from, Point p) const
  {
    int n = 0;
    _stack.each(from, _stack.top(), [&](std::span<const Point> ring)
                { n += rings::winding(ring, p); });
    return n > 0;
  }

  /// All of a cell.
  void fill(std::int32_t c)
  {
    const Triangle t = place(c);
    _out.parts[static_cast<std::size_t>(c)] =
        polygon::shifted(position::about_first<G>(t), t[0]);
    ++_out.full;
    if (_wants_pieces)
      keep(c, t);
  }

  /// Cut the rings by the cell's edges; sums of signed areas do not care about
  /// the ways to and fro along its edges that this leaves between parts.
  void cut(std::int32_t c, Stack::Mark from)
  {
    const Triangle t = place(c);
    const Point o = t[0];
    const Point corner[3] = {{}, t[1] - o, t[2] - o};
    double size = 0;
    for (const Point p : corner)
      size = std::max({size, std::abs(p.x), std::abs(p.y)});
    double reach = size;
    rings::Sums<G> sums(o);
    _kept.clear();
    _stack.each(from, _stack.top(),
                [&](std::span<const Point> ring)
                {
                  _ring.clear();
                  for (const Point p : ring)
                  {
                    _ring.push_back(p - o);
                    reach = std::max({reach, std::abs(_ring.back().x),
                                      std::abs(_ring.back().y)});
                  }
                  for (int k = 0; k < 3 and not _ring.empty(); ++k)
                    clip(HalfPlane::left_of(corner[k], corner[(k + 1) % 3]));
                  if (_ring.size() < 3)
                    return;
                  sums.add(_ring);
                  if (_wants_pieces)
                    _kept.push_back(_ring);
                });
    const Moments all = position::about_first<G>(t);
    const Moments part = sums.local();
    const double noise = 16 * std::numeric_limits<double>::epsilon() * reach
                         * size * position::weight<G>(t);
    if (not(part.v > noise))
      return;
    if (not(all.v - part.v > noise))
      return fill(c);
    const Point g =
        position::held_in({Point{}, corner[1], corner[2]}, part.centroid());
    _out.parts[static_cast<std::size_t>(c)] =
        polygon::shifted({part.v, part.v * g.x, part.v * g.y}, o);
    _out.mixed.push_back(c);
    if (not _wants_pieces)
      return;
    // Smaller ones could turn over when they are put in their place.
    const double far = std::max(std::abs(o.x), std::abs(o.y)) + reach;
    trapezoids(_kept, 4 * std::numeric_limits<double>::epsilon() * far * size,
               [&](std::span<const Point> piece) { keep(c, piece, o); });
  }

  /// `_ring` cut by a half-plane.
  /// @source Sutherland & Hodgman (1974)
  void clip(const HalfPlane& h)
  {
    _next.clear();
    Point a = _ring.back();
    double da = h.depth(a.x, a.y);
    for (const Point b : _ring)
    {
      const double db = h.depth(b.x, b.y);
      // From the end inside, so that two cells find the same place.
      if (da > 0 and not(db > 0))
        _next.push_back(a + (da / (da - db)) * (b - a));
      else if (not(da > 0) and db > 0)
        _next.push_back(b + (db / (db - da)) * (a - b));
      if (db > 0)
        _next.push_back(b);
      a = b;
      da = db;
    }
    _ring.swap(_next);
  }

  void keep(std::int32_t c, std::span<const Point> piece, Point origin = {})
  {
    for (const Point p : piece)
      _pieces.points.push_back(p + origin);
    _pieces.offsets.push_back(static_cast<std::int32_t>(_pieces.points.size()));
    _pieces.cells.push_back(c);
  }

  /// The pieces in order of cells.
  void collect(DomainPieces& out) const
  {
    out = {};
    for (const std::size_t i : order_by(_pieces.size(), [this](std::size_t k)
                                        { return _pieces.cells[k]; }))
    {
      const auto piece = _pieces[i];
      out.points.insert(out.points.end(), piece.begin(), piece.end());
      out.offsets.push_back(static_cast<std::int32_t>(out.points.size()));
      out.cells.push_back(_pieces.cells[i]);
    }
  }

  std::span<const std::int32_t> _cells;
  std::span<const double> _x;
  bool _wants_pieces;
  std::vector<std::int32_t> _order;
  Stack _stack;
  Ring _ring, _next;
  std::vector<Ring> _kept;
  DomainPieces _pieces;
  PartialVolumes _out;
};
} // namespace

template <Geometry G>
PartialVolumes partial_volumes(const Domain& domain,
                               std::span<const std::int32_t> cells,
                               std::span<const double> x, DomainPieces* pieces)
{
  return Walk<G>(domain, cells, x, pieces).result();
}

template PartialVolumes
partial_volumes<Geometry::plane>(const Domain&, std::span<const std::int32_t>,
                                 std::span<const double>, DomainPieces*);
template PartialVolumes
partial_volumes<Geometry::axisymmetric>(const Domain&,
                                        std::span<const std::int32_t>,
                                        std::span<const double>, DomainPieces*);
} // namespace remap
