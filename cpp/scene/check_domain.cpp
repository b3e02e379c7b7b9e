// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include <format>

namespace mmale::scene
{
namespace
{
/// Nothing moves where domains are laid: what belongs to a motion is a mistake.
void check_nothing_moves(const Scene& scene, Complaints& out)
{
  const auto useless = [&](const std::string& key)
  {
    out.push_back({key,
                   "is not used: a scene with domains lays them over the mesh, "
                   "and has no stages",
                   {}});
  };
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
    useless("stage." + stage_label(scene.stage, i));
  for (const auto& [name, material] : scene.material)
    useless("material." + name);
  for (std::size_t i = 0; i < scene.region.size(); ++i)
    useless("region." + std::to_string(i));
  for (const auto& [name, tracer] : scene.tracer)
    useless("tracer." + name);
  if (scene.motion)
    useless("motion");
  if (scene.remap.mode != RemapMode::lagrangian)
    useless("remap.mode");
  for (const auto& [name, curve] : scene.output.curve)
    useless("output.curve." + name);
  for (const auto& [name, line] : scene.output.line)
    useless("output.line." + name);
}

std::string box_words(const DomainOutline& domain)
{
  return std::format("its box is {} to {}", words(domain.low),
                     words(domain.high));
}

void check_place(const Scene& scene, const std::string& key,
                 const DomainOutline& domain, const Outline* outline,
                 Complaints& out)
{
  if (scene.symmetry == Symmetry::axisymmetric and domain.low[0] < 0)
    out.push_back(
        {key, "reaches to the left of the axis: " + box_words(domain), {}});
  if (outline)
    check_in_mesh(key, domain, *outline, out);
}
} // namespace

void check_in_mesh(const std::string& key, const DomainOutline& domain,
                   const Outline& outline, Complaints& out)
{
  for (std::size_t d = 0; d < 2; ++d)
    if (domain.high[d] <= outline.low[d] or domain.low[d] >= outline.high[d])
    {
      out.push_back({key,
                     std::format("lies outside the mesh, which is {} to {}; {}",
                                 words(outline.low), words(outline.high),
                                 box_words(domain)),
                     {}});
      return;
    }
}

void check_scale(const std::string& key, const Domain& domain, Complaints& out)
{
  if (domain.height > 0 and domain.scale != Domain().scale)
    out.push_back(
        {key + ".scale", "follows from height, which is given too", {}});
}

void check_domains(const Scene& scene, const Outline* outline,
                   const DomainReader& read_domain, Complaints& out)
{
  if (scene.domain.empty())
    return;
  check_nothing_moves(scene, out);
  for (const auto& [name, domain] : scene.domain)
  {
    const std::string key = "domain." + name;
    check_scale(key, domain, out);
    for (const auto& [table, taken] :
         {std::pair{"picture", scene.output.picture.contains(name)},
          std::pair{"chart", scene.output.chart.contains(name)}})
      if (taken)
        out.push_back({std::string("output.") + table + "." + name,
                       "the domain's own picture has this name too",
                       {}});
    if (domain.file.empty() or not read_domain)
      continue;
    const DomainOutline found = read_domain(name, domain);
    out.insert(out.end(), found.complaints.begin(), found.complaints.end());
    if (found.complaints.empty())
      check_place(scene, key, found, outline, out);
  }
}
} // namespace mmale::scene
