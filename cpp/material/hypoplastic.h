// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "hypoplastic_rate.h"
#include "law.h"
#include <array>

namespace mmale::material
{
/// Hypoplastic sand, with or without intergranular strain.
///
/// Rates: hypoplastic_rate.h. A step's strain goes in along a line; an embedded
/// Runge–Kutta pair takes it in sub-steps, whose errors in stress and
/// intergranular strain are kept below `tolerance`; the void ratio is exact.
///
/// Zero stress. Pressures count from the apex, p + p_t. Between 2 p_min and
/// p_min a growing share of any further fall is held back, so that the rates
/// are never asked below p_min. What the volume then still grows lets the
/// pressure fall with the small stiffness `apex_stiffness` p_min, through the
/// apex and beyond, and takes the deviator to zero at the apex along a ray.
/// Compression from there closes the gap to p_min with the bulk stiffness that
/// the law has at p_min, or with the small one while the void ratio is above
/// e_i and grains do not touch. Of grains that touch in part, below p_min, the
/// rates see that part of the strain.
///
/// It tells the bubble of no plastic flow: sand flows in part all the time, and
/// a strip load then stops at a third of the way that it goes without.
///
/// @source von Wolffersdorff (1996), Mech. Cohes.-Frict. Mater. 1, 251-271;
/// Niemunis & Herle (1997), the same 2, 279-299
struct Hypoplastic
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "hypoplastic";
  static constexpr std::string_view set_key = "sand";
  static constexpr bool symmetric = false, yields = false, fluid = false;

  double phi_c_deg = required; ///< critical friction angle [degrees]
  double h_s = required;       ///< granulate hardness [Pa]
  double n = required;         ///< exponent of the compression law [-]
  double e_d0 = required;      ///< least void ratio, at zero pressure [-]
  double e_c0 = required;      ///< critical, likewise
  double e_i0 = required;      ///< largest, likewise
  double alpha = required;     ///< exponent of the density, peak strength [-]
  double beta = required;      ///< exponent of the density, stiffness [-]
  double m_R = not_given;      ///< stiffness after reversal over basic one [-]
  double m_T = not_given;      ///< after a turn by 90 degrees [-]
  double R = not_given;        ///< size of the intergranular strain [-]
  double beta_R = not_given;   ///< exponent of its growth [-]
  double chi = not_given;      ///< exponent of its effect [-]
  double p_t = 0;              ///< cohesion: shift of the apex [Pa]
  double grain_density = required; ///< [kg/m3]
  double void_ratio = not_given;   ///< at the start, or:
  double relative_density =
      not_given;              ///< (e_c0 - e)/(e_c0 - e_d0) at the start
  double p_min = 100;         ///< zero-stress floor, counted from the apex [Pa]
  double apex_stiffness = 10; ///< bulk stiffness beyond it, over p_min [-]
  double tolerance = 1e-4;    ///< of a sub-step, relative [-]
  double max_substeps = 2000; ///< of an update; more: a smaller step
  std::string intergranular_strain; ///< "on" or "off"
  std::string integrator = "bs32";  ///< a name of runge_kutta.h

  static const std::array<Parameter<Hypoplastic>, 21> parameters;
  static const std::array<TextParameter<Hypoplastic>, 2> texts;
  static std::span<const ParameterSet> sets();

  /// `void_ratio`, and with intergranular strain `intergranular_strain`.
  std::vector<HistoryField> history() const;
  void begin(const Start& at, std::span<double> q) const;
  std::vector<std::string> complaints() const;

  /// Density of the dry sand [kg/m3]; water adds its own.
  double initial_density(const Start& at) const;

  /// Of L, with intergranular strain of m_R L: the stiffest.
  Moduli moduli(const Point& start, double dt) const;

  /// Stress back into the cone whose Matsuoka-Nakai friction angle is
  /// `widest_angle_deg`, beyond the apex without a deviator; intergranular
  /// strain into its sphere. The void ratio is grain mass and stays: the law
  /// takes it at its limits. Returns the larger of the two shares cut off.
  double admit(Eigen::Ref<Voigt> s, double& p, std::span<double> q) const;

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const;

  /// Beyond it dense sand, whose f_d is small, would come to bear tension,
  /// where the rates are not defined.
  static constexpr double widest_angle_deg = 70;

  bool with_grains() const { return intergranular_strain == "on"; }
  double initial_void_ratio(const Start& at) const;
  hypoplasticity::Sand constants() const;
};

static_assert(MaterialLaw<Hypoplastic>);
} // namespace mmale::material
