// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Interfaces in motion, for the study: one line of CSV a case.
//
//   interface_cases methods                     names, one a line
//   interface_cases run CASE T METHOD SQUARES COURANT
//   interface_cases filament METHOD             breadth over square
//   interface_cases fraction METHOD             of a layer in its row of cells
//   interface_cases aspect METHOD               of stretched cells
//   interface_cases draw CASE T METHOD SQUARES COURANT
//
// draw prints polygons: half or end, material or mean, x y x y …; the others
// the numbers of `print`. METHOD may be donor_cell, for run and draw,
// and one_cut: moment of fluid without filaments.

#include "remap/tests/motion.h"

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

using namespace remap;
using motion::Case;
using motion::Result;
using motion::Setting;

namespace
{
/// A reconstruction by its name; `one_cut` is moment of fluid that sees no
/// filaments.
std::optional<Reconstruction> method_named(const std::string& name)
{
  if (name == "one_cut")
    return reconstruction::MomentOfFluid{
        .filament = std::numeric_limits<double>::infinity()};
  return find<Reconstructions>(name);
}

void print(const std::string& method, int squares, double number,
           const Result& r)
{
  const auto& s = r.seconds;
  std::printf("%s,%d,%d,%g,%d,%.6g,%.6g,%.3g,%.6g,%d,%.6g,%lld,%lld,%.6g,%.6g,"
              "%.6g,%s\n",
              method.c_str(), squares, r.cells, number, r.steps, r.error,
              r.relative, r.drift, r.spread, r.pieces, r.mixed,
              static_cast<long long>(r.swept), static_cast<long long>(r.kept),
              s.reconstruct, s.carry, s.move, describe(r.outcome).data());
}

Result result_of(const Case& what, const std::string& method, Setting how)
{
  if (method == "donor_cell")
    return motion::run_donor_cell(what, how);
  how.method = *method_named(method);
  return motion::run(what, how);
}

/// A thin ring that goes along a line and back.
void filament_cases(const std::string& method)
{
  constexpr int squares = 32;
  for (const double breadth :
       {0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0})
  {
    Case what = motion::find_case("shift", 1);
    const Point middle{0.4, 0.4};
    const double half = 0.5 * breadth / squares;
    what.bodies = {shapes::without(shapes::disc(middle, 0.2 + half),
                                   shapes::disc(middle, 0.2 - half))};
    print(method, squares, breadth,
          result_of(what, method, {.squares = squares}));
  }
}

/// A flat layer that reaches so far into a row of cells, once to a shaken mesh:
/// error over a square's area.
void fraction_cases(const std::string& method)
{
  constexpr int n = 32;
  constexpr double h = 1.0 / n;
  const auto data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  const Mesh mesh = data.mesh();
  const auto to = meshes::shaken(data.x, 0.2 * h, 3);
  for (int power = -14; power <= -1; ++power)
  {
    const double depth = std::pow(10.0, power);
    const std::vector<shapes::Body> layer = {
        shapes::part_in(shapes::everything<Geometry::plane>,
                        {{{0, 1}, {0, (n / 2 + depth) * h}}})};
    Result out;
    Materials now = shapes::lay(mesh, data.x, layer, 1e-16);
    out.cells = mesh.num_cells();
    out.steps = 1;
    out.mixed = static_cast<double>(now.mixed().size());
    Interfaces interfaces(mesh, {.method = *method_named(method)});
    VolumeTransport transport(mesh, {});
    MaterialLedger ledger;
    interfaces.reconstruct(data.x, now, {});
    const double before =
        eulerian::volume(mesh, Geometry::plane, data.x, now, 1);
    out.outcome = transport.carry(data.x, to, {}, interfaces.partitions(), now,
                                  {}, ledger);
    out.drift =
        std::abs(eulerian::volume(mesh, Geometry::plane, to, now, 1) - before);
    out.error =
        eulerian::error(mesh, to, now, shapes::lay(mesh, to, layer, 1e-16), 1);
    out.relative = out.error / (h * h);
    out.swept = transport.report().slivers_swept;
    out.kept = transport.report().slivers_kept;
    print(method, n, depth, out);
  }
}

/// An ellipse in cells as flat as itself, along a line and back.
void aspect_cases(const std::string& method)
{
  constexpr int squares = 32;
  for (const double aspect : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0})
  {
    Case what = motion::find_case("shift", 1);
    const auto disc = shapes::disc({0.4, 0.4}, 0.2);
    const double flat = 1 / aspect;
    what.bodies = {[=](const shapes::Outline& cell, Point about)
                   {
                     shapes::Outline round;
                     for (int i = 0; i < cell.size; ++i)
                       round.push({cell[i].x, cell[i].y * aspect});
                     const Moments m = disc(round, {about.x, about.y * aspect});
                     return Moments{flat * m.v, flat * m.x, flat * flat * m.y};
                   }};
    what.flow.stream = [flat](Point p) { return p.y - 0.37 * flat * p.x; };
    what.flow.velocity = [flat](Point) { return Point{1, 0.37 * flat}; };
    print(method, squares, aspect,
          result_of(what, method, {.squares = squares, .height = flat}));
  }
}

