// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/schema.h"
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

/// Visitor of `keys` that writes a table as JSON, as it was understood.
namespace mmale::scene
{
using Json = nlohmann::ordered_json;

inline Json json_of(const TimeSeries& series)
{
  if (series.amplitude != 0)
    return Json{{"mean", series.value.front()},
                {"amplitude", series.amplitude},
                {"frequency", series.frequency},
                {"phase_deg", series.phase_deg}};
  if (series.time.empty())
    return series.value.front();
  return Json{{"time", series.time}, {"value", series.value}};
}

/// Writes one table as JSON; a visitor of `keys`.
class Writer
{
public:
  explicit Writer(Json& json) : _json(json) {}

  void operator()(const Key& key, double& x)
  {
    if (std::isfinite(x))
      _json[key.name] = x;
  }

  void operator()(const Key& key, std::optional<double>& x)
  {
    if (x)
      _json[key.name] = *x;
  }

  void operator()(const Key& key, std::string& text)
  {
    if (not text.empty())
      _json[key.name] = text;
  }

  template <class T>
    requires OneOf<T, int, bool, Point, std::array<Point, 4>,
                   std::array<int, 2>, std::vector<std::string>,
                   std::vector<Point>>
  void operator()(const Key& key, T& value)
  {
    // A pair of zeros stands for "by size".
    if constexpr (std::same_as<T, std::array<int, 2>>)
      if (value == std::array{0, 0})
        return;
    _json[key.name] = value;
  }

  template <Enumeration E>
  void operator()(const Key& key, E& choice)
  {
    _json[key.name] = names<E>()[static_cast<std::size_t>(choice)];
  }

  void operator()(const Key& key, std::optional<Point>& x)
  {
    if (x)
      _json[key.name] = *x;
  }

  void operator()(const Key& key, std::optional<TimeSeries>& series)
  {
    if (series)
      _json[key.name] = json_of(*series);
  }

  void operator()(const Key& key,
                  std::optional<std::array<TimeSeries, 2>>& pair)
  {
    if (pair)
      _json[key.name] = {json_of((*pair)[0]), json_of((*pair)[1])};
  }

  template <Table T>
  void operator()(const Key& key, T& table)
  {
    fill(_json[key.name], table);
  }

  template <Table T>
  void operator()(const Key& key, std::optional<T>& table)
  {
    if (table)
      fill(_json[key.name], *table);
  }

  template <Table T>
  void operator()(const Key& key, std::map<std::string, T>& tables)
  {
    for (auto& [name, table] : tables)
      fill(_json[key.name][name], table);
  }

  void operator()(const Key& key, std::vector<Stage>& stages)
  {
    for (Stage& stage : stages)
      fill(_json[key.name].emplace_back(Json::object()), stage);
  }

  template <Table T>
  void operator()(const Key& key, std::vector<T>& tables)
  {
    if (tables.empty())
      return;
    for (T& table : tables)
      fill(_json[key.name].emplace_back(Json::object()), table);
  }

  void rest(const std::string&, Material& m)
  {
    for (const auto& [name, text] : m.texts)
      _json[name] = text;
    for (const auto& [name, x] : m.parameters)
      _json[name] = x;
    for (const auto& [name, list] : m.lists)
      _json[name] = list;
  }

  template <class F>
  void only_with(const std::string&, const std::string& chosen,
                 const std::vector<std::string>& choices,
                 std::initializer_list<std::size_t> wanted, F visit_keys)
  {
    if (is_one_of(chosen, choices, wanted))
      visit_keys();
  }

private:
  template <Table T>
  static void fill(Json& json, T& table)
  {
    json = Json::object();
    Writer writer(json);
    keys(writer, table);
  }

  Json& _json;
};
} // namespace mmale::scene
