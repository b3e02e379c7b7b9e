// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

/// Exact consolidation of elastic soils, by series. T = c t / length^2.
namespace mmale::test
{
/// Zero of a function that changes its sign once in between.
inline double bisect(const std::function<double(double)>& f, double low,
                     double high)
{
  const double sign = f(low) > 0 ? 1 : -1;
  for (int i = 0; i < 200; ++i)
  {
    const double middle = 0.5 * (low + high);
    (sign * f(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Terzaghi: p_w / p_0 of a layer drained at the top.
/// @param[in] y height over the base, of the layer's
inline double terzaghi(double y, double T)
{
  double sum = 0;
  for (int m = 0; m < 400; ++m)
  {
    const double a = (m + 0.5) * std::numbers::pi;
    sum += 2 / a * (m % 2 ? -1 : 1) * std::cos(a * y) * std::exp(-a * a * T);
  }
  return sum;
}

/// Mandel: a slab between smooth rigid plates, 2 a wide, drained at its sides.
/// @source Cheng & Detournay, Int. J. Numer. Anal. Meth. Geomech. 12 (1988)
struct Mandel
{
  double nu, nu_u;

  double root(int m) const
  {
    const double ratio = (1 - nu) / (nu_u - nu);
    const double at = m * std::numbers::pi;
    return bisect([&](double x)
                  { return std::sin(x) - ratio * x * std::cos(x); }, at + 1e-9,
                  at + 0.5 * std::numbers::pi);
  }

  /// p_w / p_0 at x of a.
  double pressure(double x, double T) const
  {
    double sum = 0;
    for (int m = 0; m < 400; ++m)
    {
      const double r = root(m), s = std::sin(r), c = std::cos(r);
      sum += 2 * s / (r - s * c) * (std::cos(r * x) - c) * std::exp(-r * r * T);
    }
    return sum;
  }

  /// Strain across the plates over that of a drained slab at its end.
  double settlement(double T) const
  {
    double sum = 0;
    for (int m = 0; m < 400; ++m)
    {
      const double r = root(m), s = std::sin(r), c = std::cos(r);
      sum += s * c / (r - s * c) * std::exp(-r * r * T);
    }
    return 1 - 2 * (1 - nu_u) / (1 - nu) * sum;
  }
};

/// Cryer: p_w / p_0 in the centre of a sphere under a fluid's pressure,
/// constituents incompressible.
inline double cryer(double nu, double T)
{
  const double eta = (1 - nu) / (1 - 2 * nu);
  double sum = 0;
  for (int m = 1; m < 400; ++m)
  {
    const double at = m * std::numbers::pi;
    const double x = bisect(
        [&](double x)
        { return (1 - 0.5 * eta * x * x) * std::sin(x) - x * std::cos(x); },
        at - (m == 1 ? std::numbers::pi - 1e-3 : 0.5 * std::numbers::pi),
        at + 0.5 * std::numbers::pi);
    const double s = std::sin(x), c = std::cos(x);
    sum += eta * (s - x) / (0.5 * eta * x * c + (eta - 1) * s)
           * std::exp(-x * x * T);
  }
  return sum;
}
} // namespace mmale::test
