// SPDX-License-Identifier: LGPL-3.0-or-later
// Regions of a scene in the cells; on any number of processes the same.
#include "bridge/paint.h"
#include "mesh/grid.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <unistd.h>

using namespace mmale;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace
{
/// Sand, steel and water, in this order, in a body of 2 m by 1 m.
scene::Scene body()
{
  scene::Scene s;
  s.mesh.shape = "rectangle";
  s.mesh.width = 2;
  s.mesh.height = 1;
  s.mesh.cells = {12, 7};
  s.mesh.distortion = 0.3;
  for (const char* name : {"sand", "steel", "water"})
    s.material[name].law = "elastic";
  return s;
}

mesh::Domain mesh_of(const scene::Scene& s)
{
  return mesh::make_domain(MPI_COMM_WORLD, mesh::make_grid(s.mesh), {});
}

double area(const mesh::Domain& d, int c)
{
  const auto& n = d.cells[static_cast<std::size_t>(c)];
  return std::abs(::remap::twice_area(::remap::point(d.initial_x, n[0]),
                                      ::remap::point(d.initial_x, n[1]),
                                      ::remap::point(d.initial_x, n[2])))
         / 2;
}

/// Area of each material in all cells of all processes, and the number of
/// mixed cells.
std::array<double, 4> totals(const scene::Scene& s)
{
  const mesh::Domain d = mesh_of(s);
  const ::remap::Materials m = bridge::paint(s, d);
  REQUIRE(m.num_cells() == d.num_cells());
  std::array<double, 4> out = {0, 0, 0, 0};
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    for (int k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(k)] += m.fraction(c, k) * area(d, c);
    out[3] += m.pure(c) < 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, out.data(), 4, MPI_DOUBLE, MPI_SUM,
                MPI_COMM_WORLD);
  return out;
}

scene::Region region(const std::string& material, const std::string& shape)
{
  scene::Region r;
  r.material = material;
  r.shape = shape;
  return r;
}
} // namespace

TEST_CASE("regions: all shapes, painted as written", "[unit][regions]")
{
  scene::Scene s = body();
  s.region.push_back(region("water", "everywhere"));
  scene::Region ground = region("sand", "half_plane");
  ground.point = {1, 0.4};
  ground.normal = {-0.1, 2};
  s.region.push_back(ground);
  scene::Region pile = region("steel", "rectangle");
  pile.low = {0.9, 0.25};
  pile.high = {1.1, 3};
  s.region.push_back(pile);
  // The ground's surface: y = 0.4 + 0.05 (x - 1), the pile's shadow cut out.
  const double ground_area = 0.8 - 0.2 * 0.15, pile_area = 0.2 * 0.75;
  const auto first = totals(s);
  CHECK(first[0] == Approx(ground_area).epsilon(1e-14));
  CHECK(first[1] == Approx(pile_area).epsilon(1e-14));
  CHECK(first[2] == Approx(2 - ground_area - pile_area).epsilon(1e-14));
  CHECK(first[3] > 20);
  // The ground over the pile.
  std::swap(s.region[1], s.region[2]);
  const auto other = totals(s);
  CHECK(other[0] == Approx(0.8).epsilon(1e-14));
  CHECK(other[1] == Approx(0.2 * 0.6).epsilon(1e-14));

  SECTION("a disc, and a triangle in it")
  {
    scene::Region disc = region("steel", "circle");
    disc.centre = {0.5, 0.6};
    disc.radius = 0.3;
    scene::Region wedge = region("water", "polygon");
    wedge.points = {{0.4, 0.5}, {0.5, 0.7}, {0.6, 0.5}}; // clockwise
    s.region = {region("sand", "everywhere"), disc, wedge};
    const auto found = totals(s);
    CHECK(found[2] == Approx(0.02).epsilon(1e-13));
    CHECK(found[1] == Approx(std::numbers::pi * 0.09 - 0.02).epsilon(1e-13));
    CHECK(found[0] == Approx(2 - std::numbers::pi * 0.09).epsilon(1e-13));
  }
  SECTION("a file, which the first process alone needs to see")
  {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const fs::path folder = fs::temp_directory_path()
                            / ("mmale_regions_" + std::to_string(::getpid()));
    if (rank == 0)
    {
      fs::create_directories(folder);
      std::ofstream(folder / "l.txt") << "0 0\n3 0\n3 1\n1 1\n1 2\n0 2\n";
    }
    scene::Region drawn = region("steel", "file");
    drawn.drawing.folder = rank == 0 ? folder.string() : "nowhere";
    drawn.drawing.file = "l.txt";
    drawn.drawing.height = 0.5;
    drawn.drawing.at = scene::Point{0.2, 0.3};
    s.region = {region("sand", "everywhere"), drawn};
    const auto found = totals(s);
    CHECK(found[1] == Approx(4 * 0.0625).epsilon(1e-13));
    if (rank == 0)
      fs::remove(folder / "l.txt");
    CHECK_THROWS_WITH(totals(s), ContainsSubstring("region.1.file")
                                     and ContainsSubstring("no such file"));
    if (rank == 0)
      fs::remove_all(folder);
  }
}

