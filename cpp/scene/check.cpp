// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check.h"
#include "scene/check_parts.h"
#include "scene/checker.h"
#include <algorithm>
#include <cctype>
#include <format>

namespace mmale::scene
{
bool Range::holds(double x) const
{
  return (minimum_excluded ? x > minimum : x >= minimum)
         and (maximum_excluded ? x < maximum : x <= maximum);
}

std::string Range::words() const
{
  const bool low = minimum > -infinity;
  const bool high = maximum < infinity;
  if (low and high)
    return std::format("{} {} x {} {}", minimum, minimum_excluded ? "<" : "<=",
                       maximum_excluded ? "<" : "<=", maximum);
  if (low)
    return std::format("{} {}", minimum_excluded ? ">" : ">=", minimum);
  if (high)
    return std::format("{} {}", maximum_excluded ? "<" : "<=", maximum);
  return "";
}

bool is_name(const std::string& name)
{
  const auto letter = [](unsigned char c)
  { return c == '_' or (c < 128 and std::isalpha(c)); };
  return not name.empty() and letter(static_cast<unsigned char>(name[0]))
         and std::ranges::all_of(name,
                                 [&](unsigned char c)
                                 {
                                   return letter(c) or c == '-'
                                          or (c < 128 and std::isdigit(c));
                                 });
}

std::string stage_label(const std::vector<Stage>& stages, std::size_t i)
{
  const std::string& name = stages[i].name;
  const bool own = std::ranges::count(stages, name, &Stage::name) == 1;
  return name.empty() or not own ? std::to_string(i) : name;
}

std::vector<Complaint> check(Scene scene, const Libraries& libraries,
                             const OutlineReader& read_mesh,
                             const DomainReader& read_domain,
                             const RegionReader& read_region)
{
  Complaints out;
  Checker checker("", out);
  keys(checker, scene);
  check_mesh(scene, out);
  check_boundaries(scene, out);
  const auto outline = outline_of(scene, read_mesh, out);
  const Outline* known = outline ? &*outline : nullptr;
  check_materials(scene, libraries, out);
  check_regions(scene, known, read_region, out);
  check_stages(scene, known, out);
  check_water(scene, libraries, out);
  check_solver(scene, out);
  check_remap(scene, libraries, known, out);
  check_tracers(scene, known, out);
  check_domains(scene, known, read_domain, out);
  check_output(scene, libraries, known, out);
  return out;
}
} // namespace mmale::scene
