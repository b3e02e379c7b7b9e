// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// Viscous fluid with a yield stress, as grout and bentonite are; Bingham's
/// with exponent 1, a power law with yield stress 0.
///
///     tau = yield_stress + consistency rate^exponent   above `regularisation`
///     tau = viscosity there * rate                     below it
///
/// for the shear rate sqrt(2 d:d) and tau = sqrt(s:s/2). What should be rigid
/// creeps at rates below `regularisation`; what flows faster is exact
/// (`studies/grout_regularisation`: smooth substitutes such as Papanastasiou's
/// are wrong on both sides of the yield stress, for the same largest
/// viscosity).
/// @source Tanner & Milthorpe (1983) for the two straight lines
struct HerschelBulkley
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "herschel_bulkley";
  static constexpr bool symmetric = true, yields = false, fluid = true;
  static constexpr bool linear_pressure = true;

  double yield_stress = required;   ///< in shear [Pa]
  double consistency = required;    ///< [Pa s^exponent]
  double exponent = required;       ///< [-]
  double regularisation = required; ///< [1/s]
  double bulk_modulus = required;   ///< [Pa]
  double density = required;        ///< [kg/m3]

  static inline const std::array<Parameter<HerschelBulkley>, 6> parameters{{
      {"yield_stress", "Pa", &HerschelBulkley::yield_stress, scene::at_least(0),
       "shear stress below which it does not flow"},
      {"consistency", "Pa s^exponent", &HerschelBulkley::consistency,
       scene::above(0), "shear stress above it, at the rate 1/s"},
      {"exponent", "-", &HerschelBulkley::exponent, scene::above(0),
       "rise of that stress: as the rate to this power"},
      {"regularisation", "1/s", &HerschelBulkley::regularisation,
       scene::above(0), "shear rate below which it is merely very viscous"},
      {"bulk_modulus", "Pa", &HerschelBulkley::bulk_modulus, scene::above(0),
       "resistance to change of volume"},
      {"density", "kg/m3", &HerschelBulkley::density, scene::at_least(0),
       "mass density"},
  }};

  /// The rate gives the apparent viscosity for the step's moduli.
  std::vector<HistoryField> history() const { return {{"shear_rate"}}; }
  void begin(const Start&, std::span<double> q) const { q[0] = 0; }
  std::vector<std::string> complaints() const { return {}; }
  double admit(Eigen::Ref<Voigt>, double&, std::span<double>) const
  {
    return 0;
  }

  /// tau over the shear rate [Pa s].
  double viscosity(double rate) const
  {
    const double r = std::max(rate, regularisation);
    return (yield_stress + consistency * std::pow(r, exponent)) / r;
  }

  /// In no time nothing flows: as stiff in shear as in volume.
  Moduli moduli(const Point& start, double dt) const
  {
    return {dt > 0 ? viscosity(start.q[0]) / dt : bulk_modulus, bulk_modulus};
  }

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const
  {
    answer = {};
    answer.p = start.p - bulk_modulus * step.theta;
    answer.dp_dtheta = -bulk_modulus;
    answer.s = start.s;
    if (not(step.dt > 0))
      return Outcome::ok; // no rate: the deviator stays as it was
    // sqrt(2 e:e) with the engineering shear in e
    const Voigt& e = step.de;
    const double strain =
        std::sqrt(2 * e.head<3>().squaredNorm() + e[3] * e[3]);
    const double rate = strain / step.dt, eta = viscosity(rate);
    const Voigt2 D = shear_stiffness(eta / step.dt);
    q[0] = rate;
    answer.s = D * e;
    answer.ds_de = D;
    if (not(rate > regularisation) or kind == TangentKind::robust)
      return Outcome::ok;
    // tau' of the rate against tau / rate; n = s / tau, d rate/de = n / dt
    const double slope = consistency * exponent * std::pow(rate, exponent - 1);
    const Voigt n = answer.s / (eta * rate);
    answer.ds_de += (slope - eta) / step.dt * n * n.transpose();
    return Outcome::ok;
  }
};

static_assert(MaterialLaw<HerschelBulkley>);
} // namespace mmale::material
