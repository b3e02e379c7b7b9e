// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include "scene/schema.h"
#include <algorithm>
#include <cmath>
#include <format>

namespace mmale::scene
{
namespace
{
template <class T>
std::vector<std::string> names_of(const std::map<std::string, T>& tables)
{
  std::vector<std::string> list;
  for (const auto& [name, table] : tables)
    list.push_back(name);
  return list;
}

/// May a line end here? On a curved boundary the ends of lines, as they are
/// meant, lie a little outside of the cells.
bool may_reach(const Scene& scene, const Outline& outline, const Point& x)
{
  if (scene.mesh.shape != "gmsh")
    return outline.may_hold(x);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double slack = 1e-9 * (outline.high[d] - outline.low[d]);
    if (not(x[d] >= outline.low[d] - slack and x[d] <= outline.high[d] + slack))
      return false;
  }
  return true;
}

/// A curve of a tracer: it names one and nothing else.
void check_tracer_curve(const Scene& scene, const Curve& c,
                        const std::string& key, Complaints& out)
{
  const auto known = names_of(scene.tracer);
  if (c.tracer.empty())
    out.push_back({key + ".tracer",
                   missing("Tracer of " + c.quantity, "",
                           known.empty() ? "but none is defined"
                                         : "one of " + join(known)),
                   {}});
  else if (not scene.tracer.contains(c.tracer))
    out.push_back(
        {key + ".tracer",
         "no tracer '" + c.tracer + "', " + suggestion(c.tracer, known),
         {}});
  if (not c.boundary.empty())
    out.push_back({key + ".boundary", "is not used by " + c.quantity, {}});
  if (c.point)
    out.push_back({key + ".point", "is not used by " + c.quantity, {}});
}

/// A curve of the water, or of the stress without it.
void check_water_curve(const Scene& scene, const Curve& c,
                       const std::string& key, Complaints& out)
{
  const bool discharge = c.quantity == "discharge";
  if (discharge and c.point)
    out.push_back({key + ".point",
                   "a discharge belongs to a boundary, not to a point",
                   {}});
  if (discharge and not(scene.water and scene.water->seepage()))
    out.push_back({key + ".quantity",
                   "discharge needs a table water with drainage = \"seepage\"",
                   {}});
  if (scene.water)
    return;
  if (c.quantity == "pore_pressure"
      or c.quantity.starts_with("effective_stress"))
    out.push_back({key + ".quantity", c.quantity + " needs a table water", {}});
}

/// A curve of the body: it names a boundary or a point.
void check_body_curve(const Scene& scene, const Outline* outline,
                      const Curve& c, const std::string& key, Complaints& out)
{
  const auto known = outline ? outline->names() : std::vector<std::string>();
  const bool place = c.quantity == "x_max" or c.quantity == "y_max";
  const bool reaction = c.quantity.starts_with("reaction")
                        or c.quantity == "discharge" or place
                        or c.quantity == "covered_length";
  if (scene.motion)
    out.push_back({key + ".quantity",
                   c.quantity + " is not known with a prescribed motion",
                   {}});
  if (not c.tracer.empty())
    out.push_back({key + ".tracer", "is not used by " + c.quantity, {}});
  if (reaction and c.point and c.quantity != "discharge")
    out.push_back({key + ".point",
                   std::format("a {} belongs to a boundary, not to a point",
                               place ? "largest place"
                               : c.quantity == "covered_length" ? "length"
                                                                : "reaction"),
                   {}});
  else if (c.point and not c.boundary.empty())
    out.push_back({key + ".point", "give boundary or point, not both", {}});
  check_water_curve(scene, c, key, out);
  if (c.quantity == "covered_length"
      and not scene.material.contains(c.material))
    out.push_back({key + ".material",
                   c.material.empty()
                       ? missing("Material of covered_length", "",
                                 "one of " + join(names_of(scene.material)))
                       : "no material '" + c.material + "', "
                             + suggestion(c.material, names_of(scene.material)),
                   {}});
  if (c.quantity != "covered_length" and not c.material.empty())
    out.push_back({key + ".material", "is not used by " + c.quantity, {}});
  if (c.quantity.starts_with("stress")
      or c.quantity.starts_with("effective_stress"))
  {
    if (not c.boundary.empty())
      out.push_back({key + ".boundary",
                     "a stress belongs to a point, not to a boundary",
                     {}});
    else if (not c.point)
      out.push_back(
          {key + ".point", missing("Point of " + c.quantity, "m", ""), {}});
  }
  else if (c.boundary.empty() and (reaction or not c.point))
    out.push_back({key + ".boundary",
                   missing("Boundary of " + c.quantity, "",
                           outline ? "one of " + join(known) : "")
                       + (reaction ? "" : "; or a point"),
                   {}});
  if (not outline)
    return;
  const Outline::Part* part = outline->find(c.boundary);
  if (not c.boundary.empty() and not part)
    out.push_back(
        {key + ".boundary",
         "no boundary '" + c.boundary + "', " + suggestion(c.boundary, known),
         {}});
  if (not c.breadth.empty() and part and not part->straight)
    out.push_back({key + ".breadth", "needs a straight boundary", {}});
  if (c.point and not outline->may_hold(*c.point))
    out.push_back(
        {key + ".point", words(*c.point) + " lies outside the mesh", {}});
}

bool is_energy(const std::string& quantity)
{
  return quantity.ends_with("_energy") or quantity.ends_with("_work");
}

/// A curve of the body's energy: it belongs to no place, and needs inertia.
void check_energy_curve(const Scene& scene, const Curve& c,
                        const std::string& key, Complaints& out)
{
  if (std::ranges::none_of(scene.stage, [](const Stage& stage)
                           { return stage.dynamics.has_value(); }))
    out.push_back({key + ".quantity",
                   c.quantity + " is known in stages with dynamics only",
                   {}});
  for (const auto& [name, given] :
       {std::pair{".tracer", not c.tracer.empty()},
        std::pair{".boundary", not c.boundary.empty()},
        std::pair{".point", c.point.has_value()}})
    if (given)
      out.push_back({key + name, "is not used by " + c.quantity, {}});
}

void check_curves(const Scene& scene, const Outline* outline, Complaints& out)
{
  for (const auto& [name, c] : scene.output.curve)
  {
    const std::string key = "output.curve." + name;
    if (name == "time" or name == "step")
      out.push_back({key, "is a column of its own; take another name", {}});
    if (c.divide_by == 0)
      out.push_back({key + ".divide_by", "must not be 0", {}});
    if (not c.breadth.empty() and not c.quantity.starts_with("reaction"))
      out.push_back({key + ".breadth", "is for reactions only", {}});
    if (std::ranges::find(quantities, c.quantity) == quantities.end())
      continue;
    if (c.quantity.starts_with("tracer"))
      check_tracer_curve(scene, c, key, out);
    else if (is_energy(c.quantity))
      check_energy_curve(scene, c, key, out);
    else
      check_body_curve(scene, outline, c, key, out);
  }
}

/// The curves of charts are there, and no two pictures share a file.
void check_charts(const Scene& scene, Complaints& out)
{
  auto columns = names_of(scene.output.curve);
  columns.insert(columns.begin(), {"time", "step"});
  for (const auto& [name, chart] : scene.output.chart)
  {
    const std::string key = "output.chart." + name;
    const auto look_up = [&](const std::string& column, const char* part)
    {
      if (std::ranges::find(columns, column) == columns.end())
        out.push_back(
            {key + part,
             "no curve '" + column + "', " + suggestion(column, columns),
             {}});
    };
    look_up(chart.x, ".x");
    for (const std::string& y : chart.y)
      look_up(y, ".y");
    if (chart.y.empty())
      out.push_back(
          {key + ".y",
           missing("Curves that it shows", "", "some of " + join(columns)),
           {}});
    if (scene.output.picture.contains(name))
      out.push_back({key, "a picture has this name too", {}});
  }
  for (const char* name : {"curves", "diagnostics"})
    for (const std::string table : {"chart", "picture"})
      if (table == "chart" ? scene.output.chart.contains(name)
                           : scene.output.picture.contains(name))
        out.push_back({"output." + table + "." + name,
                       "is a picture of its own; take another name",
                       {}});
}

void check_pictures(const Scene& scene, const Libraries& libraries, double end,
                    Complaints& out)
{
  std::vector<std::string> fields = libraries.fields;
  for (const auto& [name, tracer] : scene.tracer)
    fields.push_back(name);
  if (not scene.domain.empty())
    fields.clear();
  for (const auto& [name, domain] : scene.domain)
    fields.insert(fields.end(), {name, name + "_centroid"});
  const bool known = not libraries.fields.empty() or not scene.domain.empty();
  for (const auto& [name, picture] : scene.output.picture)
  {
    const std::string key = "output.picture." + name;
    if (known and not picture.field.empty()
        and std::ranges::find(fields, picture.field) == fields.end())
      out.push_back({key + ".field",
                     "no field '" + picture.field + "', "
                         + suggestion(picture.field, fields),
                     {}});
    if (picture.field.empty() and not picture.mesh)
      out.push_back({key, "shows nothing: give a field or mesh = true", {}});
    if (picture.field.empty() and picture.surface)
      out.push_back({key + ".surface", "needs a field", {}});
    if (picture.surface and picture.arrows)
      out.push_back({key + ".surface", "leaves no room for arrows", {}});
    // The sum of durations carries round-off.
    if (picture.at < infinity and picture.at > end * (1 + 1e-12))
      out.push_back(
          {key + ".at",
           std::format("is {} s, the run ends at {} s", picture.at, end),
           {}});
  }
}
} // namespace