TEST_CASE("regions: about an axis, and none at all", "[unit][regions]")
{
  scene::Scene s = body();
  s.symmetry = scene::Symmetry::axisymmetric;
  scene::Region ball = region("steel", "circle");
  ball.centre = {0, 0.5};
  ball.radius = 0.4;
  s.region = {region("sand", "everywhere"), ball};
  const mesh::Domain d = mesh_of(s);
  const ::remap::Materials m = bridge::paint(s, d);
  double volume = 0;
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    const auto& n = d.cells[static_cast<std::size_t>(c)];
    const auto x = [&](std::size_t k)
    { return ::remap::point(d.initial_x, n[k]).x; };
    volume += m.fraction(c, 1) * area(d, c) * (x(0) + x(1) + x(2)) / 3;
  }
  MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  // Chords are nowhere farther from the circle than 1e-4 of its radius, and
  // enclose its area; the ball's volume is then off by less.
  CHECK(volume == Approx(2. / 3 * 0.064).epsilon(1e-4));

  s.region.clear();
  const ::remap::Materials none = bridge::paint(s, d);
  CHECK(none.mixed().empty());
  CHECK(none.num_materials() == 3);
  for (int c = 0; c < d.num_cells(); ++c)
    CHECK(none.pure(c) == 0);
}

TEST_CASE("regions: what they leave bare is told on all processes",
          "[unit][regions]")
{
  scene::Scene s = body();
  scene::Region left = region("sand", "rectangle");
  left.low = {-1, -1};
  left.high = {1.25, 2};
  scene::Region right = region("water", "half_plane");
  right.point = {1.5, 0};
  right.normal = {-1, 0};
  s.region = {left, right};
  CHECK_THROWS_WITH(
      bridge::paint(s, mesh_of(s)),
      ContainsSubstring("region: the body is covered by no region at (1.")
          and ContainsSubstring("0.25 m2 of it in all"));
  s.region[0].high[0] = 1.5;
  const auto found = totals(s);
  CHECK(found[0] == Approx(1.5).epsilon(1e-14));
  CHECK(found[2] == Approx(0.5).epsilon(1e-14));
}

TEST_CASE("regions: ghosts hold what their owners hold", "[unit][regions]")
{
  scene::Scene s = body();
  scene::Region disc = region("steel", "circle");
  disc.centre = {1, 0.5};
  disc.radius = 0.37;
  s.region = {region("sand", "everywhere"), disc};
  mesh::Domain d = mesh_of(s);
  const ::remap::Materials m = bridge::paint(s, d);
  std::vector<double> mine(static_cast<std::size_t>(d.num_cells()));
  for (int c = 0; c < d.num_cells(); ++c)
    mine[static_cast<std::size_t>(c)] = m.fraction(c, 1);
  auto owners = mine;
  d.cell_halo->update(owners, 1);
  CHECK(owners == mine);
}

TEST_CASE("regions: outlines for the checks", "[unit][regions]")
{
  scene::Region r = region("sand", "polygon");
  r.points = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  const auto crossed = bridge::region_outline("region.4", r);
  REQUIRE(crossed.complaints.size() == 1);
  CHECK(to_string(crossed.complaints[0])
        == "region.4.points: point 1: the ring crosses itself near (0.5, 0.5)");
  r.points = {{0, 0}, {3, 1}, {1, 2}};
  const auto good = bridge::region_outline("region.4", r);
  CHECK(good.complaints.empty());
  CHECK(good.low == scene::Point{0, 0});
  CHECK(good.high == scene::Point{3, 2});
  r = region("sand", "file");
  r.drawing.file = "none.svg";
  CHECK(bridge::region_outline("region.4", r).complaints.at(0).key
        == "region.4.file");
}
