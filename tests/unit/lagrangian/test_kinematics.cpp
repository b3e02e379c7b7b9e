// SPDX-License-Identifier: LGPL-3.0-or-later
#include "lagrangian/kernel.h"
#include "lagrangian/kinematics.h"
#include "material/j2.h"

#include <Eigen/Dense>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <limits>
#include <numbers>
#include <random>

using namespace mmale;
using namespace mmale::lagrangian;
using Catch::Approx;
using Eigen::Matrix2d;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double degree = std::numbers::pi / 180;

Matrix2d rotation(double angle)
{
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

/// Hughes and Winget's increment from a deformation gradient and a hoop
/// stretch, by its definition G = 2 (f - I) (f + I)^-1.
Gradient increment(const Matrix2d& f, double hoop = 1)
{
  const Matrix2d I = Matrix2d::Identity();
  const Matrix2d G = 2 * (f - I) * (f + I).inverse();
  return (Gradient() << G(0, 0), G(0, 1), G(1, 0), G(1, 1),
          2 * (hoop - 1) / (hoop + 1))
      .finished();
}

/// The same from the nodes of a triangle, through the form.
Gradient increment_of_triangle(const Matrix2d& f)
{
  const double start[3][2] = {{0.3, -0.2}, {1.4, 0.1}, {0.5, 1.1}};
  double w[11] = {}, x[9] = {};
  for (int v = 0; v < 3; ++v)
  {
    const Eigen::Vector2d from(start[v][0], start[v][1]), to = f * from;
    for (int d = 0; d < 2; ++d)
    {
      w[3 * v + d] = to[d] - from[d];
      x[3 * v + d] = 0.5 * (to[d] + from[d]);
    }
  }
  Gradient G;
  mid_gradient<1>(false, w, x, G.data());
  return G;
}

Matrix2d in_plane(const Voigt& s)
{
  return Matrix2d{{s[0], s[3]}, {s[3], s[1]}};
}

material::J2 metal()
{
  return {
      .E = 100, .nu = 0.3, .yield_stress = 10, .hardening = 5, .density = 1};
}

/// All that a step makes of a cell.
struct End
{
  Motion motion;
  Driven law;
  Voigt s;
};

End take_step(const Gradient& G, const Voigt& s_n, double p_n, double p)
{
  End end;
  end.motion = motion(G);
  const auto [c, t] = std::pair(end.motion.cosine, end.motion.sine);
  const double before = 0.01;
  double plastic_strain = 0;
  REQUIRE(material::drive(metal(),
                          {rotate(s_n, c, t), p_n, std::span(&before, 1)},
                          end.motion.de, p, 1, std::nan(""),
                          material::TangentKind::consistent,
                          std::span(&plastic_strain, 1), end.law)
          == material::Outcome::ok);
  end.s = rotate(end.law.s, c, t);
  return end;
}
} // namespace

TEST_CASE("a rigid rotation gives no strain and turns the stress exactly",
          "[unit][lagrangian]")
{
  const double angle =
      degree * GENERATE(0.01, 1.0, 30.0, 90.0, 100.0, 150.0, 179.0, -77.0);
  INFO("angle " << angle / degree << " degrees");
  // Half way the body is a line: it has shrunk by cos(angle / 2), and the
  // round-off of its nodes has grown by as much in each factor of G.
  const double mid = std::cos(angle / 2);
  const double tolerance = 1e-14 / (mid * mid);
  const bool by_nodes = GENERATE(false, true);
  const Gradient G = by_nodes ? increment_of_triangle(rotation(angle))
                              : increment(rotation(angle));
  const Motion m = motion(G);
  CHECK(m.de.norm() < tolerance);
  CHECK(std::abs(m.ln_J) < tolerance);

  const Voigt s(3, -1, -2, 5);
  const Voigt turned = rotate(rotate(s, m.cosine, m.sine), m.cosine, m.sine);
  const Matrix2d exact =
      rotation(angle) * in_plane(s) * rotation(angle).transpose();
  CHECK((in_plane(turned) - exact).norm() < tolerance * exact.norm());
  CHECK(turned[2] == s[2]);
}

TEST_CASE("many rotations add up to one", "[unit][lagrangian]")
{
  const int steps = GENERATE(7, 360, 1000);
  const double total = 2 * std::numbers::pi * 3 + 1.1;
  const Motion m = motion(increment(rotation(total / steps)));
  const Voigt start(3, -1, -2, 5);
  Voigt s = start;
  for (int k = 0; k < steps; ++k)
    s = rotate(rotate(s, m.cosine, m.sine), m.cosine, m.sine);
  const Matrix2d exact =
      rotation(total) * in_plane(start) * rotation(total).transpose();
  // each step adds its round-off and the error of its angle
  CHECK((in_plane(s) - exact).norm() < 8 * steps * eps * exact.norm());
}

TEST_CASE("the logarithm of the volume keeps its digits at any strain",
          "[unit][lagrangian]")
{
  const double size = GENERATE(1e-15, 1e-12, 1e-8, 1e-3, 0.4);
  // a stretch along axes, whose logarithms add up
  const double a = size, b = 0.37 * size, c = -0.21 * size;
  const Gradient G =
      (Gradient() << 2 * a / (2 + a), 0, 0, 2 * b / (2 + b), 2 * c / (2 + c))
          .finished();
  const double exact = std::log1p(a) + std::log1p(b) + std::log1p(c);
  CHECK(motion(G).ln_J == Approx(exact).epsilon(16 * eps).margin(0));
}

