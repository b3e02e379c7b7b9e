// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include <algorithm>
#include <cmath>
#include <format>

namespace mmale::scene
{
namespace
{
/// What is prescribed along one direction of a boundary.
struct Direction
{
  const char* name;
  bool displacement, velocity, traction;
  bool moved() const { return displacement or velocity; }
};

/// One condition: at most one thing may hold along a direction.
///
/// @param part  the boundary; null where nothing is known of it
void check_condition(const Outline::Part* part, const Condition& c,
                     const std::string& key, Complaints& out)
{
  const std::array<Direction, 2> directions = {
      {{"x", c.displacement_x.has_value(), c.velocity_x.has_value(),
        c.traction_x.has_value()},
       {"y", c.displacement_y.has_value(), c.velocity_y.has_value(),
        c.traction_y.has_value()}}};
  // Directions that a roller blocks; a slanted boundary would block a mixture.
  std::array<bool, 2> blocked = {false, false};
  if (part)
    blocked = {part->extends[1], part->extends[0]};
  if (c.roller and blocked[0] and blocked[1])
    out.push_back({key + ".roller",
                   "the boundary is slanted or curved; a roller needs one that "
                   "is straight along x or y",
                   {}});
  bool pressed_in_vain = c.fixed or c.roller;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const Direction& along = directions[d];
    const std::string displacement = key + ".displacement_" + along.name;
    const std::string velocity = key + ".velocity_" + along.name;
    const std::string traction = key + ".traction_" + along.name;
    const std::string& moving = along.displacement ? displacement : velocity;
    const char* held = c.fixed                   ? "fixed"
                       : c.roller and blocked[d] ? "a roller"
                                                 : nullptr;
    if (along.displacement and along.velocity)
      out.push_back({velocity,
                     std::format("displacement_{} is given too; a direction "
                                 "has one of the two",
                                 along.name),
                     {}});
    if (held and along.moved())
      out.push_back({moving, std::format("the boundary is {} too", held), {}});
    if (along.traction and (held or along.moved()))
      out.push_back({traction,
                     std::format("has no effect: the boundary is {}",
                                 held ? held : "moved in this direction"),
                     {}});
    pressed_in_vain = pressed_in_vain or (blocked[d] and along.moved());
  }
  for (const Direction& along : directions)
    if (c.absorbing and (c.fixed or c.roller or along.moved()))
    {
      out.push_back({key + ".absorbing",
                     "has no effect: the boundary is held or moved",
                     {}});
      break;
    }
  if (c.fixed and c.roller)
    out.push_back({key + ".roller", "the boundary is fixed too", {}});
  if (c.pressure and pressed_in_vain)
    out.push_back({key + ".pressure",
                   "has no effect: the boundary is held or moved along its "
                   "normal",
                   {}});
}

/// A wall has one place, and moves along itself alone.
void check_wall(const Wall& wall, const std::string& key, Complaints& out)
{
  if (not wall.x and not wall.y)
    out.push_back({key,
                   "needs x, where an upright wall stands, or y, where a level "
                   "one lies [m]",
                   {}});
  else if (wall.x and wall.y)
    out.push_back(
        {key + ".y", "x is given too; a wall has one of the two", {}});
  const auto moved = [&](bool across, bool along, const char* name)
  {
    if (across)
      out.push_back({key + name,
                     "would move the wall off its place; it may go along "
                     "itself",
                     {}});
    else if (along and wall.grip == "smooth")
      out.push_back({key + name, "has no effect: the wall is smooth", {}});
  };
  const bool level = not wall.x;
  moved(wall.velocity_x and not level, wall.velocity_x and level,
        ".velocity_x");
  moved(wall.velocity_y and level, wall.velocity_y and not level,
        ".velocity_y");
}

void check_steps(const Stage& stage, const std::string& key, Complaints& out)
{
  const auto ordered =
      [&](const char* name, double x, const char* limit_name, double limit)
  {
    if (x > 0 and limit > 0 and x > limit)
      out.push_back(
          {key + "." + name,
           std::format("must be <= {} of {} s, is {}", limit_name, limit, x),
           {}});
  };
  ordered("step", stage.step, "duration", stage.duration);
  ordered("step_min", stage.step_min, "step", stage.step);
  ordered("step", stage.step, "step_max", stage.step_max);
  ordered("step_max", stage.step_max, "duration", stage.duration);
}

/// Inertia: what belongs together, and what needs it.
void check_dynamics(const Scene& scene, std::size_t index,
                    const std::string& key, Complaints& out)
{
  const Stage& stage = scene.stage[index];
  for (const auto& [name, condition] : stage.boundary)
    if (condition.absorbing and not stage.dynamics)
      out.push_back({key + ".boundary." + name + ".absorbing",
                     "needs a table " + key
                         + ".dynamics: in statics there are "
                           "no waves",
                     {}});
  if (index == 0 and not stage.dynamics
      and (scene.initial.velocity[0] != 0 or scene.initial.velocity[1] != 0))
    out.push_back({"initial.velocity",
                   "has no effect: the first stage has no table dynamics",
                   {}});
  if (not stage.dynamics)
    return;
  const Dynamics& d = *stage.dynamics;
  const Dynamics standard;
  for (const auto& [name, given] :
       {std::pair{".beta", d.beta != standard.beta},
        std::pair{".gamma", d.gamma != standard.gamma}})
    if (d.alpha < 0 and given)
      out.push_back({key + ".dynamics" + name,
                     "follows from alpha, which is given too",
                     {}});
  for (const auto& [name, material] : scene.material)
    if (const auto at = material.parameters.find("density");
        at != material.parameters.end() and at->second == 0)
      out.push_back({"material." + name + ".density",
                     std::format("must be > 0 kg/m3, is 0: stage '{}' has "
                                 "inertia",
                                 stage.name),
                     {}});
}

void check_motion(const Scene& scene, Complaints& out)
{
  if (scene.motion->revolutions == 0)
    out.push_back({"motion.revolutions", "must not be 0", {}});
  if (scene.symmetry == Symmetry::axisymmetric)
    out.push_back({"symmetry",
                   "must be plane_strain: a rotation in the plane would leave "
                   "the axis",
                   {}});
  if (scene.stage.size() > 1)
    out.push_back({"motion", "turns over one stage; give exactly one", {}});
  for (const auto& [name, material] : scene.material)
    out.push_back({"material." + name,
                   "is not used: with a prescribed motion nothing is "
                   "strained",
                   {}});
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
  {
    const std::string key = "stage." + stage_label(scene.stage, i);
    if (not scene.stage[i].boundary.empty())
      out.push_back(
          {key + ".boundary", "is not used: the motion is prescribed", {}});
    if (scene.stage[i].gravity)
      out.push_back(
          {key + ".gravity", "is not used: the motion is prescribed", {}});
    if (scene.stage[i].dynamics)
      out.push_back(
          {key + ".dynamics", "is not used: the motion is prescribed", {}});
  }
}

/// Is this number, text or list of a material there under this name?
template <class Table>
bool given(const Table& table, const std::string& name)
{
  return table.contains(name);
}

/// The known material that a scene names, or none.
const SetInfo* check_set(const Material& material, const LawInfo& law,
                         const std::string& key, Complaints& out)
{
  const auto text = material.texts.find(law.set_key);
  if (law.set_key.empty() or text == material.texts.end())
    return nullptr;
  const auto set = std::ranges::find(law.sets, text->second, &SetInfo::name);
  if (set != law.sets.end())
    return &*set;
  std::vector<std::string> names;
  for (const SetInfo& s : law.sets)
    names.push_back(s.name);
  out.push_back(
      {key + "." + law.set_key,
       "unknown '" + text->second + "', " + suggestion(text->second, names),
       {}});
  return nullptr;
}

/// The keys that a law takes, by the kind of their values.
struct LawKeys
{
  std::vector<std::string> numbers, texts, lists;

