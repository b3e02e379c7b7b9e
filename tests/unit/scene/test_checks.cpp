// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check.h"
#include "support.h"
#include <catch2/catch_test_macros.hpp>
#include <limits>

using namespace mmale::scene;

namespace
{
/// A scene built by a program: a block pulled at its right side.
Scene block()
{
  Scene scene;
  scene.mesh.shape = "rectangle";
  scene.mesh.width = 2;
  scene.mesh.height = 1;
  scene.mesh.size = 0.1;
  scene.material["steel"] = {"elastic", {{"E", 2e11}, {"nu", 0.3}}};
  Stage& stage = scene.stage.emplace_back();
  stage.name = "pull";
  stage.duration = 1;
  stage.step = 0.5;
  stage.boundary["left"].roller = true;
  stage.boundary["right"].traction_x = TimeSeries{{}, {1e6}};
  return scene;
}

std::string complaints(const Scene& scene)
{
  return test::text_of(check(scene, test::libraries()));
}
} // namespace

TEST_CASE("checks: a scene built by a program needs no file", "[scene]")
{
  CHECK(complaints(block()) == "");

  Scene scene = block();
  scene.mesh.width = required;
  scene.mesh.height = infinity;
  scene.stage[0].boundary["right"].traction_x = TimeSeries{};
  CHECK(complaints(scene)
        == "mesh.width: missing: Width of the rectangle [m], > 0\n"
           "mesh.height: must be > 0 m, is inf\n"
           "stage.pull.boundary.right.traction_x: has no value\n");
}

TEST_CASE("checks: a forgotten scene complains and does not crash", "[scene]")
{
  const std::string text = complaints({});
  CHECK(text.find("mesh.shape: missing") != std::string::npos);
  CHECK(text.find("stage: missing") != std::string::npos);
  CHECK(text.find("material: missing") != std::string::npos);
}

