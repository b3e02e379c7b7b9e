// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "elastic.h"

namespace mmale::material
{
/// Elastic, ideally plastic or linearly hardening metal (von Mises).
///
/// Yield: sqrt(3/2) |s| <= yield_stress + hardening * plastic_strain.
/// Radial return, exact for the strain path of a step along a line.
/// @source Simo & Hughes, Computational Inelasticity (1998), box 3.2
struct J2
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "j2";
  static constexpr bool symmetric = true, yields = true, fluid = false;
  static constexpr bool linear_pressure = true;

  double E = required;            ///< Young's modulus [Pa]
  double nu = required;           ///< Poisson ratio [-]
  double yield_stress = required; ///< in uniaxial tension [Pa]
  double hardening = required;    ///< d(yield stress)/d(plastic strain) [Pa]
  double density = required;      ///< [kg/m3]

  static inline const std::array<Parameter<J2>, 5> parameters{{
      {"E", "Pa", &J2::E, scene::above(0), "Young's modulus"},
      {"nu", "-", &J2::nu, scene::between(-1, 0.5), "Poisson ratio"},
      {"yield_stress", "Pa", &J2::yield_stress, scene::above(0),
       "yield stress in uniaxial tension"},
      {"hardening", "Pa", &J2::hardening, scene::at_least(0),
       "rise of the yield stress over plastic strain"},
      {"density", "kg/m3", &J2::density, scene::at_least(0), "mass density"},
  }};

  std::vector<HistoryField> history() const { return {{"plastic_strain"}}; }
  void begin(const Start&, std::span<double> q) const { q[0] = 0; }
  std::vector<std::string> complaints() const { return {}; }

  Moduli moduli(const Point&, double) const
  {
    return {E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))};
  }

  /// The bubble's plastic flow is capped: a step that shears a cell by more
  /// than ten times its yield strain has nothing left to stabilise.
  static constexpr double max_flow = 10;

  /// Radius of the yield surface, sqrt(2/3) of the yield stress [Pa].
  double yield_radius(double plastic_strain) const
  {
    return std::sqrt(2.0 / 3.0) * (yield_stress + hardening * plastic_strain);
  }

  /// Radially back to the yield surface.
  double admit(Eigen::Ref<Voigt> s, double&, std::span<double> q) const
  {
    const double size = norm(s), radius = yield_radius(q[0]);
    if (not(size > radius))
      return 0;
    s *= radius / size;
    return 1 - radius / size;
  }

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const
  {
    const auto [G, K] = moduli(start, step.dt);
    const Voigt2 D = shear_stiffness(G);
    answer = {};
    answer.p = start.p - K * step.theta;
    answer.dp_dtheta = -K;
    answer.ds_de = D;
    answer.s = start.s + D * step.de;

    const double trial = norm(answer.s);
    const double radius = yield_radius(q[0]);
    if (not(trial > radius))
      return Outcome::ok;

    const double h = 1 + hardening / (3 * G);
    const double dgamma = (trial - radius) / (2 * G * h);
    const Voigt n = answer.s / trial;
    // n : de; with engineering shear n_xy counts once, as 2 n_xy eps_xy
    const Voigt dtrial_de = 2 * G * n;
    q[0] += std::sqrt(2.0 / 3.0) * dgamma;
    // |s| at the end; trial - 2 G dgamma would lose the digits that a large
    // step has before the point
    const double size = yield_radius(q[0]);
    answer.s = size * n;
    const double keep = kind == TangentKind::continuum ? 1 : size / trial;
    answer.ds_de = keep * D + ((1 - 1 / h) - keep) * n * dtrial_de.transpose();

    const double flow = trial / size - 1;
    answer.flow = std::min(flow, max_flow);
    if (flow < max_flow)
      answer.dflow_de =
          (1 / size - trial / (size * size) * (1 - 1 / h)) * dtrial_de;
    return Outcome::ok;
  }
};

static_assert(MaterialLaw<Elastic> and MaterialLaw<J2>);
} // namespace mmale::material
