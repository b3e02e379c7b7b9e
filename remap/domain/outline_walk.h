// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: which cells do outlines meet? A tree of boxes of cells is walked
// down where an outline passes; on the way the outlines are thinned to what the
// box can see, without making a new point. In: rings with labels, cells. Out,
// to a visitor: cells that no outline comes near, box by box, and the others
// one by one, each with the rings as it sees them.
#pragma once

#include "remap/domain/domain.h"
#include "remap/geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace remap::outline
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
  /// Do the line through a, b and the box have no point in common? On the safe
  /// side: false where round-off could decide.
  [[nodiscard]] bool misses(Point a, Point b) const
  {
    const Point d = b - a;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    double size = 0;
    for (const Point p : {low, {high.x, low.y}, high, {low.x, high.y}})
    {
      const double left = d.x * (p.y - a.y), right = d.y * (p.x - a.x);
      least = std::min(least, left - right);
      most = std::max(most, left - right);
      size = std::max(size, std::abs(left) + std::abs(right));
    }
    const double noise = 8 * std::numeric_limits<double>::epsilon() * size;
    return least > noise or most < -noise;
  }
  /// Does the way from a to b come near the box?
  [[nodiscard]] bool meets(Point a, Point b) const
  {
    const unsigned p = beyond(a), q = beyond(b);
    return p == 0 or q == 0 or ((p & q) == 0 and not misses(a, b));
  }
};

/// Rings on a stack: those of a box lie on top of those of the box around it.
struct Stack
{
  std::vector<Point> points;
  std::vector<std::size_t> ends; ///< of each ring, in points
  std::vector<int> labels;       ///< of each ring

  struct Mark
  {
    std::size_t points, rings;
  };
  [[nodiscard]] Mark top() const { return {points.size(), ends.size()}; }
  void pop(Mark to)
  {
    points.resize(to.points);
    ends.resize(to.rings);
    labels.resize(to.rings);
  }
};

/// Rings as a box sees them: how often they run around each of its points is
/// as with all of the outline, and so are the edges that meet it.
class Seen
{
public:
  Seen(const Stack& stack, Stack::Mark from) : _stack(stack), _from(from) {}

  /// Visit the rings: visit(label, points).
  template <class V>
  void each(V visit) const
  {
    std::size_t begin = _from.points;
    for (std::size_t r = _from.rings; r < _stack.ends.size(); ++r)
    {
      visit(_stack.labels[r],
            std::span(_stack.points).subspan(begin, _stack.ends[r] - begin));
      begin = _stack.ends[r];
    }
  }

private:
  const Stack& _stack;
  Stack::Mark _from;
};

/// Cells of a rank.
struct Cells
{
  std::span<const std::int32_t> nodes; ///< shape (num_cells, 3)
  std::span<const double> x;           ///< shape (num_nodes, 2) [m]

  [[nodiscard]] std::size_t size() const { return nodes.size() / 3; }
  [[nodiscard]] Point corner(std::int32_t c, std::size_t k) const
  {
    return point(x, nodes[3 * static_cast<std::size_t>(c) + k]);
  }
  /// Corners, counter-clockwise.
  [[nodiscard]] Triangle place(std::int32_t c) const
  {
    return polygon::turned({corner(c, 0), corner(c, 1), corner(c, 2)});
  }
};

/// Walks down the tree. The visitor has
/// - apart(cells, box, seen): no outline comes near this box of cells;
/// - cut(cell, box, seen): one comes near this cell's box.
template <class Visitor>
class Walk
{
public:
  Walk(const Cells& cells, Visitor& visitor)
      : _cells(cells), _visitor(visitor), _order(cells.size())
  {
    std::iota(_order.begin(), _order.end(), 0);
  }

  void add(int label, std::span<const Point> ring)
  {
    _stack.points.insert(_stack.points.end(), ring.begin(), ring.end());
    _stack.ends.push_back(_stack.points.size());
    _stack.labels.push_back(label);
  }

  void run()
  {
    if (not _order.empty())
      visit(_order, {0, 0});
  }

private:
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
      {
        _stack.ends.push_back(_stack.points.size());
        _stack.labels.push_back(_stack.labels[r]);
      }
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
      near = box.meets(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
    return true;
  }

  /// Cells that a box holds, with the rings that the box around it sees, those
  /// from a mark to the top.
  void visit(std::span<std::int32_t> cells, Stack::Mark from)
  {
    Box box;
    for (const std::int32_t c : cells)
      for (std::size_t k = 0; k < 3; ++k)
        box.add(_cells.corner(c, k));
    const Stack::Mark mine = _stack.top();
    if (not thin(from, mine, box))
      _visitor.apart(cells, box, Seen(_stack, mine));
    else if (cells.size() == 1)
      _visitor.cut(cells[0], box, Seen(_stack, mine));
    else
      halve(cells, box, mine);
    _stack.pop(mine);
  }

  void halve(std::span<std::int32_t> cells, const Box& box, Stack::Mark mine)
  {
    const bool along_x = box.high.x - box.low.x >= box.high.y - box.low.y;
    const auto at = [&](std::int32_t c)
    {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point p = _cells.corner(c, k);
        sum += along_x ? p.x : p.y;
      }
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

  const Cells& _cells;
  Visitor& _visitor;
  std::vector<std::int32_t> _order;
  Stack _stack;
};
} // namespace remap::outline
