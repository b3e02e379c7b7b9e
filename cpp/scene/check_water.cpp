// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include <algorithm>
#include <format>

namespace mmale::scene
{
namespace
{
/// What the water of a boundary does in a stage: one thing at most.
void check_drainage(const Scene& scene, const Condition& c,
                    const std::string& key, Complaints& out)
{
  std::vector<std::string> given;
  if (c.drained)
    given.push_back("drained");
  if (c.pore_pressure)
    given.push_back("pore_pressure");
  if (c.seepage_face)
    given.push_back("seepage_face");
  for (const std::string& name : given)
    if (not scene.water or not scene.water->seepage())
      out.push_back({key + "." + name,
                     "needs a table water with drainage = \"seepage\": else no "
                     "water passes any boundary",
                     {}});
    else if (name != given.front())
      out.push_back(
          {key + "." + name,
           std::format("{} is given too; water has one of them", given.front()),
           {}});
}

/// The void ratio comes from the law, or the porosity from the scene.
void check_porosity(const Scene& scene, const Libraries& libraries,
                    Complaints& out)
{
  for (const auto& [name, material] : scene.material)
  {
    const auto law =
        std::ranges::find(libraries.laws, material.law, &LawInfo::name);
    if (law == libraries.laws.end())
      continue;
    const bool given = scene.water->porosity > 0;
    if (law->void_ratio and given)
      out.push_back({"water.porosity",
                     std::format("law '{}' of material '{}' has a void ratio, "
                                 "which tells it",
                                 law->name, name),
                     {}});
    if (not law->void_ratio and not given)
      out.push_back(
          {"water.porosity",
           missing("Porosity, for laws without a void ratio", "", "0 < x < 1")
               + " (law " + law->name + ")",
           {}});
  }
}

void check_seepage(const Scene& scene, Complaints& out)
{
  const std::string asks = "water.drainage is \"seepage\"";
  if (not(scene.water->permeability > 0))
    out.push_back(
        {"water.permeability",
         missing("Hydraulic conductivity", "m/s", "> 0") + ", because " + asks,
         {}});
  if (scene.solver.layout != Layout::mean)
    out.push_back({"solver.layout", "must be mean: " + asks, {}});
  if (scene.solver.element == Element::constant_strain)
    out.push_back(
        {"solver.element", "must not be constant_strain: " + asks, {}});
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
  {
    const auto& dynamics = scene.stage[i].dynamics;
    const std::string key =
        "stage." + stage_label(scene.stage, i) + ".dynamics.";
    if (dynamics and dynamics->resolved().beta == 0)
      out.push_back({key + "beta", "must be > 0: " + asks, {}});
    // it would damp the total pressure, and with it the flow
    if (dynamics and dynamics->damping_stiffness > 0)
      out.push_back({key + "damping_stiffness",
                     "must be 0: " + asks + ", and the flow damps",
                     {}});
  }
}
} // namespace

void check_water(const Scene& scene, const Libraries& libraries,
                 Complaints& out)
{
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
    for (const auto& [name, condition] : scene.stage[i].boundary)
      check_drainage(
          scene, condition,
          "stage." + stage_label(scene.stage, i) + ".boundary." + name, out);
  if (not scene.water)
    return;
  if (scene.motion or scene.stage.empty())
  {
    out.push_back({"water", "is not used: nothing is strained", {}});
    return;
  }
  check_porosity(scene, libraries, out);
  if (scene.water->seepage())
    check_seepage(scene, out);
}
} // namespace mmale::scene
