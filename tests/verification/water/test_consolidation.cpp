// SPDX-License-Identifier: LGPL-3.0-or-later
// Consolidation of elastic soils: Terzaghi, Mandel, Cryer.
#include "series.h"
#include "soil.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace mmale;
using namespace mmale::test;

namespace
{
constexpr double load = 1e3; // [Pa]: strains of 1e-4, so that all is linear

/// Times from `first` on, each step longer by `growth`.
std::vector<double> times(double first, double growth, double last)
{
  std::vector<double> t{0, first};
  while (t.back() < last)
    t.push_back(std::min(last, t.back() * growth));
  return t;
}

/// Errors over p_0 of a curve that starts with a jump at t = 0.
struct Error
{
  double largest = 0; ///< from T = 0.01 on
  double mean = 0;    ///< root of the mean square over log T
  double peak = 0;    ///< largest pressure
};

/// Take a body through consolidation.
/// @param[in] now,exact pressure over p_0, of the body and of the series at T
Error consolidate(Body& body, const std::vector<double>& T, double second,
                  const std::function<double()>& now,
                  const std::function<double(double)>& exact)
{
  Error out;
  double sum[2] = {0, 0};
  for (std::size_t i = 1; i < T.size(); ++i)
  {
    const auto taken = body.step(T[i - 1] * second, T[i] * second);
    INFO("T " << T[i] << ": " << taken.cause);
    REQUIRE(taken);
    CHECK(taken.iterations <= 3); // linear but for strains of 1e-4
    const double p = now();
    out.peak = std::max(out.peak, p);
    if (T[i] < 0.01)
      continue;
    const double error = std::abs(p - exact(T[i]));
    out.largest = std::max(out.largest, error);
    const double weight = std::log(T[i] / T[i - 1]);
    sum[0] += error * error * weight;
    sum[1] += weight;
  }
  out.mean = std::sqrt(sum[0] / sum[1]);
  return out;
}

/// A layer of height 1 that drains at its loaded top.
Error layer(int n, double growth, double time_weight = 1)
{
  const Soil soil;
  auto scene = soil.rectangle(2.0 / n, 1, 2, n);
  scene.mesh.diagonal = scene::Diagonal::alternating;
  scene.water->time_weight = time_weight;
  Body body(scene);
  auto s = trough();
  s.boundary["top"].pressure = constant(load);
  s.boundary["top"].drained = true;
  body.set_stage(s);
  const double p_0 = load / soil.M() / (1 / soil.M() + 1 / soil.K_w());
  const int base = body.node(0, 0);
  return consolidate(
      body, times(1e-4, growth, 1), 1 / soil.c_v(),
      [&] { return body.state().p_w[base] / p_0; },
      [](double T) { return terzaghi(0, T); });
}

/// A quarter of a slab of half-width 1; the rigid plate follows its exact
/// settlement, so that the force on it is a result.
Error slab(int n, double growth, double& force_error)
{
  const Soil soil{.nu = 0.2};
  const Mandel exact{soil.nu, soil.nu_u()};
  const double height = 2.0 / n;
  auto scene = soil.rectangle(1, height, n, 2);
  scene.water->time_weight = 0.5;
  scene.mesh.diagonal = scene::Diagonal::alternating;
  Body body(scene);
  const auto T = times(1e-4, growth, 1);
  const double second = 1 / soil.c_v();
  auto s = stage(1e9);
  s.boundary["left"].roller = s.boundary["bottom"].roller = true;
  s.boundary["right"].drained = true;
  scene::TimeSeries& u = s.boundary["top"].displacement_y.emplace();
  for (double t : T)
  {
    const double drained = load * (1 - soil.nu) / (2 * soil.G()) * height;
    u.time.push_back(t * second);
    u.value.push_back(t > 0 ? -drained * exact.settlement(t) : 0);
  }
  body.set_stage(s);
  const double p_0 = load * (1 + soil.nu_u()) * soil.B() / 3;
  const int centre = body.node(0, 0);
  force_error = 0;
  return consolidate(
      body, T, second,
      [&]
      {
        force_error = std::max(force_error,
                               std::abs(-body.reaction("top")[1] / load - 1));
        return body.state().p_w[centre] / p_0;
      },
      [&](double t) { return exact.pressure(0, t); });
}

/// A ball of radius 1 in a fluid of given pressure, drained; constituents
/// incompressible to 1e-5, as the series has them.
Error ball(double refine, double growth, double nu)
{
  const Soil soil{.nu = nu, .K_f = 2.2e13, .K_s = 3.6e14};
  scene::Scene scene;
  scene.symmetry = scene::Symmetry::axisymmetric;
  scene.mesh.shape = "gmsh";
  scene.mesh.file = SPHERE_GEO;
  scene.mesh.refine = refine;
  soil.put_into(scene);
  scene.water->time_weight = 0.5;
  Body body(scene);
  auto s = stage(1e9);
  s.boundary["axis"].roller = s.boundary["level"].roller = true;
  s.boundary["surface"].pressure = constant(load);
  s.boundary["surface"].drained = true;
  body.set_stage(s);
  const int centre = body.node(0, 0);
  return consolidate(
      body, times(1e-4, growth, 1), 1 / soil.c_v(),
      [&] { return body.state().p_w[centre] / load; },
      [&](double T) { return cryer(nu, T); });
}

double order(double coarse, double fine)
{
  return std::log2(coarse / fine);
}
} // namespace