  explicit LawKeys(const LawInfo& law)
  {
    for (const ParameterInfo& p : law.parameters)
      numbers.push_back(p.name);
    if (not law.set_key.empty())
      texts.push_back(law.set_key);
    for (const TextInfo& t : law.texts)
      texts.push_back(t.name);
    for (const ListInfo& l : law.lists)
      lists.push_back(l.name);
  }

  std::vector<std::string> all() const
  {
    std::vector<std::string> known = numbers;
    known.insert(known.end(), texts.begin(), texts.end());
    known.insert(known.end(), lists.begin(), lists.end());
    known.push_back("law");
    return known;
  }
};

/// What is wrong with a key of a law whose value is `is`; nothing if it is
/// among the wanted ones.
void check_kind(const std::string& name, const std::vector<std::string>& wanted,
                const std::string& is, const LawInfo& law,
                const std::string& key, Complaints& out)
{
  const LawKeys keys(law);
  const auto in = [&name](const std::vector<std::string>& list)
  { return std::ranges::find(list, name) != list.end(); };
  if (in(wanted))
    return;
  const char* kind = in(keys.numbers) ? "a number"
                     : in(keys.texts) ? "a text"
                     : in(keys.lists) ? "a list of numbers"
                                      : nullptr;
  out.push_back({key + "." + name,
                 kind ? std::format("must be {}, is {}", kind, is)
                      : "unknown for law '" + law.name + "', "
                            + suggestion(name, keys.all()),
                 {}});
}

/// Does the known material that is named bring this number? One whose name
/// is not known has its complaint already.
bool by_set(const Material& material, const LawInfo& law, const SetInfo* set,
            const std::string& name)
{
  if (set)
    return given(set->values, name);
  return not law.set_key.empty() and given(material.texts, law.set_key)
         and std::ranges::any_of(law.sets, [&name](const SetInfo& s)
                                 { return given(s.values, name); });
}

void check_numbers(const Material& material, const LawInfo& law,
                   const SetInfo* set, const std::string& key, Complaints& out)
{
  for (const ParameterInfo& p : law.parameters)
  {
    const std::string unit = p.unit.empty() or p.unit == "-" ? "" : p.unit;
    const auto written = material.parameters.find(p.name);
    if (written == material.parameters.end() or std::isnan(written->second))
    {
      const bool wrong_kind =
          given(material.texts, p.name) or given(material.lists, p.name);
      if (p.is_required() and not wrong_kind
          and not by_set(material, law, set, p.name))
        out.push_back({key + "." + p.name,
                       missing(p.sentence, p.unit, p.range.words()) + " (law "
                           + law.name + ")",
                       {}});
    }
    else if (not p.range.holds(written->second))
      out.push_back(
          {key + "." + p.name,
           std::format("must be {}{}, is {}",
                       p.range.words().empty() ? "finite" : p.range.words(),
                       unit.empty() ? "" : " " + unit, written->second),
           {}});
  }
}

void check_parameters(const Material& material, const LawInfo& law,
                      const std::string& key, Complaints& out)
{
  const std::size_t before = out.size();
  const SetInfo* set = check_set(material, law, key, out);
  check_numbers(material, law, set, key, out);
  for (const TextInfo& t : law.texts)
    if (t.needed and not given(material.texts, t.name))
      out.push_back({key + "." + t.name,
                     missing(t.sentence, "", "") + " (law " + law.name + ")",
                     {}});
  const LawKeys keys(law);
  for (const auto& [name, x] : material.parameters)
    check_kind(name, keys.numbers, std::format("{}", x), law, key, out);
  for (const auto& [name, text] : material.texts)
    check_kind(name, keys.texts, "the text \"" + text + "\"", law, key, out);
  for (const auto& [name, list] : material.lists)
    check_kind(name, keys.lists, "a list", law, key, out);
  if (out.size() == before and law.complaints)
    for (const std::string& complaint : law.complaints(material))
      out.push_back({key, complaint, {}});
}
} // namespace

