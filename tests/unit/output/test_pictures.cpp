// SPDX-License-Identifier: LGPL-3.0-or-later
#include "folder.h"
#include "output/pictures.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

using namespace mmale::output;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace
{
/// An environment variable for the length of a test.
class Variable
{
public:
  Variable(const char* name, const std::string& value) : _name(name)
  {
    if (const char* old = std::getenv(name))
      _old = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable()
  {
    if (_old.empty())
      ::unsetenv(_name);
    else
      ::setenv(_name, _old.c_str(), 1);
  }

private:
  const char* _name;
  std::string _old;
};

bool is_png(const std::filesystem::path& file)
{
  return read(file).starts_with("\x89PNG\r\n");
}
} // namespace

TEST_CASE("pictures: a curve with a reference is drawn over its own abscissa")
{
  const std::vector<std::string> names = {"z_B", "p_sy", "p_sy_eff", "load"};
  const std::vector<Reference> references = {
      {.name = "p_at_0.05",
       .curve = "p_sy",
       .take = Reference::Take::at,
       .at = {"z_B", 0.05},
       .reference = 2.9685,
       .source = "Prandtl"},
      {.name = "reached", .curve = "z_B", .take = Reference::Take::last}};
  const std::vector<Chart> c = charts(names, references);
  REQUIRE(c.size() == 1);
  CHECK(c[0].name == "p_sy_over_z_B");
  CHECK(c[0].x == "z_B");
  CHECK(c[0].y == std::vector<std::string>{"p_sy", "p_sy_eff"});
  REQUIRE(c[0].references.size() == 1);
  CHECK(c[0].references[0].value == 2.9685);
  CHECK(c[0].references[0].label == "Prandtl");
  CHECK(charts(names, {}).empty());
}

TEST_CASE("pictures: every column is drawn, the scene's apart from the others")
{
  const std::vector<std::string> columns = {"time", "step", "z_B",
                                            "p_sy", "load", "left.reaction_x"};
  const std::vector<Reference> references = {{.name = "p_at_0.05",
                                              .curve = "p_sy",
                                              .take = Reference::Take::at,
                                              .at = {"z_B", 0.05},
                                              .reference = 2.9685}};
  mmale::scene::Scene scene;
  for (const char* name : {"z_B", "p_sy", "load"})
    scene.output.curve[name] = {};
  SECTION("without charts the references make one")
  {
    const auto c = pictures(scene, columns, references, {}).charts;
    REQUIRE(c.size() == 3);
    CHECK(c[0].name == "p_sy_over_z_B");
    CHECK(c[1].name == "curves");
    CHECK(c[1].y == std::vector<std::string>{"load"});
    CHECK(c[1].layout == Layout::panels);
    CHECK(c[2].name == "diagnostics");
    CHECK(c[2].y == std::vector<std::string>{"step", "left.reaction_x"});
    CHECK(c[2].layout == Layout::diagnostics);
  }
  SECTION("the scene's charts take their place")
  {
    scene.output.chart["pull"] = {.x = "load",
                                  .y = {"z_B"},
                                  .references = {{2, "two"}},
                                  .title = "T",
                                  .x_label = "",
                                  .y_label = ""};
    const auto c = pictures(scene, columns, references, {}).charts;
    REQUIRE(c.size() == 3);
    CHECK(c[0].name == "pull");
    CHECK(c[0].x == "load");
    CHECK(c[0].y == std::vector<std::string>{"z_B"});
    CHECK(c[0].references[0].label == "two");
    CHECK(c[0].title == "T");
    CHECK(c[0].layout == Layout::together);
    REQUIRE(c[0].points.size() == 1); // known values at a place
    CHECK(c[0].points[0].x == "z_B");
    CHECK(c[0].points[0].at == 0.05);
    CHECK(c[0].points[0].y == "p_sy");
    CHECK(c[0].points[0].value == 2.9685);
    CHECK(c[1].y == std::vector<std::string>{"p_sy"});
  }
  SECTION("nothing is drawn of nothing")
  {
    CHECK(
        pictures({}, std::vector<std::string>{"time"}, {}, {}).charts.empty());
  }
}

TEST_CASE("pictures: pictures.json says what the scene asked for")
{
  mmale::scene::Scene scene;
  scene.title = "Piercing";
  scene.symmetry = mmale::scene::Symmetry::axisymmetric;
  scene.output.picture["strain"] = {.field = "plastic_strain", .at = 0.5};
  scene.output.picture["flow"] = {.field = "", .arrows = true};
  const json j = json::parse(
      to_json(pictures(scene, {}, {}, {{"plastic_strain", {.unit = "Pa"}}})));
  CHECK(j["title"] == "Piercing");
  CHECK(j["axisymmetric"] == true);
  REQUIRE(j["fields"].size() == 2);
  CHECK(j["fields"][0]["file"] == "flow.png");
  CHECK(j["fields"][0]["time"].is_null());
  CHECK(j["fields"][0]["arrows"] == "velocity");
  CHECK(j["fields"][1]["field"] == "plastic_strain");
  CHECK(j["fields"][1]["unit"] == "Pa");
  CHECK(j["fields"][1]["time"] == 0.5);
  CHECK(j["fields"][1]["arrows"].is_null());
  CHECK(j["domains"].empty());
  const Pictures logo{.domains = {"logo"}};
  const json k = json::parse(to_json(logo));
  CHECK(k["domains"][0]["file"] == "logo.png");
  CHECK(k["domains"][0]["outline"] == "logo.txt");
  CHECK(k["domains"][0]["pieces"] == "logo.vtp");
}

TEST_CASE("pictures: a run's curves become a picture")
{
  const Variable place("MMALE_DRAW", MMALE_DRAW_SOURCE);
  const Folder folder;
  put(folder.path / "curves.csv", "time,a\n0,1\n1,3\n2,2\n");
  Pictures p;
  p.title = "A run";
  p.charts = {{.name = "curves", .x = "time", .y = {"a"}}};
  const std::string warning = draw(folder.path, p);
  CHECK(warning.empty());
  CHECK(is_png(folder.path / "curves.png"));
}

TEST_CASE("pictures: the runs of a sweep are drawn into one chart")
{
  const Variable place("MMALE_DRAW", MMALE_DRAW_SOURCE);
  const Folder folder;
  Pictures p;
  p.charts = {{.name = "curves", .x = "time", .y = {"a"}}};
  const std::vector<std::filesystem::path> members = {folder.path / "k=1",
                                                      folder.path / "k=2"};
  for (const auto& member : members)
  {
    std::filesystem::create_directories(member);
    put(member / "curves.csv", "time,a\n0,1\n1,3\n2,2\n");
    put(member / "pictures.json", to_json(p));
  }
  CHECK(draw_sweep(folder.path, members).empty());
  CHECK(is_png(folder.path / "curves.png"));
  CHECK_THAT(draw_sweep(folder.path, {}), ContainsSubstring("required: runs"));
}

TEST_CASE("pictures: what stops the drawing is told and nothing thrown")
{
  const Folder folder;
  const Pictures p{.title = "x"};
  SECTION("no draw.py")
  {
    const Variable place("MMALE_DRAW", "/nowhere/draw.py");
    CHECK_THAT(draw(folder.path, p), ContainsSubstring("/nowhere/draw.py"));
  }
  SECTION("no Python")
  {
    const Variable place("MMALE_DRAW", MMALE_DRAW_SOURCE);
    const Variable path("PATH", folder.path.string());
    CHECK_THAT(draw(folder.path, p),
               ContainsSubstring("python3: No such file"));
  }
  SECTION("no matplotlib")
  {
    const Variable place("MMALE_DRAW", MMALE_DRAW_SOURCE);
    // A module of that name that cannot be imported.
    put(folder.path / "matplotlib.py", "raise ImportError('none here')\n");
    const Variable modules("PYTHONPATH", folder.path.string());
    CHECK_THAT(draw(folder.path, p), ContainsSubstring("matplotlib")
                                         and ContainsSubstring("none here"));
  }
  SECTION("a failing program")
  {
    put(folder.path / "draw.py", "raise SystemExit('the reason')\n");
    const Variable place("MMALE_DRAW", (folder.path / "draw.py").string());
    CHECK(draw(folder.path, p) == "python3 ended with code 1: the reason");
  }
  SECTION("an unwritable folder")
  {
    CHECK_THAT(draw(folder.path / "no", p), ContainsSubstring("pictures.json"));
  }
}
