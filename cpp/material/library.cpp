// SPDX-License-Identifier: LGPL-3.0-or-later
#include "library.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace mmale::material
{
namespace
{
/// Call `f(L{})` for every law of the list.
template <class... Laws>
void for_each_law(std::variant<Laws...>*, auto&& f)
{
  (f(Laws{}), ...);
}
constexpr AnyLaw* list = nullptr;

template <class L>
concept HasSets = requires { L::set_key; };
template <class L>
concept HasTexts = requires { L::texts; };
template <class L>
concept HasLists = requires { L::lists; };
/// A law with files beside the scene.
template <class L>
concept HasFiles = requires(L law) {
  law.folder;
  { law.open() } -> std::same_as<std::string>;
};

/// Give `law` the value that its table calls `key`.
/// @return false if there is no such key
bool assign(auto& law, const auto& table, std::string_view key,
            const auto& value)
{
  for (const auto& entry : table)
    if (entry.name == key)
    {
      law.*entry.value = value;
      return true;
    }
  return false;
}

[[noreturn]] void refuse(std::string_view law, const std::string& key)
{
  throw std::invalid_argument("law '" + std::string(law)
                              + "' has no parameter '" + key + "'");
}

template <class L>
void take_set(L& law, const std::string& name)
{
  const auto sets = L::sets();
  const auto set = std::ranges::find(sets, name, &ParameterSet::name);
  if (set == sets.end())
    throw std::invalid_argument("law '" + std::string(L::name) + "' has no "
                                + std::string(L::set_key) + " '" + name + "'");
  for (const auto& [key, value] : set->values)
    if (not assign(law, L::parameters, key, value))
      refuse(L::name, std::string(key));
}

template <class L>
L filled(const scene::Material& material)
{
  L law;
  if constexpr (HasFiles<L>)
    law.folder = material.folder;
  for (const auto& [key, text] : material.texts)
  {
    bool known = false;
    if constexpr (HasSets<L>)
      if (key == L::set_key)
      {
        take_set(law, text);
        known = true;
      }
    if constexpr (HasTexts<L>)
      known = known or assign(law, L::texts, key, text);
    if (not known)
      refuse(L::name, key);
  }
  for (const auto& [key, numbers] : material.lists)
  {
    bool known = false;
    if constexpr (HasLists<L>)
      known = assign(law, L::lists, key, numbers);
    if (not known)
      refuse(L::name, key);
  }
  for (const auto& [key, value] : material.parameters)
    if (not assign(law, L::parameters, key, value))
      refuse(L::name, key);
  return law;
}

template <class L>
scene::LawInfo info_of()
{
  scene::LawInfo info{.name = std::string(L::name)};
  info.complaints = [](const scene::Material& material)
  { return filled<L>(material).complaints(); };
  for (const Parameter<L>& p : L::parameters)
    info.parameters.push_back({std::string(p.name), std::string(p.unit),
                               p.range, L{}.*p.value, std::string(p.meaning)});
  info.void_ratio = void_ratio_index(L{}) >= 0;
  if constexpr (HasTexts<L>)
    for (const TextParameter<L>& t : L::texts)
      info.texts.push_back(
          {std::string(t.name), t.needed, std::string(t.meaning)});
  if constexpr (HasLists<L>)
    for (const ListParameter<L>& l : L::lists)
      info.lists.push_back({std::string(l.name), std::string(l.meaning)});
  if constexpr (HasSets<L>)
  {
    info.set_key = L::set_key;
    for (const ParameterSet& set : L::sets())
    {
      std::map<std::string, double> values;
      for (const auto& [name, value] : set.values)
        values.emplace(name, value);
      info.sets.push_back(
          {std::string(set.name), std::string(set.source), std::move(values)});
    }
  }
  return info;
}
} // namespace

std::vector<scene::LawInfo> law_infos()
{
  std::vector<scene::LawInfo> infos;
  for_each_law(list, [&infos]<class L>(L) { infos.push_back(info_of<L>()); });
  return infos;
}

AnyLaw make_law(const scene::Material& material)
{
  std::optional<AnyLaw> made;
  for_each_law(list,
               [&]<class L>(L)
               {
                 if (L::name != material.law)
                   return;
                 L law = filled<L>(material);
                 if constexpr (HasFiles<L>)
                   if (const std::string trouble = law.open();
                       not trouble.empty())
                     throw std::invalid_argument(trouble);
                 made = std::move(law);
               });
  if (not made)
    throw std::invalid_argument("no law is called '" + material.law + "'");
  return *made;
}

std::vector<std::string> history_names(const AnyLaw& law, bool water)
{
  std::vector<std::string> names;
  for (const HistoryField& field :
       std::visit([](const auto& l) { return l.history(); }, law))
    if (field.size == 1)
      names.push_back(field.name);
    else
      for (const char* component : {"_xx", "_yy", "_zz", "_xy"})
        names.push_back(field.name + component);
  if (water)
    names.insert(names.end(), {"pore_pressure", "porosity"});
  return names;
}

int num_history(const AnyLaw& law, bool water)
{
  return static_cast<int>(history_names(law, water).size());
}

int void_ratio_index(const AnyLaw& law)
{
  const auto names = history_names(law);
  const auto at = std::ranges::find(names, "void_ratio");
  return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

double porosity(const AnyLaw& law, std::span<const double> q, double given)
{
  const int at = void_ratio_index(law);
  return at < 0 ? given : q[at] / (1 + q[at]);
}
} // namespace mmale::material
