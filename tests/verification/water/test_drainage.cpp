// SPDX-License-Identifier: LGPL-3.0-or-later
// What is said of a scene's water before it is run.
#include "drainage.h"

#include "soil.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace mmale;
using namespace mmale::test;
using Catch::Approx;

TEST_CASE("vibratory driving in coarse and in finer sand", "[water][drainage]")
{
  // 20 Hz, 50 mm, E_oed = 20 MPa in the skeleton; k / gamma_w E_oed / (f D^2)
  // by hand, water as incompressible: 40.8 and 0.408
  const double nu = 0.25;
  Soil soil{.E = 20e6 * (1 + nu) * (1 - 2 * nu) / (1 - nu), .nu = nu};
  for (const auto& [k, T_v, model] :
       {std::tuple{1e-3, 40.77, "dry"}, std::tuple{1e-5, 0.4077, "seepage"},
        std::tuple{1e-6, 0.04077, "undrained"}})
  {
    soil.k = k;
    auto scene = soil.rectangle(2, 1, 2, 2);
    scene.stage.push_back(stage(1, 0.1));
    scene.water->frequency = 20;
    scene.water->drainage_length = 0.05;
    const auto said = drainage(scene);
    REQUIRE(said);
    CHECK(said->T_v == Approx(T_v).epsilon(0.01)); // M / K_w = 0.4 %
    CHECK(said->recommended == model);
    CHECK(said->words().find("T_v") != std::string::npos);
  }
}

TEST_CASE("frequency and length of a scene, where nothing is said of them",
          "[water][drainage]")
{
  const Soil soil;
  auto scene = soil.rectangle(2, 1, 2, 2);
  scene.stage.push_back(stage(10, 0.1));
  scene.stage.push_back(stage(4, 0.1));
  const auto said = drainage(scene);
  CHECK(said->frequency == 0.25);
  CHECK(said->length == 1);
  scene.water->permeability = 0;
  CHECK(drainage(scene)->recommended.empty());
  scene.water.reset();
  CHECK_FALSE(drainage(scene));
}
