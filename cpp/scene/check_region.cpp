// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include <algorithm>
#include <format>

namespace mmale::scene
{
namespace
{
std::string key_of(std::size_t region)
{
  return std::format("region.{}", region);
}

/// Which regions name which materials.
void check_names(const Scene& scene, Complaints& out)
{
  std::vector<std::string> known;
  for (const auto& [name, material] : scene.material)
    known.push_back(name);
  for (std::size_t i = 0; i < scene.region.size(); ++i)
    if (const std::string& name = scene.region[i].material;
        not name.empty() and not scene.material.contains(name))
      out.push_back({key_of(i) + ".material",
                     "no such material, " + suggestion(name, known),
                     {}});
  if (known.size() < 2)
    return;
  if (scene.region.empty())
    out.push_back({"region",
                   "missing: with several materials each needs a [[region]] "
                   "with material and shape",
                   {}});
  else
    for (const std::string& name : known)
      if (std::ranges::find(scene.region, name, &Region::material)
          == scene.region.end())
        out.push_back({"material." + name, "no region names it", {}});
}

/// What scenes with several materials cannot have.
void check_several(const Scene& scene, Complaints& out)
{
  if (scene.solver.layout != Layout::mean)
    out.push_back({"solver.layout", "must be mean with several materials", {}});
  if (scene.solver.element == Element::constant_strain)
    out.push_back({"solver.element",
                   "must be mini or equal_order with several materials",
                   {}});
  if (scene.water)
    out.push_back({"water", "is not there yet beside other materials", {}});
  if (scene.initial.K0)
    out.push_back(
        {"initial.K0", "is not there yet with several materials", {}});
}

/// A rectangle between its corners.
void check_rectangle(const std::string& key, const Region& region,
                     Complaints& out)
{
  for (std::size_t d = 0; d < 2; ++d)
    if (region.high[d] <= region.low[d])
    {
      out.push_back({key + ".high",
                     "must lie above and to the right of low "
                         + words(region.low) + ", is " + words(region.high),
                     {}});
      return;
    }
}

/// A half-plane; NaN fails no test.
void check_half_plane(const std::string& key, const Region& region,
                      const Outline* outline, Complaints& out)
{
  const auto& [point, normal] = std::pair(region.point, region.normal);
  if (normal[0] == 0 and normal[1] == 0)
  {
    out.push_back({key + ".normal", "must not be [0, 0]", {}});
    return;
  }
  if (not outline)
    return;
  bool outside = true;
  for (const double x : {outline->low[0], outline->high[0]})
    for (const double y : {outline->low[1], outline->high[1]})
      outside =
          outside
          and normal[0] * (x - point[0]) + normal[1] * (y - point[1]) >= 0;
  if (outside)
    out.push_back({key,
                   std::format("lies outside the mesh, which is {} to {}; the "
                               "normal points out of the material",
                               words(outline->low), words(outline->high)),
                   {}});
}

/// The box around a region, where its numbers tell; complaints of the reader.
DomainOutline box_of(const std::string& key, const Region& r,
                     const RegionReader& read_region)
{
  if (r.shape == "rectangle")
    return {r.low, r.high, {}};
  if (r.shape == "circle" and r.radius > 0)
    return {{r.centre[0] - r.radius, r.centre[1] - r.radius},
            {r.centre[0] + r.radius, r.centre[1] + r.radius},
            {}};
  const bool given =
      r.shape == "polygon" ? r.points.size() >= 3 : not r.drawing.file.empty();
  if (read_region and given)
    return read_region(key, r);
  return {{required, required}, {required, required}, {}};
}

void check_shape(const std::string& key, const Region& region,
                 const Outline* outline, const RegionReader& read_region,
                 Complaints& out)
{
  const std::size_t before = out.size();
  if (region.shape == "rectangle")
    check_rectangle(key, region, out);
  else if (region.shape == "half_plane")
    return check_half_plane(key, region, outline, out);
  else if (region.shape == "polygon" and not region.points.empty()
           and region.points.size() < 3)
    out.push_back({key + ".points",
                   std::format("a polygon needs 3 points at least, there {} {}",
                               region.points.size() == 1 ? "is" : "are",
                               region.points.size()),
                   {}});
  else if (region.shape == "file")
    check_scale(key, region.drawing, out);
  else if (region.shape != "circle" and region.shape != "polygon")
    return;
  if (out.size() > before)
    return;
  const DomainOutline box = box_of(key, region, read_region);
  out.insert(out.end(), box.complaints.begin(), box.complaints.end());
  if (box.complaints.empty() and outline)
    check_in_mesh(key, box, *outline, out);
}
} // namespace

void check_regions(const Scene& scene, const Outline* outline,
                   const RegionReader& read_region, Complaints& out)
{
  if (not scene.domain.empty())
    return; // nothing moves there, which is a complaint of its own
  if (scene.motion)
  {
    for (std::size_t i = 0; i < scene.region.size(); ++i)
      out.push_back({key_of(i),
                     "is not used: with a prescribed motion there are no "
                     "materials",
                     {}});
    return;
  }
  check_names(scene, out);
  for (std::size_t i = 0; i < scene.region.size(); ++i)
  {
    check_shape(key_of(i), scene.region[i], outline, read_region, out);
    if (i > 0 and scene.region[i].shape == "everywhere")
      out.push_back({key_of(i),
                     "covers all regions that are written before it; write "
                     "it first",
                     {}});
  }
  for (const auto& [name, boundary] : scene.boundary)
    if (not boundary.inflow.empty()
        and (scene.material.size() < 2
             or not scene.material.contains(boundary.inflow)))
      out.push_back({"boundary." + name + ".inflow",
                     "no such material beside others",
                     {}});
  if (scene.material.size() > 1)
    check_several(scene, out);
}
} // namespace mmale::scene
