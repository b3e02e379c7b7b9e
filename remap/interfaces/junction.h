// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: three parts that meet in a point, each a wedge (Y junction). Half-
// planes that nest cannot show it. The point and the three directions minimise
// Σ fraction · distance² of the centroids under the volumes: damped Gauss–
// Newton steps with derivatives in closed form, then the volumes to round-off.
#pragma once

#include "remap/interfaces/corner.h"
#include "remap/interfaces/partition.h"
#include "remap/interfaces/round.h"

#include <numbers>
#include <optional>

namespace remap
{
/// Three wedges: part i lies counter-clockwise of ray i.
struct Junction
{
  Point at;
  std::array<double, 3> angle{};
  std::array<int, 3> part = {0, 1, 2};
  double error = 0;

  [[nodiscard]] Point ray(int i) const
  {
    return {std::cos(angle[i]), std::sin(angle[i])};
  }
  /// As cuts: the ray opposite the widest wedge goes on into that wedge.
  /// @return false if the rays are not in order
  bool cuts(Partition& out) const
  {
    double wide[3], all = 0;
    for (int i = 0; i < 3; ++i)
    {
      wide[i] = std::remainder(angle[i == 2 ? 0 : i + 1] - angle[i],
                               2 * std::numbers::pi);
      wide[i] += wide[i] < 0 ? 2 * std::numbers::pi : 0;
      all += wide[i];
    }
    if (not(std::abs(all - 2 * std::numbers::pi) < 1))
      return false;
    const int widest =
        static_cast<int>(std::max_element(wide, wide + 3) - wide);
    const int a = widest, b = (a + 1) % 3, e = (a + 2) % 3;
    const auto left = [this](int i)
    { return HalfPlane{{ray(i).y, -ray(i).x}, at}; };
    const auto name = [this](int i)
    { return static_cast<std::int8_t>(~part[i]); };
    out.count = 0;
    out.add({left(e), 1, 2});
    out.add({left(a), name(a), name(e)});
    out.add({left(b), name(b), name(a)});
    return true;
  }
};

namespace junction
{
constexpr int unknowns = 5, conditions = 8;
using Step = std::array<double, unknowns>;

/// Least squares with damping: (JᵀJ + damping · diag) x = −Jᵀ r.
inline bool solve(const double (&j)[conditions][unknowns],
                  const double (&r)[conditions], double damping, Step& x)
{
  double a[unknowns][unknowns + 1] = {};
  for (int m = 0; m < unknowns; ++m)
    for (int i = 0; i < conditions; ++i)
    {
      for (int n = 0; n < unknowns; ++n)
        a[m][n] += j[i][m] * j[i][n];
      a[m][unknowns] -= j[i][m] * r[i];
    }
  for (int m = 0; m < unknowns; ++m)
    a[m][m] *= 1 + damping;
  for (int m = 0; m < unknowns; ++m)
  {
    int pivot = m;
    for (int n = m + 1; n < unknowns; ++n)
      pivot = std::abs(a[n][m]) > std::abs(a[pivot][m]) ? n : pivot;
    std::swap(a[m], a[pivot]);
    if (not(std::abs(a[m][m]) > 0))
      return false;
    for (int n = m + 1; n < unknowns; ++n)
      for (int k = unknowns; k >= m; --k)
        a[n][k] -= a[n][m] / a[m][m] * a[m][k];
  }
  for (int m = unknowns - 1; m >= 0; --m)
  {
    x[m] = a[m][unknowns];
    for (int n = m + 1; n < unknowns; ++n)
      x[m] -= a[m][n] * x[n];
    x[m] /= a[m][m];
    if (not std::isfinite(x[m]))
      return false;
  }
  return true;
}

template <Geometry G>
struct Problem
{
  Piece polygon;                 ///< in round coordinates, as all places here
  double all, radius, size;      ///< volume; a length of the cell
  std::array<Target, 3> targets; ///< fractions of the polygon
  Round shape;                   ///< back to where distances are measured

  /// Residuals: centroids over the size, weighted; volumes over all, heavier.
  static constexpr double heavy = 30;

  [[nodiscard]] bool holds(Point p) const
  {
    for (int i = 0; i < polygon.size; ++i)
    {
      const Point a = polygon[i], b = polygon[i + 1 < polygon.size ? i + 1 : 0];
      if (not(cross(b - a, p - a) > 0))
        return false;
    }
    return true;
  }

  [[nodiscard]] std::array<Moments, 3> moments(const Junction& y) const
  {
    std::array<Moments, 3> out{};
    Partition cuts;
    if (y.cuts(cuts))
      split(polygon, cuts,
            [&](int part, const Piece& p)
            {
              out[part] +=
                  polygon::fan<G>(p.x.data(), p.y.data(), p.size, radius);
            });
    return out;
  }

