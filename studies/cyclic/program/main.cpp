// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Cases of the remap library alone, for studies: one line of CSV a case.
//
//   remap_cases schemes                        names, one a line
//   remap_cases cyclic SCHEME METHOD SQUARES   every path and function
//   remap_cases border SCHEME METHOD LOSS      a jump moved by 0.1 to 3 cells
//   remap_cases local                          a part of 131 072 cells

#include "remap/tests/cyclic.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>

using namespace remap;

namespace
{
double now()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// By its name on the command line.
std::optional<Method> method_named(const std::string& name)
{
  if (name == "swept")
    return Method::swept;
  if (name == "overlay")
    return Method::overlay;
  return {};
}

/// 80 remaps that end where they began.
void cyclic_cases(const std::string& name, const std::string& method,
                  int squares)
{
  const auto cycle = cyclic::Cycle::squares(squares);
  for (const auto function : cyclic::functions)
    for (const auto path : cyclic::paths)
    {
      const Options options = {.method = *method_named(method),
                               .scheme = *find<Schemes>(name),
                               .max_loss = 0.999};
      const bool range = name == scheme::SmoothExtrema::name;
      // The fastest of a few: small meshes are over in milliseconds.
      cyclic::Result best = cycle.run(path, function, 80, options, range);
      for (int k = 1; k < (squares < 40 ? 3 : 1); ++k)
        best.seconds =
            std::min(best.seconds,
                     cycle.run(path, function, 80, options, range).seconds);
      const auto [least, most] = cyclic::range(function);
      std::printf("%s,%s,%s,%s,%d,%d,%.6g,%.6g,%.3g,%.3g,%d,%s\n", name.c_str(),
                  method.c_str(), cyclic::name(function).data(),
                  cyclic::name(path).data(), squares, cycle.mesh.num_cells(),
                  best.seconds, best.error,
                  std::max({0.0, least - best.lowest, best.highest - most}),
                  best.mass_error, best.cycles, describe(best.outcome).data());
    }
}

/// Nodes of a mesh on the unit square, moved by a wave of shear; the walls
/// stand.
std::vector<double> wave(std::span<const double> x, double amplitude)
{
  constexpr double pi = std::numbers::pi;
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); i += 2)
    if (not meshes::on_outline({x[i], x[i + 1]}))
      out[i] += amplitude * std::sin(pi * x[i]) * std::sin(2 * pi * x[i + 1]);
  return out;
}

/// The shock, 20 times away and home by so many cells.
void border_cases(const std::string& name, const std::string& method,
                  double max_loss)
{
  constexpr int squares = 32, times = 20;
  const auto cycle = cyclic::Cycle::squares(squares);
  const auto start =
      cyclic::means(cycle.mesh, cycle.data.x, cyclic::Function::shock);
  std::vector<double> v(start.size());
  cell_volumes(cycle.mesh, Geometry::plane, cycle.data.x, v);
  for (const double cells :
       {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0})
  {
    const auto away = wave(cycle.data.x, cells / squares);
    Remapper remapper(cycle.mesh,
                      {.method = *method_named(method),
                       .scheme = *find<Schemes>(name),
                       .max_loss = max_loss,
                       .boundaries = std::vector(4, Boundary::closed)});
    auto u = start;
    const Field field{.values = u};
    Ledger ledger;
    Outcome outcome = Outcome::ok;
    double beyond = 0;
    int cycles = 0;
    const double begin = now();
    for (int k = 0; k < 2 * times and outcome == Outcome::ok; ++k)
    {
      const auto& from = k % 2 == 0 ? cycle.data.x : away;
      const auto& to = k % 2 == 0 ? away : cycle.data.x;
      outcome = remapper.remap(from, to, {&field, 1}, {}, {}, ledger);
      cycles += remapper.report().cycles;
      for (const double value : u)
        beyond = std::max({beyond, -value, value - 1});
    }
    const double seconds = now() - begin;
    double error = 0, before = 0, after = 0;
    for (std::size_t c = 0; c < u.size(); ++c)
    {
      error += v[c] * std::abs(u[c] - start[c]);
      before += v[c] * start[c];
      after += v[c] * u[c];
    }
    std::printf("%s,%s,%g,%g,%.6g,%.6g,%.3g,%.3g,%d,%s\n", name.c_str(),
                method.c_str(), max_loss, cells, seconds, error / before,
                beyond, (after - before) / before, cycles,
                describe(outcome).data());
  }
}

