// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4.1, optimisation: minimise Σ |T|²/(2 det T) over the patch, T = A
// W⁻¹, by Newton with backtracking. For equilateral targets this is the inverse
// mean ratio; with the initial shapes as targets a graded mesh stays graded.
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

/// Σ N/D over the patch with the node at x; N = α p·p − 2β p·q + γ q·q and
/// D = p × q, p = a − x, q = b − x. D is linear and N quadratic in x, so
///   ∇(N/D)  = ∇N/D − N ∇D/D²
///   ∇²(N/D) = 2κ I/D − (∇N ∇Dᵀ + ∇D ∇Nᵀ)/D² + 2N ∇D ∇Dᵀ/D³,
/// κ = α − 2β + γ: quadratic over linear, convex where D > 0.
inline Distortion distortion(std::span<const PatchCell> cells, Point x)
{
  Distortion out;
  for (const PatchCell& c : cells)
  {
    const quality::Target& w = c.target;
    const Point p = c.a - x;
    const Point q = c.b - x;
    const double d = 1 / cross(p, q);
    const double n =
        w.alpha * dot(p, p) - 2 * w.beta * dot(p, q) + w.gamma * dot(q, q);
    const Point gn = 2 * (w.beta - w.alpha) * p + 2 * (w.beta - w.gamma) * q;
    const Point gd = {c.a.y - c.b.y, c.b.x - c.a.x};
    const double f = n * d;
    const Point g = d * gn - (f * d) * gd;
    const double kappa = 2 * (w.alpha - 2 * w.beta + w.gamma) * d;
    const double two = 2 * f * d * d;
    out.f += f;
    out.g = out.g + g;
    out.xx += kappa - 2 * gn.x * gd.x * d * d + two * gd.x * gd.x;
    out.yy += kappa - 2 * gn.y * gd.y * d * d + two * gd.y * gd.y;
    out.xy += -(gn.x * gd.y + gn.y * gd.x) * d * d + two * gd.x * gd.y;
  }
  return out;
}

struct Optimise
{
  static constexpr std::string_view name = "optimise";
  /// Newton steps a visit. Doubled: nothing but time, it converges in 2 to 4.
  static constexpr int max_steps = 5;
  /// Halvings of a step. Doubled: nothing but time.
  static constexpr int max_halvings = 12;

  static Point propose(const Patch& patch)
  {
    Point x = patch.x;
    for (int k = 0; k < max_steps; ++k)
    {
      const Distortion now = distortion(patch.cells, x);
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
      // Quadratic convergence: the next step would be below round-off.
      if (-dot(now.g, step) < 1e-14 * now.f)
        return x;
    }
    return x;
  }

  /// Σ |T|²/(2 det T); infinite if a cell has no positive area.
  static double value(std::span<const PatchCell> cells, Point x)
  {
    double f = 0;
    for (const PatchCell& c : cells)
    {
      const Point p = c.a - x;
      const Point q = c.b - x;
      if (not(cross(p, q) > 0))
        return std::numeric_limits<double>::infinity();
      f += quality::distortion(c.target, p, q);
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
} // namespace remap::smoother
