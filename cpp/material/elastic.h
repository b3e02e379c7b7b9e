// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// Hypoelastic with constant moduli: s' = 2 G e', p' = -K theta'.
struct Elastic
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "elastic";
  static constexpr bool symmetric = true, yields = false, fluid = false;
  static constexpr bool linear_pressure = true;

  double E = required;       ///< Young's modulus [Pa]
  double nu = required;      ///< Poisson ratio [-]
  double density = required; ///< [kg/m3]

  static inline const std::array<Parameter<Elastic>, 3> parameters{{
      {"E", "Pa", &Elastic::E, scene::above(0), "Young's modulus"},
      {"nu", "-", &Elastic::nu, scene::between(-1, 0.5), "Poisson ratio"},
      {"density", "kg/m3", &Elastic::density, scene::at_least(0),
       "mass density"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const { return {}; }
  double admit(Eigen::Ref<Voigt>, double&, std::span<double>) const
  {
    return 0;
  }

  Moduli moduli(const Point&, double) const
  {
    return {E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))};
  }

  Outcome update(const Point& start, const Strain& step, TangentKind,
                 std::span<double>, Response& answer) const
  {
    const auto [G, K] = moduli(start, step.dt);
    answer = {};
    answer.ds_de = shear_stiffness(G);
    answer.s = start.s + answer.ds_de * step.de;
    answer.p = start.p - K * step.theta;
    answer.dp_dtheta = -K;
    return Outcome::ok;
  }
};
} // namespace mmale::material
