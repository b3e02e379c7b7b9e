// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: one field over one sub-cycle. In: volumes with their pieces; out:
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
#include "remap/transport/field.h"
#include "remap/transport/gradient.h"

namespace remap::kernel
{
/// Where a block of B components of a field stands, and what the outside does.
template <int B>
struct Block
{
  Values<B> u;
  const double* least = nullptr;   ///< range, or null
  const double* most = nullptr;    ///< as least
  const double* inflow = nullptr;  ///< row of the first marker, or null
  std::array<double, B> weights{}; ///< of a vector's components in its length
  std::span<const Boundary> kinds;
  /// Entries of this block's first component and those behind it; a row of
  /// components for each kind of volume.
  std::span<Exchange> book;

  /// What comes in at an open boundary.
  [[nodiscard]] const double* given(std::int32_t marker) const
  {
    return inflow + u.stride * static_cast<std::size_t>(marker);
  }
  /// Where component k of what volume i exchanges with the outside is booked.
  [[nodiscard]] Exchange& entry(const ControlVolumes& cv, std::int32_t i,
                                int k) const
  {
    return book[u.stride * cv.kind(i) + static_cast<std::size_t>(k)];
  }
};

/// Carry what passes the boundary, at the donor's linear function if `linear`.
template <bool linear, int B>
void carry_outer(ControlVolumes& cv, const Block<B>& block)
{
  for (std::size_t p = 0; p < cv.outer.count; ++p)
  {
    const std::int32_t from = cv.outer.from[p], to = cv.outer.to[p];
    const bool in = from < 0;
    const std::int32_t own = in ? to : from;
    const Boundary kind = kind_of(block.kinds, cv.marker[p]);
    const double* value = in and kind == Boundary::open
                              ? block.given(cv.marker[p])
                              : block.u[own];
    const double v = in ? cv.outer.volume[p] : -cv.outer.volume[p];
    const Point d = cv.outer.at[p] - cv.centroid[own];
    for (int k = 0; k < B; ++k)
    {
      double amount = v * value[k];
      if constexpr (linear)
        if (not in)
          amount += v * predict<B>(cv, from, k, d);
      cv.content[std::size_t(B) * own + k] += amount;
      if (cv.ours(own))
        block.entry(cv, own, k)[std::size_t(way(kind, in))] += amount;
    }
  }
}

/// Contents after the sub-cycle: what was there and what the pieces carry.
template <bool linear, int B>
void carry(ControlVolumes& cv, const Block<B>& block)
{
  for (std::int32_t i : cv.touched)
    for (int k = 0; k < B; ++k)
      cv.content[std::size_t(B) * i + k] = cv.volume[i] * block.u[i][k];
  const Pieces& pieces = cv.inner;
  for (std::size_t p = 0; p < pieces.count; ++p)
  {
    const std::int32_t from = pieces.from[p];
    const double v = pieces.volume[p];
    const double* own = block.u[from];
    double* out = &cv.content[std::size_t(B) * from];
    double* in = &cv.content[std::size_t(B) * pieces.to[p]];
    for (int k = 0; k < B; ++k)
    {
      double value = own[k];
      if constexpr (linear)
        value += predict<B>(cv, from, k, pieces.at[p] - cv.centroid[from]);
      out[k] -= v * value;
      in[k] += v * value;
    }
  }
  carry_outer<linear>(cv, block);
}

/// Contents to means, of our volumes.
template <int B>
void put(const ControlVolumes& cv, Values<B> u)
{
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      const double inverse = 1 / cv.next[i];
      for (int k = 0; k < B; ++k)
        u[i][k] = cv.content[std::size_t(B) * i + k] * inverse;
    }
}

/// Least squares of all volumes that give something away, if not done yet.
inline void fit_all(ControlVolumes& cv)
{
  if (cv.fitted != cv.nobody)
    return;
  for (std::int32_t i : cv.touched)
    if (cv.ours(i) and cv.leaving[i] > 0)
      fit(cv, i);
  cv.fitted = cv.donors;
}

/// Gradients of B components, each limited by itself, ghosts included.
///
/// @param[in,out] cv    volumes with pieces
/// @param[in]     block where means stand
/// @param[in]     halo  fills ghosts: halo(values, block)
template <class Scheme, int B, class Halo>
void prepare(ControlVolumes& cv, const Block<B>& block, Halo&& halo)
{
  if constexpr (Scheme::linear)
  {
    limited_slopes<typename Scheme::limiter>(cv, block.u, block.least,
                                             block.most, halo);
    halo(std::span(cv.gradient.data(), std::size_t(2) * B * cv.num), 2 * B);
  }
}
} // namespace remap::kernel
