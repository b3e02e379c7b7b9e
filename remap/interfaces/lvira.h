// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: least-squares volume-of-fluid: of all lines that give the cell its
// fraction, the one that gives the cells around theirs best, Σ (error of the
// fraction)² over all that share a vertex. Exact for straight interfaces.
//
// When the line turns about the weighted middle of its chord the cell keeps its
// volume; a cell beside it gains the first moment of the chord there about that
// point. So Gauss–Newton steps in the angle are in closed form; from Youngs'.
//
// @source Puckett (1991), Pilliod & Puckett (2004), on squares and with a
// search by brackets. ELVIRA takes its candidates from differences of columns,
// which triangles do not have: `swartz` is the cheap exact one here.
#pragma once

#include "remap/interfaces/placement.h"
#include "remap/interfaces/youngs.h"

namespace remap::reconstruction
{
struct Lvira
{
  static constexpr std::string_view name = "lvira";
  static constexpr bool uses_centroids = false;
  static constexpr bool exact = true; ///< for straight interfaces
  static constexpr int sweeps = 0;

  template <Geometry G>
  static Point normal(const Stencil& s)
  {
    Point n = Youngs::normal<G>(s);
    const double length = std::sqrt(dot(n, n));
    if (not(length > 0))
      return n;
    n = 1 / length * n;
    Fit fit = look<G>(s, n);
    for (int i = 0; i < 20 and fit.slope2 > 0; ++i)
    {
      double turn = std::clamp(-fit.slope / fit.slope2, -0.5, 0.5);
      Point next = turned(n, turn);
      Fit trial = look<G>(s, next);
      while (trial.error > fit.error and std::abs(turn) > 1e-8)
      {
        turn *= 0.25;
        next = turned(n, turn);
        trial = look<G>(s, next);
      }
      if (not(trial.error <= fit.error))
        break;
      n = next;
      fit = trial;
      // Steps square themselves where the interface is nearly straight.
      if (std::abs(turn) < 1e-7)
        break;
    }
    return n;
  }

private:
  struct Fit
  {
    double error = 0, slope = 0, slope2 = 0; ///< Σ r², Σ r r', Σ r'²
  };

  static Point turned(Point n, double angle)
  {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * n.x - s * n.y, s * n.x + c * n.y};
  }

  /// Where the line meets the cell: the point that it may turn about.
  template <Geometry G>
  static Point pivot(const Stencil& s, Point n)
  {
    const double f = s.cell().value;
    if constexpr (G == Geometry::plane)
      return place(s.cell().t, n, f, 1 - f).at;
    return place_fraction<G>(Polygon<3>(s.cell().t), n, f, 1 - f, s.origin().x)
        .at;
  }

  template <Geometry G>
  static Fit look(const Stencil& s, Point n)
  {
    const Point at = pivot<G>(s, n), along = {-n.y, n.x};
    const double radius = s.origin().x;
    Fit out;
    for (const Stencil::Cell& c : s.around())
    {
      const Triangle& t = c.t;
      const double d[3] = {dot(n, t[0] - at), dot(n, t[1] - at),
                           dot(n, t[2] - at)};
      const unsigned in = static_cast<unsigned>(d[0] < 0)
                          | static_cast<unsigned>(d[1] < 0) << 1
                          | static_cast<unsigned>(d[2] < 0) << 2;
      if (in == 0 or in == 7)
      {
        const double r = (in == 7) - c.value;
        out.error += r * r;
        continue;
      }
      // The corner that is alone on its side.
      constexpr int alone[8] = {0, 0, 1, 2, 2, 1, 0, 0};
      const bool filled = in == 1 or in == 2 or in == 4;
      const int i = alone[in], j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
      const double p = d[i] / (d[i] - d[j]), q = d[i] / (d[i] - d[k]);
      const Point u = p * (t[j] - t[i]), v = q * (t[k] - t[i]);
      const Point a = t[i] + u - at, b = t[i] + v - at;
      const double xa = dot(along, a), xb = dot(along, b);
      const double length = std::abs(xb - xa), mid = 0.5 * (xa + xb);
      double corner = p * q, gain = -length * mid;
      double volume = 0.5 * twice_area(t[0], t[1], t[2]);
      if constexpr (G == Geometry::axisymmetric)
      {
        const double mean = radius + c.centre.x;
        corner *= (radius + t[i].x + (u.x + v.x) / 3) / mean;
        const double r = radius + at.x + 0.5 * (a.x + b.x);
        gain = -length * (r * mid + along.x * length * length / 12);
        volume *= mean;
      }
      const double r = (filled ? corner : 1 - corner) - c.value;
      const double slope = gain / volume;
      out.error += r * r;
      out.slope += r * slope;
      out.slope2 += slope * slope;
    }
    return out;
  }
};
} // namespace remap::reconstruction
