// SPDX-License-Identifier: LGPL-3.0-or-later
// Meshes from gmsh on one process: what is read, and every complaint.
#include "mesh/gmsh.h"
#include "mesh/msh.h"
#include "mesh/sides.h"
#include "mesh/sound.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>
#include <unistd.h>

using namespace mmale;
using Catch::Approx;
namespace fs = std::filesystem;

namespace
{
std::string content(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string words(const std::vector<scene::Complaint>& complaints)
{
  std::string text;
  for (const auto& complaint : complaints)
    text += to_string(complaint) + "\n";
  return text;
}

/// A grid from text, and what is said about it.
mesh::Grid read(const std::string& text, const std::string& name,
                std::string& said, bool axisymmetric = false)
{
  std::vector<scene::Complaint> complaints;
  std::istringstream stream(text);
  const mesh::Msh msh = mesh::read_msh(stream, name, complaints);
  mesh::Grid grid;
  if (complaints.empty())
    grid = mesh::make_sound_grid(msh, name, axisymmetric, complaints);
  said = words(complaints);
  return grid;
}

scene::Scene scene_of(const fs::path& file, double refine = 1)
{
  scene::Scene scene;
  scene.mesh.shape = "gmsh";
  scene.mesh.file = file.filename();
  scene.mesh.folder = file.parent_path();
  scene.mesh.refine = refine;
  return scene;
}

double area(const mesh::Grid& g)
{
  double sum = 0;
  for (std::size_t c = 0; c < g.cells.size(); c += 3)
  {
    const double *a = &g.x[2 * g.cells[c]], *b = &g.x[2 * g.cells[c + 1]],
                 *d = &g.x[2 * g.cells[c + 2]];
    const double twice =
        (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
    CHECK(twice > 0);
    sum += 0.5 * twice;
  }
  return sum;
}

/// Folder of this test's own, removed at the end.
struct Folder
{
  fs::path path =
      fs::temp_directory_path() / ("mmale_msh_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};
} // namespace

TEST_CASE("a mesh file is read node by node, in both formats")
{
  const std::string name = GENERATE("square_2.2.msh", "square_4.1.msh");
  INFO(name);
  std::string said;
  const mesh::Grid g = read(content(fs::path(MESHES) / name), name, said);
  CHECK(said == "");
  // Unused nodes (7) and cells of no physical surface are left out; the
  // clockwise surface is turned.
  CHECK(g.x == std::vector<double>{0, 0, 2, 0, 2, 1, 0, 1, 1.25, 0.5});
  CHECK(g.cells
        == std::vector<std::int64_t>{4, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0});
  CHECK(g.names == std::vector<std::string>{"bottom", "walls", ""});
  using Edges = std::set<std::array<std::int64_t, 3>>;
  CHECK(Edges(g.edges.begin(), g.edges.end())
        == Edges{{0, 1, 0}, {1, 2, 1}, {2, 3, 2}, {3, 0, 1}});
  CHECK(area(g) == 2);
}

TEST_CASE("bad mesh files: each gets all of its complaints, word by word")
{
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(fs::path(MESHES) / "bad"))
    if (entry.path().extension() == ".msh")
      paths.push_back(entry.path());
  std::ranges::sort(paths);
  REQUIRE(paths.size() >= 25);
  for (const fs::path& path : paths)
  {
    INFO(path.filename());
    std::string said;
    const mesh::Grid g = read(content(path), path.filename(), said);
    CHECK(said == content(fs::path(path).replace_extension(".txt")));
    CHECK(g.cells.empty());
  }
}

TEST_CASE("a mesh file that is cut off anywhere is refused, never a crash")
{
  const std::string name = GENERATE("square_2.2.msh", "square_4.1.msh");
  const std::string text = content(fs::path(MESHES) / name);
  const auto end = text.find("$EndElements");
  for (std::size_t n = 0; n < end + std::string("$EndElements").size(); ++n)
  {
    std::string said;
    read(text.substr(0, n), name, said);
    CHECK(said != "");
  }
}

TEST_CASE("in axisymmetry nodes stay on their side of the axis")
{
  std::string text = content(fs::path(MESHES) / "square_2.2.msh"), said;
  text.replace(text.find("\n1 0 0 0\n"), 9, "\n1 -1e-13 0 0\n");
  const mesh::Grid g = read(text, "a.msh", said, true);
  CHECK(said == "");
  CHECK(g.x[0] == 0); // round-off of gmsh's
  text.replace(text.find("-1e-13"), 6, "-0.125");
  read(text, "a.msh", said, true);
  CHECK(said
        == "a.msh:12: the radius x must not be negative in axisymmetry: node "
           "1 at (-0.125, 0)\n");
  read(text, "a.msh", said, false);
  CHECK(said == "");
}

TEST_CASE("files that are not there, folders, and meshes without names")
{
  const Folder folder;
  const auto said = [](const fs::path& path)
  { return words(mesh::load_gmsh(scene_of(path)).outline.complaints); };
  const std::string at = folder.path.string();
  CHECK(said(folder.path / "no.msh")
        == "mesh.file: " + at + "/no.msh: no such file\n");
  fs::create_directory(folder.path / "is.msh");
  CHECK(said(folder.path / "is.msh")
        == "mesh.file: " + at + "/is.msh: is a folder\n");
  std::string text = content(fs::path(MESHES) / "square_2.2.msh");
  const auto names = text.find("$PhysicalNames"), nodes = text.find("$Nodes");
  std::ofstream(folder.path / "plain.msh")
      << text.substr(0, names) << text.substr(nodes);
  CHECK(said(folder.path / "plain.msh")
        == at
               + "/plain.msh: no boundary has a name; give physical curves "
                 "names, Physical Curve(\"left\") = {4}\n");
}

TEST_CASE("the outline tells straight boundaries from others")
{
  const auto square =
      mesh::load_gmsh(scene_of(fs::path(MESHES) / "square_4.1.msh"));
  REQUIRE(square.outline.complaints.empty());
  CHECK(square.outline.names() == std::vector<std::string>{"bottom", "walls"});
  const auto* bottom = square.outline.find("bottom");
  const auto* walls = square.outline.find("walls");
  CHECK(bottom->straight);
  CHECK(bottom->extends == std::array{true, false});
  CHECK(not walls->straight); // two lines, both upright
  CHECK(walls->extends == std::array{false, true});
  CHECK(square.outline.low == scene::Point{0, 0});
  CHECK(square.outline.high == scene::Point{2, 1});
  CHECK(square.outline.may_hold({2, 1}));
  CHECK(not square.outline.may_hold({2.001, 1}));

  const auto ring = mesh::load_gmsh(scene_of(fs::path(MESHES) / "ring.msh"));
  REQUIRE(ring.outline.complaints.empty());
  const auto* inner = ring.outline.find("inner");
  CHECK(inner->extends == std::array{true, true});
  CHECK(not inner->straight);
  CHECK(ring.outline.find("level")->extends == std::array{true, false});
  CHECK(not ring.outline.may_hold({0.05, 0.05}));
}

TEST_CASE("sides: straight stretches whole, each edge of an arc alone")
{
  const auto grid =
      *mesh::load_gmsh(scene_of(fs::path(MESHES) / "ring.msh")).grid;
  std::vector<mesh::Side> sides;
  const auto side_of = mesh::find_sides(grid.x, grid.edges, sides);
  REQUIRE(side_of.size() == grid.edges.size());
  int straight = 0, alone = 0;
  for (const auto& side : sides)
    if (side.edges > 1)
    {
      ++straight;
      CHECK(side.length() == Approx(0.1).epsilon(1e-9));
      CHECK((grid.names[side.boundary] == "level"
             or grid.names[side.boundary] == "upright"));
    }
    else
      ++alone;
  CHECK(straight == 2);
  CHECK(alone
        == std::ranges::count_if(grid.edges,
                                 [&](const auto& e)
                                 {
                                   return grid.names[e[2]] == "inner"
                                          or grid.names[e[2]] == "outer";
                                 }));
}

TEST_CASE("a .geo is meshed by gmsh, and arcs stay arcs when refined")
{
  const fs::path file = fs::path(DEMOS) / "thick_cylinder/ring.geo";
  double cells[2], edges[2][2] = {{0, 0}, {0, 0}}; // of inner and outer arc
  for (int k = 0; k < 2; ++k)
  {
    const auto loaded = mesh::load_gmsh(scene_of(file, k + 1));
    REQUIRE(words(loaded.outline.complaints) == "");
    const mesh::Grid& g = *loaded.grid;
    cells[k] = static_cast<double>(g.cells.size()) / 3;
    CHECK(g.names
          == std::vector<std::string>{"inner", "level", "outer", "upright"});
    for (const auto& [a, b, name] : g.edges)
      for (const int arc : {0, 1})
        if (g.names[name] == (arc == 0 ? "inner" : "outer"))
        {
          ++edges[k][arc];
          for (std::int64_t n : {a, b})
            CHECK(std::hypot(g.x[2 * n], g.x[2 * n + 1])
                  == Approx(arc == 0 ? 0.1 : 0.2).epsilon(1e-9));
        }
    // polygons in the arcs, n equal edges each
    const auto sector = [](double r, double n)
    { return 0.5 * r * r * n * std::sin(std::numbers::pi / 2 / n); };
    CHECK(area(g)
          == Approx(sector(0.2, edges[k][1]) - sector(0.1, edges[k][0]))
                 .epsilon(1e-9));
  }
  // edges of 1/40 m on arcs of pi/20 m and pi/10 m; then of half the length
  CHECK(edges[0][0] == 7);
  CHECK(edges[0][1] == 13);
  CHECK(edges[1][0] == 13);
  CHECK(edges[1][1] == 26);
  CHECK(cells[1] / cells[0] == Approx(4).epsilon(0.15));
}

TEST_CASE("what gmsh says about a wrong .geo is told; so is its absence")
{
  const Folder folder;
  const auto said = [&](const std::string& name, const std::string& text)
  {
    std::ofstream(folder.path / name) << text;
    return words(
        mesh::load_gmsh(scene_of(folder.path / name)).outline.complaints);
  };
  const std::string wrong = said("wrong.geo", "Point(1) = {0, 0, 0\n");
  CHECK(wrong.find("wrong.geo: gmsh fails:\n    Error") != std::string::npos);
  CHECK(wrong.find("wrong.geo', line") != std::string::npos);
  CHECK(said("none.geo", "Point(1) = {0, 0, 0};\n").find("has no triangles")
        != std::string::npos);

  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.path.c_str(), 1);
  const std::string absent = said("any.geo", "");
  ::setenv("PATH", path.c_str(), 1);
  CHECK(absent.find("any.geo: the program gmsh, which makes a mesh of it, is "
                    "not there")
        != std::string::npos);
}
