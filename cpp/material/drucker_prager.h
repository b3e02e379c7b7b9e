// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "friction.h"
#include <array>

namespace mmale::material
{
/// Elastic, ideally plastic with a round cone in place of Mohr-Coulomb's
/// hexagon; non-associated.
///
///     sqrt(J2) <= alpha p + k,   d eps_plastic = dLambda (s / (2 sqrt(J2)) +
///     beta / 3)
///
/// `cone` says where it meets the hexagon: in triaxial "compression" (outer
/// edges) or "extension" (inner edges), in the failure of a body in
/// "plane_strain" (which also depends on the dilation), or nowhere outside
/// ("inscribed"). The return is exact for a straight step: cone, tip and
/// tension cut-off are straight where s keeps its direction.
/// @source Drucker & Prager (1952); tip: de Souza Neto, Peric & Owen (2008),
///         box 8.9. Departures: a gap beyond the tip (`friction.h`); the
///         plane-strain cone is ours for beta != alpha
struct DruckerPrager
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "drucker_prager";
  static constexpr bool symmetric = false, yields = true, fluid = false;

  double E = required;                 ///< Young's modulus [Pa]
  double nu = required;                ///< Poisson ratio [-]
  double cohesion = required;          ///< Mohr-Coulomb's [Pa]
  double friction_deg = required;      ///< Mohr-Coulomb's, in degrees
  double dilation_deg = required;      ///< Mohr-Coulomb's, in degrees
  double density = required;           ///< [kg/m3]
  double tensile_strength = not_given; ///< largest mean tension [Pa]
  std::string cone;                    ///< which circle

  static inline const std::array<Parameter<DruckerPrager>, 7> parameters{{
      {"E", "Pa", &DruckerPrager::E, scene::above(0), "Young's modulus"},
      {"nu", "-", &DruckerPrager::nu, scene::between(-1, 0.5), "Poisson ratio"},
      {"cohesion", "Pa", &DruckerPrager::cohesion, scene::at_least(0),
       "cohesion of the Mohr-Coulomb law that the cone stands for"},
      {"friction_deg",
       "deg",
       &DruckerPrager::friction_deg,
       {0, 90, false, true},
       "its angle of friction"},
      {"dilation_deg",
       "deg",
       &DruckerPrager::dilation_deg,
       {0, 90, false, true},
       "its angle of dilation, at most that of friction"},
      {"density", "kg/m3", &DruckerPrager::density, scene::at_least(0),
       "mass density"},
      {"tensile_strength", "Pa", &DruckerPrager::tensile_strength,
       scene::at_least(0), "largest mean tension; not given: that of the tip"},
  }};
  static inline const std::array<TextParameter<DruckerPrager>, 1> texts{{
      {"cone", &DruckerPrager::cone, true,
       "where it meets Mohr-Coulomb's hexagon: compression | extension | "
       "plane_strain | inscribed"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const;

  Moduli moduli(const Point&, double) const
  {
    return {E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))};
  }

  /// The cone's numbers.
  struct Cone
  {
    double alpha; ///< rise of sqrt(J2) over p [-]
    double beta;  ///< plastic volume strain over dLambda [-]
    double k;     ///< sqrt(J2) at p = 0 [Pa]
    double floor; ///< least pressure but for gaps [Pa]

    /// Largest sqrt(J2) at pressure p [Pa].
    double strength(double p) const
    {
      return std::max(alpha * std::max(p, floor) + k, 0.0);
    }
  };
  Cone numbers() const;

  /// Radially back to the cone, at constant pressure.
  double admit(Eigen::Ref<Voigt> s, double& p, std::span<double>) const;

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double>, Response& answer) const;
};

static_assert(MaterialLaw<DruckerPrager>);
} // namespace mmale::material
