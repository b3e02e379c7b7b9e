// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/reader.h"
#include <string>
#include <vector>

/// Laws and names that the scene tests offer to the reader: the reader takes
/// them from its caller, so the tests do not depend on the solver's lists.
namespace mmale::scene::test
{
inline Libraries libraries()
{
  const ParameterInfo E = {"E", "Pa", above(0), required, "Young's modulus."};
  const ParameterInfo nu = {"nu", "-", between(-1, 0.5), required,
                            "Poisson's ratio."};
  const ParameterInfo density = {"density", "kg/m^3", above(0), 1000,
                                 "Mass per volume."};
  const ParameterInfo yield = {"yield_stress", "Pa", above(0), required,
                               "Yield stress."};
  const ParameterInfo hardening = {"hardening", "Pa", at_least(0), 0,
                                   "Slope of the yield stress."};
  return {{{"elastic", {E, nu, density}},
           {"j2", {E, nu, yield, hardening, density}}},
          {"average", "optimise"},
          {"donor_cell", "limited_linear"},
          {"equal_pressure"},
          {"moment_of_fluid"},
          {"plastic_strain", "pressure", "velocity"}};
}

/// Read text as file "scene.toml" with `key=value` changes.
inline Reading read(const std::string& text,
                    const std::vector<Override>& overrides = {})
{
  return scene::read(text, "scene.toml", overrides, libraries());
}

/// All complaints, one a line.
inline std::string text_of(const std::vector<Complaint>& complaints)
{
  std::string text;
  for (const Complaint& complaint : complaints)
    text += to_string(complaint) + "\n";
  return text;
}
} // namespace mmale::scene::test
