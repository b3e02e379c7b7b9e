// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/sweep.h"
#include "support.h"
#include <catch2/catch_test_macros.hpp>
#include <filesystem>

using namespace mmale::scene;
using Words = std::vector<std::string>;

namespace
{
std::string piercing()
{
  return load(std::filesystem::path(DEMOS) / "piercing/scene.toml").text;
}

/// Read the piercing scene with words of a command line.
Reading piercing_with(const Words& arguments)
{
  const Sweep sweep = expand(arguments);
  REQUIRE(test::text_of(sweep.complaints) == "");
  REQUIRE(sweep.members.size() == 1);
  return test::read(piercing(), sweep.members[0].overrides);
}

std::string complaints_with(const Words& arguments)
{
  return test::text_of(piercing_with(arguments).complaints);
}
} // namespace

TEST_CASE("overrides: a value takes the place of the file's", "[scene]")
{
  const Reading reading = piercing_with(
      {"mesh.size=0.05", "mesh.grading.towards=[0.25, 1.5]", "stage.0.step=.01",
       "stage.push.duration=1.",
       "stage.push.boundary.punch.velocity_y={time = [0, 1], value = [0, -1]}",
       "material.billet.yield_stress=3e4", "remap.mode=lagrangian",
       "title=\"two words\"", "boundary.punch.to=0.25",
       "output.curve.p_sy.divide_by=-3e4"});
  CHECK(test::text_of(reading.complaints) == "");
  const Scene& scene = reading.scene;
  CHECK(scene.mesh.size == 0.05);
  CHECK(scene.mesh.grading->towards == Point{0.25, 1.5});
  CHECK(scene.stage.at(0).step == 0.01);
  CHECK(scene.stage.at(0).duration == 1);
  const auto& velocity = scene.stage.at(0).boundary.at("punch").velocity_y;
  CHECK(velocity->time == std::vector<double>{0, 1});
  CHECK(velocity->value == std::vector<double>{0, -1});
  CHECK(scene.material.at("billet").parameters.at("yield_stress") == 3e4);
  CHECK(scene.remap.mode == RemapMode::lagrangian);
  CHECK(scene.title == "two words");
  CHECK(scene.boundary.at("punch").to == 0.25);
  CHECK(scene.output.curve.at("p_sy").divide_by == -3e4);
}

TEST_CASE("overrides: missing tables are made", "[scene]")
{
  const Reading reading = piercing_with(
      {"solver.tolerance=1e-6", "stage.push.boundary.surface.pressure=10",
       "output.picture.p.field=pressure"});
  CHECK(test::text_of(reading.complaints) == "");
  CHECK(reading.scene.solver.tolerance == 1e-6);
  CHECK((*reading.scene.stage[0].boundary.at("surface").pressure)(0) == 10);
  CHECK(reading.scene.output.picture.at("p").field == "pressure");
}

TEST_CASE("overrides: cells as a list, in place of size and grading", "[scene]")
{
  Words arguments = {"mesh.cells=[10,15]", "mesh.size=0"};
  CHECK(complaints_with(arguments).find("mesh.grading: needs mesh.size")
        != std::string::npos);
  std::string text = piercing();
  const auto first = text.find("[mesh.grading]");
  text.erase(first, text.find("[boundary.punch]") - first);
  const Reading reading =
      test::read(text, expand(arguments).members[0].overrides);
  CHECK(test::text_of(reading.complaints) == "");
  CHECK(reading.scene.mesh.cells == std::array{10, 15});
}

TEST_CASE("overrides: mistakes are the command line's, all at once", "[scene]")
{
  CHECK(complaints_with({"mesh.size=-1", "mesh.sice=2", "stage.5.step=1",
                         "stage.pull.step=1", "stage.push.step=nan",
                         "mesh.width.x=1", "material.billet.nu=\"a\"",
                         "remap.mode=euler", "solver.line_search=yes",
                         "mesh.height=[1", "title=", "mesh.cells=4"})
        == "command line: material.billet.nu: must be a number, is the text "
           "\"a\"\n"
           "command line: mesh.cells: must be a list of 2 whole numbers, is "
           "4\n"
           "command line: mesh.height: cannot read the value '[1'; write texts "
           "with spaces or signs in quotes\n"
           "command line: mesh.sice: unknown key, did you mean 'size'? (known: "
           "shape, width, height, origin, corners, file, size, cells, "
           "diagonal, grading, distortion, refine)\n"
           "command line: mesh.size: must be >= 0 m, is -1\n"
           "command line: mesh.width.x: no 'x': mesh.width is 1, it has no "
           "keys\n"
           "command line: remap.mode: unknown 'euler', did you mean "
           "'eulerian'? (known: lagrangian, ale, eulerian)\n"
           "command line: solver.line_search: must be true or false, is the "
           "text \"yes\"\n"
           "command line: stage.5.step: no '5': stage has only: push\n"
           "command line: stage.pull.step: no 'pull': stage has only: push\n"
           "command line: stage.push.step: must be finite, is nan\n"
           "command line: title: cannot read the value ''; write texts with "
           "spaces or signs in quotes\n");
}

