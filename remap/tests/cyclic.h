// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Cyclic remap: meshes that move on the unit square and come back to where they
// began, and functions with their exact means. What is left of a function after
// a cycle, against its means at the start, is the error of the remap alone.
//
// Meshes and functions after Margolin & Shashkov (2003), with the amplitudes
// that Portage was measured with; the README has both.
#pragma once

#include "remap/remap.h"
#include "remap/tests/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string_view>

namespace cyclic
{
using remap::Point;

/// How the nodes move; t in [0, 1] is the part of the cycle done.
enum class Path
{
  tensor, ///< two waves of squeezing along each axis; nodes slide on the walls
  smooth, ///< one swirl; walls stand still
  random, ///< inner nodes anew by up to ± a quarter of a cell, each step
};
inline constexpr std::array paths = {Path::tensor, Path::smooth, Path::random};

/// What is carried.
enum class Function
{
  sine,  ///< smooth, with extrema
  peak,  ///< a cone on a step, radius a quarter
  shock, ///< a slanting jump
};
inline constexpr std::array functions = {Function::sine, Function::peak,
                                         Function::shock};

constexpr std::string_view name(Path m)
{
  constexpr std::array<std::string_view, 3> names = {"tensor", "smooth",
                                                     "random"};
  return names[static_cast<std::size_t>(m)];
}

constexpr std::string_view name(Function f)
{
  constexpr std::array<std::string_view, 3> names = {"sine", "peak", "shock"};
  return names[static_cast<std::size_t>(f)];
}

/// Nodes at a step of the cycle.
///
/// @param[in] x     at rest, shape (num_nodes, 2), on the unit square
/// @param[in] h     size of a cell, for `random`
/// @param[in] step  of `steps`; the first and the last are at rest
inline std::vector<double> placed(std::span<const double> x, Path path,
                                  double h, int step, int steps)
{
  if (step % steps == 0)
    return {x.begin(), x.end()};
  if (path == Path::random)
    return meshes::shaken(x, 0.25 * h, static_cast<unsigned>(step));
  constexpr double pi = std::numbers::pi;
  const double t = static_cast<double>(step) / steps;
  const double wave = 0.5 * std::sin(4 * pi * t);
  const double swirl = std::min(t, 1 - t) / 5;
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); i += 2)
  {
    const double p = x[i], q = x[i + 1];
    if (path == Path::tensor)
    {
      out[i] = (1 - wave) * p + wave * p * p * p;
      out[i + 1] = (1 - wave) * q + wave * q * q;
    }
    else if (not meshes::on_outline({p, q}))
    {
      const double d = swirl * std::sin(2 * pi * p) * std::sin(2 * pi * q);
      out[i] = p + d;
      out[i + 1] = q + d;
    }
  }
  return out;
}

inline double value(Function f, Point p)
{
  constexpr double pi = std::numbers::pi;
  switch (f)
  {
  case Function::sine:
    return 1 + std::sin(2 * pi * p.x) * std::sin(2 * pi * p.y);
  case Function::peak:
  {
    const double r = std::hypot(p.x - 0.5, p.y - 0.5);
    return r < 0.25 ? 1 + 4 * (0.25 - r) : 0.001;
  }
  case Function::shock:
    break;
  }
  return p.y < (p.x - 0.4) / 0.3 ? 1 : 0;
}

/// Mean over a triangle by the rule of three points, degree 2, on n² equal
/// parts.
inline double mean_by_parts(Function f, Point a, Point b, Point c, int n)
{
  double sum = 0;
  const auto at = [&](double s, double t)
  { return value(f, a + s * (b - a) + t * (c - a)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int turned = 0; turned < (i + j < n - 1 ? 2 : 1); ++turned)
        for (int k = 0; k < 3; ++k)
        {
          // Barycentric 1/6, 1/6, 4/6 within the part.
          const double u = k == 0 ? 4.0 / 6 : 1.0 / 6;
          const double v = k == 1 ? 4.0 / 6 : 1.0 / 6;
          sum += turned ? at((i + 1 - u) / n, (j + 1 - v) / n)
                        : at((i + u) / n, (j + v) / n);
        }
  return sum / (3.0 * n * n);
}

/// Exact part of a triangle below the shock: what a line cuts off.
inline double part_below(Point a, Point b, Point c)
{
  const auto depth = [](Point p) { return (p.x - 0.4) - 0.3 * p.y; };
  const std::array<double, 3> d = {depth(a), depth(b), depth(c)};
  const auto inside =
      std::count_if(d.begin(), d.end(), [](double s) { return s > 0; });
  if (inside == 0 or inside == 3)
    return inside == 3 ? 1 : 0;
  // One vertex stands alone; its corner is cut at two parts of its sides.
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double alone = d[i], next = d[(i + 1) % 3], last = d[(i + 2) % 3];
    if ((alone > 0) == (next > 0) or (alone > 0) == (last > 0))
      continue;
    const double corner = alone / (alone - next) * (alone / (alone - last));
    return inside == 1 ? corner : 1 - corner;
  }
  return 0;
}

