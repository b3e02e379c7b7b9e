// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sides.h"

#include <limits>

namespace mmale::mesh
{
namespace
{
using Point = std::array<double, 2>;
using Edge = std::array<std::int64_t, 3>;

/// Neighbouring edges that turn by more [rad] are not in a row; what is left
/// is then held against the chord.
constexpr double in_a_row = 1e-6;

double cross(const Point& o, const Point& a, const Point& b)
{
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double distance(const Point& a, const Point& b)
{
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/// The edge that goes on straight behind each, or -1.
std::vector<int> followers(std::span<const double> x,
                           std::span<const Edge> edges)
{
  constexpr int none = -1, several = -2;
  std::vector<int> from(x.size() / 2, none), ends(x.size() / 2, 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    int& first = from[edges[i][0]];
    first = first == none ? static_cast<int>(i) : several;
    ++ends[edges[i][1]];
  }
  const auto point = [&](std::int64_t n)
  { return Point{x[2 * n], x[2 * n + 1]}; };
  std::vector<int> out(edges.size(), none);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const int next = from[edges[i][1]];
    if (next < 0 or ends[edges[i][1]] > 1 or edges[next][2] != edges[i][2])
      continue;
    const Point a = point(edges[i][0]), b = point(edges[i][1]),
                c = point(edges[next][1]);
    const double along = distance(a, b) * distance(b, c);
    const double cosine =
        (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    if (std::abs(cross(a, b, c)) <= in_a_row * along and cosine > 0)
      out[i] = next;
  }
  return out;
}
} // namespace

std::array<Point, 2> common_line(std::span<const Side> sides, int boundary)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> points;
  for (const Side& side : sides)
    if (side.boundary == boundary)
      points.insert(points.end(), side.ends.begin(), side.ends.end());
  if (points.empty())
    return {{{nan, nan}, {nan, nan}}};
  // Of points on a line the farthest from any is an end.
  const auto farthest = [&](const Point& from)
  {
    Point out = from;
    for (const Point& p : points)
      if (distance(from, p) > distance(from, out))
        out = p;
    return out;
  };
  const Point a = farthest(points[0]), b = farthest(a);
  for (const Point& p : points)
    if (std::abs(cross(a, b, p))
        > Side::straight * distance(a, b) * distance(a, b))
      return {{{nan, nan}, {nan, nan}}};
  return {a, b};
}

std::vector<int> find_sides(std::span<const double> x,
                            std::span<const Edge> edges,
                            std::vector<Side>& sides)
{
  const auto point = [&](std::int64_t n)
  { return Point{x[2 * n], x[2 * n + 1]}; };
  const std::vector<int> follower = followers(x, edges);
  std::vector<bool> follows(edges.size(), false);
  for (int next : follower)
    if (next >= 0)
      follows[next] = true;

  std::vector<int> side_of(edges.size(), -1);
  const auto add = [&](std::span<const int> row)
  {
    const auto a = edges[row.front()][0], b = edges[row.back()][1];
    for (int i : row)
      side_of[i] = static_cast<int>(sides.size());
    sides.push_back({static_cast<int>(edges[row.front()][2]),
                     static_cast<int>(row.size()),
                     {a, b},
                     {point(a), point(b)}});
  };
  std::vector<int> row;
  for (std::size_t first = 0; first < edges.size(); ++first)
  {
    if (follows[first])
      continue;
    row.clear();
    for (int i = static_cast<int>(first); i >= 0; i = follower[i])
      row.push_back(i);
    const Point a = point(edges[row.front()][0]),
                b = point(edges[row.back()][1]);
    const double room = Side::straight * distance(a, b) * distance(a, b);
    bool straight = true;
    for (int i : row)
      straight = straight and std::abs(cross(a, b, point(edges[i][1]))) <= room;
    if (straight)
      add(row);
    else
      for (int i : row)
        add(std::span(&i, 1));
  }
  return side_of;
}
} // namespace mmale::mesh
