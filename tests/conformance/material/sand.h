// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include <Eigen/Dense>
#include <catch2/catch_test_macros.hpp>

/// Sand at a point, for tests: element tests along paths of strain and, by
/// Newton on the law, of mixed control. x and z are radial, y is the axis.
namespace mmale::test
{
using material::Hypoplastic;
using material::Outcome;
using material::Response;
using material::TangentKind;
using material::Voigt;
using material::Voigt2;

/// A sand by its name, tight unless told otherwise.
inline Hypoplastic sand(const std::string& set, double void_ratio, bool grains,
                        double tolerance = 1e-11)
{
  return std::get<Hypoplastic>(material::make_law(
      {.law = "hypoplastic",
       .parameters = {{"grain_density", 2650},
                      {"void_ratio", void_ratio},
                      {"tolerance", tolerance},
                      {"max_substeps", 1e6}},
       .texts = {{"sand", set},
                 {"intergranular_strain", grains ? "on" : "off"}}}));
}

/// Derivative of the stress by the strain, engineering shear.
inline Voigt2 stiffness(const Response& a)
{
  const Voigt one(1, 1, 1, 0);
  Voigt2 deviator = Voigt2::Identity();
  deviator -= one * one.transpose() / 3;
  return (a.ds_de - one * a.dp_de.transpose()) * deviator
         + (a.ds_dtheta - one * a.dp_dtheta) * one.transpose();
}

struct Element
{
  Hypoplastic law;
  Voigt sigma;                  ///< tension positive [Pa]
  std::vector<double> q = {};   ///< void ratio, intergranular strain
  material::Effort effort = {}; ///< so far
  Response last = {};
  TangentKind kind = TangentKind::consistent;

  /// Under isotropic pressure [Pa].
  Element(const Hypoplastic& sand, double p)
      : law(sand), sigma(-p, -p, -p, 0), q(sand.with_grains() ? 5 : 1)
  {
    law.begin({.p = p}, q);
  }

  double p() const { return -sigma.head<3>().sum() / 3; }
  /// Axial less radial compression [Pa].
  double deviator() const { return sigma[0] - sigma[1]; }

  Outcome answer(const Voigt& strain, std::vector<double>& history,
                 Response& out) const
  {
    const Voigt one(1, 1, 1, 0);
    const double theta = strain.head<3>().sum();
    history = q;
    return law.update({sigma + p() * one, p(), q},
                      {strain - theta / 3 * one, theta, 1}, kind, history, out);
  }

  /// Strain by an increment, engineering shear.
  void strain(const Voigt& increment)
  {
    std::vector<double> history;
    REQUIRE(answer(increment, history, last) == Outcome::ok);
    sigma = last.s - last.p * Voigt(1, 1, 1, 0);
    q = history;
    effort += last.effort;
  }

  /// Axial strain with the radial stress held.
  void triaxial(double axial, double radial_stress)
  {
    double radial = -0.3 * axial;
    for (int i = 0; i < 30; ++i)
    {
      std::vector<double> history;
      Response a;
      REQUIRE(answer({radial, axial, radial, 0}, history, a) == Outcome::ok);
      const double excess = a.s[0] - a.p - radial_stress;
      const Voigt2 C = stiffness(a);
      if (std::abs(excess) < 1e-11 * std::abs(radial_stress))
        break;
      radial -= excess / (C(0, 0) + C(0, 2));
    }
    strain({radial, axial, radial, 0});
  }
};
} // namespace mmale::test
