// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// Viscous fluid of constant viscosity, a little compressible:
/// s = 2 viscosity dev d, p' = -K tr d.
struct Newtonian
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "newtonian";
  static constexpr bool symmetric = true, yields = false, fluid = true;
  static constexpr bool linear_pressure = true;

  double viscosity = required;    ///< shear stress over shear rate [Pa s]
  double bulk_modulus = required; ///< [Pa]
  double density = required;      ///< [kg/m3]

  static inline const std::array<Parameter<Newtonian>, 3> parameters{{
      {"viscosity", "Pa s", &Newtonian::viscosity, scene::above(0),
       "shear stress over shear rate"},
      {"bulk_modulus", "Pa", &Newtonian::bulk_modulus, scene::above(0),
       "resistance to change of volume"},
      {"density", "kg/m3", &Newtonian::density, scene::at_least(0),
       "mass density"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const { return {}; }
  double admit(Eigen::Ref<Voigt>, double&, std::span<double>) const
  {
    return 0;
  }

  /// In no time nothing flows: as stiff in shear as in volume.
  Moduli moduli(const Point&, double dt) const
  {
    return {dt > 0 ? viscosity / dt : bulk_modulus, bulk_modulus};
  }

  Outcome update(const Point& start, const Strain& step, TangentKind,
                 std::span<double>, Response& answer) const
  {
    answer = {};
    answer.p = start.p - bulk_modulus * step.theta;
    answer.dp_dtheta = -bulk_modulus;
    answer.s = start.s;
    if (not(step.dt > 0))
      return Outcome::ok; // no rate: the deviator stays as it was
    answer.ds_de = shear_stiffness(viscosity / step.dt);
    answer.s = answer.ds_de * step.de;
    return Outcome::ok;
  }
};

static_assert(MaterialLaw<Newtonian>);
} // namespace mmale::material
