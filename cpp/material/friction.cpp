// SPDX-License-Identifier: LGPL-3.0-or-later
#include "friction.h"

#include <format>

namespace mmale::material
{
std::vector<std::string> complaints_of_friction(double cohesion,
                                                double friction_deg,
                                                double dilation_deg,
                                                double tensile_strength,
                                                double apex)
{
  std::vector<std::string> out;
  if (not(cohesion > 0) and not(friction_deg > 0))
    out.push_back("there is no strength: cohesion and friction_deg are both 0");
  if (dilation_deg > friction_deg)
    out.push_back(std::format("dilation_deg = {} is above friction_deg = {}: "
                              "the material would make energy",
                              dilation_deg, friction_deg));
  if (tensile_strength != not_given and tensile_strength > apex)
    out.push_back(std::format("tensile_strength = {} Pa is above the cone's "
                              "own, {} Pa",
                              tensile_strength, apex));
  return out;
}
} // namespace mmale::material
