// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: three parts that meet in a point, each a wedge (Y junction). Half-
// planes that nest cannot show it. With the point and one ray given, the
// volumes give the other two rays in closed form, so three numbers minimise Σ
// fraction · distance² of the centroids: damped Gauss–Newton steps with
// derivatives in closed form, from the best of a scan.
#pragma once

#include "remap/interfaces/corner.h"
#include "remap/interfaces/partition.h"
#include "remap/interfaces/round.h"
#include "remap/interfaces/sort.h"
#include "remap/interfaces/turning.h"

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
constexpr int unknowns = 3, conditions = 6;

/// A point, one of its rays by where it goes, and what follows from them.
struct Stand
{
  Point at;
  int first = 0;    ///< number of the ray that is given
  double angle = 0; ///< its direction
  std::array<int, 3> part{};
  double error = -1;
  double r[conditions]; ///< root of the fraction · distance of each centroid
  Point ends[3];        ///< of the rays, on the outline
};

template <Geometry G>
struct Problem
{
  Piece polygon;                 ///< in round coordinates, as all places here
  double all, radius;            ///< volume
  std::array<Target, 3> targets; ///< fractions of the polygon
  Round shape;                   ///< back to where distances are measured

  [[nodiscard]] int next(int i) const
  {
    return i + 1 < polygon.size ? i + 1 : 0;
  }

  [[nodiscard]] bool holds(Point p) const
  {
    for (int i = 0; i < polygon.size; ++i)
      if (const Point a = polygon[i], b = polygon[next(i)];
          not(cross(b - a, p - a) > 1e-12 * dot(b - a, b - a)))
        return false;
    return true;
  }

  /// Rays and residuals from the point and the given ray.
  /// @return false if the point is not inside
  bool fill(Stand& y) const
  {
    if (not holds(y.at))
      return false;
    const Point way = {std::cos(y.angle), std::sin(y.angle)};
    double reach = 1e300;
    int edge = 0;
    for (int i = 0; i < polygon.size; ++i)
    {
      const Point a = polygon[i], b = polygon[next(i)];
      const double slope = cross(b - a, way);
      if (const double l = cross(b - a, y.at - a) / -slope;
          slope < 0 and l < reach)
        reach = l, edge = i;
    }
    y.ends[y.first] = y.at + reach * way;
    y.error = 0;
    Point from = y.ends[y.first];
    int walked = 0;
    for (int k = 0; k < 3; ++k)
    {
      const int ray = (y.first + k) % 3, then = (ray + 1) % 3;
      const Target& t = targets[y.part[ray]];
      double left = t.fraction * all;
      Moments m;
      // Triangles between the point and the outline, until the wedge is full;
      // the last ends where the first ray does.
      for (; walked <= polygon.size; ++walked)
      {
        const bool home = walked == polygon.size;
        const Point to = home ? y.ends[y.first] : polygon[next(edge)];
        const Moments here = turning::piece<G>(y.at, from, to, radius);
        if (k < 2 and left <= here.v)
        {
          const double s = turning::share<G>(y.at, from, to, radius, left);
          const Point end = from + s * (to - from);
          m += turning::piece<G>(y.at, from, end, radius);
          y.ends[then] = from = end;
          break;
        }
        m += here;
        left -= here.v;
        from = to;
        edge = next(edge);
      }
      if (k < 2 and walked > polygon.size)
        return false;
      const double v = t.fraction * all;
      const Point off = shape.back(Point{m.x / v, m.y / v} - t.centroid);
      const double w = std::sqrt(t.fraction);
      y.r[2 * ray] = w * off.x;
      y.r[2 * ray + 1] = w * off.y;
      y.error += t.fraction * dot(off, off);
    }
    return std::isfinite(y.error);
  }

