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

/// Least squares over the neighbours of one volume, d from its centroid to
/// theirs: Σ w dx², the slope m of dy over dx, Σ w (dy − m dx)², as 1/…, m,
/// 1/…, then the square of the least distance. Neighbours on a line give the
/// gradient along it, none gives none.
inline void fit(ControlVolumes& cv, std::int32_t i)
{
  constexpr double nearest = 0.05; // of the mean square distance
  double xx = 0, xy = 0, yy = 0, mean = 0;
  const Point c = cv.centroid[i];
  const auto around = (*cv.neighbours)[i];
  for (std::int32_t j : around)
    mean += dot(cv.centroid[j] - c, cv.centroid[j] - c);
  const double near2 =
      nearest * mean
      / static_cast<double>(std::max(around.size(), std::size_t(1)));
  for (std::int32_t j : around)
  {
    const Point d = cv.centroid[j] - c;
    const double w = weight(d, near2);
    xx += w * d.x * d.x;
    xy += w * d.x * d.y;
    yy += w * d.y * d.y;
  }
  const double m = xx > 1e-30 * yy ? xy / xx : 0;
  double rest = yy - m * xy;
  if (rest < 1e-4 * yy)
  {
    // Flat cells cost no more digits than they must.
    rest = 0;
    for (std::int32_t j : around)
    {
      const Point d = cv.centroid[j] - c;
      const double off = d.y - m * d.x;
      rest += weight(d, near2) * off * off;
    }
  }
  const bool line = not(rest > 1e-26 * yy);
  double* out = &cv.fit[std::size_t(4) * i];
  out[0] = xx > 1e-30 * yy ? 1 / (xx * (line ? 1 + m * m : 1.0)) : 0;
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
  for (std::int32_t j : (*cv.neighbours)[i])
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
  for (std::int32_t j : (*cv.neighbours)[i])
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
      for (std::int32_t j : (*cv.beside)[i])
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
  { return i < cv.owned and cv.leaving[i] > 0; };
  for (std::int32_t i : cv.touched)
    if (L::extends ? i < cv.owned : gives(i))
      slope<B>(cv, i, u);
  if constexpr (L::extends)
  {
    for (std::int32_t i : cv.ring)
      if (i < cv.owned)
        slope<B>(cv, i, u);
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
      if (i < 0 or i >= cv.owned)
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
