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
  static constexpr bool symmetric = true, yields = false;
  static constexpr std::array<std::string_view, 0> no_history{};
  static constexpr std::span<const std::string_view> history = no_history;

  double E = required;       ///< Young's modulus [Pa]
  double nu = required;      ///< Poisson ratio [-]
  double density = required; ///< [kg/m3]

  static inline const std::array<Parameter<Elastic>, 3> parameters{{
      {"E", "Pa", &Elastic::E, scene::above(0), "Young's modulus"},
      {"nu", "-", &Elastic::nu, scene::between(-1, 0.5), "Poisson ratio"},
      {"density", "kg/m3", &Elastic::density, scene::at_least(0),
       "mass density"},
  }};

  double shear_modulus() const { return E / (2 * (1 + nu)); }
  double bulk_modulus() const { return E / (3 * (1 - 2 * nu)); }
  std::vector<std::string> complaints() const { return {}; }

  double admit(Eigen::Ref<Voigt>, std::span<const double>) const { return 0; }

  Outcome update(const Increment& step, TangentKind, std::span<double>,
                 Response& answer) const
  {
    const double K = bulk_modulus();
    answer = {};
    answer.ds_de = shear_stiffness(shear_modulus());
    answer.s = step.s + answer.ds_de * step.de;
    answer.theta = -(step.p - step.p_n) / K;
    answer.dtheta_dp = -1 / K;
    return Outcome::ok;
  }
};
} // namespace mmale::material
