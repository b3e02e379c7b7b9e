// SPDX-License-Identifier: LGPL-3.0-or-later
// What rules of few points make of the bubble's stiffness K_bb: its
// eigenvalues against those of exact integration.
#include "body.h"

#include <Eigen/Dense>
#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <vector>

using namespace mmale;
using Catch::Approx;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using test::Body;

namespace
{
using Corners = std::array<Vector2d, 3>;
using Shares = std::array<double, 3>;

/// Integral of grad b grad b^T, b = 27 l_0 l_1 l_2, by points of equal weight.
Matrix2d by_rule(const Corners& x, const std::vector<Shares>& points)
{
  Matrix2d J;
  J << x[1] - x[0], x[2] - x[0];
  Eigen::Matrix<double, 2, 3> g;
  g << -1, 1, 0, -1, 0, 1;
  g = (J.inverse().transpose() * g).eval();
  Matrix2d sum = Matrix2d::Zero();
  for (const Shares& l : points)
  {
    const Vector2d grad = 27
                          * (l[1] * l[2] * g.col(0) + l[0] * l[2] * g.col(1)
                             + l[0] * l[1] * g.col(2));
    sum += grad * grad.transpose();
  }
  return 0.5 * J.determinant() / static_cast<double>(points.size()) * sum;
}

/// And in closed form: 81 / 20 of the area times the sum of g_a g_a^T.
Matrix2d exactly(const Corners& x)
{
  Matrix2d J;
  J << x[1] - x[0], x[2] - x[0];
  Eigen::Matrix<double, 2, 3> g;
  g << -1, 1, 0, -1, 0, 1;
  g = (J.inverse().transpose() * g).eval();
  return 4.05 * 0.5 * J.determinant() * g * g.transpose();
}

/// Integral of 2 dev eps(b) : eps(b) from that of grad b grad b^T.
Matrix2d stiffness(const Matrix2d& M)
{
  return M.trace() * Matrix2d::Identity() + M / 3;
}

/// Smallest and largest eigenvalue of A against B.
std::array<double, 2> against(const Matrix2d& A, const Matrix2d& B)
{
  const Vector2d l = Eigen::GeneralizedSelfAdjointEigenSolver<Matrix2d>(
                         A, B, Eigen::EigenvaluesOnly)
                         .eigenvalues();
  return {l[0], l[1]};
}

std::vector<Shares> turned(double a, double b, double c)
{
  return {{a, b, c}, {b, c, a}, {c, a, b}};
}
} // namespace

TEST_CASE("the bubble's stiffness by few points: definite, and near the exact "
          "one",
          "[verification][bubble]")
{
  // at rest with G = 1; thin and distorted cells
  const double height = GENERATE(1.0, 0.05);
  const int points = GENERATE(1, 3, 6);
  CAPTURE(height, points);
  auto scene = test::rectangle(1, height, 3, 3, "elastic",
                               {{"E", 2.6}, {"nu", 0.3}, {"density", 1}});
  scene.mesh.distortion = 0.3;
  scene.solver.bubble_spring = 0;
  test::use_points(scene, points);
  Body body(scene);
  const std::vector<double> z(3 * body.num_nodes(), 0);
  REQUIRE(body.evaluate(z));
  auto six = turned(11. / 18, 5. / 18, 2. / 18);
  for (const Shares& l : turned(11. / 18, 2. / 18, 5. / 18))
    six.push_back(l);
  const auto three = turned(4. / 9, 4. / 9, 1. / 9);
  double low[2] = {1e9, 1e9}, high[2] = {0, 0};
  for (int c = 0; c < body.num_cells(); ++c)
  {
    Corners x;
    for (int v = 0; v < 3; ++v)
      x[v] = Vector2d(&body.state().x[2 * body.cell(c)[v]]);
    if ((x[1][0] - x[0][0]) * (x[2][1] - x[0][1])
        < (x[2][0] - x[0][0]) * (x[1][1] - x[0][1]))
      std::swap(x[1], x[2]);
    const Matrix2d exact = stiffness(exactly(x));
    std::array<double, 11> R;
    std::array<double, 121> J;
    body.full(c, z, R, J);
    const Matrix2d K{{J[108], J[109]}, {J[119], J[120]}};
    const Matrix2d expected =
        points == 1 ? exact : stiffness(by_rule(x, points == 3 ? three : six));
    CHECK((K - expected).norm() < 1e-11 * expected.norm());
    // beside it Gauss' three points of degree 2, and the centroid alone
    const auto ours = against(K, exact);
    const auto gauss =
        against(stiffness(by_rule(x, turned(1. / 6, 1. / 6, 2. / 3))), exact);
    low[0] = std::min(low[0], ours[0]);
    high[0] = std::max(high[0], ours[1]);
    low[1] = std::min(low[1], gauss[0]);
    high[1] = std::max(high[1], gauss[1]);
    const std::vector<Shares> centroid{{1. / 3, 1. / 3, 1. / 3}};
    CHECK(stiffness(by_rule(x, centroid)).norm() < 1e-12 * exact.norm());
  }
  CAPTURE(low[0], high[0], low[1], high[1]);
  // one number whatever the cell: the sum over turned points has the cell's own
  // symmetry. Gauss' points are stable too, but 2.4 times too soft.
  const double share = points == 1 ? 1 : points == 3 ? 320. / 243 : low[0];
  CHECK(low[0] == Approx(share).epsilon(1e-9));
  CHECK(high[0] == Approx(low[0]).epsilon(1e-9));
  CHECK(std::abs(low[0] - 1) < 0.33);
  CHECK(low[1] == Approx(5. / 12).epsilon(1e-9));
  CHECK(high[1] == Approx(5. / 12).epsilon(1e-9));
}
