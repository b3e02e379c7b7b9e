// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include <Eigen/Dense>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <random>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
scene::Scene scene_of(const char* law, scene::Symmetry symmetry)
{
  auto scene = test::rectangle(1, 1, 3, 3, law,
                               {{"E", 100}, {"nu", 0.4}, {"density", 1}});
  if (scene.material["body"].law == "j2")
    scene.material["body"].parameters.insert(
        {{"yield_stress", 1}, {"hardening", 3}});
  scene.mesh.distortion = 0.3;
  scene.mesh.origin = {0.2, 0};
  scene.symmetry = symmetry;
  return scene;
}

/// Random displacements and pressures.
std::vector<double> trial(const Body& body, double displacement,
                          double pressure, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> z(3 * body.num_nodes());
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] = (i % 3 == 2 ? pressure : displacement) * uniform(random);
  return z;
}
} // namespace

TEST_CASE("a Newton step with the bubbles as unknowns is the condensed one",
          "[verification][element]")
{
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  Body body(scene_of("j2", symmetry));
  const auto z = trial(body, 0.02, 2, 3); // elastic and plastic cells
  REQUIRE(body.evaluate(z));
  const int nodal = 3 * body.num_nodes();
  const int all = nodal + 2 * body.num_cells();
  std::vector<bool> held(all, false);
  for (int n : body.nodes("left"))
    held[3 * n] = held[3 * n + 1] = true;

  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(nodal, nodal);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(nodal),
                  q = Eigen::VectorXd::Zero(all);
  for (int c = 0; c < body.num_cells(); ++c)
  {
    const auto R = body.residual(c, z);
    const auto J = body.jacobian(c, z);
    std::array<double, 11> R11;
    std::array<double, 121> J121;
    body.full(c, z, R11, J121);
    const auto cell = body.cell(c);
    const auto at = [&](int i)
    { return i < 9 ? 3 * cell[i / 3] + i % 3 : nodal + 2 * c + i - 9; };
    for (int i = 0; i < 11; ++i)
    {
      if (not held[at(i)])
        q[at(i)] += R11[i];
      for (int j = 0; j < 11; ++j)
        if (not held[at(i)])
          B(at(i), at(j)) += J121[11 * i + j];
      if (i < 9 and not held[at(i)])
      {
        r[at(i)] += R[i];
        for (int j = 0; j < 9; ++j)
          A(at(i), at(j)) += J[9 * i + j];
      }
    }
  }
  for (int i = 0; i < all; ++i)
    if (held[i])
    {
      B(i, i) = 1;
      A(i, i) = 1;
    }
  const Eigen::VectorXd condensed = A.fullPivLu().solve(r);
  const Eigen::VectorXd uncondensed = B.fullPivLu().solve(q);
  CHECK(condensed.norm() > 0.01);
  CHECK(uncondensed.tail(2 * body.num_cells()).norm() > 1e-6); // bubbles move
  CHECK((condensed - uncondensed.head(nodal)).norm()
        < 1e-10 * condensed.norm());
}

TEST_CASE("the element's tangent is the derivative of its residual",
          "[verification][element]")
{
  // With p at its value of the start the bubble has nothing to drive it, so
  // that its dependence on the geometry, which the tangent leaves out, is not
  // seen: the tangent must be exact.
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  Body body(scene_of("elastic", symmetry));
  auto z = trial(body, 0.03, 5, 7);
  for (int n = 0; n < body.num_nodes(); ++n)
    body.state().p[n] = z[3 * n + 2];
  std::mt19937_64 random(8);
  for (double& s : body.state().s)
    s = static_cast<double>(random() % 1000) / 100;
  REQUIRE(body.evaluate(z));
  std::vector<std::array<double, 81>> J;
  for (int c = 0; c < body.num_cells(); ++c)
    J.push_back(body.jacobian(c, z));

  const auto d = trial(body, 1, 100, 9);
  constexpr double h = 1e-6; // truncation 1e-12, round-off 1e-10
  std::vector<std::array<double, 9>> slope(body.num_cells());
  for (const double side : {1.0, -1.0})
  {
    auto y = z;
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] += side * h * d[i];
    REQUIRE(body.evaluate(y));
    for (int c = 0; c < body.num_cells(); ++c)
    {
      const auto R = body.residual(c, y);
      for (int i = 0; i < 9; ++i)
        slope[c][i] += side * R[i] / (2 * h);
    }
  }
  for (int c = 0; c < body.num_cells(); ++c)
    for (int i = 0; i < 9; ++i)
    {
      double expected = 0, size = 0;
      for (int j = 0; j < 9; ++j)
      {
        const double term =
            J[c][9 * i + j] * d[3 * body.cell(c)[j / 3] + j % 3];
        expected += term;
        size += std::abs(term);
      }
      INFO("cell " << c << ", row " << i);
      CHECK(slope[c][i] == Approx(expected).margin(1e-7 * size));
    }
}
