// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3: one field over one sub-cycle. In: volumes with their pieces; out:
// new means. Conserved: Σ mean · volume, up to what the ledger books.
//
// Bounds. With every piece's value and the value of what remains taken from one
// limited linear function, the new mean is
//   u⁺V⁺ = u(c_rem) V_rem + Σ_in v_j u_j,   V⁺ = V_rem + Σ_in v_j,
// c_rem the centroid of the old region minus what left. It is a mean of bounded
// values as long as V_rem = V⁻ − Σ_out v > 0. So two things keep the bounds:
// the limiter looks at the centroids of all leaving pieces and at c_rem, and no
// volume loses all of itself in one sub-cycle (`max_loss` < 1).
#pragma once

#include "remap/host.h"
#include "remap/transport/control_volumes.h"
#include "remap/transport/field.h"

#include <algorithm>

namespace remap::kernel
{
/// Inverse of Σ d dᵀ over the neighbours of one volume; d joins centroids.
/// Neighbours on a line give the gradient along it, none gives none.
inline void fit(ControlVolumes& cv, std::int32_t i)
{
  double xx = 0, xy = 0, yy = 0;
  const Point c = cv.centroid[i];
  for (std::int32_t j : (*cv.neighbours)[i])
  {
    const Point d = cv.centroid[j] - c;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  double* out = &cv.fit[std::size_t(3) * i];
  const double trace = xx + yy;
  const double det = xx * yy - xy * xy;
  // Aspect ratios to 1e6 stay regular; beyond, det is round-off of trace².
  const bool regular = det > 1e-13 * trace * trace;
  const double s = regular ? 1 / det : (trace > 0 ? 1 / (trace * trace) : 0);
  out[0] = s * (regular ? yy : xx);
  out[1] = s * (regular ? -xy : xy);
  out[2] = s * (regular ? xx : yy);
}

/// Smallest factor over all places where a value of volume i will be taken.
template <class Limiter>
double factor(const ControlVolumes& cv, std::int32_t i, Point g, double lo,
              double hi)
{
  const Point c = cv.centroid[i];
  double phi = 1;
  Point away{};
  for (std::int32_t k = cv.first[i]; k >= 0; k = cv.pieces[k].next)
  {
    const Piece& p = cv.pieces[k];
    const Point d = p.at - c;
    phi = std::min(phi, Limiter::factor(dot(g, d), lo, hi));
    away = away + p.volume * d;
  }
  const double rest = cv.volume[i] - cv.leaving[i];
  const Point remains = (-1 / rest) * away;
  return std::min(phi, Limiter::factor(dot(g, remains), lo, hi));
}

/// Limited gradient of one volume. NC components, or `nc` if NC is 0.
template <class Scheme, int NC>
void gradient(ControlVolumes& cv, std::int32_t i, const double* u, int nc,
              int group)
{
  const int n = NC > 0 ? NC : nc;
  double* g = &cv.gradient[std::size_t(2) * n * i];
  const double* own = &u[std::size_t(n) * i];
  const auto neighbours = (*cv.neighbours)[i];
  const double* a = &cv.fit[std::size_t(3) * i];
  const Point c = cv.centroid[i];
  for (int first = 0; first < n; first += group)
  {
    double phi = 1;
    for (int k = first; k < first + group; ++k)
    {
      double bx = 0, by = 0, lo = 0, hi = 0;
      for (std::int32_t j : neighbours)
      {
        const Point d = cv.centroid[j] - c;
        const double du = u[std::size_t(n) * j + k] - own[k];
        bx += d.x * du;
        by += d.y * du;
        lo = std::min(lo, du);
        hi = std::max(hi, du);
      }
      const Point slope = {a[0] * bx + a[1] * by, a[1] * bx + a[2] * by};
      g[2 * k] = slope.x;
      g[2 * k + 1] = slope.y;
      if constexpr (Scheme::bounded)
        phi = std::min(phi,
                       factor<typename Scheme::limiter>(cv, i, slope, lo, hi));
    }
    if constexpr (Scheme::bounded)
      for (int k = 2 * first; k < 2 * (first + group); ++k)
        g[k] *= phi;
  }
}

/// Which way a piece over the boundary goes in the book.
inline Way way(Boundary kind, bool inwards)
{
  switch (kind)
  {
  case Boundary::free_surface:
    return inwards ? Way::gained : Way::lost;
  case Boundary::open:
    return inwards ? Way::inflow : Way::outflow;
  case Boundary::closed:
    break;
  }
  return Way::closed;
}

/// What a boundary with some marker does; without a marker it is closed.
inline Boundary kind_of(std::span<const Boundary> kinds, std::int32_t marker)
{
  return marker >= 0 and marker < static_cast<std::int32_t>(kinds.size())
             ? kinds[marker]
             : Boundary::closed;
}

/// Carry one piece: content of its donor falls, content of its receiver rises.
template <class Scheme, int NC>
void carry(ControlVolumes& cv, const Piece& p, const Field& field,
           std::span<const Boundary> kinds, std::span<Exchange> book)
{
  const int n = NC > 0 ? NC : field.components;
  const double* u = field.values.data();
  if (p.from >= 0)
  {
    const double* own = u + std::size_t(n) * p.from;
    double* out = &cv.content[std::size_t(n) * p.from];
    double* in = p.to >= 0 ? &cv.content[std::size_t(n) * p.to] : nullptr;
    const Point d = p.at - cv.centroid[p.from];
    for (int k = 0; k < n; ++k)
    {
      double value = own[k];
      if constexpr (Scheme::linear)
      {
        const double* g = &cv.gradient[2 * (std::size_t(n) * p.from + k)];
        value += g[0] * d.x + g[1] * d.y;
      }
      const double amount = p.volume * value;
      out[k] -= amount;
      if (in)
        in[k] += amount;
      else if (p.from < cv.owned)
        book[k][std::size_t(way(kind_of(kinds, p.marker), false))] -= amount;
    }
    return;
  }
  const Boundary kind = kind_of(kinds, p.marker);
  const double* given = kind == Boundary::open
                            ? &field.inflow[std::size_t(n) * p.marker]
                            : u + std::size_t(n) * p.to;
  double* in = &cv.content[std::size_t(n) * p.to];
  for (int k = 0; k < n; ++k)
  {
    const double amount = p.volume * given[k];
    in[k] += amount;
    if (p.to < cv.owned)
      book[k][std::size_t(way(kind, true))] += amount;
  }
}

/// One field over one sub-cycle, but for the halo of its new values.
///
/// @param[in,out] cv     volumes, pieces, and room for gradient and content
/// @param[in,out] field  means
/// @param[in]     kinds  what each boundary marker does
/// @param[in,out] book   one entry a component
/// @param[in]     halo   fills ghosts of a gradient: halo(values, block)
template <class Scheme, int NC, class Halo>
void transport(ControlVolumes& cv, const Field& field,
               std::span<const Boundary> kinds, std::span<Exchange> book,
               Halo&& halo)
{
  const int n = NC > 0 ? NC : field.components;
  double* u = field.values.data();
  if constexpr (Scheme::linear)
  {
    for (std::int32_t i : cv.touched)
      if (i < cv.owned and cv.first[i] >= 0)
        gradient<Scheme, NC>(cv, i, u, n, field.group);
    halo(std::span(cv.gradient.data(), std::size_t(2) * n * cv.num), 2 * n);
  }
  for (std::int32_t i : cv.touched)
    for (int k = 0; k < n; ++k)
      cv.content[std::size_t(n) * i + k] =
          cv.volume[i] * u[std::size_t(n) * i + k];
  for (const Piece& p : cv.pieces)
    carry<Scheme, NC>(cv, p, field, kinds, book);
  for (std::int32_t i : cv.touched)
    if (i < cv.owned)
      for (int k = 0; k < n; ++k)
        u[std::size_t(n) * i + k] =
            cv.content[std::size_t(n) * i + k] / cv.next[i];
}
} // namespace remap::kernel