  /// Derivatives of the residuals by the point, and by the volume that all
  /// rays sweep; and how the given ray turns with them.
  void derivatives(const Stand& y, double (&j)[conditions][unknowns],
                   double (&turn)[unknowns]) const
  {
    Point gain[3][unknowns]; // of first moments, clockwise of each ray
    for (int i = 0; i < 3; ++i)
    {
      const Point way = y.ends[i] - y.at;
      const double l = std::sqrt(dot(way, way));
      const Point d = 1 / l * way, up = {-d.y, d.x};
      double i0 = l, i1 = l * l / 2, i2 = l * l * l / 3;
      if constexpr (G == Geometry::axisymmetric)
      {
        const double w = radius + y.at.x;
        i0 = w * l + d.x * i1;
        i1 = w * i1 + d.x * i2;
        i2 = w * i2 + d.x * l * l * l * l / 4;
      }
      // A turn sweeps i1, its first moment lies around `pivot`; a move along
      // `up` sweeps i0, and the turn that takes this back.
      const Point pivot = y.at + i2 / i1 * d;
      const Point moved = (i1 - i0 * i2 / i1) * d;
      gain[i][0] = up.x * moved;
      gain[i][1] = up.y * moved;
      gain[i][2] = pivot;
      if (i == y.first)
      {
        turn[0] = -i0 * up.x / i1;
        turn[1] = -i0 * up.y / i1;
        turn[2] = 1 / i1;
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      const Target& t = targets[y.part[i]];
      const double w = std::sqrt(t.fraction) / (t.fraction * all);
      for (int m = 0; m < unknowns; ++m)
      {
        const Point off =
            shape.back(w * (gain[i == 2 ? 0 : i + 1][m] - gain[i][m]));
        j[2 * i][m] = off.x;
        j[2 * i + 1][m] = off.y;
      }
    }
  }

  /// From a start to a minimum.
  void settle(Stand& y, double good_enough) const
  {
    double damping = 1e-3;
    for (int i = 0; i < 100 and y.error > good_enough; ++i)
    {
      // The longest ray is the one to follow.
      for (int k = 0; k < 3; ++k)
        if (const Point a = y.ends[k] - y.at, b = y.ends[y.first] - y.at;
            dot(a, a) > dot(b, b))
          y.first = k;
      const Point way = y.ends[y.first] - y.at;
      y.angle = std::atan2(way.y, way.x);
      double j[conditions][unknowns], turn[unknowns] = {};
      derivatives(y, j, turn);
      const double before = y.error;
      for (int k = 0; k < 12; ++k, damping *= 10)
      {
        double x[unknowns];
        if (not solve(j, y.r, damping, x))
          continue;
        double angle = 0;
        for (int m = 0; m < unknowns; ++m)
          angle += turn[m] * x[m];
        const double most =
            std::max({std::abs(x[0]) / 0.3, std::abs(x[1]) / 0.3,
                      std::abs(angle) / 0.5});
        const double share = most > 1 ? 1 / most : 1;
        Stand trial = y;
        trial.at = y.at + share * Point{x[0], x[1]};
        trial.angle = y.angle + share * angle;
        if (fill(trial) and trial.error < y.error)
        {
          y = trial;
          break;
        }
      }
      if (not(y.error < (1 - 1e-9) * before))
        break;
      damping = std::max(1e-9, 0.05 * damping);
    }
  }

  /// Least squares with damping: (JᵀJ + damping · diag) x = −Jᵀ r.
  static bool solve(const double (&j)[conditions][unknowns],
                    const double (&r)[conditions], double damping,
                    double (&x)[unknowns])
  {
    double a[unknowns][unknowns] = {}, b[unknowns] = {};
    for (int m = 0; m < unknowns; ++m)
      for (int i = 0; i < conditions; ++i)
      {
        for (int n = 0; n < unknowns; ++n)
          a[m][n] += j[i][m] * j[i][n];
        b[m] -= j[i][m] * r[i];
      }
    for (int m = 0; m < unknowns; ++m)
      a[m][m] *= 1 + damping;
    // Cholesky.
    for (int m = 0; m < unknowns; ++m)
    {
      for (int n = 0; n <= m; ++n)
      {
        double sum = a[m][n];
        for (int k = 0; k < n; ++k)
          sum -= a[m][k] * a[n][k];
        if (m != n)
          a[m][n] = sum / a[n][n];
        else if (not(sum > 0))
          return false;
        else
          a[m][m] = std::sqrt(sum);
      }
      for (int k = 0; k < m; ++k)
        b[m] -= a[m][k] * b[k];
      b[m] /= a[m][m];
    }
    for (int m = unknowns - 1; m >= 0; --m)
    {
      for (int k = m + 1; k < unknowns; ++k)
        b[m] -= a[k][m] * b[k];
      x[m] = b[m] /= a[m][m];
    }
    return std::isfinite(x[0]) and std::isfinite(x[1]) and std::isfinite(x[2]);
  }

  /// The best of a scan over points, rays and both ways around.
  int scan(Stand* best, int most) const
  {
    Point small, mean;
    double sum = 0;
    for (const Target& t : targets)
    {
      small = small + 1 / t.fraction * t.centroid;
      sum += 1 / t.fraction;
      mean = mean + 1.0 / 3 * t.centroid;
    }
    small = 1 / sum * small;
    int found = 0;
    const auto look = [&](Point at)
    {
      constexpr int rays = 12;
      for (int k = 0; k < 2 * rays; ++k)
      {
        Stand y;
        y.at = at;
        y.angle = 2 * std::numbers::pi * k / rays;
        y.part = k < rays ? std::array{0, 1, 2} : std::array{0, 2, 1};
        if (not fill(y))
          continue;
        if (found < most)
          best[found++] = y;
        else if (y.error < best[found - 1].error)
          best[found - 1] = y;
        for (int i = found - 1; i > 0 and best[i].error < best[i - 1].error;
             --i)
          std::swap(best[i], best[i - 1]);
      }
    };
    look(mean);
    look(small);
    for (int i = 0; i < 6; ++i)
      look(mean + (i < 3 ? 0.4 : -0.4) * (targets[i % 3].centroid - mean));
    for (int i = 0; i < polygon.size; ++i)
    {
      look(mean + 0.8 * (polygon[i] - mean));
      look(mean + 0.85 * (middle(polygon[i], polygon[next(i)]) - mean));
    }
    return found;
  }
};
} // namespace junction

