// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: least-squares gradients of B neighbouring components of a field,
// the bounds that the neighbours set, and the factors that keep them. In: means
// over volumes; out: ControlVolumes::gradient, shape (num, B, 2), lo, hi,
// factor, shape (num, B).
#pragma once

#include "remap/transport/control_volumes.h"

#include <algorithm>
#include <array>
#include <limits>

namespace remap::kernel
{
/// B components of a field that start at `u`, one volume every `stride`.
template <int B>
struct Values
{
  double* u;
  std::size_t stride;

  [[nodiscard]] double* operator[](std::int32_t i) const
  {
    return u + stride * static_cast<std::size_t>(i);
  }
};

/// Weight of a neighbour at distance d in the least squares: 1 / |d|⁴. The
/// nearest, across facets, count most, which keeps jumps steep; the others
/// round them off. (With |d|⁻² smooth fields and jumps both come out worse,
/// with |d|⁻⁶ smooth fields become stairs: the cyclic remap tells.) No nearer
/// than `near2`: in flat cells the round-off of centroids would speak.
inline double weight(Point d, double near2)
{
  const double d2 = std::max(dot(d, d), near2);
  return 1 / (d2 * d2);
}

/// What one pass over the neighbours of a volume gathers, d from its centroid
/// to theirs: the spread of places and, for B components, of values.
template <int B>
struct Gathered
{
  double xx = 0, xy = 0, yy = 0; ///< Σ w dx², Σ w dx dy, Σ w dy²
  double nearest = std::numeric_limits<double>::max(); ///< least d²
  double square = 0;                                   ///< Σ d²
  double x[B + 1] = {}, y[B + 1] = {};                 ///< Σ w dx du, Σ w dy du
  double lo[B + 1] = {}, hi[B + 1] = {}; ///< largest fall and rise