void check_material(const Material& material, const Libraries& libraries,
                    const std::string& key, Complaints& out)
{
  const auto law =
      std::ranges::find(libraries.laws, material.law, &LawInfo::name);
  if (law != libraries.laws.end())
    return check_parameters(material, *law, key, out);
  std::vector<std::string> laws;
  for (const LawInfo& info : libraries.laws)
    laws.push_back(info.name);
  out.push_back({key + ".law",
                 material.law.empty() ? missing("Name of the material law", "",
                                                "one of " + join(laws))
                                      : "unknown '" + material.law + "', "
                                            + suggestion(material.law, laws),
                 {}});
}

void check_materials(const Scene& scene, const Libraries& libraries,
                     Complaints& out)
{
  if (scene.material.empty() and not scene.motion and scene.domain.empty())
    out.push_back({"material",
                   "missing: a table [material.NAME] with law and its numbers",
                   {}});
  if (scene.material.size() == 1
      and scene.material.begin()->second.law == "void")
    out.push_back({"material." + scene.material.begin()->first,
                   "is void: give another material beside it",
                   {}});
  for (const auto& [name, material] : scene.material)
    check_material(material, libraries, "material." + name, out);
}

namespace
{
void check_initial(const Scene& scene, Complaints& out)
{
  const Initial& initial = scene.initial;
  if (initial.pressure and initial.K0)
    out.push_back({"initial.pressure", "is for a body without K0", {}});
  for (std::size_t i = 1; i < initial.void_ratio.size(); ++i)
    if (not(initial.void_ratio[i].depth > initial.void_ratio[i - 1].depth))
      out.push_back({std::format("initial.void_ratio.{}.depth", i),
                     "depths must ascend",
                     {}});
  if (not initial.K0)
  {
    if (initial.surface and initial.void_ratio.empty())
      out.push_back({"initial.surface", "needs K0 or void_ratio", {}});
    if (initial.surcharge > 0)
      out.push_back({"initial.surcharge", "needs K0", {}});
    if (initial.water_table)
      out.push_back({"initial.water_table", "needs K0", {}});
    return;
  }
  if (initial.water_table and not scene.water)
    out.push_back({"initial.water_table", "needs a table [water]", {}});
  const auto& gravity =
      scene.stage.empty() ? std::nullopt : scene.stage.front().gravity;
  if (not gravity or (*gravity)[0](0) != 0 or not((*gravity)[1](0) < 0))
    out.push_back({"initial.K0",
                   "needs gravity = [0, -9.81] or the like in the first stage",
                   {}});
}
} // namespace

