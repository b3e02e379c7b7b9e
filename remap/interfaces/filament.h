// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: a filament thinner than a cell: one part between two parallel
// lines, the other on both sides. Two volumes and a centroid are as many
// conditions as a direction and two positions are free, so the strip is found
// from moments alone: Newton steps in the direction and the volume below the
// strip.
#pragma once

#include "remap/interfaces/corner.h"
#include "remap/interfaces/placement.h"
#include "remap/interfaces/round.h"

#include <numbers>

namespace remap
{
/// The part between two parallel lines.
struct Strip
{
  HalfPlane below, upto; ///< the strip is in `upto`, not in `below`
  double error = 0;      ///< as `Straight::error`
};

namespace filament
{
template <Geometry G>
struct Weighted
{
  Point middle;
  double second; ///< moment of the chord about its middle

  Weighted(const Chord& c, double radius) : middle(pivot<G>(c, radius))
  {
    const Point way = c.b - c.a;
    const double length = std::sqrt(dot(way, way));
    const double cube = length * length * length;
    second = cube / 12;
    if constexpr (G == Geometry::axisymmetric)
    {
      const double a = radius + c.a.x, b = radius + c.b.x;
      const double part = a + b > 0 ? (a + 2 * b) / (3 * (a + b)) : 0.5;
      second = cube * ((a + 3 * b) / 12 - part * part * (a + b) / 2);
    }
  }
};

/// A strip, and how its centroid moves.
struct Stand
{
  Point normal;
  double below = 0; ///< volume
  HalfPlane low, high;
  Point off;                ///< centroid less its target
  Point by_angle, by_below; ///< derivatives of the centroid
  double width = 0;
};

template <Geometry G, int N>
Stand stand(const Polygon<N>& p, double all, double volume, Point target,
            double radius, Point normal, double below)
{
  Stand out;
  out.normal = normal;
  out.below = below = std::clamp(below, 0.0, all - volume);
  const double above = all - below - volume;
  const Chord low = place<G>(p, normal, below, radius);
  // From the nearer side.
  const Chord high = above < below + volume
                         ? place<G>(p, -1.0 * normal, above, radius)
                         : place<G>(p, normal, below + volume, radius);
  const Weighted<G> l(low, radius), h(high, radius);
  out.low = {normal, l.middle};
  out.high = {normal, h.middle};
  Polygon<N + 2> upto, strip;
  clip(p, out.high, upto);
  clip(upto, out.low.flipped(), strip);
  const Moments m =
      strip.size < 3
          ? Moments{}
          : polygon::fan<G>(strip.x.data(), strip.y.data(), strip.size, radius);
  const Point at = m.v > 0 ? m.centroid() : middle(l.middle, h.middle);
  out.off = at - target;
  const Point along = {-normal.y, normal.x};
  out.by_angle = (l.second - h.second) / volume * along;
  out.by_below = 1 / volume * (h.middle - l.middle);
  out.width = dot(normal, h.middle - l.middle);
  return out;
}

/// Newton steps with halving.
template <Geometry G, int N>
Stand settle(const Polygon<N>& p, double all, double volume, Point target,
             double radius, Stand x)
{
  for (int i = 0; i < 30; ++i)
  {
    const double error = dot(x.off, x.off);
    const double det = cross(x.by_angle, x.by_below);
    double turn = -cross(x.off, x.by_below) / det;
    double more = -cross(x.by_angle, x.off) / det;
    if (not(std::isfinite(turn) and std::isfinite(more)) or error == 0)
      break;
    const double most = std::max(std::abs(turn) / 0.4, std::abs(more) / all);
    if (most > 1)
      turn /= most, more /= most;
    bool better = false;
    for (int k = 0; k < 12 and not better; ++k, turn *= 0.5, more *= 0.5)
    {
      const double c = std::cos(turn), s = std::sin(turn);
      const Point n = {c * x.normal.x - s * x.normal.y,
                       s * x.normal.x + c * x.normal.y};
      const Stand next =
          stand<G>(p, all, volume, target, radius, n, x.below + more);
      if (dot(next.off, next.off) < error)
        x = next, better = true;
    }
    if (not better)
      break;
  }
  return x;
}
} // namespace filament

/// The strip for a part with its fraction and centroid, the other on both
/// sides.
///
/// @param[in] p        counter-clockwise, measured from a point at `radius`
/// @param[in] whole    volume and first moments of p
/// @param[in] in,other fractions > 0 of p add up to 1; centroids
template <Geometry G, int N>
Strip best_strip(const Polygon<N>& p, const Moments& whole, const Target& in,
                 const Target& other, double radius)
{
  const Point centre = whole.centroid();
  const Point miss = in.fraction * (in.centroid - centre)
                     + other.fraction * (other.centroid - centre);
  const Point target = in.centroid - miss;
  const double volume = in.fraction * whole.v;
  filament::Stand best;
  double least = -1;
  constexpr int starts = 12;
  const Round shape(p);
  for (int i = 0; i < starts; ++i)
  {
    const double angle = std::numbers::pi * i / starts;
    Point n = shape.normal({std::cos(angle), std::sin(angle)});
    n = 1 / std::sqrt(dot(n, n)) * n;
    Polygon<N + 1> half;
    clip(p, HalfPlane{n, target}, half);
    const double below =
        half.size < 3
            ? 0
            : polygon::fan<G>(half.x.data(), half.y.data(), half.size, radius)
                  .v;
    const filament::Stand s = filament::settle<G>(
        p, whole.v, volume, target, radius,
        filament::stand<G>(p, whole.v, volume, target, radius, n,
                           below - 0.5 * volume));
    // Several may fit: then the thickest, which is the shortest.
    const double d = dot(s.off, s.off);
    const double same =
        1e-16
        * (dot(s.by_angle, s.by_angle) + dot(best.by_angle, best.by_angle));
    if (least < 0 or d < least - same
        or (d < least + same and s.width > best.width))
      least = d, best = s;
  }
  return {best.low, best.high,
          in.fraction / other.fraction * least + dot(miss, miss)};
}
} // namespace remap