  Gathered(const ControlVolumes& cv, std::int32_t i, double near2,
           Values<B> u = {})
  {
    double own[B + 1];
    if constexpr (B > 0)
      std::copy_n(u[i], B, own);
    const Point c = cv.centroid[i];
    for (std::int32_t j : cv.neighbours[i])
    {
      const Point d = cv.centroid[j] - c;
      const double d2 = dot(d, d);
      const double w = weight(d, near2);
      nearest = std::min(nearest, d2);
      square += d2;
      const Point wd = w * d;
      xx += wd.x * d.x;
      xy += wd.x * d.y;
      yy += wd.y * d.y;
      for (int k = 0; k < B; ++k)
      {
        const double du = u[j][k] - own[k];
        x[k] += wd.x * du;
        y[k] += wd.y * du;
        lo[k] = std::min(lo[k], du);
        hi[k] = std::max(hi[k], du);
      }
    }
  }
};

/// Nearest neighbours that count in full, of the mean square distance.
inline constexpr double nearest_part = 0.05;
/// Below this part of Σ w dy² the rest beside the slope is found anew, by
/// differences: flat cells cost no more digits than they must.
inline constexpr double flat_part = 1e-4;

/// Least squares over the neighbours of one volume: Σ w dx², the slope m of dy
/// over dx, Σ w (dy − m dx)², as 1/…, m, 1/…, then the square of the least
/// distance. Neighbours on a line give the gradient along it, none gives none.
inline void fit(ControlVolumes& cv, std::int32_t i)
{
  const auto around = cv.neighbours[i];
  double near2 = 0;
  Gathered<0> s(cv, i, near2);
  if (const double mean = s.square / static_cast<double>(around.size());
      s.nearest < nearest_part * mean)
  {
    near2 = nearest_part * mean;
    s = Gathered<0>(cv, i, near2);
  }
  const double m = s.xx > 1e-30 * s.yy ? s.xy / s.xx : 0;
  double rest = s.yy - m * s.xy;
  if (rest < flat_part * s.yy)
  {
    rest = 0;
    for (std::int32_t j : around)
    {
      const Point d = cv.centroid[j] - cv.centroid[i];
      const double off = d.y - m * d.x;
      rest += weight(d, near2) * off * off;
    }
  }
  const bool line = not(rest > 1e-26 * s.yy);
  double* out = &cv.fit[std::size_t(4) * i];
  out[0] = s.xx > 1e-30 * s.yy ? 1 / (s.xx * (line ? 1 + m * m : 1.0)) : 0;
  out[1] = m;
  out[2] = line ? 0 : 1 / rest;
  out[3] = near2;
}

/// Gradient of one volume, not limited, with the fall and the rise to its
/// neighbours.
template <int B>
void slope(ControlVolumes& cv, std::int32_t i, Values<B> u)
{
  double bx[B] = {}, by[B] = {}, lo[B] = {}, hi[B] = {}, own[B];
  const double* a = &cv.fit[std::size_t(4) * i];
  std::copy_n(u[i], B, own);
  const Point c = cv.centroid[i];
  for (std::int32_t j : cv.neighbours[i])
  {
    const Point d = cv.centroid[j] - c;
    const double w = weight(d, a[3]);
    const Point wd = {w * d.x, w * (d.y - a[1] * d.x)};
    const double* other = u[j];
    for (int k = 0; k < B; ++k)
    {
      const double du = other[k] - own[k];
      bx[k] += wd.x * du;
      by[k] += wd.y * du;
      lo[k] = std::min(lo[k], du);
      hi[k] = std::max(hi[k], du);
    }
  }
  const std::size_t at = std::size_t(B) * i;
  for (int k = 0; k < B; ++k)
  {
    const double gy = a[2] * by[k];
    const double gx = a[0] * bx[k] - a[1] * gy;
    cv.gradient[2 * (at + k)] = gx;
    cv.gradient[2 * (at + k) + 1] = a[2] > 0 ? gy : a[1] * gx;
    cv.lo[at + k] = lo[k];
    cv.hi[at + k] = hi[k];
  }
}

/// Both in one pass, for the first field: where cells are flat, in two.
template <int B>
void fit_and_slope(ControlVolumes& cv, std::int32_t i, Values<B> u)
{
  const Gathered<B> s(cv, i, 0, u);
  const auto number = static_cast<double>(cv.neighbours[i].size());
  const double m = s.xy / s.xx;
  const double rest = s.yy - m * s.xy;
  if (not(s.nearest * number >= nearest_part * s.square
          and rest > flat_part * s.yy and s.xx >= flat_part * s.yy))
  {
    fit(cv, i);
    return slope<B>(cv, i, u);
  }
  double* out = &cv.fit[std::size_t(4) * i];
  out[0] = 1 / s.xx;
  out[1] = m;
  out[2] = 1 / rest;
  out[3] = 0;
  const std::size_t at = std::size_t(B) * i;
  for (int k = 0; k < B; ++k)
  {
    const double gy = out[2] * (s.y[k] - m * s.x[k]);
    cv.gradient[2 * (at + k)] = out[0] * s.x[k] - m * gy;
    cv.gradient[2 * (at + k) + 1] = gy;
    cv.lo[at + k] = s.lo[k];
    cv.hi[at + k] = s.hi[k];
  }
}

/// Change that component k of volume i's linear function predicts over d.
template <int B>
double predict(const ControlVolumes& cv, std::int32_t i, int k, Point d)
{
  const double* g = &cv.gradient[2 * (std::size_t(B) * i + k)];
  return g[0] * d.x + g[1] * d.y;
}

/// Change that all neighbours' own linear functions predict at a place d from
/// the centroid of volume i: at least, and at most, so much. At a maximum of a
/// smooth field every neighbour's tangent passes above it, in a volume on the
/// boundary every neighbour foresees the same; beside a jump a neighbour on the
/// flat side says no. Needs their gradients, not limited.
template <int B>
std::array<double, 2> foresee(const ControlVolumes& cv, std::int32_t i, int k,
                              Point d, Values<B> u)
{
  const Point at = cv.centroid[i] + d;
  double least = 0, most = 0;
  bool first = true;
  for (std::int32_t j : cv.neighbours[i])
  {
    const double change =
        u[j][k] - u[i][k] + predict<B>(cv, j, k, at - cv.centroid[j]);
    least = first ? change : std::min(least, change);
    most = first ? change : std::max(most, change);
    first = false;
  }
  return {least, most};
}

/// What limits one field: means, gradients, and the range it may not leave.
template <class L, int B>
struct Limits
{
  const ControlVolumes& cv;
  Values<B> u;
  const double* least; ///< of each component, or null
  const double* most;