TEST_CASE("checks: a roller blocks the normal of its side only", "[scene]")
{
  Scene scene = block();
  Condition& left = scene.stage[0].boundary["left"];
  left.velocity_y = TimeSeries{{}, {1}};
  CHECK(complaints(scene) == "");
  left.velocity_x = TimeSeries{{}, {1}};
  CHECK(complaints(scene)
        == "stage.pull.boundary.left.velocity_x: the boundary is a roller "
           "too\n");

  // A slanted side would block a mixture of both directions.
  scene = block();
  scene.mesh.shape = "quadrilateral";
  scene.mesh.corners = {{{0, 0}, {2, 0}, {2, 1}, {0.5, 1}}};
  CHECK(complaints(scene)
        == "stage.pull.boundary.left.roller: the boundary is slanted or "
           "curved; a roller needs one that is straight along x or y\n");
  // Level by its places, whatever the side is called.
  scene.mesh.corners = {{{1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  scene.stage[0].boundary["left"].displacement_x = TimeSeries{{}, {0}};
  CHECK(complaints(scene) == "");
  scene.stage[0].boundary["left"].displacement_y = TimeSeries{{}, {0}};
  CHECK(complaints(scene)
        == "stage.pull.boundary.left.displacement_y: the boundary is a roller "
           "too\n");
}

TEST_CASE("checks: parts of a side may touch, in any order", "[scene]")
{
  Scene scene = block();
  scene.boundary["c"] = {"top", 0.7, 1.5};
  scene.boundary["a"] = {"top", 1.5, infinity};
  scene.boundary["b"] = {"top", -infinity, 0.7};
  CHECK(complaints(scene) == "");
  scene.stage[0].boundary["top"].roller = true;
  CHECK(complaints(scene)
        == "stage.pull.boundary.top: nothing is left of this side: named "
           "boundaries claim all of it\n");
  // A gap in the middle is the side's own again.
  scene.boundary["c"].to = 1.4;
  CHECK(complaints(scene) == "");
}

TEST_CASE("checks: a finer zone counts its cells", "[scene]")
{
  Scene scene = block();
  scene.mesh.grading = {{1, 1}, 1e-3, 1.15, 0};
  CHECK(complaints(scene) == "");
  // A uniform zone of 1 m half-breadth with edges of 0.25 mm alone has
  // 2 * 8000 * 4000 = 6.4e7 cells.
  scene.mesh.grading = {{1, 1}, 2.5e-4, 1.15, 1};
  CHECK(complaints(scene)
        == "mesh.size: makes about 6.4e+07 cells, more than 5e+06\n");
}

TEST_CASE("checks: the nearest name is the one a finger meant", "[scene]")
{
  const std::vector<std::string> known = {"left",     "right", "bottom", "top",
                                          "eulerian", "ale",   "j2"};
  CHECK(nearest("lfet", known) == "left");      // swapped
  CHECK(nearest("rihgt", known) == "right");    // swapped
  CHECK(nearest("botom", known) == "bottom");   // one forgotten
  CHECK(nearest("topp", known) == "top");       // one too many
  CHECK(nearest("euler", known) == "eulerian"); // shortened, not "ale"
  CHECK(nearest("j3", known) == "j2");
  CHECK(nearest("velocity", known) == "");
  CHECK(nearest("left", {}) == "");
  CHECK(suggestion("left", {}) == "none is known");
}

TEST_CASE("checks: NaN lies outside of every range", "[scene]")
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Range& range : {above(0), at_least(0), between(-1, 0.5),
                             from_to(0, 1), unbounded(), Range{}})
    CHECK(not range.holds(nan));
  CHECK(not above(0).holds(0));
  CHECK(at_least(0).holds(0));
  CHECK(not at_least(0).holds(infinity));
  CHECK(from_to(0, 1).holds(1));
  CHECK(not between(0, 1).holds(1));
  CHECK(unbounded().holds(-infinity));
  CHECK(between(-1, 0.5).words() == "-1 < x < 0.5");
  CHECK(from_to(0, 1).words() == "0 <= x <= 1");
  CHECK(Range{-infinity, 3, true, false}.words() == "<= 3");
}

TEST_CASE("checks: regions in any shape, and the reader's complaints",
          "[scene]")
{
  Scene scene = block();
  const auto add = [&](const std::string& shape) -> Region&
  {
    Region& r = scene.region.emplace_back();
    r.material = "steel";
    r.shape = shape;
    return r;
  };
  add("everywhere");
  Region& low = add("rectangle");
  low.low = {-1, -1};
  low.high = {1, 0.5};
  Region& disc = add("circle");
  disc.centre = {2.1, 0.5};
  disc.radius = 0.2;
  Region& half = add("half_plane");
  half.point = {1.9, 0};
  half.normal = {-1, 0};
  add("polygon").points = {{0, 0}, {1, 1}, {1, 0}};
  CHECK(complaints(scene) == "");

  // The half-plane's material is behind its normal: here beyond the mesh.
  scene.region[3].point = {2, 0};
  CHECK(complaints(scene).starts_with("region.3: lies outside the mesh"));
  scene.region[3].normal = {1, 0};
  CHECK(complaints(scene) == "");

  // Shapes whose box the checks do not know are asked for, by their keys.
  std::string asked;
  const RegionReader reader = [&](const std::string& key, const Region& region)
  {
    asked += key + " " + region.shape + "\n";
    return DomainOutline{{0, 1}, {1, 2}, {}};
  };
  CHECK(test::text_of(check(scene, test::libraries(), {}, {}, reader))
        == "region.4: lies outside the mesh, which is (0, 0) to (2, 1); its "
           "box is (0, 1) to (1, 2)\n");
  CHECK(asked == "region.4 polygon\n");
  const RegionReader crossing = [](const std::string& key, const Region&)
  { return DomainOutline{{0, 0}, {0, 0}, {{key + ".points", "crossed", {}}}}; };
  CHECK(test::text_of(check(scene, test::libraries(), {}, {}, crossing))
        == "region.4.points: crossed\n");

  // Nothing of a prescribed motion is made of materials.
  Scene turned = scene;
  turned.region.resize(1);
  turned.motion = {{1, 0.5}, 1};
  CHECK(complaints(turned).find("region.0: is not used") != std::string::npos);
}