TEST_CASE("the volume ratio is the determinant", "[unit][lagrangian]")
{
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-0.4, 0.4);
  for (int k = 0; k < 100; ++k)
  {
    Matrix2d f = Matrix2d::Identity();
    for (double& v : f.reshaped())
      v += uniform(random);
    const double hoop = 1 + uniform(random);
    if (f.determinant() < 0.1)
      continue;
    CHECK(motion(increment(f, hoop)).ln_J
          == Approx(std::log(f.determinant() * hoop)).margin(1e-14));
  }
}

TEST_CASE("a cell that inverts has no volume strain", "[unit][lagrangian]")
{
  const Matrix2d mirror{{-0.5, 0}, {0, 1}};
  CHECK_FALSE(std::isfinite(motion(increment(mirror)).ln_J));
  CHECK_FALSE(
      std::isfinite(motion(increment(Matrix2d::Identity(), -0.1)).ln_J));
}

TEST_CASE("simple shear follows Jaumann's sine, with errors of second order",
          "[unit][lagrangian]")
{
  // Jaumann's rate in simple shear: sigma_12 = G sin gamma,
  // sigma_11 = -sigma_22 = G (1 - cos gamma)
  const double gamma = GENERATE(0.7, 2.3, 4.0), shear = 38;
  double errors[4];
  for (int level = 0; level < 4; ++level)
  {
    const int steps = 20 << level;
    const Matrix2d f{{1, gamma / steps}, {0, 1}};
    const Motion m = motion(increment(f));
    Voigt s = Voigt::Zero();
    for (int k = 0; k < steps; ++k)
    {
      s = rotate(s, m.cosine, m.sine);
      s += material::shear_stiffness(shear) * m.de;
      s = rotate(s, m.cosine, m.sine);
    }
    const Voigt exact =
        shear
        * Voigt(1 - std::cos(gamma), std::cos(gamma) - 1, 0, std::sin(gamma));
    errors[level] = (s - exact).norm() / shear;
  }
  CAPTURE(gamma, errors[0], errors[1], errors[2], errors[3]);
  CHECK(errors[3] < 1e-3);
  CHECK(std::log2(errors[2] / errors[3]) == Approx(2).margin(0.05));
}

TEST_CASE("the tangent is the derivative of stress and volume by the end's "
          "displacement",
          "[unit][lagrangian]")
{
  // T = sigma F^-T det F for a further gradient F = I + x h of the end
  // geometry is what the virtual work sees of it, once the integral is taken
  // over the geometry at x = 0; without the change of the geometry it is the
  // stress alone. The same for the volume, (theta - ln J) det F.
  const bool geometric = GENERATE(true, false);
  const bool hoop = GENERATE(true, false);
  INFO("geometric " << geometric << ", hoop " << hoop);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int plastic = 0;
  for (int trial = 0; trial < 50; ++trial)
  {
    Matrix2d f = Matrix2d::Identity(), h;
    for (double& v : f.reshaped())
      v += 0.15 * uniform(random);
    for (double& v : h.reshaped())
      v = uniform(random);
    const double f_z = hoop ? 1 + 0.1 * uniform(random) : 1;
    const double h_z = hoop ? uniform(random) : 0;
    const double a = uniform(random), b = uniform(random);
    const Voigt s_n(a, b, -a - b, uniform(random));
    const double p_n = uniform(random), p = 2 * uniform(random);

    const End end = take_step(increment(f, f_z), s_n, p_n, p);
    plastic += end.law.flow > 0;
    const CellTangent t =
        tangent(increment(f, f_z), end.motion, end.law, end.s, p, geometric);
    const Gradient direction =
        (Gradient() << h(0, 0), h(0, 1), h(1, 0), h(1, 1), h_z).finished();

    const auto at = [&](double x)
    {
      const Matrix2d F = Matrix2d::Identity() + x * h;
      const double F_z = 1 + x * h_z;
      const End e = take_step(increment(F * f, F_z * f_z), s_n, p_n, p);
      Matrix2d sigma = in_plane(e.s);
      double sigma_z = e.s[2], volume = e.law.theta - e.motion.ln_J;
      if (geometric)
      {
        const double det = F.determinant() * F_z;
        sigma =
            (sigma - p * Matrix2d::Identity()) * F.inverse().transpose() * det;
        sigma_z = (sigma_z - p) / F_z * det;
        volume *= det;
      }
      return (Eigen::Vector<double, 7>() << sigma(0, 0), sigma(0, 1),
              sigma(1, 0), sigma(1, 1), sigma_z, volume, e.law.flow)
          .finished();
    };
    constexpr double x = 1e-6; // truncation 1e-12 f''', round-off 1e-10
    const Eigen::Vector<double, 7> slope = (at(x) - at(-x)) / (2 * x);
    const double size = 2 * metal().moduli({}, 1).G;
    CHECK((t.ds_dh * direction - slope.head<5>()).norm() < 1e-7 * size);
    CHECK(t.dtheta_dh.dot(direction) == Approx(slope[5]).margin(1e-8));
    CHECK(t.dflow_dh.dot(direction) == Approx(slope[6]).margin(1e-5));
  }
  CHECK(plastic > 25); // both branches of the law were there
  CHECK(plastic < 50);
}
