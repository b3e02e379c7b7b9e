// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: a vector or tensor over one sub-cycle, limited as one, in a
// convex set that its old values at its place and around span, in any frame.
//
// The set is their convex hull: what lies in any convex set (a yield surface)
// stays there. Or it is the smallest ball about their mean that holds them.
// Values that turn on a curved surface have a hull thinner than what they vary
// in a cell: strictly in the hull, conservation leaves order 1; the ball leaves
// order 2, and the host's own law takes back what is left outside its surface.
//
// The donor cell's result is in both: a mean of neighbours. To it the pieces
// add what the linear functions carry more, times the smaller factor of the
// volumes on their two sides. A volume whose sum leaves its set lowers its
// factor; that changes its neighbours' sums, so it is done again until all are
// in. (A limiter of the gradients, as for scalars, must not be used: a value on
// the rim of its hull is no mean of two others, and every piece would have to
// carry the donor's mean.)
// @source after the convex limiting of Guermond, Nazarov, Popov & Tomas (2018)
#pragma once

#include "remap/transport/hull.h"
#include "remap/transport/kernel.h"

namespace remap::kernel
{
/// The part of a way, in [0, 1], that stays in a ball.
/// @param[in] from from the ball's centre
/// @param[in] room radius² − |from|²
template <int N>
double reach_in_ball(const hull::Vector<N>& weights,
                     const hull::Vector<N>& from, const hull::Vector<N>& way,
                     double room)
{
  double a = 0, b = 0;
  for (int k = 0; k < N; ++k)
  {
    a += weights[k] * way[k] * way[k];
    b += weights[k] * from[k] * way[k];
  }
  // The larger root of a t² + 2 b t = room, in the form that does not cancel.
  if (a + 2 * b <= room)
    return 1;
  if (not(room > 0))
    return 0;
  const double root = std::sqrt(b * b + a * room);
  return b > 0 ? room / (b + root) : (root - b) / a;
}

/// One vector of N components with its sets: hulls or balls.
template <int N, bool balls>
struct Convex
{
  ControlVolumes& cv;
  const Block<N>& block;

  /// Donor cell's result, held where scalars hold their bounds.
  [[nodiscard]] double* low(std::int32_t i) const
  {
    return &cv.lo[std::size_t(N) * i];
  }
  /// What the pieces change with their factors, per new volume.
  [[nodiscard]] double* change(std::int32_t i) const
  {
    return &cv.hi[std::size_t(N) * i];
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
      for (std::int32_t j : cv.neighbours[i])
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
      // What held nothing has no set of its own: it gets the donors' means.
      factor(i) = i < cv.first_new ? 1 : 0;
    }
  }

  /// Digits that a result does not have: few more than numbers do not, but
  /// where little is left of a volume.
  [[nodiscard]] double round_off(std::int32_t i) const
  {
    return 1e-13 * std::max(1.0, 0.01 * cv.volume[i] / cv.next[i]);
  }

  /// Part of a way from the donor cell's result that stays in the set.
  [[nodiscard]] double reach(std::int32_t i, const hull::Vector<N>& way) const
  {
    hull::Vector<N> from;
    std::copy_n(low(i), N, from.begin());
    if constexpr (not balls)
      return hull::reach<N>(around(i), from, way,
                            round_off(i) * size_around(i));
    const auto norm2 = [this](const hull::Vector<N>& v)
    {
      double sum = 0;
      for (int k = 0; k < N; ++k)
        sum += block.weights[k] * v[k] * v[k];
      return sum;
    };
    const auto far2 = [&](const hull::Vector<N>& centre)
    {
      double most = 0;
      around(i)(
          [&](const double* u)
          {
            hull::Vector<N> d;
            for (int k = 0; k < N; ++k)
              d[k] = u[k] - centre[k];
            most = std::max(most, norm2(d));
          });
      return most;
    };
    hull::Vector<N> mean{};
    int n = 0;
    around(i)(
        [&](const double* u)
        {
          ++n;
          for (int k = 0; k < N; ++k)
            mean[k] += u[k];
        });
    hull::Vector<N> off;
    for (int k = 0; k < N; ++k)
    {
      mean[k] /= n;
      off[k] = from[k] - mean[k];
    }
    return reach_in_ball<N>(block.weights, off, way, far2(mean) - norm2(off));
  }