void check_stages(const Scene& scene, const Outline* outline, Complaints& out)
{
  if (not scene.motion)
    check_initial(scene, out);
  if (scene.stage.empty() and scene.domain.empty())
    out.push_back({"stage",
                   "missing: at least one [[stage]] with name, duration and "
                   "step",
                   {}});
  if (scene.motion)
    check_motion(scene, out);
  const auto known = outline ? outline->names() : std::vector<std::string>();
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
  {
    const Stage& stage = scene.stage[i];
    const std::string key = "stage." + stage_label(scene.stage, i);
    for (std::size_t j = 0; j < i; ++j)
      if (not stage.name.empty() and stage.name == scene.stage[j].name)
      {
        out.push_back(
            {key + ".name",
             std::format("'{}' is the name of stage {} too", stage.name, j),
             {}});
        break;
      }
    check_steps(stage, key, out);
    if (not scene.motion)
      check_dynamics(scene, i, key, out);
    for (const auto& [name, condition] : stage.boundary)
    {
      const std::string where = key + ".boundary." + name;
      const Outline::Part* part = outline ? outline->find(name) : nullptr;
      if (outline and not part)
        out.push_back(
            {where, "no such boundary, " + suggestion(name, known), {}});
      else
      {
        check_condition(part, condition, where, out);
        if (condition.wall)
          check_wall(*condition.wall, where + ".wall", out);
      }
    }
  }
}

void check_solver(const Scene& scene, Complaints& out)
{
  const Solver& solver = scene.solver;
  if (solver.points != 3 and solver.points != 6)
    out.push_back({"solver.points",
                   std::format("must be 3 or 6, is {}", solver.points),
                   {}});
  if (solver.layout == Layout::quadrature and solver.element != Element::mini)
    out.push_back(
        {"solver.element", "must be mini: layout quadrature has no other", {}});
}

void check_remap(const Scene& scene, const Libraries& libraries,
                 const Outline* outline, Complaints& out)
{
  const Remap& remap = scene.remap;
  if (remap.mode != RemapMode::lagrangian and remap.every == 0
      and remap.quality_below == 0)
    out.push_back({"remap",
                   "never happens: give every > 0 or quality_below > 0, or "
                   "mode = \"lagrangian\"",
                   {}});
  if (not remap.open.empty() and not scene.motion)
    out.push_back({"remap.open",
                   "only tracers of a prescribed motion flow through open "
                   "boundaries; material that flows in is not there yet",
                   {}});
  const auto one_of = [&](const char* key, const std::string& name,
                          const std::vector<std::string>& list,
                          const char* what)
  {
    if (std::ranges::find(list, name) == list.end())
      out.push_back({key,
                     std::string("no ") + what + " '" + name + "', "
                         + suggestion(name, list),
                     {}});
  };
  if (remap.mode == RemapMode::ale)
    one_of("remap.smoother", remap.smoother, libraries.smoothers, "smoother");
  if (remap.mode != RemapMode::lagrangian)
    one_of("remap.transport", remap.transport, libraries.transports,
           "transport scheme");
  if (scene.material.size() > 1)
    one_of("solver.closure", scene.solver.closure, libraries.closures,
           "closure");
  if (scene.material.size() > 1)
    one_of("remap.interfaces", remap.interfaces, libraries.interfaces,
           "reconstruction of interfaces");
  const auto known = outline ? outline->names() : std::vector<std::string>();
  for (const std::string& name : remap.surface)
  {
    if (outline)
      one_of("remap.surface", name, known, "boundary");
    if (std::ranges::find(remap.open, name) != remap.open.end())
      out.push_back({"remap.open", "'" + name + "' is in surface too", {}});
  }
  for (const std::string& name : remap.open)
    if (outline)
      one_of("remap.open", name, known, "boundary");
}
} // namespace mmale::scene
