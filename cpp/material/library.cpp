// SPDX-License-Identifier: LGPL-3.0-or-later
#include "library.h"

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
} // namespace

std::vector<scene::LawInfo> law_infos()
{
  std::vector<scene::LawInfo> infos;
  for_each_law(list,
               [&infos]<class L>(L)
               {
                 scene::LawInfo info{std::string(L::name), {}};
                 for (const Parameter<L>& p : L::parameters)
                   info.parameters.push_back(
                       {std::string(p.name), std::string(p.unit), p.range,
                        L{}.*p.value, std::string(p.meaning)});
                 infos.push_back(std::move(info));
               });
  return infos;
}

AnyLaw make_law(const std::string& name,
                const std::map<std::string, double>& parameters)
{
  std::optional<AnyLaw> made;
  for_each_law(list,
               [&]<class L>(L law)
               {
                 if (L::name != name)
                   return;
                 for (const auto& [key, value] : parameters)
                 {
                   bool known = false;
                   for (const Parameter<L>& p : L::parameters)
                     if (p.name == key)
                     {
                       law.*p.value = value;
                       known = true;
                     }
                   if (not known)
                     throw std::invalid_argument(
                         "law '" + name + "' has no parameter '" + key + "'");
                 }
                 made = law;
               });
  if (not made)
    throw std::invalid_argument("no law is called '" + name + "'");
  return *made;
}
} // namespace mmale::material