  void find_changes() const
  {
    for (std::int32_t i : cv.touched)
      std::fill_n(change(i), N, 0.0);
    const auto add =
        [this](std::int32_t i, double v, const hull::Vector<N>& value)
    {
      for (int k = 0; k < N; ++k)
        change(i)[k] += v / cv.next[i] * value[k];
    };
    each_piece(
        [&](std::int32_t from, std::int32_t to, const auto& value, double all,
            std::int32_t)
        {
          const double v =
              all * std::min(factor(from), to >= 0 ? factor(to) : 1.0);
          add(from, -v, value);
          if (to >= 0)
            add(to, v, value);
        });
  }

  /// Lower the factors of our volumes that leave their sets.
  /// @return did any?
  bool lower_factors(int round) const
  {
    bool any = false;
    for (std::int32_t i : cv.touched)
    {
      // A volume that nothing is left of has no say.
      if (not cv.ours(i) or not(factor(i) > 0)
          or not(cv.next[i] > 1e-12 * cv.volume[i]))
        continue;
      hull::Vector<N> way;
      std::copy_n(change(i), N, way.begin());
      const double part = reach(i, way);
      if (not(part < 1))
        continue;
      any = true;
      // Neighbours that lower theirs change the sum: with a little more room
      // than needed most are in after three rounds, and it must come to an end.
      factor(i) *=
          round < 6 ? 0.999 * part : std::min(part, round < 12 ? 0.5 : 0.0);
    }
    return any;
  }

  /// Add to the donor cell's contents what the factors let through.
  void add_limited() const
  {
    const auto add =
        [this](std::int32_t i, double v, const hull::Vector<N>& value)
    {
      for (int k = 0; k < N; ++k)
        cv.content[std::size_t(N) * i + k] += v * value[k];
    };
    each_piece(
        [&](std::int32_t from, std::int32_t to, const auto& value, double all,
            std::int32_t)
        {
          const double v =
              all * std::min(factor(from), to >= 0 ? factor(to) : 1.0);
          add(from, -v, value);
          if (to >= 0)
            add(to, v, value);
        });
  }

  /// Book a part of what `add_limited` let leave over the boundary.
  void book_limited(double part) const
  {
    for (std::size_t p = 0; p < cv.outer.count; ++p)
    {
      const std::int32_t from = cv.outer.from[p];
      if (from < 0 or not cv.ours(from))
        continue;
      const auto lost =
          std::size_t(way(kind_of(block.kinds, cv.marker[p]), false));
      const double v = part * factor(from) * cv.outer.volume[p];
      const auto value = beyond(cv.outer, p);
      for (int k = 0; k < N; ++k)
        block.entry(cv, from, k)[lost] -= v * value[k];
    }
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
/// @param[in] max   maximum over all ranks
/// @param[in] guard gets the `Convex` with contents and the donor cell's
///                  results; tells which part of the difference may stay
template <int N, bool balls, class Halo, class Max, class Guard>
void transport_convex(ControlVolumes& cv, const Block<N>& block, Halo&& halo,
                      Max&& max, Guard&& guard)
{
  fit_all(cv);
  for (std::int32_t i : cv.touched)
    if (cv.ours(i) and cv.leaving[i] > 0)
      slope<N>(cv, i, block.u);
  halo(std::span(cv.gradient.data(), std::size_t(2) * N * cv.num), 2 * N);
  const Convex<N, balls> convex{cv, block};
  convex.find_low();
  for (int round = 0;; ++round)
  {
    convex.find_changes();
    if (not(max(convex.lower_factors(round) ? 1.0 : 0.0) > 0))
      break;
    halo(std::span(cv.factor.data(), std::size_t(cv.num)), 1);
  }
  convex.add_limited();
  const double part = guard(convex);
  if (part < 1)
    convex.take_back(part);
  convex.book_limited(part);
  put(cv, block.u);
}
} // namespace remap::kernel
