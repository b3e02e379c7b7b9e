// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: a triangle under the edges of several outlines, piece by piece:
// cut into slabs between the heights where an edge begins, ends or crosses
// another one. Between them edges lie side by side, in one order. The pieces
// of all slabs fill the triangle, whatever round-off does to the edges.
#pragma once

#include "remap/domain/orientation.h"
#include "remap/geometry/polygon.h"

#include <algorithm>
#include <array>
#include <vector>

namespace remap::outline
{
/// An edge that is not level, its lower end first.
struct Edge
{
  Point low, high;
  int label = 0; ///< which outline it belongs to
  int turn = 0;  ///< by how much that outline runs around more to its right

  [[nodiscard]] double at(double y) const
  {
    if (y <= low.y)
      return low.x;
    if (y >= high.y)
      return high.x;
    return low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x);
  }
  [[nodiscard]] bool spans(double from, double to) const
  {
    return low.y <= from and high.y >= to;
  }
};

/// Cuts triangles, with the room it needs.
class Slabs
{
public:
  /// A new triangle, counter-clockwise.
  void begin(const Triangle& t)
  {
    _edges.clear();
    _heights.clear();
    _low = std::min({t[0].y, t[1].y, t[2].y});
    _high = std::max({t[0].y, t[1].y, t[2].y});
    for (std::size_t k = 0; k < 3; ++k)
      add(0, t[k], t[(k + 1) % 3]);
    _sides = _edges.size();
  }

  /// An edge of an outline, from a to b, which has its inside to the left.
  void add(int label, Point a, Point b)
  {
    put(a.y);
    put(b.y);
    if (a.y < b.y)
      _edges.push_back({a, b, label, -1});
    else if (a.y > b.y)
      _edges.push_back({b, a, label, 1});
  }

  /// Visit all pieces, slab by slab, each from left to right.
  ///
  /// @param start  start(p): at a point on the left side of the triangle; what
  ///               the outlines there are is known to the caller
  /// @param pass   pass(label, turn): the next piece is behind an edge
  /// @param piece  piece(corners): 4 points, counter-clockwise; may have no
  ///               breadth at one end, or at both
  template <class Start, class Pass, class Piece>
  void visit(Start start, Pass pass, Piece piece)
  {
    find_crossings();
    std::ranges::sort(_heights);
    _heights.erase(std::unique(_heights.begin(), _heights.end()),
                   _heights.end());
    for (std::size_t h = 0; h + 1 < _heights.size(); ++h)
      visit_slab(_heights[h], _heights[h + 1], start, pass, piece);
  }

private:
  struct Place
  {
    double x;
    std::size_t edge;
  };

  void put(double y)
  {
    if (y >= _low and y <= _high)
      _heights.push_back(y);
  }

  void find_crossings()
  {
    for (std::size_t i = 0; i < _edges.size(); ++i)
      for (std::size_t j = std::max(i + 1, _sides); j < _edges.size(); ++j)
        cross_edges(_edges[i], _edges[j]);
  }

  void cross_edges(const Edge& e, const Edge& f)
  {
    if (e.high.y <= f.low.y or f.high.y <= e.low.y)
      return;
    const double a = twice_area(f.low, f.high, e.low);
    const double b = twice_area(f.low, f.high, e.high);
    if (not((a > 0 and b < 0) or (a < 0 and b > 0)))
      return;
    const double y = e.low.y + a / (a - b) * (e.high.y - e.low.y);
    if (y > f.low.y and y < f.high.y)
      put(y);
  }

  template <class Start, class Pass, class Piece>
  void visit_slab(double from, double to, Start& start, Pass& pass,
                  Piece& piece)
  {
    double mid = from + 0.5 * (to - from);
    if (not(mid < to))
      mid = from;
    // The triangle's own two edges.
    std::array<const Edge*, 2> side = {nullptr, nullptr};
    for (std::size_t k = 0; k < _sides; ++k)
      if (_edges[k].spans(from, to))
        side[_edges[k].turn > 0 ? 0 : 1] = &_edges[k];
    if (not side[0] or not side[1])
      return;
    const Point at{side[0]->at(mid), mid};
    _here.clear();
    for (std::size_t e = _sides; e < _edges.size(); ++e)
      // As exact as the outline's way around this point is found.
      if (_edges[e].spans(from, to)
          and orientation::side(_edges[e].low, _edges[e].high, at) > 0)
        _here.push_back({_edges[e].at(mid), e});
    std::ranges::sort(_here, {},
                      [](const Place& p) { return std::pair(p.x, p.edge); });
    const double end0 = side[1]->at(from), end1 = side[1]->at(to);
    double x0 = side[0]->at(from), x1 = side[0]->at(to);
    const auto reach = [&](double y0, double y1)
    {
      // Round-off may have edges cross a little beside their crossing.
      y0 = std::min(std::max(y0, x0), std::max(end0, x0));
      y1 = std::min(std::max(y1, x1), std::max(end1, x1));
      if (y0 > x0 or y1 > x1)
        piece(
            std::array<Point, 4>{{{x0, from}, {y0, from}, {y1, to}, {x1, to}}});
      x0 = y0;
      x1 = y1;
    };
    start(at);
    for (const Place& p : _here)
    {
      const Edge& e = _edges[p.edge];
      reach(e.at(from), e.at(to));
      pass(e.label, e.turn);
    }
    reach(end0, end1);
  }

  std::vector<Edge> _edges; ///< the triangle's own first
  std::size_t _sides = 0;   ///< number of those
  std::vector<double> _heights;
  std::vector<Place> _here;
  double _low = 0, _high = 0;
};
} // namespace remap::outline
