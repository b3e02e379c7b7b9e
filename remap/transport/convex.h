// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.3: a vector or tensor over one sub-cycle, limited as one. Its values
// stay in the convex hull of the old ones at its place and around, in any
// frame, so a convex set that holds all values holds them afterwards.
//
// The donor cell's result is such a value: a mean of neighbours. To it the
// pieces add what the linear functions carry more, each as much as the hulls on
// both its sides allow. (A limiter of the gradients, as for scalars, must not
// be used: a value on the rim of its neighbours' hull, as on a yield surface,
// is no mean of two others, and every piece would have to carry the donor's
// mean.)
// @source after the convex limiting of Guermond, Nazarov, Popov & Tomas (2018)
#pragma once

#include "remap/transport/hull.h"
#include "remap/transport/kernel.h"

namespace remap::kernel
{
/// One vector of N components with its hulls.
template <int N>
struct Convex
{
  ControlVolumes& cv;
  const Block<N>& block;

  /// Donor cell's result, held where scalars hold their bounds.
  [[nodiscard]] double* low(std::int32_t i) const
  {
    return &cv.lo[std::size_t(N) * i];
  }
  /// Volume of all pieces in and out, over the new volume.
  [[nodiscard]] double& exchanged(std::int32_t i) const
  {
    return cv.hi[std::size_t(N) * i];
  }
  /// Distance that counts as none beside a volume's neighbours.
  [[nodiscard]] double& close(std::int32_t i) const
  {
    return cv.hi[std::size_t(N) * i + 1];
  }
  [[nodiscard]] double& factor(std::int32_t i) const { return cv.factor[i]; }

  /// What a piece carries beyond its donor's mean, per volume.
  [[nodiscard]] hull::Vector<N> beyond(const Pieces& pieces,
                                       std::size_t p) const
  {
    const std::int32_t i = pieces.from[p];
    const Point d = pieces.at[p] - cv.centroid[i];
    hull::Vector<N> out;
    for (int k = 0; k < N; ++k)
      out[k] = predict<N>(cv, i, k, d);
    return out;
  }

  /// Calls with every old value at and around a volume.
  [[nodiscard]] auto around(std::int32_t i) const
  {
    return [this, i](const auto& call)
    {
      call(block.u[i]);
      for (std::int32_t j : (*cv.neighbours)[i])
        call(block.u[j]);
    };
  }

  [[nodiscard]] double size_around(std::int32_t i) const
  {
    double most = 0;
    around(i)(
        [&](const double* u)
        {
          double size = 0;
          for (int k = 0; k < N; ++k)
            size += u[k] * u[k];
          most = std::max(most, size);
        });
    return std::sqrt(most);
  }

  /// Calls with every piece: donor, receiver (-1: outside), what it carries
  /// beyond the mean, volume, marker.
  template <class Call>
  void each_piece(const Call& call) const
  {
    for (std::size_t p = 0; p < cv.inner.count; ++p)
      call(cv.inner.from[p], cv.inner.to[p], beyond(cv.inner, p),
           cv.inner.volume[p], -1);
    for (std::size_t p = 0; p < cv.outer.count; ++p)
      if (cv.outer.from[p] >= 0)
        call(cv.outer.from[p], -1, beyond(cv.outer, p), cv.outer.volume[p],
             cv.marker[p]);
  }

  void find_low() const
  {
    carry<false>(cv, block);
    for (std::int32_t i : cv.touched)
    {
      for (int k = 0; k < N; ++k)
        low(i)[k] = cv.content[std::size_t(N) * i + k] / cv.next[i];
      exchanged(i) = 0;
      close(i) = i < cv.owned ? 1e-14 * size_around(i) : 0;
      factor(i) = 1;
    }
    each_piece(
        [this](std::int32_t from, std::int32_t to, const auto&, double v,
               std::int32_t)
        {
          exchanged(from) += v / cv.next[from];
          if (to >= 0)
            exchanged(to) += v / cv.next[to];
        });
  }

  /// A volume's result is a mean, by the pieces' volumes, of what it would be
  /// with each piece alone in the place of all: each of these must fit.
  void find_factors() const
  {
    const auto look =
        [this](std::int32_t i, double sign, const hull::Vector<N>& value)
    {
      if (i < 0 or i >= cv.owned or not(factor(i) > 0))
        return;
      hull::Vector<N> from, way;
      for (int k = 0; k < N; ++k)
      {
        from[k] = low(i)[k];
        way[k] = sign * exchanged(i) * value[k];
      }
      factor(i) =
          std::min(factor(i), hull::reach<N>(around(i), from, way, close(i)));
    };
    each_piece(
        [&look](std::int32_t from, std::int32_t to, const auto& value, double,
                std::int32_t)
        {
          look(from, -1, value);
          look(to, 1, value);
        });
  }

  /// Add to the donor cell's contents what the factors let through.
  /// @return what of that leaves over the boundary, by component
  [[nodiscard]] std::array<Exchange, N> add_limited() const
  {
    std::array<Exchange, N> passed{};
    const auto add =
        [this](std::int32_t i, double v, const hull::Vector<N>& value)
    {
      for (int k = 0; k < N; ++k)
        cv.content[std::size_t(N) * i + k] += v * value[k];
    };
    each_piece(
        [&](std::int32_t from, std::int32_t to, const auto& value, double all,
            std::int32_t marker)
        {
          const double v =
              all * std::min(factor(from), to >= 0 ? factor(to) : 1.0);
          add(from, -v, value);
          if (to >= 0)
            return add(to, v, value);
          const auto lost =
              std::size_t(way(kind_of(block.kinds, marker), false));
          for (int k = 0; from < cv.owned and k < N; ++k)
            passed[k][lost] -= v * value[k];
        });
    return passed;
  }

  /// Take back all but a part of what was added.
  void take_back(double part) const
  {
    for (std::int32_t i : cv.touched)
      for (int k = 0; k < N; ++k)
      {
        double& content = cv.content[std::size_t(N) * i + k];
        const double least = low(i)[k] * cv.next[i];
        content = least + part * (content - least);
      }
  }
};

/// A vector or tensor of N components, limited as one, but for the halo of its
/// new values. See `prepare`.
/// @param[in] guard gets the `Convex` with contents and the donor cell's
///                  results; tells which part of the difference may stay
template <int N, class Halo, class Guard>
void transport_convex(ControlVolumes& cv, const Block<N>& block, Halo&& halo,
                      Guard&& guard)
{
  for (std::int32_t i : cv.touched)
    if (i < cv.owned and cv.leaving[i] > 0)
      slope<N>(cv, i, block.u);
  halo(std::span(cv.gradient.data(), std::size_t(2) * N * cv.num), 2 * N);
  const Convex<N> convex{cv, block};
  convex.find_low();
  convex.find_factors();
  halo(std::span(cv.factor.data(), std::size_t(cv.num)), 1);
  const auto passed = convex.add_limited();
  const double part = guard(convex);
  if (part < 1)
    convex.take_back(part);
  for (int k = 0; k < N; ++k)
    for (std::size_t w = 0; w < num_ways; ++w)
      block.book[k][w] += part * passed[k][w];
  put(cv, block.u);
}
} // namespace remap::kernel