TEST_CASE("overrides: a value cannot smuggle in other keys", "[scene]")
{
  CHECK(complaints_with({"mesh.size=0.1\nmesh.width=7"})
        == "command line: mesh.size: cannot read the value '0.1\nmesh.width=7';"
           " write texts with spaces or signs in quotes\n");
}

TEST_CASE("sweep: the product of all lists, the last key fastest", "[scene]")
{
  const Words arguments = {"mesh.size=0.1,0.05", "solver.lag_jacobian=2",
                           "mesh.cells=[1,2],[3,4],[5,6]"};
  const Sweep sweep = expand(arguments);
  CHECK(sweep.complaints.empty());
  REQUIRE(sweep.members.size() == 6);
  const Words folders = {
      "mesh.size=0.1,mesh.cells=[1,2]",  "mesh.size=0.1,mesh.cells=[3,4]",
      "mesh.size=0.1,mesh.cells=[5,6]",  "mesh.size=0.05,mesh.cells=[1,2]",
      "mesh.size=0.05,mesh.cells=[3,4]", "mesh.size=0.05,mesh.cells=[5,6]"};
  for (std::size_t i = 0; i < 6; ++i)
  {
    CHECK(sweep.members[i].folder == folders[i]);
    REQUIRE(sweep.members[i].overrides.size() == 3);
    CHECK(sweep.members[i].overrides[1].value == "2");
    REQUIRE(sweep.members[i].swept.size() == 2);
    CHECK(sweep.members[i].swept[1].key == "mesh.cells");
  }
}

TEST_CASE("sweep: brackets, braces and quotes protect commas", "[scene]")
{
  const Words arguments = {"a=[1,2]", "b={time = [0,1], value = [2,3]}",
                           "c=\"x,y\"", "d='p,q'", "e=\"x,y\",z"};
  const Sweep sweep = expand(arguments);
  REQUIRE(sweep.members.size() == 2);
  CHECK(sweep.members[0].overrides[0].value == "[1,2]");
  CHECK(sweep.members[0].overrides[1].value == "{time = [0,1], value = [2,3]}");
  CHECK(sweep.members[0].overrides[2].value == "\"x,y\"");
  CHECK(sweep.members[0].overrides[3].value == "'p,q'");
  CHECK(sweep.members[1].overrides[4].value == "z");
}

TEST_CASE("sweep: no arguments make one run without a folder", "[scene]")
{
  const Sweep sweep = expand({});
  REQUIRE(sweep.members.size() == 1);
  CHECK(sweep.members[0].overrides.empty());
  CHECK(sweep.members[0].folder.empty());
}

TEST_CASE("sweep: folders stay below the results", "[scene]")
{
  const Words arguments = {"solver.petsc=\"../a b\",/c"};
  const Sweep sweep = expand(arguments);
  REQUIRE(sweep.members.size() == 2);
  CHECK(sweep.members[0].folder == "solver.petsc=.._a_b");
  CHECK(sweep.members[1].folder == "solver.petsc=_c");
}

TEST_CASE("sweep: mistakes", "[scene]")
{
  const Words arguments = {"mesh.size", "=3",  "a..b=1",
                           "x=1",       "x=2", "y=1,2,1"};
  CHECK(test::text_of(expand(arguments).complaints)
        == "command line: 'mesh.size' is not key=value\n"
           "command line: '=3' is not key=value\n"
           "command line: 'a..b=1' is not key=value\n"
           "command line: x: is given twice\n"
           "command line: two runs of the sweep are the same: y=1\n");
  std::string list = "1";
  for (int i = 2; i <= 101; ++i)
    list += "," + std::to_string(i);
  const Words large = {"a=" + list, "b=" + list};
  CHECK(test::text_of(expand(large).complaints)
        == "command line: b: the sweep has more than 10000 runs\n");
}

TEST_CASE("sweep: the table holds keys, outcome and all curves", "[scene]")
{
  const std::vector<Row> rows = {
      {{{"mesh.size", "0.1"}, {"mesh.cells", "[1,2]"}},
       "completed",
       {{"p_sy", 3.25}, {"z_B", 0.25}}},
      {{{"mesh.size", "0.05"}, {"mesh.cells", "[1,2]"}},
       "stopped: \"billet\", cell 7",
       {{"z_B", 0.125}}}};
  CHECK(to_csv(rows)
        == "mesh.size,mesh.cells,outcome,p_sy,z_B\n"
           "0.1,\"[1,2]\",completed,3.25,0.25\n"
           "0.05,\"[1,2]\",\"stopped: \"\"billet\"\", cell 7\",,0.125\n");
}