/// Means of a function over all cells.
inline std::vector<double> means(const remap::Mesh& mesh,
                                 std::span<const double> x, Function f)
{
  std::vector<double> u(mesh.num_cells());
  for (std::int32_t i = 0; i < mesh.num_cells(); ++i)
  {
    const remap::Triple& n = mesh.cell(i);
    const Point a = remap::point(x, n[0]), b = remap::point(x, n[1]),
                c = remap::point(x, n[2]);
    u[i] = f == Function::shock
               ? part_below(a, b, c)
               : mean_by_parts(f, a, b, c, f == Function::sine ? 8 : 24);
  }
  return u;
}

/// Values that a function stays in: its means too.
constexpr std::array<double, 2> range(Function f)
{
  return f == Function::sine   ? std::array{0.0, 2.0}
         : f == Function::peak ? std::array{0.001, 2.0}
                               : std::array{0.0, 1.0};
}

/// What a cycle came to.
struct Result
{
  remap::Outcome outcome = remap::Outcome::ok;
  double error = 0;      ///< L1, relative to that of the function
  double lowest = 0;     ///< value at any step
  double highest = 0;    ///< value at any step
  double mass_error = 0; ///< relative, after the last step
  int cycles = 0;        ///< sub-cycles of all steps
  double seconds = 0;    ///< of the processor, in remaps alone
};

/// A mesh on the unit square with closed walls.
struct Cycle
{
  meshes::Data data;
  double h; ///< side of a square: what `random` measures its shifts in
  remap::Mesh mesh = data.mesh();

  /// n² squares, each cut in two, alternating.
  static Cycle squares(int n)
  {
    return {meshes::rectangle(n, n, meshes::Diagonal::crossed), 1.0 / n};
  }

  /// @param[in] in_range tell the remapper the range of the function
  Result run(Path path, Function function, int steps, remap::Options options,
             bool in_range = false) const
  {
    options.boundaries = std::vector(4, remap::Boundary::closed);
    remap::Remapper remapper(mesh, options);
    std::vector<double> u = means(mesh, data.x, function), x = data.x;
    const std::vector<double> start = u;
    const auto [least, most] = range(function);
    remap::Field field{.values = u};
    if (in_range)
      field.least = {&least, 1}, field.most = {&most, 1};
    remap::Ledger ledger;
    Result out;
    out.lowest = *std::min_element(u.begin(), u.end());
    out.highest = *std::max_element(u.begin(), u.end());
    for (int k = 1; k <= steps; ++k)
    {
      const auto to = placed(data.x, path, h, k, steps);
      const auto begin = std::clock();
      out.outcome = remapper.remap(x, to, {&field, 1}, {}, {}, ledger);
      out.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      if (out.outcome != remap::Outcome::ok)
        return out;
      x = to;
      out.cycles += remapper.report().cycles;
      out.lowest = std::min(out.lowest, *std::min_element(u.begin(), u.end()));
      out.highest =
          std::max(out.highest, *std::max_element(u.begin(), u.end()));
    }
    std::vector<double> v(mesh.num_cells());
    remap::cell_volumes(mesh, options.geometry, data.x, v);
    double before = 0, after = 0;
    for (std::size_t c = 0; c < u.size(); ++c)
    {
      before += v[c] * start[c];
      after += v[c] * u[c];
      out.error += v[c] * std::abs(u[c] - start[c]);
    }
    out.error /= before;
    out.mass_error = (after - before) / before;
    return out;
  }
};
} // namespace cyclic
