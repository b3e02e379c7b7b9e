// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/transport/carrier.h"

#include "remap/transport/convex.h"

#include <cmath>

using namespace remap;

namespace
{
constexpr int widest_scalars = 4;

/// Call with a number of components as a constant.
template <int most, class F>
void with_components(int n, F&& call)
{
  if constexpr (most > 0)
  {
    if (n == most)
      return call(std::integral_constant<int, most>{});
    with_components<most - 1>(n, std::forward<F>(call));
  }
}

/// Components [first, first + B) of a field.
template <int B>
kernel::Block<B> block_of(const Field& field, const Travel& travel,
                          std::span<Exchange> book, int first)
{
  const auto at = [first](std::span<const double> all)
  { return all.empty() ? nullptr : all.data() + first; };
  std::array<double, B> weights;
  weights.fill(1);
  if (field.weights.size() == B)
    std::copy_n(field.weights.begin(), B, weights.begin());
  return {.u = {field.values.data() + first,
                static_cast<std::size_t>(field.components)},
          .least = at(field.least),
          .most = at(field.most),
          .inflow = at(field.inflow),
          .weights = weights,
          .kinds = travel.boundaries,
          .book = book.subspan(first)};
}

/// What each piece takes of a field whose gradients are ready.
template <bool linear>
void note_amounts(const ControlVolumes& cv, const kernel::Block<1>& block,
                  Amounts& out)
{
  const auto value = [&](std::int32_t from, Point at)
  {
    double u = *block.u[from];
    if constexpr (linear)
      u += kernel::predict<1>(cv, from, 0, at - cv.centroid[from]);
    return u;
  };
  for (std::size_t p = 0; p < cv.inner.count; ++p)
    out.inner[p] = cv.inner.volume[p] * value(cv.inner.from[p], cv.inner.at[p]);
  for (std::size_t p = 0; p < cv.outer.count; ++p)
  {
    const std::int32_t from = cv.outer.from[p], to = cv.outer.to[p];
    const bool open = kind_of(block.kinds, cv.marker[p]) == Boundary::open;
    const double u = from >= 0 ? value(from, cv.outer.at[p])
                     : open    ? *block.given(cv.marker[p])
                               : *block.u[to];
    out.outer[p] = cv.outer.volume[p] * u;
  }
}

/// Part of the correction to the donor cell's velocities that leaves no more
/// kinetic energy than there was, with what passed the boundary. The donor
/// cell's never has more, because its velocities are means; with a part t of
/// the correction the energy is E_L + b t + a t².
template <int N, bool balls>
double kinetic_part(const kernel::Convex<N, balls>& convex, const Host& host)
{
  ControlVolumes& cv = convex.cv;
  const auto half_square = [](const double* v)
  {
    double e = 0;
    for (int k = 0; k < N; ++k)
      e += 0.5 * v[k] * v[k];
    return e;
  };
  double room = 0, a = 0, b = 0;
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      room += cv.volume[i] * half_square(convex.block.u[i])
              - cv.next[i] * half_square(convex.low(i));
      for (int k = 0; k < N; ++k)
      {
        const double low = convex.low(i)[k];
        const double more =
            cv.content[std::size_t(N) * i + k] - cv.next[i] * low;
        b += more * low;
        a += 0.5 * more * more / cv.next[i];
      }
    }
  for (std::size_t p = 0; p < cv.outer.count; ++p)
  {
    const std::int32_t from = cv.outer.from[p], to = cv.outer.to[p];
    const std::int32_t own = from >= 0 ? from : to;
    if (not cv.ours(own))
      continue;
    const bool given =
        from < 0
        and kind_of(convex.block.kinds, cv.marker[p]) == Boundary::open;
    const double* v =
        given ? convex.block.given(cv.marker[p]) : convex.block.u[own];
    room += (from < 0 ? 1 : -1) * cv.outer.volume[p] * half_square(v);
  }
  double all[3] = {room, a, b};
  host.sum(all);
  room = std::max(all[0], 0.0);
  if (all[1] + all[2] <= room)
    return 1;
  // The larger root of a t² + b t = room, in the form that does not cancel.
  const double root = std::sqrt(all[2] * all[2] + 4 * all[1] * room);
  const double t =
      all[2] > 0 ? 2 * room / (all[2] + root) : (root - all[2]) / (2 * all[1]);
  return std::min(std::max(t, 0.0), 1.0);
}

/// One group that is limited as one.
template <int N, bool balls>
double carry_convex(ControlVolumes& cv, const kernel::Block<N>& block,
                    const Travel& travel)
{
  double part = 1;
  kernel::transport_convex<N, balls>(
      cv, block, travel.halo, [&](double v) { return travel.host.max(v); },
      [&](const kernel::Convex<N, balls>& convex)
      {
        return part = travel.kinetic ? kinetic_part(convex, travel.host) : 1.0;
      });
  return part;
}

template <class S>
double carry_with(ControlVolumes& cv, const Field& field, const Travel& travel,
                  std::span<Exchange> book)
{
  double part = 1;
  if (S::linear and S::bounded and field.group > 1)
  {
    for (int first = 0; first < field.components; first += field.group)
      with_components<largest_group>(
          field.group,
          [&]<int N>(std::integral_constant<int, N>)
          {
            if constexpr (N > 1)
            {
              const auto block = block_of<N>(field, travel, book, first);
              const bool ball =
                  S::limiter::extends or field.bound == Bound::ball;
              part = std::min(part,
                              ball ? carry_convex<N, true>(cv, block, travel)
                                   : carry_convex<N, false>(cv, block, travel));
            }
          });
    return part;
  }
  for (int first = 0; first < field.components; first += widest_scalars)
    with_components<widest_scalars>(
        std::min(field.components - first, widest_scalars),
        [&]<int B>(std::integral_constant<int, B>)
        {
          const auto block = block_of<B>(field, travel, book, first);
          kernel::prepare<S>(cv, block, travel.halo);
          if constexpr (B == 1)
            if (travel.amounts)
              note_amounts<S::linear>(cv, block, *travel.amounts);
          kernel::carry<S::linear>(cv, block);
          kernel::put(cv, block.u);
        });
  return part;
}
} // namespace

bool remap::looks_at_sides(const Scheme& scheme)
{
  return std::visit([]<class S>(const S&) { return S::limiter::sides; },
                    scheme);
}

int remap::rings_of(const Scheme& scheme)
{
  return std::visit([]<class S>(const S&)
                    { return S::linear ? (S::limiter::extends ? 2 : 1) : 0; },
                    scheme);
}

int remap::widest_block(int components)
{
  return std::min(components, std::max(widest_scalars, largest_group));
}

double remap::carry_field(ControlVolumes& cv, const Field& field,
                          const Travel& travel, std::span<Exchange> book)
{
  const double part = std::visit(
      [&]<class S>(const S&) { return carry_with<S>(cv, field, travel, book); },
      travel.scheme);
  if (travel.fill_ghosts)
    travel.halo(field.values, field.components);
  return part;
}
