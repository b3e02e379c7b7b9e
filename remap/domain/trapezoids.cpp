// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/trapezoids.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace remap
{
namespace
{
/// An edge that is not level, its lower end first.
struct Edge
{
  Point low, high;
  int turn; ///< 1 where it goes down: what lies to its right is inside

  [[nodiscard]] double at(double y) const
  {
    if (y <= low.y)
      return low.x;
    if (y >= high.y)
      return high.x;
    return low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x);
  }
};

/// A piece that still grows upwards.
struct Open
{
  std::size_t left, right; ///< edges
  double from;
  bool goes_on;
};

std::vector<Edge> edges_of(std::span<const Ring> rings,
                           std::vector<double>& heights)
{
  std::vector<Edge> out;
  for (const Ring& ring : rings)
  {
    Point a = ring.back();
    for (const Point b : ring)
    {
      if (a.y < b.y)
        out.push_back({a, b, -1});
      else if (a.y > b.y)
        out.push_back({b, a, 1});
      heights.push_back(b.y);
      a = b;
    }
  }
  std::ranges::sort(heights);
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return out;
}

void close(const Open& open, double to, const std::vector<Edge>& edges,
           double least,
           const std::function<void(std::span<const Point>)>& emit)
{
  const Edge &left = edges[open.left], &right = edges[open.right];
  const std::array<Point, 4> corner = {Point{left.at(open.from), open.from},
                                       {right.at(open.from), open.from},
                                       {right.at(to), to},
                                       {left.at(to), to}};
  std::array<Point, 4> piece;
  std::size_t n = 0;
  for (const Point p : corner)
    if (n == 0 or p != piece[n - 1])
      piece[n++] = p;
  if (n > 1 and piece[n - 1] == piece[0])
    --n;
  double area = 0;
  for (std::size_t i = 1; i + 1 < n; ++i)
    area += twice_area(piece[0], piece[i], piece[i + 1]);
  if (n >= 3 and area > 2 * least)
    emit(std::span(piece).first(n));
}
} // namespace

void trapezoids(std::span<const Ring> rings, double least,
                const std::function<void(std::span<const Point>)>& emit)
{
  std::vector<double> heights;
  const std::vector<Edge> edges = edges_of(rings, heights);
  std::vector<Open> open;
  std::vector<std::pair<double, std::size_t>> here;
  for (std::size_t h = 0; h + 1 < heights.size(); ++h)
  {
    const double from = heights[h], to = heights[h + 1];
    const double mid = from + 0.5 * (to - from);
    here.clear();
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (edges[e].low.y <= from and edges[e].high.y >= to)
        here.emplace_back(edges[e].at(mid), e);
    // Of edges in one place first those that begin something.
    std::ranges::sort(
        here, {}, [&](const auto& e)
        { return std::tuple(e.first, -edges[e.second].turn, e.second); });
    for (Open& o : open)
      o.goes_on = false;
    std::vector<Open> next;
    int inside = 0;
    for (std::size_t i = 0; i < here.size(); ++i)
    {
      const int before = inside;
      inside += edges[here[i].second].turn;
      if (before > 0 or inside <= 0)
        continue;
      // The piece ends where nothing is inside any more.
      std::size_t j = i;
      for (int n = inside; n > 0 and j + 1 < here.size();)
        n += edges[here[++j].second].turn;
      if (here[j].first > here[i].first)
        next.push_back({here[i].second, here[j].second, from, true});
    }
    for (Open& n : next)
      for (Open& o : open)
        if (o.left == n.left and o.right == n.right)
        {
          n.from = o.from;
          o.goes_on = true;
        }
    for (const Open& o : open)
      if (not o.goes_on)
        close(o, from, edges, least, emit);
    open = std::move(next);
  }
  for (const Open& o : open)
    close(o, heights.back(), edges, least, emit);
}
} // namespace remap
