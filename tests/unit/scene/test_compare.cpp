// SPDX-License-Identifier: LGPL-3.0-or-later
// With which scene a run may go on that was begun with another.
#include "scene/compare.h"

#include <catch2/catch_test_macros.hpp>

using namespace mmale::scene;
using Lines = std::vector<std::string>;

namespace
{
/// A run of two stages, as `describe` writes it.
std::string text(const std::string& mesh = R"({"size": 0.1})",
                 const std::string& first = R"("duration": 2.0)",
                 const std::string& second = R"("duration": 1.0)",
                 const std::string& rest = R"("solver": {"tolerance": 1e-8})")
{
  return R"({"title": "a", "mesh": )" + mesh
         + R"(, "stage": [{"name": "push", )" + first
         + R"(}, {"name": "pull", )" + second + "}], " + rest + "}";
}
const std::string before = text();
} // namespace

TEST_CASE("compare: the same scene has no differences")
{
  CHECK(differences(before, before, {0, 1}).empty());
}

TEST_CASE("compare: a key that differs is named with both values")
{
  CHECK(differences(before, text(R"({"size": 0.2})"), {0, 1})
        == Lines{"mesh.size was 0.1 and is 0.2"});
  CHECK(differences(before, text(R"({"size": 0.1, "refine": 2.0})"), {0, 1})
        == Lines{"mesh.refine was nothing and is 2.0"});
  CHECK(differences(before, text("{}"), {0, 1})
        == Lines{"mesh.size was 0.1 and is nothing"});
}

TEST_CASE("compare: past stages stay, later ones may be any")
{
  const auto shorter = text(R"({"size": 0.1})", R"("duration": 1.5)");
  CHECK(differences(before, shorter, {1, 0.5})
        == Lines{"stage.push.duration was 2.0 and is 1.5"});
  const auto other =
      text(R"({"size": 0.1})", R"("duration": 2.0)", R"("step": 3.0)");
  CHECK(differences(before, other, {0, 1}).empty());
}

TEST_CASE("compare: the present stage may end later than now, not before")
{
  const auto at = [](const std::string& stage)
  { return text(R"({"size": 0.1})", stage); };
  CHECK(differences(before, at(R"("duration": 5.0)"), {0, 1}).empty());
  CHECK(differences(before, at(R"("duration": 1.0)"), {0, 1}).empty());
  CHECK(
      differences(before, at(R"("duration": 0.5)"), {0, 1})
      == Lines{"stage.push.duration is 0.5 s, but the run is at 1.0 s of it"});
  CHECK(differences(before, at(R"("duration": 2.0, "step_min": 1e-3)"), {0, 1})
            .empty());
  CHECK(differences(before, at(R"("duration": 2.0, "step": 1e-3)"), {0, 1})
        == Lines{"stage.push.step was nothing and is 0.001"});
}

TEST_CASE("compare: how hard the solver tries and what is drawn may change")
{
  const auto rest = [](const std::string& words)
  {
    return text(R"({"size": 0.1})", R"("duration": 2.0)", R"("duration": 1.0)",
                words);
  };
  CHECK(differences(before, rest(R"("solver": {"tolerance": 1e-6}, "output":
                         {"checkpoint_every": 5.0, "picture": {"a": {}},
                          "chart": {"b": {"x": "time"}}})"),
                    {0, 1})
            .empty());
  CHECK(differences(before,
                    rest(R"("solver": {"tolerance": 1e-8, "element": "mini"})"),
                    {0, 1})
        == Lines{"solver.element was nothing and is \"mini\""});
  CHECK(differences(before, rest(R"("solver": {"tolerance": 1e-8},
                         "output": {"curve": {"a": {"point": [0]}}})"),
                    {0, 1})
            .size()
        == 1);
}
