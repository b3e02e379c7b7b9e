// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mohr_coulomb.h"

#include "principal.h"
#include <Eigen/LU>

namespace mmale::material
{
namespace
{
/// A plane of the surface in principal stresses s1 >= s2 >= s3.
struct Plane
{
  Principal normal; ///< of a in a . s <= limit
  Principal flow;   ///< plastic strain per multiplier
  double limit;     ///< [Pa]
};

/// Which plane: Mohr-Coulomb's between two principal stresses, the floor of
/// the pressure.
enum Face
{
  mc13,
  mc12,
  mc23,
  floor_,
  num_faces
};

constexpr int max_active = 3;

/// Faces that may be active together: the plane, its edges, the floor, and
/// where they meet (with the tip as floor: the two last).
struct Set
{
  int size;
  std::array<Face, max_active> face;

  bool has_floor() const { return face[size - 1] == floor_; }
};
constexpr std::array<Set, 7> sets{{{1, {mc13}},
                                   {2, {mc13, mc12}},
                                   {2, {mc13, mc23}},
                                   {1, {floor_}},
                                   {2, {mc13, floor_}},
                                   {3, {mc13, mc12, floor_}},
                                   {3, {mc13, mc23, floor_}}}};

using Multipliers = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_active, 1>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, max_active, 3>;
using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, max_active>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                             max_active, max_active>;

/// Stress after a return, and its derivative by the trial stress.
struct Returned
{
  Principal sigma;
  Principal2 slope;
  double p = 0;   ///< its pressure, without the round-off of shear [Pa]
  double gap = 0; ///< volume strain beyond the floor [-]
  bool plastic = false;
};

/// The surface of one law, and the return to it.
class Surface
{
public:
  Surface(const MohrCoulomb& law, double G, double K) : _G(G), _K(K)
  {
    const double sine = std::sin(radian(law.friction_deg));
    const double sine_flow = std::sin(radian(law.dilation_deg));
    const double limit = 2 * law.cohesion * std::cos(radian(law.friction_deg));
    const double tension = std::min(law.tensile_strength, law.tip());
    const auto between = [&](int i, int j)
    {
      Plane f{Principal::Zero(), Principal::Zero(), limit};
      f.normal[i] = 1 + sine;
      f.normal[j] = sine - 1;
      f.flow[i] = 1 + sine_flow;
      f.flow[j] = sine_flow - 1;
      return f;
    };
    _plane[mc13] = between(0, 2);
    _plane[mc12] = between(0, 1);
    _plane[mc23] = between(1, 2);
    const Principal mean = Principal::Constant(1.0 / 3);
    _plane[floor_] = {mean, mean, tension};
    _bounded = std::isfinite(tension);
    _pointed = not(tension < law.tip());
  }

  /// Least pressure but for gaps [Pa].
  double floor() const { return _bounded ? -_plane[floor_].limit : -infinite; }

  /// Largest excess of a stress over a plane that it may meet [Pa].
  double excess(const Principal& sigma) const
  {
    double worst = -infinite;
    for (int f = 0; f < (_bounded ? num_faces : floor_); ++f)
      worst = std::max(worst, _plane[f].normal.dot(sigma) - _plane[f].limit);
    return worst;
  }

  /// Largest share of `s` that the surface bears at pressure p >= floor.
  double share(const Principal& s, double p) const
  {
    const Plane& f = _plane[mc13];
    const double size = f.normal.dot(s);
    const double room = std::max(f.limit + p * f.normal.sum(), 0.0);
    return size > room ? room / size : 1;
  }

  /// Back to the surface from a trial stress s1 >= s2 >= s3.
  Returned back(const Principal& trial) const
  {
    const double scale =
        trial.cwiseAbs().maxCoeff() + std::abs(_plane[mc13].limit);
    Returned best{trial, Principal2::Identity()};
    if (not(excess(trial) > 4e-15 * scale))
      return best;
    // Each is tried: the first without a violation is the answer, and with
    // round-off the one with the least.
    double least = infinite;
    for (const Set& set : sets)
    {
      if (set.has_floor() and not _bounded)
        continue;
      Returned r;
      const double violation = solve(set, trial, r);
      if (violation < least)
      {
        least = violation;
        best = r;
      }
      if (least <= 1e-14 * scale)
        break;
    }
    return best;
  }

private:
  static constexpr double infinite = scene::infinity;

