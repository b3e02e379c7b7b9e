// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"
#include "tangents.h"

#include <Eigen/Dense>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace mmale;
using Catch::Approx;
using test::Body;
using test::tangent_error;
using test::trial;

namespace
{
scene::Scene scene_of(const char* law, scene::Symmetry symmetry, int points)
{
  auto scene = test::rectangle(1, 1, 3, 3, law,
                               {{"E", 100}, {"nu", 0.4}, {"density", 1}});
  if (scene.material["body"].law == "j2")
    scene.material["body"].parameters.insert(
        {{"yield_stress", 1}, {"hardening", 3}});
  scene.mesh.distortion = 0.3;
  scene.mesh.origin = {0.2, 0};
  scene.symmetry = symmetry;
  test::use_points(scene, points);
  return scene;
}
} // namespace

TEST_CASE("a Newton step with the bubbles as unknowns is the condensed one",
          "[verification][element]")
{
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  const int points = GENERATE(1, 3, 6);
  CAPTURE(symmetry, points);
  Body body(scene_of("j2", symmetry, points));
  // elastic and plastic cells; what bubbles of plastic points can still hold
  const auto z = trial(body, 0.02, points == 1 ? 2 : 0.3, 3);
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
  Body body(scene_of("elastic", symmetry, 1));
  auto z = trial(body, 0.03, 5, 7);
  for (int n = 0; n < body.num_nodes(); ++n)
    body.state().p[n] = z[3 * n + 2];
  std::mt19937_64 random(8);
  for (double& s : body.state().s)
    s = static_cast<double>(random() % 1000) / 100;
  // truncation 1e-12, round-off 1e-10
  CHECK(tangent_error(body, z, 1e-6) < 1e-7);
}

TEST_CASE("about a homogeneous strain the tangent is exact, up to the step's "
          "strain in the bubbles of layout quadrature",
          "[verification][element]")
{
  // A stretch of a tenth in one stress: bubbles at rest, the rest at its
  // largest. The points' bubbles do not move the geometry, the tangent takes
  // them as if they did. (Layout mean about an axis takes the plastic flow at
  // all points of the bubble's rule instead of in the middle, O(h / r)^2.)
  const char* law = GENERATE("elastic", "j2");
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  const int points = GENERATE(1, 3, 6);
  const bool round = symmetry == scene::Symmetry::axisymmetric;
  double error[2];
  for (int level = 0; level < 2; ++level)
  {
    const double share = level ? 0.1 : 1;
    auto scene = scene_of(law, symmetry, points);
    if (law == std::string("j2"))
      scene.material["body"].parameters["yield_stress"] = 0.1;
    Body body(scene);
    std::vector<double> z(3 * body.num_nodes(), 2);
    for (int n = 0; n < body.num_nodes(); ++n)
    {
      const double x = share * body.state().x[2 * n],
                   y = share * body.state().x[2 * n + 1];
      z[3 * n] = 0.08 * x + (round ? 0 : 0.05 * y);
      z[3 * n + 1] = -0.06 * y - (round ? 0 : 0.03 * x);
      body.state().p[n] = 2;
    }
    error[level] = tangent_error(body, z, 1e-6);
  }
  CAPTURE(law, symmetry, points, error[0], error[1]);
  if (points > 1)
  {
    CHECK(error[0] < 0.06);
    CHECK(error[1] < 0.6 * error[0]);
  }
  else if (round and law == std::string("j2"))
    CHECK(error[0] < 0.06);
  else
    CHECK(error[0] < 1e-7);
}

TEST_CASE("the tangent is exact for small steps, with inertia and damping, in "
          "every layout",
          "[verification][element]")
{
  // What the tangent leaves out, the bubble's part in the change of geometry,
  // goes with the strain, 1e-4 here. J2 starts on its yield surface: some
  // cells flow, some unload.
  const char* law = GENERATE("elastic", "j2");
  const auto symmetry =
      GENERATE(scene::Symmetry::plane_strain, scene::Symmetry::axisymmetric);
  const int points = GENERATE(1, 3, 6);
  const bool dynamic = GENERATE(false, true);
  CAPTURE(law, symmetry, points, dynamic);
  Body body(scene_of(law, symmetry, points));
  const auto z = trial(body, 1e-5, 1e-3, 12);
  for (std::size_t q = 0; q < body.state().P.size(); ++q)
    Eigen::Vector4d::Map(&body.state().s[4 * q]) =
        Eigen::Vector4d(1, -1, 0, 0) / std::sqrt(3);
  if (dynamic)
  {
    const auto motion = trial(body, 1e-4, 0, 13);
    for (int n = 0; n < body.num_nodes(); ++n)
      for (int d = 0; d < 2; ++d)
        body.state().v[2 * n + d] = motion[3 * n + d];
    body.set_dynamics({.damping_stiffness = 0.02}, 0.1); // c h / dt of order 1
  }
  CHECK(tangent_error(body, z, 1e-8) < 1e-3);
}
