// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/complaint.h"
#include "scene/describe.h"
#include "scene/lister.h"
#include <algorithm>

namespace mmale::scene
{
namespace
{
/// With a full stop.
std::string closed(const std::string& sentence)
{
  return sentence.ends_with(".") ? sentence : sentence + ".";
}

/// What a law takes, as keys of a material.
void add_law(const std::string& path, const LawInfo& law,
             std::vector<KeyInfo>& reference)
{
  const std::string of = " Law " + law.name + ".";
  if (not law.set_key.empty())
  {
    std::string sentence = "Known material whose numbers are taken:";
    std::vector<std::string> names;
    for (const SetInfo& set : law.sets)
    {
      sentence += " " + set.name + " (" + set.source + ");";
      names.push_back(set.name);
    }
    sentence.back() = '.';
    reference.push_back(
        {path + law.set_key, "text", "", join(names), "", sentence + of});
  }
  for (const TextInfo& t : law.texts)
    reference.push_back({path + t.name, "text", "", "",
                         t.needed ? "required" : "", closed(t.sentence) + of});
  for (const ParameterInfo& p : law.parameters)
    reference.push_back({path + p.name, "number", p.unit, p.range.words(),
                         standard_of(p.standard), closed(p.sentence) + of});
  for (const ListInfo& l : law.lists)
    reference.push_back(
        {path + l.name, "list of numbers", "", "", "", closed(l.sentence) + of});
}

void allow(std::vector<KeyInfo>& reference, const std::string& key,
           const std::vector<std::string>& list)
{
  std::ranges::find(reference, key, &KeyInfo::key)->allowed = join(list);
}
} // namespace

void add_laws(const std::string& path, const Libraries& libraries,
              std::vector<KeyInfo>& reference)
{
  std::vector<std::string> laws;
  for (const LawInfo& law : libraries.laws)
    laws.push_back(law.name);
  allow(reference, path + "law", laws);
  std::ranges::find(reference, path + "law", &KeyInfo::key)->standard =
      "required";
  for (const LawInfo& law : libraries.laws)
    add_law(path, law, reference);
}

std::vector<KeyInfo> key_reference(const Libraries& libraries)
{
  std::vector<KeyInfo> reference;
  Scene scene;
  Lister lister("", reference);
  keys(lister, scene);
  allow(reference, "remap.smoother", libraries.smoothers);
  allow(reference, "remap.transport", libraries.transports);
  allow(reference, "output.picture.NAME.field", libraries.fields);
  add_laws("material.NAME.", libraries, reference);
  return reference;
}

std::string to_string(const std::vector<KeyInfo>& reference)
{
  std::string text;
  for (const KeyInfo& info : reference)
  {
    std::string facts = info.kind;
    if (not info.unit.empty() and info.unit != "-")
      facts += " [" + info.unit + "]";
    if (not info.allowed.empty())
      facts += ", " + info.allowed;
    if (info.standard == "required")
      facts += ", required";
    else if (not info.standard.empty())
      facts += ", default " + info.standard;
    text += info.key + ": " + facts + "\n    " + info.sentence + "\n";
  }
  return text;
}
} // namespace mmale::scene