/// Three wedges for three parts; nothing if there is no such thing.
///
/// @param[in] p           counter-clockwise, measured from a point at `radius`
/// @param[in] targets     fractions of p, centroids
/// @param[in] good_enough an error at which the search may end
template <Geometry G>
std::optional<Junction> best_junction(const Piece& p,
                                      const std::array<Target, 3>& targets,
                                      double radius, double good_enough)
{
  const Round shape(p);
  junction::Problem<G> problem = {{}, 0, shape.scaled(radius), targets, shape};
  for (int i = 0; i < p.size; ++i)
    problem.polygon.push(shape.to(p[i]));
  const Piece& q = problem.polygon;
  problem.all =
      polygon::fan<G>(q.x.data(), q.y.data(), q.size, problem.radius).v;
  for (Target& t : problem.targets)
    t.centroid = shape.to(t.centroid);
  std::array<junction::Stand, 8> stands;
  const int found = problem.scan(stands.data(), 8);
  if (found == 0)
    return {};
  int best = 0;
  // First with distances in round coordinates: in slivers the others tell the
  // search next to nothing across.
  junction::Problem<G> rounded = problem;
  rounded.shape = {};
  for (int i = 0; i < found; ++i)
  {
    junction::Stand y = stands[i];
    if (rounded.fill(y))
    {
      rounded.settle(y, 1e-30);
      if (problem.fill(y) and y.error < stands[i].error)
        stands[i] = y;
    }
    problem.settle(stands[i], good_enough);
    if (stands[i].error < stands[best].error)
      best = i;
    if (stands[best].error <= good_enough)
      break;
  }
  const junction::Stand& y = stands[best];
  Junction out;
  out.at = shape.back(y.at);
  out.part = y.part;
  out.error = y.error;
  for (int i = 0; i < 3; ++i)
  {
    const Point d = shape.back(y.ends[i] - y.at);
    out.angle[i] = std::atan2(d.y, d.x);
  }
  return out;
}
} // namespace remap
