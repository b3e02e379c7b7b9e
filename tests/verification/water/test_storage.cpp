// SPDX-License-Identifier: LGPL-3.0-or-later
// Steps so short that no water moves: what storage and bubble are for.
#include "roughness.h"
#include "soil.h"
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using namespace mmale::test;

namespace
{
/// Pore pressures down from a drained loaded top after one short step, over
/// the exact one, which is 1 everywhere below the top.
std::vector<double> after_short_step(const char* storage, double K_f,
                                     scene::Diagonal diagonal)
{
  const Soil soil{.k = 1e-14, .K_f = K_f, .K_s = 10 * K_f};
  const int n = 16;
  auto scene = soil.rectangle(0.25, 1, 4, n);
  scene.water->storage = storage;
  scene.mesh.diagonal = diagonal;
  Body body(scene);
  auto s = trough();
  s.boundary["top"].pressure = constant(1e3);
  s.boundary["top"].drained = true;
  body.set_stage(s);
  REQUIRE(body.step(0, 1e-3));
  const double p_0 = 1e3 / soil.M() / (1 / soil.M() + 1 / soil.K_w());
  std::vector<double> out;
  for (int i = n; i >= 0; --i)
    out.push_back(body.state().p_w[body.node(0.125, double(i) / n)] / p_0);
  return out;
}

double layer_under_strip(scene::Element element, double K_f)
{
  const Soil soil{.K_f = K_f, .K_s = 10 * K_f};
  auto scene = soil.rectangle(2, 1, 20, 10);
  scene.solver.element = element;
  scene.water->drainage = "undrained";
  scene.boundary["strip"] = {"top", 0, 0.5};
  Body body(scene);
  auto s = trough();
  s.boundary["bottom"] = {};
  s.boundary["bottom"].fixed = true;
  s.boundary["strip"].pressure = constant(1e3);
  body.set_stage(s);
  REQUIRE(body.step(0, 1));
  return roughness(body, body.state().p) / 1e3;
}
} // namespace

TEST_CASE("no flow, drained loaded top: lumped storage hardly overshoots, "
          "consistent storage swings",
          "[water][storage]")
{
  const auto diagonal =
      GENERATE(scene::Diagonal::right, scene::Diagonal::alternating);
  // water as it is, and a thousand times stiffer
  for (const double K_f : {2.2e9, 2.2e12})
  {
    const auto lumped = after_short_step("lumped", K_f, diagonal),
               consistent = after_short_step("consistent", K_f, diagonal);
    CAPTURE(K_f, lumped, consistent);
    CHECK(lumped[0] == 0);
    CHECK(*std::ranges::max_element(lumped) < 1.01);
    CHECK(*std::min_element(lumped.begin() + 1, lumped.end()) > 0.98);
    double swing = 0;
    for (std::size_t i = 1; i < consistent.size(); ++i)
      swing = std::max(swing, std::abs(consistent[i] - 1));
    CHECK(swing > 0.4);
  }
}

TEST_CASE("strip load on an undrained layer: a checkerboard without the bubble",
          "[water][storage]")
{
  // p is at most the load; its own second differences at the strip's edge are
  // within the bubble's answer
  const double with = layer_under_strip(scene::Element::mini, 2.2e9);
  const double without = layer_under_strip(scene::Element::equal_order, 2.2e9);
  CAPTURE(with, without);
  CHECK(with < 0.05);
  CHECK(without > 10 * with);
}
