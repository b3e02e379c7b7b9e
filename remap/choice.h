// SPDX-License-Identifier: LGPL-3.0-or-later
//
// One member of a list of types, chosen by its name as written in scenes.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

namespace remap
{
template <class T>
concept Named = requires {
  { T::name } -> std::convertible_to<std::string_view>;
};

namespace detail
{
template <class List>
struct choice_of;

template <class... T>
struct choice_of<std::tuple<T...>>
{
  using type = std::variant<T...>;
};
} // namespace detail

/// A variant over a list; visited once per batch, so loops see a fixed type.
template <class List>
using Choice = typename detail::choice_of<List>::type;

/// The member of a list with this name, if there is one.
template <class List>
std::optional<Choice<List>> find(std::string_view name)
{
  std::optional<Choice<List>> out;
  const auto look = [&]<class... T>(std::tuple<T...>*)
  { ((T::name == name ? (out = T{}, true) : false) or ...); };
  look(static_cast<List*>(nullptr));
  return out;
}

/// All names of a list, for complaints and help texts.
template <class List>
std::vector<std::string> names()
{
  return []<class... T>(std::tuple<T...>*)
  {
    return std::vector<std::string>{std::string(T::name)...};
  }(static_cast<List*>(nullptr));
}

/// Name of the chosen member.
template <class... T>
std::string_view name_of(const std::variant<T...>& choice)
{
  return std::visit([](const auto& c) -> std::string_view { return c.name; },
                    choice);
}
} // namespace remap
