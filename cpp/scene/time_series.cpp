// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/scene.h"
#include <algorithm>
#include <cassert>

namespace mmale::scene
{
double TimeSeries::operator()(double t) const
{
  assert(not value.empty());
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