TEST_CASE("series: numbers of others", "[water][series]")
{
  // computed apart, 8 digits
  CHECK(terzaghi(0, 0.2) == Catch::Approx(0.77231161).epsilon(1e-7));
  CHECK(terzaghi(0, 0.848) == Catch::Approx(0.15711273).epsilon(1e-7));
  const Mandel slab{0.2, 0.5};
  CHECK(slab.pressure(0, 0.05) == Catch::Approx(1.0988833).epsilon(1e-7));
  CHECK(slab.pressure(0, 0.5) == Catch::Approx(0.5927854).epsilon(1e-7));
  CHECK(slab.settlement(0) == Catch::Approx(0.5 / 0.8).epsilon(1e-2));
  CHECK(cryer(0.25, 0.01) == Catch::Approx(1.153891).epsilon(1e-6));
  CHECK(cryer(0.25, 0.2) == Catch::Approx(0.606629).epsilon(1e-6));
  CHECK(cryer(0, 0.063) == Catch::Approx(1.57542).epsilon(1e-5));
}

TEST_CASE("Terzaghi: a layer drained at its top, order 2 with steps ~ h^2",
          "[water]")
{
  const Error coarse = layer(8, 1.08), middle = layer(16, 1.02),
              fine = layer(32, 1.005);
  INFO("largest " << coarse.largest << " " << middle.largest << " "
                  << fine.largest << ", mean " << coarse.mean << " "
                  << middle.mean << " " << fine.mean);
  CHECK(middle.largest < 0.005);
  CHECK(order(middle.mean, fine.mean) > 1.8);
}

TEST_CASE("Terzaghi: a weight of one half makes long steps exact", "[water]")
{
  // steps that grow by 10 %: order 2 in time, where a weight of 1 has order 1
  const Error half = layer(32, 1.1, 0.5), whole = layer(32, 1.1, 1);
  INFO("largest " << half.largest << " " << whole.largest);
  CHECK(half.largest < 0.005);
  CHECK(whole.largest > 3 * half.largest);
}

TEST_CASE("Mandel: pressure rises before it falls, and the plate's force stays",
          "[water]")
{
  double force[3];
  const Error coarse = slab(8, 1.1, force[0]),
              middle = slab(16, 1.05, force[1]),
              fine = slab(32, 1.025, force[2]);
  INFO("largest " << coarse.largest << " " << middle.largest << " "
                  << fine.largest << ", mean " << coarse.mean << " "
                  << middle.mean << " " << fine.mean << ", force " << force[0]
                  << " " << force[1] << " " << force[2] << ", peak "
                  << middle.peak);
  CHECK(middle.largest < 0.005);
  CHECK(order(middle.mean, fine.mean) > 1.8);
  // the plate meets it at first in a drained layer thinner than a cell
  CHECK(force[1] < 0.01);
  CHECK(force[2] < 0.003);
  // constituents compressible by K / K_w = 0.0011; 1.106895 without
  CHECK(middle.peak == Catch::Approx(1.1069).epsilon(0.005));
}

TEST_CASE("Cryer: the peak in the centre of a sphere, about an axis", "[water]")
{
  // cells of 1/8, 1/16, 1/24 of the radius
  const Error coarse = ball(1, 1.1, 0.25), middle = ball(2, 1.05, 0.25),
              fine = ball(3, 1.033, 0.25);
  INFO("largest " << coarse.largest << " " << middle.largest << " "
                  << fine.largest << ", mean " << coarse.mean << " "
                  << middle.mean << " " << fine.mean << ", peak " << middle.peak
                  << " " << fine.peak);
  CHECK(middle.mean < 0.005);
  CHECK(fine.largest < 0.005);
  CHECK(middle.peak == Catch::Approx(1.30752).epsilon(0.001));
  // irregular meshes: the error of one node has no clean order
  CHECK(std::log(middle.mean / fine.mean) / std::log(1.5) > 1.5);
}