/// Seconds of one remap of the cells around nodes in a square patch, or of as
/// many nodes in patches of nine.
double local_seconds(const cyclic::Cycle& cycle, int side, bool scattered,
                     std::int32_t& touched)
{
  const auto n = static_cast<int>(std::lround(1 / cycle.h));
  const auto moved = meshes::shaken(cycle.data.x, 0.25 * cycle.h, 1);
  std::vector<double> to = cycle.data.x;
  const auto move = [&](int i, int j)
  {
    const auto k = static_cast<std::size_t>(2 * (j * (n + 1) + i));
    to[k] = moved[k], to[k + 1] = moved[k + 1];
  };
  if (not scattered)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        move((n - side) / 2 + i + 1, (n - side) / 2 + j + 1);
  else
  {
    const int patches = std::max(1, side * side / 9);
    const int row = static_cast<int>(std::ceil(std::sqrt(patches)));
    for (int p = 0; p < patches; ++p)
      for (int q = 0; q < 9; ++q)
        move(1 + (p % row) * (n - 4) / row + q % 3,
             1 + (p / row) * (n - 4) / row + q / 3);
  }
  Remapper remapper(
      cycle.mesh,
      {.max_loss = 0.999, .boundaries = std::vector(4, Boundary::closed)});
  auto u = cyclic::means(cycle.mesh, cycle.data.x, cyclic::Function::shock);
  const Field field{.values = u};
  Ledger ledger;
  double best = std::numeric_limits<double>::max();
  const double begin = now();
  for (int k = 0; k < 40 and (k < 6 or now() - begin < 1.5); ++k)
  {
    const double from = now();
    if (remapper.remap(k % 2 ? to : cycle.data.x, k % 2 ? cycle.data.x : to,
                       {&field, 1}, {}, {}, ledger)
        != Outcome::ok)
      return std::numeric_limits<double>::quiet_NaN();
    best = std::min(best, now() - from);
    touched = remapper.report().touched_cells;
  }
  return best;
}

void local_cases()
{
  const auto cycle = cyclic::Cycle::squares(256);
  for (const bool scattered : {false, true})
    for (const int side : {1, 3, 8, 25, 45, 80, 140, 255})
    {
      if (scattered and (side < 3 or side > 200))
        continue;
      std::int32_t touched = 0;
      const double seconds = local_seconds(cycle, side, scattered, touched);
      std::printf("%s,%d,%.6g,%.6g\n", scattered ? "scattered" : "one patch",
                  touched, 100.0 * touched / cycle.mesh.num_cells(), seconds);
    }
}

int usage()
{
  std::fprintf(stderr, "remap_cases schemes | cyclic SCHEME METHOD SQUARES "
                       "| border SCHEME METHOD MAX_LOSS | local\n");
  return 2;
}
} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 1 and words[0] == "schemes")
    for (const std::string& name : names<Schemes>())
      std::printf("%s\n", name.c_str());
  else if (words.size() == 1 and words[0] == "local")
    local_cases();
  else if (words.size() == 4 and find<Schemes>(words[1])
           and method_named(words[2]))
  {
    if (words[0] == "cyclic")
      cyclic_cases(words[1], words[2], std::stoi(words[3]));
    else if (words[0] == "border")
      border_cases(words[1], words[2], std::stod(words[3]));
    else
      return usage();
  }
  else
    return usage();
  return 0;
}
