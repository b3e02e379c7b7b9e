// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Slots that nearly all has left: what little they hold is a difference of
// large numbers, so its mean is held between what was there and around, and
// what came. What that changes of an integral is the round-off of what was
// there.

#include "remap/materials/transport.h"
#include "remap/transport/hull.h"

#include <algorithm>
#include <cmath>

using namespace remap;

namespace
{
/// Less than this part of its volume is little.
constexpr double little = 1e-3;
} // namespace

/// Which slots of ours are thin, and who gives to them.
void MaterialTransport::find_thin()
{
  const ControlVolumes& cv = *_cv;
  _thin.clear();
  const auto look = [&](std::int32_t slot)
  {
    if (cv.ours(slot) and cv.next[slot] < little * cv.volume[slot])
      _thin.push_back({.slot = slot});
  };
  for (const std::int32_t c : _guests)
    if (_materials->row(c) < 0)
      look(c);
  const bool cells = not _thin.empty();
  for (std::size_t i = _touched; i < cv.touched.size(); ++i)
    look(cv.touched[i]);
  if (_thin.empty())
    return;
  std::sort(_thin.begin(), _thin.end(),
            [](const Thin& a, const Thin& b) { return a.slot < b.slot; });
  const auto note = [&](std::int32_t from, std::int32_t to)
  {
    if (to < 0 or (to < cv.first_part and not cells))
      return;
    const auto it = std::lower_bound(_thin.begin(), _thin.end(), to,
                                     [](const Thin& t, std::int32_t slot)
                                     { return t.slot < slot; });
    if (it == _thin.end() or it->slot != to)
      return;
    if (from >= 0)
      it->givers.push_back(from);
    else
      it->given = true;
  };
  for (std::size_t p = 0; p < cv.inner.count; ++p)
    note(cv.inner.from[p], cv.inner.to[p]);
  for (std::size_t p = 0; p < cv.outer.count; ++p)
    note(cv.outer.from[p], cv.outer.to[p]);
}

/// Before a field travels: the values between which those of thin slots lie,
/// their own first.
void MaterialTransport::note_ranges(const MaterialField& field)
{
  const auto n = static_cast<std::size_t>(field.components);
  _ranges.clear();
  for (Thin& t : _thin)
  {
    t.first = _ranges.size() / n;
    const auto add = [&](std::int32_t slot)
    {
      const auto* u = &field.values[n * static_cast<std::size_t>(slot)];
      _ranges.insert(_ranges.end(), u, u + n);
    };
    const auto around = [&](std::int32_t slot)
    {
      add(slot);
      for (const std::int32_t j : _cv->neighbours[slot])
        add(j);
    };
    around(t.slot);
    for (const std::int32_t j : t.givers)
      around(j);
    if (t.given)
      _ranges.insert(_ranges.end(), field.inflow.begin(), field.inflow.end());
    t.last = _ranges.size() / n;
  }
}

/// Part of the way from its old value to the new one that a group goes: each
/// component within the range around it, or within so much more.
double MaterialTransport::part_in_range(const Thin& t, std::size_t n,
                                        std::size_t first, int group,
                                        const double* u, double more) const
{
  double part = 1;
  for (std::size_t k = first; k < first + static_cast<std::size_t>(group); ++k)
  {
    const double old = _ranges[n * t.first + k];
    double lo = old, hi = old;
    for (std::size_t i = t.first; i < t.last; ++i)
    {
      lo = std::min(lo, _ranges[n * i + k]);
      hi = std::max(hi, _ranges[n * i + k]);
    }
    const double way = u[k - first] - old;
    const double room = std::abs((way > 0 ? hi : lo) - old) + more * (hi - lo);
    if (not(std::abs(way) <= room))
      part = std::min(part, std::isfinite(way) ? room / std::abs(way) : 0.0);
  }
  return part;
}

/// The same for a group of N in the hull of what is around it.
template <int N>
double MaterialTransport::part_in_hull(const Thin& t, std::size_t n,
                                       std::size_t first, const double* u) const
{
  const auto row = [&](std::size_t i) { return &_ranges[n * i + first]; };
  const double* old = row(t.first);
  hull::Vector<N> from, way;
  double size = 0;
  bool finite = true;
  for (int k = 0; k < N; ++k)
  {
    from[k] = old[k];
    way[k] = u[k] - old[k];
    size = std::max(size, std::abs(old[k]));
    finite = finite and std::isfinite(way[k]);
  }
  const auto points = [&](const auto& call)
  {
    for (std::size_t i = t.first; i < t.last; ++i)
      call(row(i));
  };
  return finite ? hull::reach<N>(points, from, way, 1e-12 * size) : 0.0;
}

/// After it: each group back towards its old value as far as it must.
/// @param[in] extends do bounds give way at smooth extrema?
void MaterialTransport::hold_thin(const MaterialField& field,
                                  bool extends) const
{
  const auto n = static_cast<std::size_t>(field.components);
  const auto group = static_cast<std::size_t>(field.group);
  const bool loose = extends or (group > 1 and field.bound == Bound::ball);
  // A ball is at most that much larger; what smooth extrema foresee has no
  // bound, but round-off may be larger by far.
  const double more = extends ? 1e3 : loose ? 1 : 0;
  for (const Thin& t : _thin)
    for (std::size_t first = 0; first < n; first += group)
    {
      double* u = &field.values[n * static_cast<std::size_t>(t.slot) + first];
      double part = 1;
      const auto in_hull = [&]<int N>(std::integral_constant<int, N>)
      {
        if (field.group == N)
          part = part_in_hull<N>(t, n, first, u);
      };
      if (group == 1 or loose)
        part = part_in_range(t, n, first, field.group, u, more);
      else
        [&]<int... N>(std::integer_sequence<int, N...>)
        {
          (in_hull(std::integral_constant<int, N + 2>{}), ...);
        }(std::make_integer_sequence<int, largest_group - 1>{});
      const double* old = &_ranges[n * t.first + first];
      for (std::size_t k = 0; part < 1 and k < group; ++k)
        u[k] = part > 0 ? old[k] + part * (u[k] - old[k]) : old[k];
    }
}
