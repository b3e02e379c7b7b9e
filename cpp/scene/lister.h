// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/describe.h"
#include "scene/schema.h"
#include <cmath>
#include <format>
#include <map>
#include <optional>

/// Visitor of `keys` that lists the keys of a table for people.
namespace mmale::scene
{
inline std::string standard_of(double x)
{
  return std::isnan(x) ? "required" : std::isinf(x) ? "" : std::format("{}", x);
}

/// Lists the keys of a default table; a visitor of `keys`.
class Lister
{
public:
  Lister(std::string path, std::vector<KeyInfo>& out)
      : _path(std::move(path)), _out(out)
  {
  }

  void operator()(const Key& key, double& x)
  {
    add(key, "number", key.range.words(), standard_of(x));
  }

  void operator()(const Key& key, std::optional<double>&)
  {
    add(key, "number", key.range.words(), "");
  }

  void operator()(const Key& key, int& i)
  {
    add(key, "whole number", key.range.words(), std::to_string(i));
  }

  void operator()(const Key& key, bool& flag)
  {
    add(key, "true or false", "", flag ? "true" : "false");
  }

  void operator()(const Key& key, std::string& text)
  {
    add(key, "text", join(key.choices), key.needed ? "required" : text);
  }

  template <Enumeration E>
  void operator()(const Key& key, E& choice)
  {
    add(key, "text", join(names<E>()),
        key.needed ? "required" : names<E>()[static_cast<std::size_t>(choice)]);
  }

  void operator()(const Key& key, Point& x)
  {
    add(key, "point [x, y]", "",
        std::isnan(x[0]) ? "required" : std::format("[{}, {}]", x[0], x[1]));
  }

  void operator()(const Key& key, std::vector<Point>&)
  {
    add(key, "list of points [x, y]", "", "required");
  }

  void operator()(const Key& key, std::optional<Point>&)
  {
    add(key, "point [x, y]", "", "");
  }

  void operator()(const Key& key, std::array<Point, 4>&)
  {
    add(key, "4 points [x, y]", "", "required");
  }

  void operator()(const Key& key, std::array<int, 2>&)
  {
    add(key, "2 whole numbers", key.range.words(), "");
  }

  void operator()(const Key& key, std::vector<std::string>&)
  {
    add(key, "list of texts", "", "[]");
  }

  void operator()(const Key& key, std::optional<TimeSeries>&)
  {
    add(key,
        "number, {time = [s], value = [..]} or {mean, amplitude, frequency "
        "[1/s], phase_deg}",
        "", "");
  }

  void operator()(const Key& key, std::optional<std::array<TimeSeries, 2>>&)
  {
    add(key,
        "2, each a number, {time = [s], value = [..]} or {mean, amplitude, "
        "frequency [1/s], phase_deg}",
        "", "");
  }

  template <Table T>
  void operator()(const Key& key, T& table)
  {
    enter(key, "table", key.name, table);
  }

  template <Table T>
  void operator()(const Key& key, std::optional<T>&)
  {
    T table;
    enter(key, "table", key.name, table);
  }

  template <Table T>
  void operator()(const Key& key, std::map<std::string, T>&)
  {
    T table;
    enter(key, "tables", key.name + ".NAME", table);
  }

  void operator()(const Key& key, std::vector<Stage>&)
  {
    Stage stage;
    enter(key, "list of tables", key.name + ".NAME", stage);
  }

  template <Table T>
  void operator()(const Key& key, std::vector<T>&)
  {
    T table;
    enter(key, "list of tables", key.name + ".NUMBER", table);
  }

  // The laws' numbers follow at the end of the reference.
  void rest(const std::string&, Material&) {}

  template <class F>
  void only_with(const std::string& selector, const std::string&,
                 const std::vector<std::string>& choices,
                 std::initializer_list<std::size_t> wanted, F visit_keys)
  {
    const std::size_t first = _out.size();
    visit_keys();
    for (std::size_t i = first; i < _out.size(); ++i)
      _out[i].sentence += " Only with " + selector + " = "
                          + alternatives(choices, wanted) + ".";
  }

private:
  void add(const Key& key, const std::string& kind, const std::string& allowed,
           const std::string& standard)
  {
    _out.push_back(
        {_path + key.name, kind, key.unit, allowed, standard, key.sentence});
  }

  template <Table T>
  void enter(const Key& key, const std::string& kind, const std::string& name,
             T& table)
  {
    _out.push_back({_path + name, kind, "", "", "", key.sentence});
    Lister lister(_path + name + ".", _out);
    keys(lister, table);
  }

  std::string _path;
  std::vector<KeyInfo>& _out;
};
} // namespace mmale::scene
