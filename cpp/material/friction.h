// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <numbers>

/// What laws with friction share: angles, and what is beyond the tip.
///
/// Grains that have come apart carry nothing until they meet again, so the gap
/// between them must be remembered: the pressure itself remembers it. Below
/// the floor p falls with the gap at `gap_share` of K, so that the law's p
/// falls with theta at any state. Closing takes the volume that opening gave,
/// and cycles of both make none. (A return to the apex that forgets pumps
/// volume into sand at each of them.)
namespace mmale::material
{
inline double radian(double degrees)
{
  return degrees * std::numbers::pi / 180;
}

/// Pressure below the floor, and the one that an elastic body would have.
struct Gap
{
  /// Share of K with which p falls on beyond the floor: a gap of 1 % holds
  /// back with 1e-6 K. Doubled, opened grains pull twice as much.
  static constexpr double gap_share = 1e-4;

  double floor; ///< [Pa]; -infinity: none

  double elastic(double p) const
  {
    return p < floor ? floor + (p - floor) / gap_share : p;
  }
  double actual(double elastic) const
  {
    return elastic < floor ? floor + (elastic - floor) * gap_share : elastic;
  }
};

/// The bubble's plastic flow is capped: a step that shears a cell by more
/// than ten times its yield strain has nothing left to stabilise.
inline constexpr double max_flow = 10;

/// Plastic flow, 2 G dLambda = |plastic part of the step's elastic stress|/|s|.
/// Sand that is stiff beside its pressure needs it: without, the bubble goes on
/// holding the volume strains of all the flow there has been, and the pressure
/// has a checkerboard of its own size (METHOD.md, volume equation of sand).
///
/// @param[in]     G      shear modulus [Pa]
/// @param[in]     trial  deviator if the step were elastic [Pa]
/// @param[in,out] answer with s and ds_de; gains flow and its derivatives
inline void add_flow(double G, const Voigt& trial, Response& answer)
{
  const auto weighted = [](const Voigt& t)
  { return Voigt(t[0], t[1], t[2], 2 * t[3]); };
  const Voigt cut = trial - answer.s;
  const double size = norm(answer.s), cut_size = norm(cut);
  if (not(cut_size > 0))
    return;
  answer.flow = std::min(cut_size / size, max_flow);
  if (not(answer.flow < max_flow))
    return;
  answer.dflow_de =
      ((shear_stiffness(G) - answer.ds_de).transpose() * weighted(cut)
           / cut_size
       - answer.flow / size * answer.ds_de.transpose() * weighted(answer.s))
      / size;
  answer.dflow_dtheta =
      -answer.ds_dtheta.dot(weighted(cut) / cut_size
                            + answer.flow / size * weighted(answer.s))
      / size;
}

/// What is wrong with strength and dilation together.
///
/// @param[in] apex largest mean tension that the cone bears [Pa]
std::vector<std::string> complaints_of_friction(double cohesion,
                                                double friction_deg,
                                                double dilation_deg,
                                                double tensile_strength,
                                                double apex);
} // namespace mmale::material
