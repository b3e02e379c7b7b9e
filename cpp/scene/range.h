// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <string>

/// Allowed values of a number, as checked and as printed.
namespace mmale::scene
{
/// An interval; NaN and, unless an end says otherwise, infinities are outside.
struct Range
{
  double minimum = -infinity;
  double maximum = infinity;
  bool minimum_excluded = true;
  bool maximum_excluded = true;

  /// True when `x` is inside.
  [[nodiscard]] bool holds(double x) const;

  /// In words: "> 0", "0 <= x < 0.4", or "" for any finite number.
  [[nodiscard]] std::string words() const;
};

/// x > a, finite.
inline Range above(double a)
{
  return {a, infinity, true, true};
}

/// x >= a, finite.
inline Range at_least(double a)
{
  return {a, infinity, false, true};
}

/// a < x < b.
inline Range between(double a, double b)
{
  return {a, b, true, true};
}

/// a <= x <= b.
inline Range from_to(double a, double b)
{
  return {a, b, false, false};
}

/// Any number, infinities too: the default of an end that nobody named.
inline Range unbounded()
{
  return {-infinity, infinity, false, false};
}
} // namespace mmale::scene
