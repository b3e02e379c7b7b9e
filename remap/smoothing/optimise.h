// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2, optimisation: minimise Σ (|T|²/(2 det T))^n over the patch, T = A
// W⁻¹, by Newton with backtracking. n = 1: for equilateral targets the inverse
// mean ratio, Winslow's functional on triangles of one size; with the initial
// shapes as targets a graded mesh stays graded. The greater n, the more the
// worst cell counts.
#pragma once

#include "remap/smoothing/patch.h"

#include <limits>
#include <string_view>

namespace remap::smoother
{
/// Value, gradient and Hessian of the patch's distortion.
struct Distortion
{
  double f = 0;
  Point g{};
  double xx = 0, xy = 0, yy = 0;
};

/// f^n for n known to the compiler.
template <int n>
constexpr double power(double f)
{
  if constexpr (n <= 0)
    return 1;
  else if constexpr (n % 2 == 1)
    return f * power<n - 1>(f);
  else
    return power<n / 2>(f) * power<n / 2>(f);
}

/// Σ f^n over the patch with the node at x, f = N/D; N = k/2 p·p + m·m/(2k) and
/// D = p × q, p = a − x, q = b − x, m = q − r p. D is linear and N quadratic in
/// x, so
///   ∇f  = ∇N/D − N ∇D/D²
///   ∇²f = ∇²N/D − (∇N ∇Dᵀ + ∇D ∇Nᵀ)/D² + 2N ∇D ∇Dᵀ/D³:
/// quadratic over linear, convex where D > 0, and so is f^n.
template <int n = 1>
Distortion distortion_of_power(std::span<const PatchCell> cells, Point x)
{
  Distortion out;
  for (const PatchCell& c : cells)
  {
    const quality::Target& w = c.target;
    const Point p = c.a - x;
    const Point q = c.b - x;
    const double d = 1 / cross(p, q);
    const Point m = q - w.r * p;
    const double rest = w.rest * (1 - w.r);
    // ∇N, ∇D and ∇²N, all over D.
    const Point gn = (-2 * d) * (w.own * p + rest * m);
    const Point gd = d * Point{c.a.y - c.b.y, c.b.x - c.a.x};
    const double kappa = 2 * d * (w.own + rest * (1 - w.r));
    const double f = d * (w.own * dot(p, p) + w.rest * dot(m, m));
    const Point g = gn - f * gd;
    const double xx = kappa - 2 * g.x * gd.x;
    const double yy = kappa - 2 * g.y * gd.y;
    const double xy = -(g.x * gd.y + g.y * gd.x);
    if constexpr (n == 1)
    {
      out.f += f;
      out.g = out.g + g;
      out.xx += xx;
      out.yy += yy;
      out.xy += xy;
    }
    else
    {
      const double second = n * (n - 1) * power<n - 2>(f);
      const double first = n * power<n - 1>(f);
      out.f += power<n>(f);
      out.g = out.g + first * g;
      out.xx += first * xx + second * g.x * g.x;
      out.yy += first * yy + second * g.y * g.y;
      out.xy += first * xy + second * g.x * g.y;
    }
  }
  return out;
}

/// Newton's method for the sum of n-th powers.
template <int n>
struct Newton
{
  /// Newton steps a visit. Doubled: nothing but time, it converges in 2 to 4.
  static constexpr int max_steps = 5;
  /// Halvings of a step. Doubled: nothing but time.
  static constexpr int max_halvings = 12;
  static constexpr double enough = 1e-3;

  static Point propose(const Patch& patch)
  {
    Point x = patch.x;
    for (int k = 0; k < max_steps; ++k)
    {
      const Distortion now = distortion_of_power<n>(patch.cells, x);
      const Point step = newton(now, patch.along);
      Point y = x + step;
      int halvings = 0;
      while (not(value(patch.cells, y) < now.f) and halvings < max_halvings)
      {
        ++halvings;
        y = x + std::ldexp(1.0, -halvings) * step;
      }
      if (halvings == max_halvings)
        return x;
      x = y;
      if (-dot(now.g, step) < enough * now.f)
        return x;
    }
    return x;
  }

  /// Σ f^n; infinite if a cell has no positive area.
  static double value(std::span<const PatchCell> cells, Point x)
  {
    double f = 0;
    for (const PatchCell& c : cells)
    {
      const Point p = c.a - x;
      const Point q = c.b - x;
      if (not(cross(p, q) > 0))
        return std::numeric_limits<double>::infinity();
      f += power<n>(quality::distortion(c.target, p, q));
    }
    return f;
  }

private:
  static Point newton(const Distortion& d, const std::optional<Point>& along)
  {
    if (along)
    {
      const Point t = *along;
      const double h =
          d.xx * t.x * t.x + 2 * d.xy * t.x * t.y + d.yy * t.y * t.y;
      return (-dot(d.g, t) / h) * t;
    }
    const double det = d.xx * d.yy - d.xy * d.xy;
    return {(d.xy * d.g.y - d.yy * d.g.x) / det,
            (d.xy * d.g.x - d.xx * d.g.y) / det};
  }
};

struct Optimise : Newton<1>
{
  static constexpr std::string_view name = "optimise";
};
} // namespace remap::smoother
