// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// A body that is to keep its shape: elastic, G = K = `stiffness`.
///
/// Nothing is rigid in a law that answers strain by stress; what is left is
/// the strain stress / stiffness. A thousand times the stiffness of what is
/// around leaves a thousandth of its strain; much more only costs digits.
/// (A body whose shape matters no more than its motion is better a boundary.)
struct Rigid
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "rigid";
  static constexpr bool symmetric = true, yields = false, fluid = false;
  static constexpr bool linear_pressure = true;

  double stiffness = required; ///< shear and bulk modulus [Pa]
  double density = required;   ///< [kg/m3]

  static inline const std::array<Parameter<Rigid>, 2> parameters{{
      {"stiffness", "Pa", &Rigid::stiffness, scene::above(0),
       "shear and bulk modulus: strains are stress / stiffness"},
      {"density", "kg/m3", &Rigid::density, scene::at_least(0), "mass density"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const { return {}; }
  double admit(Eigen::Ref<Voigt>, double&, std::span<double>) const
  {
    return 0;
  }

  Moduli moduli(const Point&, double) const { return {stiffness, stiffness}; }

  Outcome update(const Point& start, const Strain& step, TangentKind,
                 std::span<double>, Response& answer) const
  {
    answer = {};
    answer.ds_de = shear_stiffness(stiffness);
    answer.s = start.s + answer.ds_de * step.de;
    answer.p = start.p - stiffness * step.theta;
    answer.dp_dtheta = -stiffness;
    return Outcome::ok;
  }
};

static_assert(MaterialLaw<Rigid>);
} // namespace mmale::material
