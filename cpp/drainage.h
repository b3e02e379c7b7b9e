// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <optional>
#include <string>

/// Which model of the pore water a scene needs: said before it is run.
namespace mmale
{
/// Compares how far water can consolidate the ground with how far it would have
/// to, in a cycle of the load.
///
///     T_v = c_v / (f D^2),   c_v = k / gamma_w / (1 / M + 1 / K_w)
///
/// M is the law's confined modulus at the start, under the mean buoyant weight
/// of the drainage length if the scene has gravity; f is `water.frequency`, or
/// one over the shortest stage; D is `water.drainage_length`, or the lesser
/// one of the mesh's breadth and height.
struct Drainage
{
  /// Below it hardly any water leaves in a cycle, above the other one hardly
  /// any excess pressure stays: of a layer 25 % and 100 % of the consolidation.
  static constexpr double undrained_below = 0.05, drained_above = 10;

  double c_v = 0;            ///< coefficient of consolidation [m2/s]
  double frequency = 0;      ///< of the load [1/s]
  double length = 0;         ///< way of the water [m]
  double T_v = 0;            ///< NaN: permeability or length are not known
  std::string recommended;   ///< "undrained", "seepage", "dry"; "" if unknown
  std::string words() const; ///< one sentence
};

/// @return nothing for a scene without water
std::optional<Drainage> drainage(const scene::Scene& scene);
} // namespace mmale
