// SPDX-License-Identifier: LGPL-3.0-or-later
#include "drucker_prager.h"

namespace mmale::material
{
namespace
{
/// Rise of sqrt(J2) over p of a cone that stands for Mohr-Coulomb's angle of
/// friction, and k / (c cot phi); or the same of dilation. NaN: no such cone.
double rise(std::string_view cone, double angle)
{
  const double sine = std::sin(angle);
  constexpr double sqrt3 = std::numbers::sqrt3;
  if (cone == "compression")
    return 2 * sqrt3 * sine / (3 - sine);
  if (cone == "extension")
    return 2 * sqrt3 * sine / (3 + sine);
  if (cone == "inscribed" or cone == "plane_strain")
    return sqrt3 * sine / std::sqrt(3 + sine * sine);
  return std::nan("");
}
} // namespace

DruckerPrager::Cone DruckerPrager::numbers() const
{
  const double phi = radian(friction_deg);
  Cone c;
  c.beta = rise(cone, radian(dilation_deg));
  // sqrt(J2) = share (p sin phi + c cos phi); written so that phi may be 0
  double share;
  constexpr double sqrt3 = std::numbers::sqrt3;
  const double sine = std::sin(phi);
  if (cone == "compression")
    share = 2 * sqrt3 / (3 - sine);
  else if (cone == "extension")
    share = 2 * sqrt3 / (3 + sine);
  else if (cone == "plane_strain")
    // d eps_plastic,zz = 0 puts s_zz at -2/3 beta sqrt(J2); then the radius of
    // Mohr's circle is sqrt(J2 (1 - beta^2/3)), its centre beta/3 sqrt(J2) - p
    share = 1 / (std::sqrt(1 - c.beta * c.beta / 3) + c.beta * sine / 3);
  else
    share = sqrt3 / std::sqrt(3 + sine * sine);
  c.alpha = share * sine;
  c.k = share * cohesion * std::cos(phi);
  const double tip = c.alpha > 0 ? c.k / c.alpha : scene::infinity;
  c.floor = -std::min(tensile_strength, tip);
  return c;
}

std::vector<std::string> DruckerPrager::complaints() const
{
  const Cone c = numbers();
  auto out = complaints_of_friction(
      cohesion, friction_deg, dilation_deg, tensile_strength,
      c.alpha > 0 ? c.k / c.alpha : scene::infinity);
  if (std::isnan(c.beta))
    out.push_back("cone = \"" + cone
                  + "\" is none of compression, extension, plane_strain, "
                    "inscribed");
  return out;
}

double DruckerPrager::admit(Eigen::Ref<Voigt> s, double& p,
                            std::span<double>) const
{
  const double size = norm(s) / std::numbers::sqrt2;
  const double strength = numbers().strength(p);
  // an update leaves round-off of this size
  constexpr double digits = 4e-15;
  if (not(size > strength + digits * (std::abs(p) + size)))
    return 0;
  s *= strength / size;
  return 1 - strength / size;
}

Outcome DruckerPrager::update(const Point& start, const Strain& step,
                              TangentKind kind, std::span<double>,
                              Response& answer) const
{
  const auto [G, K] = moduli(start, step.dt);
  const Cone c = numbers();
  const Gap gap{c.floor};
  const Voigt2 D = shear_stiffness(G);
  const Voigt trial = start.s + D * step.de;
  const double p_elastic = gap.elastic(start.p) - K * step.theta;
  answer = {};
  answer.s = trial;
  answer.ds_de = D;

  constexpr double digits = 1e-15;
  const double r_trial = norm(trial) / std::numbers::sqrt2;
  // along the cone while the dilation keeps p above the floor, else at the
  // floor's strength
  const double H = G + c.alpha * c.beta * K;
  double slip = (r_trial - c.alpha * p_elastic - c.k) / H;
  bool floor = p_elastic + K * c.beta * std::max(slip, 0.0) < c.floor;
  double r = r_trial - G * slip;
  if (floor)
  {
    r = c.strength(c.floor);
    slip = (r_trial - r) / G;
  }
  const bool plastic =
      slip * H > digits * (r_trial + std::abs(c.alpha * p_elastic));
  if (not plastic)
    slip = 0;
  // p on, and beyond, the floor: the gap is what the dilation leaves of it
  const double p_end = p_elastic + K * c.beta * slip;
  floor = p_end < c.floor;
  const double stiffness = floor ? Gap::gap_share * K : K;
  answer.p = floor ? gap.actual(p_end) : p_end;
  answer.dp_dtheta = -stiffness;
  answer.effort.apex = floor;
  if (plastic)
  {
    const Voigt n = trial / norm(trial);
    const Voigt dslip_de = std::numbers::sqrt2 * G / (floor ? G : H) * n;
    const double dslip_dtheta = floor ? 0 : c.alpha * K / H;
    answer.s = std::numbers::sqrt2 * r * n;
    const double keep =
        kind == TangentKind::continuum and r > 0 ? 1 : r / r_trial;
    answer.ds_de =
        keep * (D - 2 * G * n * n.transpose())
        + std::numbers::sqrt2 * n
              * (std::numbers::sqrt2 * G * n - G * dslip_de).transpose();
    answer.ds_dtheta = -std::numbers::sqrt2 * G * dslip_dtheta * n;
    answer.dp_de = stiffness * c.beta * dslip_de;
    answer.dp_dtheta += stiffness * c.beta * dslip_dtheta;
  }
  if (kind == TangentKind::robust)
  {
    answer.ds_de = D;
    answer.ds_dtheta.setZero();
    answer.dp_de.setZero();
    answer.dp_dtheta = -K;
  }
  if (plastic)
    add_flow(G, trial, answer);
  return Outcome::ok;
}
} // namespace mmale::material
