// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/scene.h"
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace mmale::scene
{
namespace
{
constexpr double radian = std::numbers::pi / 180;
constexpr double turn = 2 * std::numbers::pi;
} // namespace

double TimeSeries::operator()(double t) const
{
  assert(not value.empty());
  if (amplitude != 0)
    return value.front()
           + amplitude * std::sin(turn * frequency * t + radian * phase_deg);
  if (time.empty() or t <= time.front())
    return value.front();
  if (t >= time.back())
    return value.back();
  const auto next = std::ranges::upper_bound(time, t) - time.begin();
  const double share = (t - time[next - 1]) / (time[next] - time[next - 1]);
  return value[next - 1] + share * (value[next] - value[next - 1]);
}

double TimeSeries::integral(double t) const
{
  if (amplitude != 0)
  {
    // cos a - cos b, without the loss of digits when they are close
    const double half = 0.5 * turn * frequency * t;
    return value.front() * t
           + amplitude * t * std::sin(half + radian * phase_deg)
                 * (half != 0 ? std::sin(half) / half : 1);
  }
  // Trapezoids between the kinks are exact for a piecewise linear function.
  double sum = 0;
  double from = 0;
  for (double kink : time)
  {
    const double to = std::min(kink, t);
    if (to <= from)
      continue;
    sum += 0.5 * (to - from) * ((*this)(from) + (*this)(to));
    from = to;
  }
  return sum + 0.5 * (t - from) * ((*this)(from) + (*this)(t));
}
} // namespace mmale::scene
