// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support.h"

#include "element/run.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace mmale::element;
using namespace mmale::element::test;
namespace fs = std::filesystem;
namespace scene = mmale::scene;

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

std::string text_of(const std::vector<scene::Complaint>& complaints)
{
  std::string text;
  for (const auto& complaint : complaints)
    text += to_string(complaint) + "\n";
  return text;
}
} // namespace

TEST_CASE(
    "a sand whose name is not known is told alone, not what it would have "
    "brought",
    "[element]")
{
  const std::string text =
      "[material]\nlaw = \"hypoplastic\"\nsand = \"hochsteten\"\n"
      "intergranular_strain = \"on\"\nvoid_ratio = 0.7\n"
      "grain_density = 2650\n"
      + isotropic_start + "[[path]]\nkind = \"oedometric\"\neps_a = 0.01\n";
  const auto said =
      mmale::element::read(text, "test.toml", {}, libraries()).complaints;
  REQUIRE(said.size() == 1);
  CHECK(to_string(said[0]).starts_with(
      "test.toml:3: material.sand: unknown 'hochsteten', did you mean "
      "'hochstetten'? (known: "));
}

TEST_CASE("bad tests: each gets all of its complaints, word by word",
          "[element]")
{
  // a few laws, so that a new one does not change the texts
  scene::Libraries few = libraries();
  std::erase_if(few.laws,
                [](const scene::LawInfo& law)
                {
                  return law.name != "elastic" and law.name != "j2"
                         and law.name != "umat";
                });
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(BAD_TESTS))
  {
    const fs::path path = entry.path();
    if (path.extension() != ".toml")
      continue;
    INFO(path.filename());
    ++seen;
    const Reading reading =
        mmale::element::read(content(path), path.filename().string(), {}, few);
    const std::string expected =
        content(fs::path(path).replace_extension(".txt"));
    CHECK(not expected.empty());
    CHECK(text_of(reading.complaints) == expected);
  }
  CHECK(seen >= 9);
}

TEST_CASE("the tests of the demos have no complaints", "[element]")
{
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(DEMOS))
  {
    if (not entry.is_directory())
      continue;
    const fs::path path = entry.path() / "test.toml";
    INFO(path);
    const Reading reading =
        mmale::element::read(content(path), path.string(), {}, libraries());
    CHECK(text_of(reading.complaints).empty());
    ++seen;
  }
  CHECK(seen >= 2);
}

TEST_CASE("any prefix of a test is answered with complaints that have places",
          "[element]")
{
  const std::string text = content(fs::path(DEMOS) / "oedometer/test.toml");
  for (std::size_t n = 0; n < text.size(); n += 5)
    for (const auto& complaint :
         mmale::element::read(text.substr(0, n), "test.toml", {}, libraries())
             .complaints)
    {
      CHECK(not complaint.what.empty());
      CHECK(complaint.place.file == "test.toml");
      CHECK(complaint.place.line >= 1);
    }
}

TEST_CASE("a material with a name is taken like one without", "[element]")
{
  const std::string rest = isotropic_start
                           + "[[path]]\nname = \"up\"\nkind = \"oedometric\"\n"
                             "eps_a = 0.01\n";
  const std::string named = "[material.clay]" + elastic.substr(11) + rest;
  CHECK(describe(make(named)) == describe(make(elastic + rest)));
  // and changed by either name; a path by its own name or its number
  for (const char* key : {"material.clay.E", "path.up.eps_a", "path.0.eps_a"})
  {
    INFO(key);
    const scene::Override change[] = {{key, "0.5"}};
    const Reading changed =
        mmale::element::read(named, "test.toml", change, libraries());
    CHECK(changed.complaints.empty());
    CHECK(describe(changed.test).find("0.5") != std::string::npos);
  }
}

TEST_CASE("the keys are listed once each, with the laws' own", "[element]")
{
  std::set<std::string> seen;
  for (const auto& info : mmale::element::key_reference(libraries()))
  {
    INFO(info.key);
    CHECK(not info.sentence.empty());
    seen.insert(info.key);
  }
  for (const char* key :
       {"title", "material.law", "material.yield_stress", "material.sand",
        "material.library", "initial.k0", "path.NUMBER.drainage",
        "path.NUMBER.q", "data.file", "solver.tolerance"})
    CHECK(seen.contains(key));
}

TEST_CASE("pictures: panels suit the last path, known points lie in theirs",
          "[element]")
{
  const auto names = [](const Test& test)
  { return columns(test, mmale::material::make_law(test.material)); };
  const Test wet = make(elastic + isotropic_start
                        + "[[path]]\nkind = \"triaxial\"\n"
                          "drainage = \"undrained\"\nq = 1e3\ncycles = 1\n");
  mmale::output::Reference r{.name = "known", .curve = "q"};
  r.take = mmale::output::Reference::Take::at;
  r.at = {"eps_a", 0.01};
  r.reference = 5;
  const auto drawn = sheet(wet, names(wet), std::span(&r, 1));
  REQUIRE(drawn.panels.size() == 4);
  CHECK(drawn.panels[0].x == "p");
  CHECK(drawn.panels[2].y == "pore_pressure");
  CHECK(drawn.panels[3].x == "cycle");
  REQUIRE(drawn.points.size() == 1);
  CHECK(drawn.points[0].at == 0.01);
  CHECK(drawn.points[0].value == 5);
  CHECK(drawn.data.empty());

  // every panel of every kind is of columns that there are
  for (const char* path :
       {"kind = \"isotropic\"\npressure = 1e3",
        "kind = \"oedometric\"\neps_a = 0", "kind = \"triaxial\"\neps_a = 0",
        "kind = \"simple_shear\"\ntau = 0",
        "kind = \"free\"\neps_a = 0\neps_r = 0\neps_t = 0\ntau = 0"})
    for (const char* e : {"", "void_ratio = 0.6\n"})
    {
      INFO(path);
      const Test test =
          make(elastic + isotropic_start + e + "[[path]]\n" + path);
      const auto known = names(test);
      CHECK((std::ranges::find(known, "void_ratio") != known.end())
            == (*e != 0));
      for (const auto& panel : sheet(test, known, {}).panels)
      {
        CHECK(std::ranges::find(known, panel.x) != known.end());
        CHECK(std::ranges::find(known, panel.y) != known.end());
      }
    }
}
