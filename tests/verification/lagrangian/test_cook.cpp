// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"
#include "roughness.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <map>

using namespace mmale;
using Catch::Approx;
using test::Body;

namespace
{
constexpr double E = 1e9, nu = 0.4999; // strains of 1e-9: small

/// Cook's membrane, n x n quadrilaterals, load of 1 N/m.
scene::Scene cook(int n, int points = 1)
{
  auto scene = test::rectangle(0, 0, n, n, "elastic",
                               {{"E", E}, {"nu", nu}, {"density", 1e3}});
  scene.mesh.shape = "quadrilateral";
  scene.mesh.corners = {{{0, 0}, {48, 44}, {48, 60}, {0, 44}}};
  scene.mesh.diagonal = scene::Diagonal::left;
  test::use_points(scene, points);
  return scene;
}

scene::Stage loaded(double duration = 1)
{
  auto stage = test::stage(duration);
  stage.boundary["left"].fixed = true;
  stage.boundary["right"].traction_y = test::constant(1.0 / 16);
  return stage;
}

/// v E / F at (48, 52) of the last step of 1 s. Not from the coordinates: they
/// have lost half of its digits.
double deflection(Body& body)
{
  return body.state().v[2 * body.node(48, 52) + 1] * E;
}

enum class Mass
{
  consistent,
  one_point
};

/// The same number from a direct small-strain solve of the MINI element, put
/// together here from its closed-form matrices: bubble b = 27 l1 l2 l3 with
/// int b = 9 A / 20 and int grad b grad b^T = (81 / 20) A sum g_a g_a^T.
double direct(int n, Mass mass)
{
  const double G = 1 / (2 * (1 + nu)), K = 1 / (3 * (1 - 2 * nu));
  const auto node = [n](int i, int j) { return j * (n + 1) + i; };
  std::vector<Eigen::Vector2d> x((n + 1) * (n + 1));
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
    {
      const double a = double(i) / n, b = double(j) / n;
      x[node(i, j)] = {48 * a, (1 - b) * 44 * a + b * (44 + 16 * a)};
    }
  const int size = 3 * static_cast<int>(x.size());
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::array<int, 3> cell)
  {
    Eigen::Matrix2d J;
    J << x[cell[1]] - x[cell[0]], x[cell[2]] - x[cell[0]];
    const double A = J.determinant() / 2;
    Eigen::Matrix<double, 2, 3> g;
    g << -1, 1, 0, -1, 0, 1;
    g = J.inverse().transpose() * g;
    Eigen::Matrix<double, 4, 6> B = Eigen::Matrix<double, 4, 6>::Zero();
    for (int a = 0; a < 3; ++a)
    {
      B(0, 2 * a) = B(3, 2 * a + 1) = g(0, a);
      B(1, 2 * a + 1) = B(3, 2 * a) = g(1, a);
    }
    const Eigen::Vector4d one(1, 1, 1, 0);
    Eigen::Matrix4d D = Eigen::Vector4d(2, 2, 2, 1).asDiagonal();
    D = G * (D - 2. / 3 * one * one.transpose());
    const Eigen::Matrix2d M = 4.05 * A * g * g.transpose();
    const Eigen::Matrix2d bubble =
        G * (M.trace() * Eigen::Matrix2d::Identity() + M / 3);
    const double integral = 0.45 * A;
    Eigen::Matrix<double, 9, 9> k;
    k << A * B.transpose() * D * B,
        -(A / 3) * B.transpose() * one * Eigen::RowVector3d::Ones(),
        Eigen::Matrix<double, 3, 9>::Zero();
    k.bottomLeftCorner<3, 6>() = k.topRightCorner<6, 3>().transpose();
    const Eigen::Matrix3d m =
        mass == Mass::one_point
            ? Eigen::Matrix3d(Eigen::Matrix3d::Constant(A / 9))
            : Eigen::Matrix3d(
                  A / 12
                  * (Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity()));
    k.bottomRightCorner<3, 3>() =
        -m / K - integral * integral * g.transpose() * bubble.inverse() * g;
    const auto unknown = [&](int i)
    { return i < 6 ? 3 * cell[i / 2] + i % 2 : 3 * cell[i - 6] + 2; };
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j)
        if (const int row = unknown(i), column = unknown(j);
            not((row / 3) % (n + 1) == 0 and row % 3 < 2)
            and not((column / 3) % (n + 1) == 0 and column % 3 < 2))
          entries.emplace_back(row, column, k(i, j));
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
    {
      add({node(i, j), node(i + 1, j), node(i, j + 1)});
      add({node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(size);
  for (int j = 0; j <= n; ++j)
  {
    for (int d = 0; d < 2; ++d)
      entries.emplace_back(3 * node(0, j) + d, 3 * node(0, j) + d, 1.0);
    f[3 * node(n, j) + 1] = (j == 0 or j == n ? 0.5 : 1.0) / n;
  }
  Eigen::SparseMatrix<double> S(size, size);
  S.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(S);
  return Eigen::VectorXd(lu.solve(f))[3 * node(n, n / 2) + 1];
}
} // namespace

TEST_CASE("Cook's membrane has the published values of the MINI element",
          "[verification][cook]")
{
  // The published table is that of the consistent mass q p / K; the method's
  // form P has the mass at one point. The direct solve has both.
  const std::map<int, double> published{
      {4, 15.432246}, {8, 17.413737}, {16, 18.137761}, {32, 18.374883}};
  const int n = GENERATE(4, 8, 16, 32);
  const double consistent = direct(n, Mass::consistent);
  const double one_point = direct(n, Mass::one_point);
  Body body(cook(n));
  body.set_stage(loaded());
  REQUIRE(body.step(0, 1));
  const double v = deflection(body);
  CAPTURE(n, v, consistent, one_point);
  CHECK(consistent == Approx(published.at(n)).epsilon(1e-7)); // its digits
  // Strains and rotations of 1e-9 enter the large-strain step.
  CHECK(v == Approx(one_point).epsilon(1e-8));
  CHECK(v == Approx(published.at(n)).epsilon(2e-5)); // the mass
  // and from the table's finest to the value of quadratic elements, 18.51
  if (n == 32)
    CHECK(v == Approx(18.51).epsilon(0.01));
}

TEST_CASE("Cook's membrane under a held load does not creep",
          "[verification][cook]")
{
  Body body(cook(16));
  body.set_stage(loaded(101));
  REQUIRE(body.step(0, 1));
  const double v = deflection(body);
  double crept = 0;
  for (int k = 1; k <= 100; ++k)
  {
    REQUIRE(body.step(k, k + 1));
    crept += deflection(body);
  }
  CHECK(std::abs(crept) < 1e-10 * v);
}

TEST_CASE("constant strain locks where the MINI element does not",
          "[verification][cook]")
{
  auto scene = cook(16);
  scene.solver.element = scene::Element::constant_strain;
  Body body(scene);
  body.set_stage(loaded());
  REQUIRE(body.step(0, 1));
  CHECK(deflection(body) == Approx(10.9).margin(0.05)); // published digits
}

TEST_CASE("equal order without bubble has a checkerboard, MINI has none",
          "[verification][cook]")
{
  double rough[2];
  for (const auto element : {scene::Element::mini, scene::Element::equal_order})
  {
    auto scene = cook(16);
    scene.solver.element = element;
    scene.material["body"].parameters["nu"] = 0.4999999;
    Body body(scene);
    body.set_stage(loaded());
    REQUIRE(body.step(0, 1));
    rough[element == scene::Element::equal_order] =
        test::roughness(body, body.state().p)
        / test::root_mean_square(body.state().p);
  }
  CAPTURE(rough[0], rough[1]);
  CHECK(rough[0] < 0.2); // the corners' own gradients
  CHECK(rough[1] > 10 * rough[0]);
  CHECK(rough[1] > 1);
}

TEST_CASE("Cook's membrane in layout quadrature: what the rules make of the "
          "MINI element",
          "[verification][cook]")
{
  // The points' rules make the bubble softer or stiffer than the exact
  // integrals of the published table do, by h^2.
  const int points = GENERATE(3, 6);
  const std::map<int, double> published{
      {4, 15.432246}, {8, 17.413737}, {16, 18.137761}, {32, 18.374883}};
  CAPTURE(points);
  double before = 0;
  for (const auto& [n, value] : published)
  {
    auto scene = cook(n, points);
    scene.solver.bubble_spring = 0;
    Body body(scene);
    body.set_stage(loaded());
    REQUIRE(body.step(0, 1));
    const double v = deflection(body);
    CAPTURE(n, v, value);
    CHECK(v > before);
    CHECK(v == Approx(value).epsilon(0.02 * 16 / (n * n)));
    before = v;
  }
  CHECK(before == Approx(18.51).epsilon(0.01));
}

TEST_CASE("near incompressibility no layout locks", "[verification][cook]")
{
  // quadratic elements' values; on 8 squares MINI has 94 % of them
  const std::map<double, double> exact{
      {0.49, 18.737}, {0.4999, 18.512}, {0.499999, 18.509}};
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points);
  for (const auto& [poisson, value] : exact)
    for (const bool mini : {true, false})
    {
      if (not mini and (points > 1 or poisson < 0.4999))
        continue;
      auto scene = cook(8, points);
      scene.material["body"].parameters["nu"] = poisson;
      if (not mini)
        scene.solver.element = scene::Element::constant_strain;
      Body body(scene);
      body.set_stage(loaded());
      REQUIRE(body.step(0, 1));
      const double ratio = deflection(body) / value;
      CAPTURE(poisson, mini, ratio);
      if (mini)
        CHECK(ratio > 0.92);
      else
        CHECK(ratio < 0.6);
    }
}
