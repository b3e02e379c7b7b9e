// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/reader.h"

#include "element/compare.h"
#include "element/schema.h"
#include "scene/check_parts.h"
#include "scene/checker.h"
#include "scene/lister.h"
#include "scene/take.h"
#include "scene/writer.h"
#include <cmath>
#include <filesystem>
#include <format>

namespace mmale::element
{
namespace
{
using Complaints = std::vector<scene::Complaint>;

/// A key of a path and whether it is given.
struct Given
{
  const char* key;
  bool given;
};

/// Exactly one of them must be there.
void one_of(std::initializer_list<Given> targets, const std::string& path,
            const std::string& what, Complaints& out)
{
  std::vector<std::string> all, found;
  for (const Given& target : targets)
  {
    all.emplace_back(target.key);
    if (target.given)
      found.emplace_back(target.key);
  }
  if (found.empty())
    out.push_back(
        {path, "missing: " + what + ", one of " + scene::join(all), {}});
  for (std::size_t i = 1; i < found.size(); ++i)
    out.push_back(
        {path + "." + found[i],
         "is given beside " + found[0] + "; give one of " + scene::join(all),
         {}});
}

void check_targets(const Path& p, const std::string& path, Complaints& out)
{
  const Given eps_a = {"eps_a", p.eps_a.has_value()};
  const Given sigma_a = {"sigma_a", p.sigma_a.has_value()};
  const Given gamma = {"gamma", p.gamma.has_value()};
  const Given tau = {"tau", p.tau.has_value()};
  if (p.kind == kinds[isotropic])
    one_of(
        {{"pressure", p.pressure.has_value()}, {"eps_v", p.eps_v.has_value()}},
        path, "the target", out);
  else if (p.kind == kinds[oedometric])
    one_of({eps_a, sigma_a}, path, "the target", out);
  else if (p.kind == kinds[triaxial])
    one_of({eps_a, sigma_a, {"q", p.q.has_value()}}, path, "the target", out);
  else if (p.kind == kinds[simple_shear])
    one_of({gamma, tau}, path, "the target", out);
  else if (p.kind == kinds[free_path])
  {
    one_of({eps_a, sigma_a}, path, "what is driven along yy", out);
    one_of({{"eps_r", p.eps_r.has_value()}, {"sigma_r", p.sigma_r.has_value()}},
           path, "what is driven along xx", out);
    one_of({{"eps_t", p.eps_t.has_value()}, {"sigma_t", p.sigma_t.has_value()}},
           path, "what is driven along zz", out);
    one_of({gamma, tau}, path, "what is driven in xy", out);
    if (p.drainage == drainages[1] and p.eps_a and p.eps_r and p.eps_t)
      out.push_back({path + ".drainage",
                     "undrained needs a stress among sigma_a, sigma_r, "
                     "sigma_t: three strains leave no volume to keep",
                     {}});
  }
}

void check_path(const Path& p, const std::string& path, Complaints& out)
{
  check_targets(p, path, out);
  if (not(p.cycles > 0))
    return;
  if (4 * p.cycles != std::round(4 * p.cycles))
    out.push_back({path + ".cycles",
                   std::format("must be a multiple of 0.25, is {}", p.cycles),
                   {}});
  if (p.steps % 4 != 0)
    out.push_back({path + ".steps",
                   std::format("a cycle needs a multiple of 4 steps, so that "
                               "one ends at each reversal, is {}",
                               p.steps),
                   {}});
}

void check_initial(const Initial& i, Complaints& out)
{
  if (i.pressure)
  {
    for (const Given& other :
         {Given{"sigma_a", i.sigma_a.has_value()}, {"k0", i.k0.has_value()}})
      if (other.given)
        out.push_back({std::string("initial.") + other.key,
                       "is given beside pressure; give pressure, or sigma_a "
                       "and k0",
                       {}});
  }
  else if (not i.sigma_a)
    out.push_back(
        {"initial", "missing: pressure [Pa], or sigma_a [Pa] and k0 [-]", {}});
  else if (not i.k0)
    out.push_back(
        {"initial", "missing: k0, radial over axial stress, >= 0", {}});
}

/// [material.sand] is taken like [material].
void unwrap_material(scene::Document& document)
{
  const auto at = document.root.entries.find("material");
  if (at == document.root.entries.end() or at->second.entries.empty())
    return;
  std::vector<std::string> names;
  for (const auto& [name, node] : at->second.entries)
    if (node.kind == scene::Node::Kind::table)
      names.push_back(name);
  if (names.size() < at->second.entries.size())
    return;
  if (names.size() > 1)
    document.complaints.push_back(
        {"material", "an element test has one, these are " + scene::join(names),
         at->second.place});
  at->second = scene::Node(at->second.entries.begin()->second);
}
} // namespace

std::vector<scene::Complaint> check(Test test,
                                    const scene::Libraries& libraries)
{
  Complaints out;
  scene::Checker checker("", out);
  keys(checker, test);
  scene::check_material(test.material, libraries, "material", out);
  check_initial(test.initial, out);
  if (test.path.empty())
    out.push_back({"path", "missing: at least one [[path]] with a kind", {}});
  for (std::size_t i = 0; i < test.path.size(); ++i)
    check_path(test.path[i], "path." + std::to_string(i), out);
  if (test.data and not test.data->file.empty())
    for (const std::string& what : read_data(*test.data).complaints)
      out.push_back({"data", what, {}});
  return out;
}

Reading read(std::string_view text, const std::string& file,
             std::span<const scene::Override> overrides,
             const scene::Libraries& libraries)
{
  Reading reading;
  reading.complaints = scene::take(
      scene::parse(text, file), overrides, reading.test,
      [&](Test& test)
      {
        test.material.folder = std::filesystem::path(file).parent_path();
        if (test.data)
          test.data->folder = test.material.folder;
        return check(test, libraries);
      },
      unwrap_material);
  return reading;
}

std::string describe(Test test)
{
  scene::Json json = scene::Json::object();
  scene::Writer writer(json);
  keys(writer, test);
  return json.dump(2);
}

std::vector<scene::KeyInfo> key_reference(const scene::Libraries& libraries)
{
  std::vector<scene::KeyInfo> reference;
  Test test;
  scene::Lister lister("", reference);
  keys(lister, test);
  scene::add_laws("material.", libraries, reference);
  return reference;
}

std::string label(const std::vector<Path>& paths, std::size_t i)
{
  const std::string& name = paths[i].name;
  return "path " + std::to_string(i)
         + (name.empty() ? " (" + paths[i].kind + ")" : " '" + name + "'");
}
} // namespace mmale::element