void print_polygon(bool end, double value, const Piece& p)
{
  std::printf("%s %.4g", end ? "end" : "half", value);
  for (int i = 0; i < p.size; ++i)
    std::printf(" %.6g %.6g", p[i].x, p[i].y);
  std::printf("\n");
}

void draw(const Case& what, const std::string& method, Setting how)
{
  const auto cell =
      [](const Mesh& mesh, std::span<const double> x, std::int32_t c)
  {
    Piece out;
    for (std::int32_t i : mesh.cell(c))
      out.push(point(x, i));
    return out;
  };
  if (method == "donor_cell")
  {
    (void)motion::run_donor_cell(
        what, how,
        [&](bool end, const Mesh& mesh, std::span<const double> x,
            std::span<const double> f)
        {
          for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
            if (f[c] > 5e-3)
              print_polygon(end, f[c], cell(mesh, x, c));
        });
    return;
  }
  how.method = *method_named(method);
  how.look = [&](bool end, const eulerian::Run& run)
  {
    const Materials& m = run.materials;
    for (std::int32_t c = 0; c < run.mesh->num_cells(); ++c)
    {
      const Piece whole = cell(*run.mesh, run.home, c);
      if (m.row(c) < 0 and m.pure(c) > 0)
        print_polygon(end, m.pure(c), whole);
      if (m.row(c) >= 0)
        split(whole, run.interfaces.partition(m.row(c)),
              [&](int part, const Piece& piece)
              {
                if (const int k = m.parts(m.row(c))[part].material; k > 0)
                  print_polygon(end, k, piece);
              });
    }
  };
  (void)motion::run(what, how);
}

int usage()
{
  std::fprintf(stderr,
               "interface_cases methods | run CASE T METHOD SQUARES COURANT | "
               "filament METHOD | fraction METHOD | aspect METHOD | "
               "draw CASE T METHOD SQUARES COURANT\n");
  return 2;
}
} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto known = [](const std::string& method, bool donor)
  {
    return (donor and method == "donor_cell")
           or method_named(method).has_value();
  };
  if (words.size() == 1 and words[0] == "methods")
    for (const std::string& name : names<Reconstructions>())
      std::printf("%s\n%s", name.c_str(),
                  name == "moment_of_fluid" ? "one_cut\n" : "");
  else if (words.size() == 2 and words[0] == "fraction"
           and known(words[1], false))
    fraction_cases(words[1]);
  else if (words.size() == 2 and words[0] == "filament"
           and known(words[1], true))
    filament_cases(words[1]);
  else if (words.size() == 2 and words[0] == "aspect" and known(words[1], true))
    aspect_cases(words[1]);
  else if (words.size() == 6 and (words[0] == "run" or words[0] == "draw")
           and known(words[3], true))
  {
    const Case what = motion::find_case(words[1], std::stod(words[2]));
    const Setting how{.squares = std::stoi(words[4]),
                      .courant = std::stod(words[5])};
    if (words[0] == "draw")
      draw(what, words[3], how);
    else
      print(words[3], how.squares, how.courant, result_of(what, words[3], how));
  }
  else
    return usage();
  return 0;
}