  double residuals(const Junction& y, double (&r)[conditions]) const
  {
    const auto m = moments(y);
    double sum = 0;
    for (int k = 0; k < 3; ++k)
    {
      const Target& t = targets[k];
      const double w = 1 / (std::sqrt(t.fraction) * all * size);
      const Point off = shape.back({w * (m[k].x - m[k].v * t.centroid.x),
                                    w * (m[k].y - m[k].v * t.centroid.y)});
      r[2 * k] = off.x;
      r[2 * k + 1] = off.y;
      if (k < 2)
        r[6 + k] = heavy * (m[k].v / all - t.fraction);
    }
    for (const double v : r)
      sum += v * v;
    return sum;
  }

  [[nodiscard]] double length(Point from, Point way) const
  {
    double out = 1e300;
    for (int i = 0; i < polygon.size; ++i)
    {
      const Point a = polygon[i], b = polygon[i + 1 < polygon.size ? i + 1 : 0];
      const double slope = cross(b - a, way);
      if (slope < 0)
        out = std::min(out, std::max(0.0, cross(b - a, from - a) / -slope));
    }
    return out < 1e300 ? out : 0;
  }

  /// @param[out] j residuals by place and angles
  void derivatives(const Junction& y, double (&j)[conditions][unknowns]) const
  {
    for (auto& row : j)
      std::fill(row, row + unknowns, 0.0);
    for (int i = 0; i < 3; ++i)
    {
      const Point d = y.ray(i), up = {-d.y, d.x};
      const double l = length(y.at, d);
      double i0 = l, i1 = l * l / 2, i2 = l * l * l / 3;
      if constexpr (G == Geometry::axisymmetric)
      {
        const double w = radius + y.at.x, i3 = i2 * l * 0.75;
        i2 = w * i2 + d.x * i3;
        i1 = w * i1 + d.x * l * l * l / 3;
        i0 = w * i0 + d.x * l * l / 2;
      }
      // What the wedge clockwise of the ray gains: by the ray's turn, and by
      // its move along `up`.
      const Moments turn = {i1, y.at.x * i1 + d.x * i2, y.at.y * i1 + d.y * i2};
      const Moments move = {i0, y.at.x * i0 + d.x * i1, y.at.y * i0 + d.y * i1};
      const auto add =
          [&](int k, double sign, int column, const Moments& m, double by)
      {
        const Target& t = targets[k];
        const double w = sign * by / (std::sqrt(t.fraction) * all * size);
        const Point off = shape.back(
            {w * (m.x - m.v * t.centroid.x), w * (m.y - m.v * t.centroid.y)});
        j[2 * k][column] += off.x;
        j[2 * k + 1][column] += off.y;
        if (k < 2)
          j[6 + k][column] += heavy * sign * by * m.v / all;
      };
      const int gains = y.part[i == 0 ? 2 : i - 1], loses = y.part[i];
      for (const auto& [k, sign] : {std::pair{gains, 1.0}, {loses, -1.0}})
      {
        add(k, sign, 2 + i, turn, 1);
        add(k, sign, 0, move, up.x);
        add(k, sign, 1, move, up.y);
      }
    }
  }

  [[nodiscard]] Junction moved(Junction y, const Step& x, double share) const
  {
    y.at = y.at + share * Point{x[0], x[1]};
    for (int i = 0; i < 3; ++i)
      y.angle[i] += share * x[2 + i];
    return y;
  }

  /// Newton steps of the least length until the volumes are met.
  bool fill(Junction& y) const
  {
    for (int i = 0; i < 8; ++i)
    {
      double r[conditions], j[conditions][unknowns];
      residuals(y, r);
      if (std::abs(r[6]) + std::abs(r[7]) <= 1e-15 * heavy)
        return true;
      derivatives(y, j);
      double aa = 0, ab = 0, bb = 0;
      for (int m = 0; m < unknowns; ++m)
      {
        aa += j[6][m] * j[6][m];
        ab += j[6][m] * j[7][m];
        bb += j[7][m] * j[7][m];
      }
      const double det = aa * bb - ab * ab;
      const double p = (bb * r[6] - ab * r[7]) / det,
                   q = (aa * r[7] - ab * r[6]) / det;
      Step x;
      for (int m = 0; m < unknowns; ++m)
        x[m] = -(p * j[6][m] + q * j[7][m]);
      const Junction next = moved(y, x, 1);
      if (not(std::isfinite(p) and std::isfinite(q)) or not holds(next.at))
        return false;
      y = next;
    }
    double r[conditions];
    residuals(y, r);
    return std::abs(r[6]) + std::abs(r[7]) <= 1e-14 * heavy;
  }