  /// Return to a set of planes.
  /// @return the worst negative multiplier or excess over a plane [Pa]
  double solve(const Set& set, const Principal& trial, Returned& r) const
  {
    Rows A(set.size, 3);
    Columns DB(3, set.size);
    Multipliers excess(set.size);
    for (int i = 0; i < set.size; ++i)
    {
      const Plane& f = _plane[set.face[i]];
      A.row(i) = f.normal;
      DB.col(i) = 2 * _G * f.flow;
      DB.col(i).array() += (_K - 2 * _G / 3) * f.flow.sum();
      excess[i] = f.normal.dot(trial) - f.limit;
    }
    const auto factor = Square(A * DB).partialPivLu();
    const Rows M = factor.solve(A);
    const Multipliers lambda = factor.solve(excess);
    r.plastic = true;
    r.sigma = trial - DB * lambda;
    r.slope = Principal2::Identity() - DB * M;
    double dilation = 0;
    for (int i = 0; i < set.size; ++i)
      dilation += lambda[i] * _plane[set.face[i]].flow.sum();
    r.p = _K * dilation - trial.mean();
    const double violation =
        std::max(-2 * _G * lambda.minCoeff(), this->excess(r.sigma));
    if (set.has_floor())
    {
      // what the floor holds back is the gap
      const double softness = Gap::gap_share * _K;
      r.gap = lambda[set.size - 1];
      if (set.size == 3 and _pointed)
        r.sigma.setConstant(-floor()); // without the trial's round-off
      r.p = floor() - softness * r.gap;
      r.sigma.array() += softness * r.gap;
      r.slope += Principal::Constant(softness) * M.row(set.size - 1);
    }
    return std::isnan(violation) ? infinite : violation;
  }

  double _G, _K;
  std::array<Plane, num_faces> _plane;
  bool _bounded; ///< there is a floor
  bool _pointed; ///< it is the tip's
};

/// Order of three numbers, the largest first.
std::array<int, 3> descending(const Principal& v)
{
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](int i, int j) { return v[i] > v[j]; });
  return order;
}
} // namespace

double MohrCoulomb::tip() const
{
  return friction_deg > 0 ? cohesion / std::tan(radian(friction_deg))
                          : scene::infinity;
}

std::vector<std::string> MohrCoulomb::complaints() const
{
  return complaints_of_friction(cohesion, friction_deg, dilation_deg,
                                tensile_strength, tip());
}

double MohrCoulomb::admit(Eigen::Ref<Voigt> s, double& p,
                          std::span<double>) const
{
  const auto [G, K] = moduli({}, 0);
  const Surface surface(*this, G, K);
  const Principal values = PrincipalAxes(s).values();
  Principal sorted;
  const auto order = descending(values);
  for (int i = 0; i < 3; ++i)
    sorted[i] = values[order[i]];
  const double at = std::max(p, surface.floor());
  const double share = surface.share(sorted, at);
  // an update leaves round-off of this size
  const double digits = 1e-14 * (1 + std::abs(p) / (norm(s) + 1e-300));
  if (not(1 - share > digits))
    return 0;
  s *= share;
  return 1 - share;
}

Outcome MohrCoulomb::update(const Point& start, const Strain& step,
                            TangentKind kind, std::span<double>,
                            Response& answer) const
{
  const auto [G, K] = moduli(start, step.dt);
  const Surface surface(*this, G, K);
  const Voigt2 D = shear_stiffness(G);
  const Voigt one(1, 1, 1, 0);
  const Voigt trial = start.s + D * step.de;
  const double p_trial = Gap{surface.floor()}.elastic(start.p) - K * step.theta;
  // What of p does no matter stays aside, so that its digits stay out of s:
  // all of it for a prism without end, and a gap that no dilation can close.
  const double floor = surface.floor();
  const double reach =
      4 * K / G * norm(trial) + std::abs(floor) + std::abs(start.p);
  double aside = 0;
  if (std::isinf(floor))
    aside = p_trial;
  else if (reach > 0 and p_trial < floor - reach)
    aside = p_trial - (floor - reach);
  const PrincipalAxes axes(trial);
  const auto order = descending(axes.values());
  Principal sorted;
  for (int i = 0; i < 3; ++i)
    sorted[i] = axes.values()[order[i]] - (p_trial - aside);
  const Returned r = surface.back(sorted);

  answer = {};
  if (not r.plastic)
  {
    answer.s = trial;
    answer.ds_de = D;
    answer.p = p_trial;
    answer.dp_dtheta = -K;
    return Outcome::ok;
  }
  Principal values;
  Principal2 slope;
  for (int i = 0; i < 3; ++i)
  {
    values[order[i]] = r.sigma[i];
    for (int j = 0; j < 3; ++j)
      slope(order[i], order[j]) = r.slope(i, j);
  }
  // a turn of the trial's axes turns the answer's: the shear between them
  const double scale = sorted.cwiseAbs().maxCoeff();
  double turn = axes.radius() > 1e-8 * scale
                    ? 0.5 * (values[0] - values[1]) / axes.radius()
                    : slope(0, 0) - slope(0, 1);
  if (kind == TangentKind::continuum and std::abs(turn) > 1e-8)
    turn = 1; // in a step without length the axes stay
  const Principal2 elastic =
      2 * G * Principal2::Identity() + Principal2::Constant(K - 2 * G / 3);
  split(axes.assemble(values),
        axes.assemble(Principal2(slope * elastic), G * turn), answer);
  answer.p = r.p + (std::isinf(floor) ? aside : Gap::gap_share * aside);
  answer.effort.apex = r.gap > 0;
  if (kind == TangentKind::robust)
  {
    answer.ds_de = D;
    answer.ds_dtheta.setZero();
    answer.dp_de.setZero();
    answer.dp_dtheta = -K;
  }
  add_flow(G, trial, answer);
  return Outcome::ok;
}
} // namespace mmale::material
