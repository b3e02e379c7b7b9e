// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "friction.h"
#include <array>

namespace mmale::material
{
/// Elastic, ideally plastic with Mohr-Coulomb's hexagonal pyramid, cut off in
/// tension; non-associated. Without friction it is Tresca's prism.
///
///     (s1 - s3) + (s1 + s3) sin phi <= 2 c cos phi,   -p <= tensile_strength
///
/// for principal stresses s1 >= s2 >= s3, tension positive; flow by the angle
/// of dilation, across the cut-off in volume. The cut-off is of the mean
/// stress: one of the largest principal stress would fix all three at its
/// corners, so that p no more fell with theta. The return is exact for an
/// elastic trial stress: in principal stresses all is planes, and of the sets
/// of planes that may be active together that one is taken whose answer
/// violates nothing.
/// @source Clausen, Damkilde & Andersen (2006, 2007) for regions, edges and
///         the turning of the axes in the tangent; de Souza Neto, Peric & Owen
///         (2008), section 8.2. Departure: a gap beyond the tip (`friction.h`)
struct MohrCoulomb
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "mohr_coulomb";
  static constexpr bool symmetric = false, yields = true, fluid = false;

  double E = required;                 ///< Young's modulus [Pa]
  double nu = required;                ///< Poisson ratio [-]
  double cohesion = required;          ///< [Pa]
  double friction_deg = required;      ///< in degrees
  double dilation_deg = required;      ///< in degrees
  double density = required;           ///< [kg/m3]
  double tensile_strength = not_given; ///< largest mean tension [Pa]

  static inline const std::array<Parameter<MohrCoulomb>, 7> parameters{{
      {"E", "Pa", &MohrCoulomb::E, scene::above(0), "Young's modulus"},
      {"nu", "-", &MohrCoulomb::nu, scene::between(-1, 0.5), "Poisson ratio"},
      {"cohesion", "Pa", &MohrCoulomb::cohesion, scene::at_least(0),
       "shear strength without normal stress"},
      {"friction_deg",
       "deg",
       &MohrCoulomb::friction_deg,
       {0, 90, false, true},
       "angle of friction"},
      {"dilation_deg",
       "deg",
       &MohrCoulomb::dilation_deg,
       {0, 90, false, true},
       "angle of dilation, at most that of friction"},
      {"density", "kg/m3", &MohrCoulomb::density, scene::at_least(0),
       "mass density"},
      {"tensile_strength", "Pa", &MohrCoulomb::tensile_strength,
       scene::at_least(0), "largest mean tension; not given: that of the tip"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const;

  Moduli moduli(const Point&, double) const
  {
    return {E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))};
  }

  /// Mean tension at the tip of the pyramid, c cot phi [Pa]; Tresca: infinite.
  double tip() const;

  /// Radially back to the surface, at constant pressure.
  double admit(Eigen::Ref<Voigt> s, double& p, std::span<double>) const;

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double>, Response& answer) const;
};

static_assert(MaterialLaw<MohrCoulomb>);
} // namespace mmale::material