void check_tracers(const Scene& scene, const Outline* outline, Complaints& out)
{
  if (not outline)
    return;
  for (const auto& [name, t] : scene.tracer)
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (t.centre[d] + t.radius <= outline->low[d]
          or t.centre[d] - t.radius >= outline->high[d])
      {
        out.push_back({"tracer." + name,
                       std::format("the circle around {} of radius {} m lies "
                                   "outside the mesh",
                                   words(t.centre), t.radius),
                       {}});
        break;
      }
    }
}

void check_output(const Scene& scene, const Libraries& libraries,
                  const Outline* outline, Complaints& out)
{
  double end = 0;
  for (const Stage& stage : scene.stage)
    end += stage.duration;
  check_curves(scene, outline, out);
  check_charts(scene, out);
  check_pictures(scene, libraries, end, out);
  for (const auto& [name, line] : scene.output.line)
  {
    const std::string key = "output.line." + name;
    if (line.from == line.to)
      out.push_back({key + ".to", "is the start of the line too", {}});
    if (outline and not may_reach(scene, *outline, line.from))
      out.push_back(
          {key + ".from", words(line.from) + " lies outside the mesh", {}});
    if (outline and not may_reach(scene, *outline, line.to))
      out.push_back(
          {key + ".to", words(line.to) + " lies outside the mesh", {}});
  }
  if (scene.output.fields_every > end)
    out.push_back({"output.fields_every",
                   std::format("is {} s, the run lasts {} s",
                               scene.output.fields_every, end),
                   {}});
}
} // namespace mmale::scene
