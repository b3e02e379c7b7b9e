// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: how much of a gradient may be used, in [0, 1]. The smallest
// factor over all that a limiter looks at holds for a volume. It looks at the
// *places* where values will be taken (centroids of the leaving regions and of
// what remains), and some of them also at the *sides*, the neighbours across
// facets.
//
// Bounds: lo <= factor · d <= hi at every place, d the predicted change there,
// lo <= 0 and hi >= 0 the largest fall and rise to a neighbour.
#pragma once

#include <cmath>
#include <concepts>

namespace remap
{
/// Which of the two a limiter looks at beyond the places' bounds, and whether
/// these bounds give way where neighbours agree that a field is smooth.
template <class L>
concept Limiter = requires(double d, double du, double lo, double hi) {
  { L::sides } -> std::convertible_to<bool>;
  { L::extends } -> std::convertible_to<bool>;
  { L::side(d, du, lo, hi) } -> std::same_as<double>;
  { L::place(d, lo, hi) } -> std::same_as<double>;
};

namespace limiter
{
/// Largest factor that keeps lo <= factor · d <= hi. No branch: what is asked
/// for cannot be foreseen.
inline double largest(double d, double lo, double hi)
{
  const double room = d > 0 ? hi : -lo;
  const double size = std::abs(d);
  const bool over = size > room;
  const double ratio = room / (over ? size : 1.0);
  return over ? ratio : 1.0;
}

/// No limit: exact for linear fields, oscillates at jumps.
struct none
{
  static constexpr bool sides = false;
  static constexpr bool extends = false;
  static double side(double, double, double, double) { return 1; }
  static double place(double, double, double) { return 1; }
};

/// The places' bounds alone: what the bounds of the result need, and no more.
struct places
{
  static constexpr bool sides = false;
  static constexpr bool extends = false;
  static double side(double, double, double, double) { return 1; }
  static double place(double d, double lo, double hi)
  {
    return largest(d, lo, hi);
  }
};

/// Places' bounds that give way where the neighbours' own gradients agree that
/// the field goes beyond its neighbours' means: at smooth extrema, and in
/// volumes on the boundary (see `kernel::extend`).
struct smooth : places
{
  static constexpr bool extends = true;
};

/// The bounds hold halfway to every neighbour across a facet too.
/// @source Barth & Jespersen (1989), there at facets or vertices.
struct barth_jespersen : places
{
  static constexpr bool sides = true;
  static double side(double d, double, double lo, double hi)
  {
    return largest(0.5 * d, lo, hi);
  }
};

/// As Barth & Jespersen, without a kink in the factor.
/// @source Venkatakrishnan (1995). Departures: without the threshold in units
/// of the field, and never above 1.
struct venkatakrishnan
{
  static constexpr bool sides = true;
  static constexpr bool extends = false;
  static double place(double d, double lo, double hi)
  {
    const double room = d > 0 ? hi : -lo;
    const double a = std::abs(d);
    const double up = room * (room + 2 * a);
    const double down = room * room + a * room + 2 * a * a;
    const bool over = down > up;
    const double ratio = up / (over ? down : 1.0);
    return over ? ratio : 1.0;
  }
  static double side(double d, double, double lo, double hi)
  {
    return place(0.5 * d, lo, hi);
  }
};

/// Part of the predicted change d that the true change du to a neighbour across
/// a facet allows, before it is shaped: in [0, 1].
inline double agreement(double d, double du)
{
  const double both = d * du;
  const double own = d * d;
  const bool less = own > both;
  const double ratio = both / (less ? own : 1.0);
  return less ? (ratio > 0 ? ratio : 0.0) : 1.0;
}

/// No prediction exceeds the change to any neighbour across a facet. On evenly
/// spaced points of a line this is the minmod of the two differences.
struct minmod : places
{
  static constexpr bool sides = true;
  static double side(double d, double du, double, double)
  {
    return agreement(d, du);
  }
};

/// With m and M the smaller and larger difference of evenly spaced points on a
/// line, r = m / ((m + M) / 2): r (2 − r) makes the slope 2mM / (m + M), van
/// Leer's harmonic mean.
struct van_leer : places
{
  static constexpr bool sides = true;
  static double side(double d, double du, double, double)
  {
    const double r = agreement(d, du);
    return r * (2 - r);
  }
};
} // namespace limiter
} // namespace remap