  /// Factor for component k of volume i at a place d from its centroid.
  [[nodiscard]] double place(std::int32_t i, int k, Point d) const
  {
    const std::size_t at = std::size_t(B) * i + k;
    const double change = raw(at, d);
    const double factor = L::place(change, cv.lo[at], cv.hi[at]);
    if constexpr (L::extends)
      if (factor < 1)
        return extended(i, k, d, change);
    return factor;
  }

  /// Prediction of the gradient before any factor.
  [[nodiscard]] double raw(std::size_t at, Point d) const
  {
    return cv.gradient[2 * at] * d.x + cv.gradient[2 * at + 1] * d.y;
  }

  /// With the bounds moved as far as all neighbours foresee.
  [[nodiscard]] double extended(std::int32_t i, int k, Point d,
                                double change) const
  {
    const std::size_t at = std::size_t(B) * i + k;
    const auto [low, high] = foresee<B>(cv, i, k, d, u);
    double lo = std::min(cv.lo[at], high);
    double hi = std::max(cv.hi[at], low);
    if (least)
      lo = std::max(lo, std::min(0.0, least[k] - u[i][k]));
    if (most)
      hi = std::min(hi, std::max(0.0, most[k] - u[i][k]));
    return L::place(change, lo, hi);
  }

  /// Smallest factor of what remains and of the sides.
  [[nodiscard]] double inside(std::int32_t i, int k) const
  {
    double factor = place(i, k, cv.remains[i]);
    if constexpr (L::sides)
    {
      const std::size_t at = std::size_t(B) * i + k;
      for (std::int32_t j : cv.beside[i])
        factor =
            std::min(factor, L::side(raw(at, cv.centroid[j] - cv.centroid[i]),
                                     u[j][k] - u[i][k], cv.lo[at], cv.hi[at]));
    }
    return factor;
  }
};

/// Gradients of all volumes that give something away, limited. Ghosts are not
/// filled.
///
/// @param[in] halo fills ghosts of a gradient: halo(values, block)
template <class L, int B, class Halo>
void limited_slopes(ControlVolumes& cv, Values<B> u, const double* least,
                    const double* most, Halo&& halo)
{
  const auto gives = [&cv](std::int32_t i)
  { return cv.ours(i) and cv.leaving[i] > 0; };
  constexpr auto wanted =
      L::extends ? ControlVolumes::everybody : ControlVolumes::donors;
  const bool first = cv.fitted < wanted;
  const auto find = [&](std::int32_t i)
  { first ? fit_and_slope<B>(cv, i, u) : slope<B>(cv, i, u); };
  cv.fitted = std::max(cv.fitted, wanted);
  for (std::int32_t i : cv.touched)
    if (L::extends ? cv.ours(i) : gives(i))
      find(i);
  if constexpr (L::extends)
  {
    for (std::int32_t i : cv.ring)
      if (cv.ours(i))
        find(i);
    halo(std::span(cv.gradient.data(), std::size_t(2) * B * cv.num), 2 * B);
  }
  const Limits<L, B> limits{cv, u, least, most};
  for (std::int32_t i : cv.touched)
    if (gives(i))
      for (int k = 0; k < B; ++k)
        cv.factor[std::size_t(B) * i + k] = limits.inside(i, k);
  const auto look = [&](const Pieces& pieces)
  {
    for (std::size_t p = 0; p < pieces.count; ++p)
    {
      const std::int32_t i = pieces.from[p];
      if (i < 0 or not cv.ours(i))
        continue;
      const Point d = pieces.at[p] - cv.centroid[i];
      for (int k = 0; k < B; ++k)
      {
        double& factor = cv.factor[std::size_t(B) * i + k];
        factor = std::min(factor, limits.place(i, k, d));
      }
    }
  };
  look(cv.inner);
  look(cv.outer);
  for (std::int32_t i : cv.touched)
    if (gives(i))
      for (std::size_t k = std::size_t(B) * i; k < std::size_t(B) * (i + 1);
           ++k)
      {
        cv.gradient[2 * k] *= cv.factor[k];
        cv.gradient[2 * k + 1] *= cv.factor[k];
      }
}
} // namespace remap::kernel
