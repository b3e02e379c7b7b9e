// SPDX-License-Identifier: LGPL-3.0-or-later
// Newmark and HHT on a vibrating column, against exact modes and against the
// schemes' own amplification matrices.
#include "column.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <complex>

using namespace mmale;
using Catch::Approx;
using test::Column;

namespace
{
constexpr double v_0 = 1e-5; // strains of 1e-7 for c = 80 m/s

/// What a scheme does to one undamped mode (d, v, a) in a step: the largest
/// eigenvalue, per step. HHT's forces are a mean over the ends of the step.
std::complex<double> amplification(scene::Dynamics scheme, double w, double dt,
                                   double damping = 0)
{
  const auto s = scheme.resolved();
  // (I + ...) x_1 = (...) x_0 from the two Newmark lines and balance
  Eigen::Matrix3d A, B;
  const double c = 2 * damping * w, k = w * w, alpha = s.alpha;
  A << 1, 0, -s.beta * dt * dt, 0, 1, -s.gamma * dt, (1 + alpha) * k,
      (1 + alpha) * c, 1;
  B << 1, dt, (0.5 - s.beta) * dt * dt, 0, 1, (1 - s.gamma) * dt, alpha * k,
      alpha * c, 0;
  const Eigen::Vector3cd lambda =
      Eigen::Matrix3d(A.inverse() * B).eigenvalues();
  std::complex<double> out = 0;
  for (const auto& l : lambda) // the pair of the motion, not the spurious one
    if (l.imag() > 0)
      out = l;
  return out;
}

/// Growth and angle of the first mode per step, from samples of its
/// displacement. Prony's method with room for three modes more: the mesh's own
/// mode is not quite the exact one, so others sound too.
std::complex<double> measured(Column& column, double dt, int steps)
{
  constexpr int order = 8;
  std::vector<double> d{column.displacement()};
  for (int k = 0; k < steps; ++k)
  {
    column.step(dt);
    d.push_back(column.displacement());
  }
  const int rows = steps + 1 - order;
  Eigen::MatrixXd A(rows, order);
  Eigen::VectorXd b(rows);
  for (int k = 0; k < rows; ++k)
  {
    for (int j = 0; j < order; ++j)
      A(k, j) = d[k + order - 1 - j];
    b[k] = d[k + order];
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  companion.row(0) = A.colPivHouseholderQr().solve(b).transpose();
  companion.bottomLeftCorner(order - 1, order - 1).setIdentity();
  const Eigen::VectorXcd root = companion.eigenvalues();
  const auto exact = std::polar(1.0, Column::frequency() * dt);
  return *std::ranges::min_element(root, {}, [&](const std::complex<double>& l)
                                   { return std::abs(l - exact); });
}

/// Frequency of the mesh's own first mode, free of the scheme's error: the
/// trapezoid rule turns w into tan(phi / 2) 2 / dt exactly.
double own_frequency(int n, int points)
{
  Column column(n, points, {});
  column.add_mode(1, v_0);
  column.begin();
  const double dt = 0.05 / Column::frequency();
  return 2 / dt * std::tan(0.5 * std::arg(measured(column, dt, 150)));
}
} // namespace

TEST_CASE("a column vibrates at its exact frequency, up to h^2",
          "[verification][dynamics]")
{
  const int points = GENERATE(1, 3, 6);
  double error[3];
  for (int level = 0; level < 3; ++level)
    error[level] =
        std::abs(own_frequency(5 << level, points) / Column::frequency() - 1);
  CAPTURE(points, error[0], error[1], error[2]);
  CHECK(error[2] < 5e-4);
  CHECK(std::log2(error[0] / error[1]) > 1.8);
  CHECK(std::log2(error[1] / error[2]) > 1.8);
}

TEST_CASE("Newmark's and HHT's period and growth are those of the schemes",
          "[verification][dynamics]")
{
  // per step, by the amplification matrix at the mesh's own frequency: order 2
  // in the period for gamma = 1/2 and for HHT; gamma < 1/2 grows
  struct Case
  {
    scene::Dynamics scheme;
    int order;
  };
  const auto c = GENERATE(Case{{}, 2}, Case{{.alpha = -0.1}, 2},
                          Case{{.beta = 0.25, .gamma = 0.45}, 1},
                          Case{{.beta = 0.3025, .gamma = 0.6}, 1});
  const int points = GENERATE(1, 3, 6);
  CAPTURE(points, c.scheme.beta, c.scheme.gamma, c.scheme.alpha);
  const double w = own_frequency(10, points);
  double error[2];
  for (int level = 0; level < 2; ++level)
  {
    const double dt = 0.4 / (1 << level) / w;
    Column column(10, points, c.scheme);
    column.add_mode(1, v_0);
    column.begin();
    const auto m = measured(column, dt, 60),
               exact = amplification(c.scheme, w, dt);
    CAPTURE(level, std::abs(m), std::abs(exact), std::arg(m), std::arg(exact));
    CHECK(std::arg(m) == Approx(std::arg(exact)).epsilon(3e-4));
    CHECK(std::abs(std::abs(m) - std::abs(exact)) < 2e-5);
    error[level] = std::abs(m / std::polar(1.0, w * dt) - 1.0) / (w * dt);
  }
  CAPTURE(error[0], error[1]);
  if (c.order == 2)
    CHECK(std::log2(error[0] / error[1]) == Approx(2).margin(0.1));
}

namespace
{
/// Growth of the first mode's amplitude over a number of steps.
///
/// Energy by the trapezoid rule of work is kept by construction; the
/// amplitude is not.
double amplitude_growth(int points, double spring, int steps)
{
  auto scene = Column::scene(10, points);
  scene.solver.bubble_spring = spring;
  Column column(scene, {});
  column.add_mode(1, v_0);
  column.begin();
  const double w = Column::frequency(), dt = 0.2 / w;
  const auto amplitude = [&]
  {
    double most = 0; // over two periods
    for (int k = 0; k < 63; ++k)
    {
      column.step(dt);
      most = std::max(most, std::abs(column.displacement()));
    }
    return most;
  };
  const double first = amplitude();
  for (int k = 0; k < steps; ++k)
    column.step(dt);
  const double last = amplitude();
  const double energy =
      0.25 * Column::rho * 4 * Column::height / 10 * Column::height * v_0 * v_0;
  CHECK(column.body.kinetic_energy() + column.body.state().work.internal
        == Approx(energy).epsilon(1e-6));
  return last / first - 1;
}
} // namespace

TEST_CASE("the trapezoid rule keeps amplitude and energy",
          "[verification][dynamics]")
{
  const int points = GENERATE(1, 3, 6);
  const double growth = amplitude_growth(points, 0.05, 100);
  CAPTURE(points, growth);
  CHECK(std::abs(growth) < 1e-3);
}

TEST_CASE("the trapezoid rule keeps amplitude and energy over 1e4 steps",
          "[verification][dynamics][slow]")
{
  const int points = GENERATE(1, 3, 6);
  const double spring = GENERATE(0.0, 0.05);
  if (points == 1 and spring > 0)
    return;
  const double growth = amplitude_growth(points, spring, 10000);
  CAPTURE(points, spring, growth);
  // 318 periods; the spring of layout quadrature is let go in each step, so it
  // damps: 0.35 % and 0.5 %. Else the phase of the samples is what differs.
  if (spring == 0)
    CHECK(std::abs(growth) < 5e-4);
  else
    CHECK((growth < 0 and growth > -1e-2));
}

TEST_CASE("HHT damps a high mode and keeps the low one",
          "[verification][dynamics]")
{
  // mode 10 is the mesh's highest but for its own zigzag; 30 steps a period of
  // the first mode
  const int points = GENERATE(1, 3, 6);
  const double dt = 0.2 / Column::frequency();
  double left[2][2];
  for (int hht = 0; hht < 2; ++hht)
  {
    Column column(10, points, {.alpha = hht ? -0.1 : 0.0});
    column.add_mode(1, v_0);
    column.add_mode(8, v_0);
    column.begin();
    double most[2][2] = {}; // [early, late][mode]
    for (int k = 0; k < 300; ++k)
    {
      column.step(dt);
      for (int m = 0; m < 2; ++m)
        if (k < 40 or k >= 260)
          most[k >= 260][m] =
              std::max(most[k >= 260][m], std::abs(column.velocity(m ? 8 : 1)));
    }
    for (int m = 0; m < 2; ++m)
      left[hht][m] = most[1][m] / most[0][m];
  }
  CAPTURE(points, left[0][0], left[0][1], left[1][0], left[1][1]);
  CHECK(left[0][0] > 0.95);
  CHECK(left[0][1] > 0.2);
  CHECK(left[1][0] > 0.95);
  CHECK(left[1][1] < 0.02);
}

TEST_CASE("Rayleigh's damping takes its share of a mode's amplitude",
          "[verification][dynamics]")
{
  // a ratio xi = a / 2 w + b w / 2 of 2 % by mass, by stiffness, by both
  const int points = GENERATE(1, 3, 6);
  const double by_mass = GENERATE(0.0, 0.01, 0.02), xi = 0.02;
  CAPTURE(points, by_mass);
  const double w = own_frequency(10, points);
  const scene::Dynamics scheme{.damping_mass = 2 * w * by_mass,
                               .damping_stiffness = 2 / w * (xi - by_mass)};
  Column column(10, points, scheme);
  column.add_mode(1, v_0);
  column.begin();
  const double dt = 0.1 / w;
  const auto m = measured(column, dt, 300);
  const auto exact = amplification(scheme, w, dt, xi);
  const double rate = -std::log(std::abs(m)) / (w * dt);
  CAPTURE(rate);
  // The rate of p starts at zero whatever v is; with gamma = 1/2 what is wrong
  // with it swings on, and weighs where stiffness alone damps.
  const double swing = by_mass == 0 ? 0.03 : 1e-3;
  CHECK(rate == Approx(xi).epsilon(5e-3 + swing)); // exp(-xi w t)
  CHECK(rate == Approx(-std::log(std::abs(exact)) / (w * dt)).epsilon(swing));
}
