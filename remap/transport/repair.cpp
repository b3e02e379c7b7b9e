// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/transport/repair.h"

#include <algorithm>
#include <cmath>

using namespace remap;

namespace
{
double& value(const Field& field, int k, std::int32_t i)
{
  return field.values[std::size_t(field.components) * i + std::size_t(k)];
}
} // namespace

/// Room of our volumes, after what is beyond the range was cut.
void Repair::find_room(const Field& field, int k, const ControlVolumes& cv)
{
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      Work& w = _work[i];
      w.up = std::max(field.most[k] - value(field, k, i), 0.0) * cv.next[i];
      w.down = std::max(value(field, k, i) - field.least[k], 0.0) * cv.next[i];
    }
}

void Repair::update(const ControlVolumes& cv, const Halo& halo)
{
  constexpr int numbers = sizeof(Work) / sizeof(double);
  halo(std::span(&_work[0].excess, std::size_t(numbers) * cv.num), numbers);
}

/// Give excess to neighbours: an offer to each by its room, of which it takes
/// the same part from everyone.
void Repair::pass_on(const Field& field, int k, const ControlVolumes& cv,
                     const Halo& halo)
{
  const auto room = [this](std::int32_t i, double sign)
  { return sign > 0 ? _work[i].up : _work[i].down; };
  const auto offer = [&](std::int32_t from, std::int32_t to)
  {
    const Work& w = _work[from];
    if (w.excess == 0 or not(w.around > 0))
      return 0.0;
    return std::copysign(std::min(std::abs(w.excess), w.around), w.excess)
           * room(to, w.excess) / w.around;
  };
  const auto ours = [&cv](const auto& call)
  {
    for (std::int32_t i : cv.touched)
      if (cv.ours(i))
        call(i, cv.neighbours[i]);
  };
  update(cv, halo);
  ours(
      [&](std::int32_t i, auto around)
      {
        _work[i].around = 0;
        for (std::int32_t j : around)
          _work[i].around += room(j, _work[i].excess);
      });
  update(cv, halo);
  ours(
      [&](std::int32_t i, auto around)
      {
        double up = 0, down = 0;
        for (std::int32_t j : around)
        {
          const double o = offer(j, i);
          (o > 0 ? up : down) += std::abs(o);
        }
        Work& w = _work[i];
        w.part_up = up > w.up ? w.up / up : 1;
        w.part_down = down > w.down ? w.down / down : 1;
      });
  update(cv, halo);
  const auto taken = [&](std::int32_t from, std::int32_t to)
  {
    const double o = offer(from, to);
    return o * (o > 0 ? _work[to].part_up : _work[to].part_down);
  };
  ours(
      [&](std::int32_t i, auto around)
      {
        double in = 0, out = 0;
        for (std::int32_t j : around)
        {
          in += taken(j, i);
          out += taken(i, j);
        }
        value(field, k, i) += in / cv.next[i];
        _work[i].rest = _work[i].excess - out;
      });
  ours([this](std::int32_t i, auto) { _work[i].excess = _work[i].rest; });
}

/// What neighbours could not take goes to all, by their room.
double Repair::spread(const Field& field, int k, const ControlVolumes& cv,
                      const Host& host)
{
  find_room(field, k, cv);
  double sums[4] = {0, 0, 0, 0}; // excess, room up, room down, volume
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      sums[0] += _work[i].excess;
      sums[1] += _work[i].up;
      sums[2] += _work[i].down;
      sums[3] += cv.next[i];
    }
  host.sum(sums);
  const double excess = sums[0];
  const double room = excess > 0 ? sums[1] : sums[2];
  const double left = std::max(std::abs(excess) - room, 0.0);
  if (excess == 0)
    return 0;
  const double part = room > 0 ? std::min(std::abs(excess) / room, 1.0) : 0.0;
  const double sign = excess > 0 ? 1 : -1;
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
      // What finds no room stays in the sum: conserved, and reported.
      value(field, k, i) +=
          sign
          * (part * (excess > 0 ? _work[i].up : _work[i].down) / cv.next[i]
             + left / sums[3]);
  return left;
}

double Repair::run(const Field& field, int k, const ControlVolumes& cv,
                   const Host::Halo& halo, const Host& host,
                   std::int64_t& number)
{
  double bad = 0;
  number = 0;
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      const double u = value(field, k, i);
      bad = std::max(bad, double(u < field.least[k] or u > field.most[k]));
    }
  if (not(host.max(bad) > 0))
    return 0;
  // Round-off is put back too, but not counted.
  const double range = field.most[k] - field.least[k];
  const auto small = [range](double end)
  { return 1e-12 * (std::isfinite(range) ? range : std::abs(end)); };
  _work.assign(std::max(_work.size(), std::size_t(cv.num)), Work{});
  for (std::int32_t i : cv.touched)
    if (cv.ours(i))
    {
      double& u = value(field, k, i);
      const double in = std::min(std::max(u, field.least[k]), field.most[k]);
      number += std::abs(u - in) > small(in) ? 1 : 0;
      _work[i].excess = (u - in) * cv.next[i];
      u = in;
    }
  find_room(field, k, cv);
  pass_on(field, k, cv, halo);
  const double left = spread(field, k, cv, host);
  halo(field.values, field.components);
  return left;
}
