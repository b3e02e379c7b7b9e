// SPDX-License-Identifier: LGPL-3.0-or-later
#include "hypoplastic.h"

#include "hypoplastic_integration.h"
#include "runge_kutta.h"
#include <numbers>

namespace mmale::material
{
using hypoplasticity::Sand;
using hypoplasticity::Task;
using hypoplasticity::Track;
using Tensor = hypoplasticity::Tensor<4>;
using Tensor2 = hypoplasticity::Tensor2<4>;

namespace
{
using H = Hypoplastic;
using scene::above;
using scene::at_least;
using scene::between;

const Tensor one(1, 1, 1, 0);
const double root2 = std::numbers::sqrt2;

Tensor mandel(const Voigt& stress)
{
  return {stress[0], stress[1], stress[2], root2 * stress[3]};
}

/// Bulk stiffness of L at the floor, times m_R: what closes below it [Pa].
double closing_stiffness(const Sand& c, double e)
{
  const auto f = hypoplasticity::factors(c, c.floor, e);
  return c.m_R * f.f_s * (3 + c.a * c.a) / 3;
}

/// What a step does to sand whose pressure is below the floor.
///
/// The rates work at the floor, on the same stress ratio; the gap between the
/// floor and the pressure is closed and opened by the volume strain. Of the
/// strain of sand whose grains touch only in part, p/p_min of them, the rates
/// see that part, until the gap has closed. With void ratios above e_i at the
/// floor no grains touch.
struct Apex
{
  double begin = 0;   ///< part of the strain that the rates do not see
  double begin_D = 0; ///< its derivative by the volume strain
  double gap = 0;     ///< at the end of the step [Pa]
  double gap_D = 0;   ///< and its derivative
};

/// @param[in] soft, stiff bulk stiffness where grains do not touch, and do
Apex approach(const Sand& c, double p, double e, double theta, double soft,
              double stiff)
{
  Apex out{.gap = c.floor - p};
  const double e_i = c.e_i * std::exp(-std::pow(3 * c.floor / c.h_s, c.n));
  const double loose = std::min(0.0, std::log((1 + e_i) / (1 + e)));
  const double touch = loose < 0 ? 0 : std::max(0.0, p / c.floor);
  out.begin = 1 - touch;
  if (theta >= 0)
  {
    out.gap_D = soft * out.begin; // the rest opens at the floor
    out.gap += out.gap_D * theta;
    return out;
  }
  const double left = out.gap + soft * loose; // when grains come to touch
  const double closed = left > 0 ? loose - left / stiff : -out.gap / soft;
  if (theta <= closed)
  {
    out.begin *= closed / theta;
    out.begin_D = -out.begin / theta;
    out.gap = 0;
    return out;
  }
  out.gap_D = theta > loose ? soft : stiff;
  out.gap +=
      soft * std::max(theta, loose) + stiff * std::min(0.0, theta - loose);
  return out;
}

/// What a step came to, in Mandel's components and counted from the apex.
struct End
{
  Tensor s;    ///< deviator [Pa]
  double p;    ///< [Pa]
  Tensor2 s_D; ///< derivatives by the strain
  Tensor p_D;
};

/// From the stress that the rates came to at or above the floor.
///
/// @param[in] gap   between that pressure and the answer, if above 0 [Pa]
/// @param[in] gap_D its derivative by the strain
End bring_down(const Track& track, double gap, const Tensor& gap_D)
{
  End out;
  const double p = -hypoplasticity::trace<4>(track.T) / 3;
  const Tensor by_D = -track.T_D.topRows<3>().colwise().sum().transpose() / 3;
  out.s = track.T + p * one;
  out.s_D = track.T_D + one * by_D.transpose();
  out.p = p - gap;
  out.p_D = by_D - gap_D;
  if (gap > 0) // along a ray to the apex
  {
    const double share = std::max(out.p, 0.0) / p;
    Tensor share_D = Tensor::Zero();
    if (out.p > 0)
      share_D = (out.p_D - share * by_D) / p;
    out.s_D = share * out.s_D + out.s * share_D.transpose();
    out.s *= share;
  }
  return out;
}

/// No plastic flow for the bubble: in ground the gradient of p is in balance
/// with that of the deviator too, so its total must not drive a bubble.
void give(const End& end, Response& answer)
{
  const auto engineering = [](Tensor x)
  {
    x[3] /= root2;
    return x;
  };
  answer.s = engineering(end.s);
  answer.p = end.p;
  answer.ds_de = end.s_D;
  answer.ds_de.row(3) /= root2;
  answer.ds_de.col(3) /= root2;
  answer.ds_dtheta = engineering(end.s_D * one / 3);
  answer.dp_de = engineering(end.p_D);
  answer.dp_dtheta = end.p_D.dot(one) / 3;
}
} // namespace

const std::array<Parameter<H>, 21> H::parameters{{
    {"phi_c_deg", "degrees", &H::phi_c_deg, between(5, 60),
     "critical friction angle"},
    {"h_s", "Pa", &H::h_s, above(0), "granulate hardness"},
    {"n", "-", &H::n, between(0, 1), "exponent of the compression law"},
    {"e_d0", "-", &H::e_d0, above(0), "least void ratio at zero pressure"},
    {"e_c0", "-", &H::e_c0, above(0), "critical void ratio at zero pressure"},
    {"e_i0", "-", &H::e_i0, above(0), "largest void ratio at zero pressure"},
    {"alpha", "-", &H::alpha, above(0), "exponent of density in the strength"},
    {"beta", "-", &H::beta, at_least(0),
     "exponent of density in the stiffness"},
    {"m_R", "-", &H::m_R, at_least(1),
     "stiffness after reversal over the basic one"},
    {"m_T", "-", &H::m_T, at_least(1),
     "stiffness after a turn of the path by 90 degrees over the basic one"},
    {"R", "-", &H::R, above(0), "size of the intergranular strain"},
    {"beta_R", "-", &H::beta_R, above(0),
     "exponent of the growth of intergranular strain"},
    {"chi", "-", &H::chi, at_least(1),
     "exponent of the effect of intergranular strain"},
    {"p_t", "Pa", &H::p_t, at_least(0), "cohesion: shift of the apex"},
    {"grain_density", "kg/m3", &H::grain_density, above(0),
     "mass density of the grains"},
    {"void_ratio", "-", &H::void_ratio, above(0), "void ratio at the start"},
    {"relative_density", "-", &H::relative_density, scene::from_to(-1, 1.5),
     "(e_c0 - e)/(e_c0 - e_d0) at the start, in the place of void_ratio"},
    {"p_min", "Pa", &H::p_min, above(0),
     "zero-stress floor: pressure above the apex below which no rates are "
     "taken; doubled, sand at a free surface is softer to twice the depth"},
    {"apex_stiffness", "-", &H::apex_stiffness, above(0),
     "bulk stiffness beyond the floor over p_min; doubled, sand in tension "
     "bears twice as much"},
    {"tolerance", "-", &H::tolerance, between(0, 0.1),
     "relative error of a sub-step; doubled, a quarter less sub-steps"},
    {"max_substeps", "-", &H::max_substeps, at_least(1),
     "sub-steps of an update before it asks for a smaller step"},
}};

const std::array<TextParameter<H>, 2> H::texts{{
    {"intergranular_strain", &H::intergranular_strain, true,
     "\"on\" or \"off\": stiffness remembers the last strains"},
    {"integrator", &H::integrator, false,
     "embedded pair of the sub-steps: heun, rkf23, bs32 (default) or dp54"},
}};

std::vector<HistoryField> H::history() const
{
  std::vector<HistoryField> fields{{"void_ratio", 1, Conserved::grain_volume}};
  if (with_grains())
    fields.push_back({"intergranular_strain", 4, Conserved::value});
  return fields;
}

double H::initial_void_ratio(const Start& at) const
{
  if (not std::isnan(at.void_ratio))
    return at.void_ratio;
  return relative_density == not_given
             ? void_ratio
             : e_c0 - relative_density * (e_c0 - e_d0);
}

double H::initial_density(const Start& at) const
{
  return grain_density / (1 + initial_void_ratio(at));
}

void H::begin(const Start& at, std::span<double> q) const
{
  std::ranges::fill(q, 0.0);
  q[0] = initial_void_ratio(at);
}

std::vector<std::string> H::complaints() const
{
  std::vector<std::string> out;
  if (not(e_d0 < e_c0 and e_c0 < e_i0))
    out.push_back("e_d0 < e_c0 < e_i0 must hold");
  if ((void_ratio == not_given) == (relative_density == not_given))
    out.push_back("give either void_ratio or relative_density");
  if (not(initial_void_ratio({}) > 0) and relative_density != not_given)
    out.push_back("relative_density makes the void ratio negative");
  if (with_grains())
  {
    for (const auto& p : parameters)
      if (p.value == &H::m_R or p.value == &H::m_T or p.value == &H::R
          or p.value == &H::beta_R or p.value == &H::chi)
        if (this->*p.value == not_given)
          out.push_back("intergranular_strain = \"on\" needs "
                        + std::string(p.name));
    if (m_R < m_T)
      out.push_back("m_R must not be less than m_T");
  }
  else if (intergranular_strain != "off")
    out.push_back("intergranular_strain must be \"on\" or \"off\"");
  if (std::ranges::find(runge_kutta::names, integrator)
      == runge_kutta::names.end())
    out.push_back("integrator must be heun, rkf23, bs32 or dp54");
  return out;
}

Sand H::constants() const
{
  using std::pow, std::sqrt;
  constexpr double radian = std::numbers::pi / 180;
  const double s = std::sin(phi_c_deg * radian);
  Sand c;
  c.h_s = h_s;
  c.n = n;
  c.e_d = e_d0;
  c.e_c = e_c0;
  c.e_i = e_i0;
  c.alpha = alpha;
  c.beta = beta;
  c.floor = p_min;
  c.a = sqrt(3) * (3 - s) / (2 * root2 * s);
  c.f_d = pow((e_i0 - e_d0) / (e_c0 - e_d0), alpha);
  const double stiff = pow(e_i0 / e_c0, beta);
  c.f_e = 1 / stiff;
  c.f_b = h_s / n * stiff / (3 + c.a * c.a - sqrt(3) * c.a * c.f_d);
  c.m_R = c.m_T = c.R = c.beta_R = c.chi = 1;
  if (with_grains())
  {
    c.m_R = m_R;
    c.m_T = m_T;
    c.R = R;
    c.beta_R = beta_R;
    c.chi = chi;
  }
  c.core = std::clamp(tolerance, 1e-12, 1e-3);
  static const double widest = hypoplasticity::cone(widest_angle_deg * radian);
  c.cone = widest;
  return c;
}

Moduli H::moduli(const Point& start, double) const
{
  const Sand c = constants();
  const double p = std::max(start.p + p_t, p_min);
  Tensor ratio = Tensor::Zero();
  if (start.p + p_t > 0)
    ratio = mandel(start.s) / (-3 * (start.p + p_t));
  const auto lode = hypoplasticity::lode<4>(ratio);
  const auto f = hypoplasticity::factors(c, p, start.q[0]);
  const double f_s = c.m_R * f.f_s / (1.0 / 3 + lode.q);
  const double F2 = lode.F * lode.F;
  return {0.5 * f_s * F2, f_s * (3 * F2 + c.a * c.a) / 9};
}

double H::admit(Eigen::Ref<Voigt> s, double& p, std::span<double> q) const
{
  double cut = 0;
  const double above_apex = p + p_t;
  if (not(above_apex > 0))
  {
    cut = norm(s) > 0 ? 1 : 0;
    s.setZero();
  }
  else if (norm(s) > 0)
  {
    const Sand c = constants();
    const Tensor Td = mandel(s) / (-3 * above_apex);
    const double share = hypoplasticity::share_in_cone(
        c.cone, Td.squaredNorm(), Td.dot(hypoplasticity::squared(Td)));
    s *= share;
    cut = 1 - share;
  }
  if (with_grains())
  {
    Eigen::Map<Voigt> h(q.data() + 1);
    const double size = norm(h);
    if (size > R)
    {
      h *= R / size;
      cut = std::max(cut, 1 - R / size);
    }
  }
  return cut;
}

Outcome H::update(const Point& start, const Strain& step, TangentKind kind,
                  std::span<double> q, Response& answer) const
{
  answer = {};
  const Sand c = constants();
  const double p0 = start.p + p_t, e = q[0], theta = step.theta;
  const Tensor s0 = mandel(start.s);
  Tensor de = step.de;
  de[3] /= root2;
  Task task{.D = de + (theta / 3) * one,
            .theta = theta,
            .e = e,
            .grains = with_grains(),
            .kind = kind,
            .tolerance = tolerance,
            .max_substeps = max_substeps,
            .scheme = integrator};
  if (not(task.D.allFinite() and s0.allFinite() and std::isfinite(p0)
          and e > 0))
    return Outcome::reduce_step;
  const double soft = apex_stiffness * p_min;
  Apex apex;
  if (p0 < p_min)
    apex = approach(c, p0, e, theta, soft, closing_stiffness(c, e));
  task.begin = apex.begin;
  task.begin_D = apex.begin_D;
  Track track{.T = -std::max(p0, p_min) * one, .h = Tensor::Zero()};
  if (p0 > 0)
    track.T += (std::max(p0, p_min) / p0) * s0;
  if (task.grains)
    track.h = mandel(Eigen::Map<const Voigt>(q.data() + 1));
  if (integrate(c, task, track) != Outcome::ok)
  {
    answer.effort = track.effort;
    return Outcome::reduce_step;
  }
  if (kind == TangentKind::continuum and apex.gap > 0)
    track.T_D *= 1 - apex.begin;

  const Tensor gap_D = soft * track.opened_D + apex.gap_D * one;
  End end = bring_down(track, apex.gap + soft * track.opened, gap_D);
  end.p -= p_t;
  give(end, answer);
  answer.effort = track.effort;
  answer.effort.apex = track.effort.apex or p0 < p_min;
  // The rates of the pressure fall with those of the volume; over a step that
  // turns the path a long way the pressure may not.
  if (kind == TangentKind::consistent and not(answer.dp_dtheta < 0))
    return Outcome::reduce_step;
  q[0] = hypoplasticity::void_ratio(task, 1);
  if (task.grains)
  {
    track.h[3] /= root2;
    Eigen::Map<Voigt>(q.data() + 1) = track.h;
  }
  return Outcome::ok;
}
} // namespace mmale::material