  /// From a start to a minimum.
  /// @param[in] bound what the error must come below: searches that do not
  ///                  come near it soon are given up
  std::optional<Junction> settle(Junction y, double bound) const
  {
    double r[conditions], j[conditions][unknowns];
    double sum = residuals(y, r), damping = 1e-3;
    for (int i = 0; i < 200 and sum > 1e-30; ++i)
    {
      const double error = sum * size * size;
      if (i >= 40 and error > 100 * bound)
        return {};
      derivatives(y, j);
      bool better = false;
      for (int k = 0; k < 16 and not better; ++k, damping *= better ? 1 : 10)
      {
        Step x;
        if (not solve(j, r, damping, x))
          continue;
        double most = 0;
        for (const double v : x)
          most = std::max(most, std::abs(v));
        const Junction next = moved(y, x, most > 0.5 ? 0.5 / most : 1);
        double s[conditions];
        if (not holds(next.at))
          continue;
        if (const double now = residuals(next, s); now < sum)
        {
          better = sum - now > 1e-9 * sum;
          y = next, sum = now;
          std::copy(s, s + conditions, r);
          if (not better)
            break;
        }
      }
      if (not better)
        break;
      damping = std::max(1e-9, 0.05 * damping);
    }
    if (not holds(y.at) or not fill(y))
      return {};
    const auto m = moments(y);
    y.error = 0;
    for (int k = 0; k < 3; ++k)
    {
      if (not(m[k].v > 0))
        return {};
      const Point off = shape.back(m[k].centroid() - targets[k].centroid);
      y.error += targets[k].fraction * dot(off, off);
    }
    return y;
  }
};
} // namespace junction

/// Three wedges for three parts; nothing if none is found.
///
/// @param[in] p       counter-clockwise, measured from a point at `radius`
/// @param[in] whole   volume and first moments of p
/// @param[in] targets fractions of p, centroids
/// @param[in] bound, good_enough errors: what it must come below, and where the
///                    search may end
template <Geometry G>
std::optional<Junction> best_junction(const Piece& p, const Moments& whole,
                                      const std::array<Target, 3>& targets,
                                      double radius, double bound,
                                      double good_enough)
{
  const Round shape(p);
  junction::Problem<G> problem = {{}, 0,       shape.scaled(radius),
                                  0,  targets, shape};
  for (int i = 0; i < p.size; ++i)
    problem.polygon.push(shape.to(p[i]));
  const Piece& q = problem.polygon;
  problem.all =
      polygon::fan<G>(q.x.data(), q.y.data(), q.size, problem.radius).v;
  problem.size = std::sqrt(whole.v / problem.all);
  for (Target& t : problem.targets)
    t.centroid = shape.to(t.centroid);
  Junction start;
  const Point g[3] = {targets[0].centroid, targets[1].centroid,
                      targets[2].centroid};
  if (cross(g[1] - g[0], g[2] - g[0]) < 0)
    start.part = {0, 2, 1};
  const Point mean = 1.0 / 3 * (g[0] + g[1] + g[2]);
  std::optional<Junction> best;
  // From between the centroids, nearer to those of small parts, to each of
  // them, and further from them.
  Point small;
  double sum = 0;
  for (const Target& t : problem.targets)
  {
    small = small + 1 / t.fraction * t.centroid;
    sum += 1 / t.fraction;
  }
  const auto place = [&](int i)
  {
    if (i == 0)
      return 1 / sum * small;
    if (i == 1)
      return mean;
    if (i < 8)
      return mean + (i < 5 ? 0.4 : -0.4) * (g[(i - 2) % 3] - mean);
    // Near vertices and the middles of edges.
    const int k = (i - 8) / 2, l = k + 1 < q.size ? k + 1 : 0;
    const Point edge = i % 2 == 0 ? q[k] : middle(q[k], q[l]);
    return mean + 0.8 * (edge - mean);
  };
  for (int i = 0; i < 8 + 2 * q.size; ++i)
  {
    start.at = place(i);
    if (not problem.holds(start.at))
      continue;
    // Rays half-way between the ways to the centroids beside them.
    double to[3];
    for (int k = 0; k < 3; ++k)
    {
      const Point d = g[start.part[k]] - start.at;
      to[k] = std::atan2(d.y, d.x);
    }
    for (int k = 0; k < 3; ++k)
    {
      const double from = to[k == 0 ? 2 : k - 1];
      double turn = std::remainder(to[k] - from, 2 * std::numbers::pi);
      turn += turn < 0 ? 2 * std::numbers::pi : 0;
      start.angle[k] = from + 0.5 * turn;
    }
    if (const auto y = problem.settle(start, best ? best->error : bound);
        y and (not best or y->error < best->error))
      best = y;
    if (best and best->error <= good_enough)
      break;
  }
  if (best)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Point d = shape.back(best->ray(i));
      best->angle[i] = std::atan2(d.y, d.x);
    }
    best->at = shape.back(best->at);
  }
  return best;
}
} // namespace remap
