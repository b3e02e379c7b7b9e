// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Pairs of triangles to break a clipper: random ones and every kind of
// coincidence. One number makes one pair, so a failure can be replayed. All
// coordinates are whole multiples of 2^-50 between -2 and 3, made by integer
// arithmetic alone: exact_overlaps.py makes the same ones.
#pragma once

#include "remap/geometry/polygon.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fuzz
{
/// Splitmix64 (Steele, Lea & Flood 2014).
class Random
{
public:
  explicit Random(std::uint64_t seed) : _state(seed) {}

  std::uint64_t operator()()
  {
    std::uint64_t z = (_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// One of 0 … n − 1.
  std::int64_t below(std::uint64_t n)
  {
    return static_cast<std::int64_t>((*this)() % n);
  }
  /// One of −n … n.
  std::int64_t about(std::uint64_t n)
  {
    return below(2 * n + 1) - static_cast<std::int64_t>(n);
  }

private:
  std::uint64_t _state;
};

/// A point in units of 2^-50.
struct Lattice
{
  std::int64_t x, y;
};
using Corners = std::array<Lattice, 3>;

inline constexpr std::uint64_t num_kinds = 16;

inline constexpr std::array<const char*, num_kinds> kinds = {
    "random",         "identical",       "edge, same side", "edge, apart",
    "vertex",         "sliver",          "two slivers",     "offset of 1e-14",
    "vertex on edge", "edges in line",   "inside",          "clockwise",
    "no area",        "nearly parallel", "edge, 1e-14 off", "far smaller"};

/// Multiples of 2^-20, so that halves to 1024ths of differences are whole.
inline Lattice coarse(Random& r)
{
  const std::int64_t x = r.below(1 << 20), y = r.below(1 << 20);
  return {x << 30, y << 30};
}

/// k/1024 of the way from a to b.
inline Lattice between(Lattice a, Lattice b, std::int64_t k)
{
  return {a.x + (b.x - a.x) / 1024 * k, a.y + (b.y - a.y) / 1024 * k};
}

inline Lattice nudged(Random& r, Lattice a, std::uint64_t by)
{
  const std::int64_t x = r.about(by), y = r.about(by);
  return {a.x + x, a.y + y};
}

/// Third corner about 1e-4 of the length of a → b beside it, or less.
inline Lattice beside(Random& r, Lattice a, Lattice b)
{
  const Lattice p = between(a, b, r.below(1025));
  return nudged(r, p, std::uint64_t(1) << (10 + r.below(27)));
}

/// The second triangle of a pair.
inline Corners partner(Random& r, std::uint64_t kind, Corners& a)
{
  Corners b = {coarse(r), coarse(r), coarse(r)};
  switch (kind)
  {
  case 1: // identical, from another corner on
    return {a[1], a[2], a[0]};
  case 2: // third corner on the same side: inside the angle at a0
    return {a[0], a[1], between(a[1], a[2], r.below(1025))};
  case 3: // a parallelogram over the shared edge
    return {a[1], a[0], {a[0].x + a[1].x - a[2].x, a[0].y + a[1].y - a[2].y}};
  case 4:
    return {a[0], b[1], b[2]};
  case 5:
    return {b[0], b[1], beside(r, b[0], b[1])};
  case 6:
    a[2] = beside(r, a[0], a[1]);
    return {b[0], b[1], beside(r, b[0], b[1])};
  case 7:
    return {nudged(r, a[0], 16), nudged(r, a[1], 16), nudged(r, a[2], 16)};
  case 8:
    return {between(a[0], a[1], r.below(1025)), b[1], b[2]};
  case 9:
    return {between(a[0], a[1], r.about(512)),
            between(a[0], a[1], r.below(1025)), b[2]};
  case 10:
    return {between(a[0], a[1], r.below(1025)),
            between(a[1], a[2], r.below(1025)),
            between(a[2], a[0], r.below(1025))};
  case 11:
    return {a[0], a[2], b[2]};
  case 12:
    return {b[0], between(b[0], b[1], r.below(1025)),
            r.below(2) == 0 ? b[0] : b[1]};
  case 13:
    return {nudged(r, a[0], std::uint64_t(1) << r.below(40)),
            nudged(r, a[1], std::uint64_t(1) << r.below(40)), b[2]};
  case 14:
    return {nudged(r, a[1], 16), nudged(r, a[0], 16), b[2]};
  case 15:
  {
    const std::uint64_t size = std::uint64_t(1) << (8 + r.below(32));
    const Lattice at = between(a[0], a[1], r.below(1025));
    return {nudged(r, at, size), nudged(r, at, size), nudged(r, at, size)};
  }
  default:
    return b;
  }
}

struct Pair
{
  std::uint64_t seed, kind;
  remap::Triangle a, b;
};

/// The pair with this number.
inline Pair pair(std::uint64_t seed)
{
  Random r(seed);
  const std::uint64_t kind = seed % num_kinds;
  Corners a = {coarse(r), coarse(r), coarse(r)};
  const Corners b = partner(r, kind, a);
  const auto triangle = [](const Corners& c)
  {
    const auto point = [](Lattice p) -> remap::Point
    {
      return {std::ldexp(static_cast<double>(p.x), -50),
              std::ldexp(static_cast<double>(p.y), -50)};
    };
    return remap::Triangle{point(c[0]), point(c[1]), point(c[2])};
  };
  return {seed, kind, triangle(a), triangle(b)};
}
} // namespace fuzz
