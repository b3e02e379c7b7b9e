// SPDX-License-Identifier: LGPL-3.0-or-later
#include "drainage.h"

#include "material/library.h"
#include "material/water.h"
#include <algorithm>
#include <cmath>
#include <format>
#include <limits>

namespace mmale
{
namespace
{
/// The lesser one of the mesh's breadth and height; NaN if a file has it [m].
double extent(const scene::Mesh& mesh)
{
  if (mesh.shape == "rectangle")
    return std::min(mesh.width, mesh.height);
  if (mesh.shape != "quadrilateral")
    return std::numeric_limits<double>::quiet_NaN();
  double out = std::numeric_limits<double>::infinity();
  for (int d = 0; d < 2; ++d)
  {
    const auto [low, high] = std::ranges::minmax(
        mesh.corners, {}, [d](const scene::Point& x) { return x[d]; });
    out = std::min(out, high[d] - low[d]);
  }
  return out;
}

/// Confined modulus of the skeleton, and compressibility of water and grains.
struct Stiffness
{
  double M, C_w;
};

Stiffness stiffness(const scene::Scene& scene, double depth)
{
  const scene::Water& water = *scene.water;
  const auto law = material::make_law(scene.material.begin()->second);
  const bool heavy = std::ranges::any_of(scene.stage, [](const auto& stage)
                                         { return stage.gravity.has_value(); });
  return std::visit(
      [&](const auto& l)
      {
        std::vector<double> q(material::num_history(law));
        l.begin({}, q);
        const material::Pores pores{0,
                                    material::porosity(law, q, water.porosity)};
        const double buoyant = material::initial_density(l, material::Start{})
                               - (1 - pores.n) * water.density;
        material::Point point{.q = q};
        point.p = scene.initial.pressure.value_or(scene.initial.surcharge);
        if (heavy)
          point.p += std::max(0.0, buoyant * 9.81 * depth / 2);
        const double dt = scene.stage.front().step;
        const auto [G, K] = l.moduli(point, dt);
        const material::Water medium{water.bulk_modulus,
                                     water.grain_bulk_modulus,
                                     water.cavitation_pressure};
        return Stiffness{K + 4 * G / 3, medium.compressibility(pores)};
      },
      law);
}
} // namespace

std::optional<Drainage> drainage(const scene::Scene& scene)
{
  if (not scene.water or scene.material.empty() or scene.stage.empty())
    return std::nullopt;
  const scene::Water& water = *scene.water;
  Drainage out;
  out.length =
      water.drainage_length > 0 ? water.drainage_length : extent(scene.mesh);
  out.frequency = water.frequency;
  if (not(out.frequency > 0))
    out.frequency =
        1 / std::ranges::min(scene.stage, {}, &scene::Stage::duration).duration;
  const auto [M, C_w] =
      stiffness(scene, std::isnan(out.length) ? 0 : out.length);
  out.c_v = water.permeability / water.unit_weight() / (1 / M + C_w);
  out.T_v = water.permeability > 0
                ? out.c_v / (out.frequency * out.length * out.length)
                : std::numeric_limits<double>::quiet_NaN();
  if (out.T_v < Drainage::undrained_below)
    out.recommended = "undrained";
  else if (out.T_v <= Drainage::drained_above)
    out.recommended = "seepage";
  else if (out.T_v > Drainage::drained_above)
    out.recommended = "dry";
  return out;
}

std::string Drainage::words() const
{
  if (recommended.empty())
    return "water: T_v is not known; give water.permeability"
           + std::string(std::isnan(length) ? " and water.drainage_length"
                                            : "");
  const std::string facts = std::format(
      "water: T_v = c_v / (f D^2) = {:.3g}, with c_v = {:.3g} m2/s, "
      "f = {:.3g} 1/s, D = {:.3g} m: ",
      T_v, c_v, frequency, length);
  if (recommended == "undrained")
    return facts
           + "next to no water leaves in a cycle, drainage = "
             "\"undrained\" will do";
  if (recommended == "seepage")
    return facts + "water leaves in part, take drainage = \"seepage\"";
  return facts
         + "no excess pressure stays; without a table water, with the buoyant "
           "density below the water table, will do";
}
} // namespace mmale
