// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/describe.h"
#include "support.h"
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

using namespace mmale::scene;
namespace fs = std::filesystem;

namespace
{
/// JSON as the value of a TOML key: inline tables and the same numbers.
std::string toml_of(const nlohmann::ordered_json& json)
{
  if (not json.is_object() and not json.is_array())
    return json.dump();
  std::string text;
  for (const auto& [key, value] : json.items())
    text += (text.empty() ? "" : ", ")
            + (json.is_object() ? key + " = " : std::string()) + toml_of(value);
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string document_of(const std::string& description)
{
  const auto json = nlohmann::ordered_json::parse(description);
  std::string text;
  for (const auto& [key, value] : json.items())
    text += key + " = " + toml_of(value) + "\n";
  return text;
}

/// A scene that uses what the demos do not.
const std::string rich = R"(
symmetry = "axisymmetric"
[mesh]
shape = "rectangle"
width = 1
height = 2.0
origin = [0.5, -1]
size = 0.25
distortion = 0.1
[mesh.grading]
towards = [1, 0]
size = 0.1
growth = 1.2
radius = 0.05
[material.m]
law = "elastic"
E = 1
nu = 0
[[region]]
material = "m"
shape = "everywhere"
[[region]]
material = "m"
shape = "polygon"
points = [[0.5, -1], [1.5, 0], [0.5, 1]]
[[region]]
material = "m"
shape = "half_plane"
point = [1, 0]
normal = [0, 2]
[[region]]
material = "m"
shape = "file"
file = "part.svg"
height = 0.5
at = [0.75, -0.5]
[[stage]]
name = "first"
duration = 2
step = 0.5
step_min = 0.125
step_max = 1
gravity = [0, {time = [0, 1], value = [0, -9.81]}]
[stage.boundary.left]
displacement_x = {time = [0, 2], value = [0, 0.125]}
[stage.boundary.top]
pressure = 5
[[stage]]
name = "second"
duration = 1
step = 1
[solver]
element = "equal_order"
tangent = "continuum"
petsc = "-ksp_view"
[remap]
mode = "eulerian"
quality_below = 0.5
surface = ["top"]
[output]
fields_every = 0.5
[output.curve.a]
quantity = "pressure"
point = [1, 0]
[output.line.b]
from = [0.5, 0]
to = [1.5, 0.5]
points = 7
[output.picture.c]
arrows = true
at = 1.5
)";

const std::string from_gmsh = R"(
[mesh]
shape = "gmsh"
file = "part.geo"
refine = 2
[material.m]
law = "elastic"
E = 1
nu = 0
[[stage]]
name = "only"
duration = 2
step = 0.5
[stage.boundary.hole]
pressure = 1
)";
} // namespace

TEST_CASE("describe: reading the description gives the same scene", "[scene]")
{
  std::vector<std::string> texts = {rich, from_gmsh};
  for (const char* name : {"piercing", "rotating_pulse", "cook_membrane"})
  {
    const FileText file = load(fs::path(DEMOS) / name / "scene.toml");
    REQUIRE(file.complaints.empty());
    texts.push_back(file.text);
  }
  for (const std::string& text : texts)
  {
    const Reading first = test::read(text);
    CHECK(test::text_of(first.complaints) == "");
    const std::string description = describe(first.scene);
    const Reading second = test::read(document_of(description));
    CHECK(test::text_of(second.complaints) == "");
    CHECK(describe(second.scene) == description);
  }
}

TEST_CASE("describe: what was written is what was understood", "[scene]")
{
  const auto json = nlohmann::json::parse(describe(test::read(rich).scene));
  CHECK(json["symmetry"] == "axisymmetric");
  CHECK(json["mesh"]["origin"] == nlohmann::json({0.5, -1}));
  CHECK(not json["mesh"].contains("corners"));
  CHECK(not json["mesh"].contains("cells"));
  CHECK(json["mesh"]["diagonal"] == "right");
  CHECK(json["mesh"]["grading"]["growth"] == 1.2);
  CHECK(json["material"]["m"]["E"] == 1);
  CHECK(json["region"].size() == 4);
  CHECK(json["region"][0]
        == nlohmann::json({{"material", "m"}, {"shape", "everywhere"}}));
  CHECK(json["region"][1]["points"]
        == nlohmann::json({{0.5, -1}, {1.5, 0}, {0.5, 1}}));
  CHECK(json["region"][2]["normal"] == nlohmann::json({0, 2}));
  CHECK(json["region"][3]["file"] == "part.svg");
  CHECK(json["region"][3]["at"] == nlohmann::json({0.75, -0.5}));
  CHECK(json["stage"].size() == 2);
  CHECK(json["stage"][0]["gravity"][0] == 0);
  CHECK(json["stage"][0]["gravity"][1]["value"] == nlohmann::json({0, -9.81}));
  const auto& left = json["stage"][0]["boundary"]["left"];
  CHECK(left["displacement_x"]["time"] == nlohmann::json({0, 2}));
  CHECK(not left.contains("displacement_y"));
  CHECK(json["solver"]["element"] == "equal_order");
  CHECK(json["solver"]["tangent"] == "continuum");
  CHECK(json["remap"]["mode"] == "eulerian");
  CHECK(json["remap"]["surface"] == nlohmann::json({"top"}));
  CHECK(json["output"]["line"]["b"]["points"] == 7);
  CHECK(json["output"]["picture"]["c"]["at"] == 1.5);
  CHECK(not json.contains("motion"));
  CHECK(not json.contains("title"));
}

TEST_CASE("key reference: every key says what it is", "[scene]")
{
  const auto reference = key_reference(test::libraries());
  std::set<std::string> seen, lines;
  for (const KeyInfo& info : reference)
  {
    INFO(info.key);
    seen.insert(info.key);
    CHECK(lines.insert(info.key + info.sentence).second);
    CHECK(info.sentence.size() > 8);
    CHECK(info.sentence.ends_with('.'));
    CHECK(not info.kind.empty());
    // Numbers have a unit, "-" where they have no dimension.
    const bool numeric = info.kind.find("number") != std::string::npos
                         or info.kind.find("point") != std::string::npos;
    CHECK(numeric == not info.unit.empty());
  }
  for (const char* key :
       {"title", "mesh.corners", "mesh.grading.growth", "boundary.NAME.side",
        "material.NAME.law", "material.NAME.hardening",
        "stage.NAME.boundary.NAME.velocity_y", "motion.revolutions",
        "remap.max_loss", "output.picture.NAME.at", "tracer.NAME.radius",
        "region.NUMBER.material", "region.NUMBER.points"})
    CHECK(seen.contains(key));
}

TEST_CASE("key reference: facts stand beside the key", "[scene]")
{
  const std::string text = to_string(key_reference(test::libraries()));
  for (const char* line :
       {"mesh.width: number [m], > 0, required\n"
        "    Width of the rectangle. Only with shape = \"rectangle\".\n",
        "mesh.grading.growth: number, 1 < x <= 2, default 1.15\n",
        "material.NAME.law: text, elastic, j2, required\n",
        "material.NAME.hardening: number [Pa], >= 0, default 0\n"
        "    Slope of the yield stress. Law j2.\n",
        "region.NUMBER.points: list of points [x, y] [m], required\n"
        "    Corners of the polygon, either way round. Only with shape = "
        "\"polygon\".\n",
        "remap.mode: text, lagrangian, ale, eulerian, required\n",
        "remap.smoother: text, average, optimise, default optimise\n",
        "solver.line_search: true or false, default true\n"})
    CHECK(text.find(line) != std::string::npos);
}
