// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/check.h"
#include "scene/schema.h"
#include <algorithm>
#include <cmath>
#include <format>
#include <functional>
#include <map>
#include <optional>

/// Visitor of `keys` that holds every value against what its key allows.
namespace mmale::scene
{
/// " m" after a number; nothing for a number without dimension.
inline std::string unit_word(const std::string& unit)
{
  return unit.empty() or unit == "-" ? "" : " " + unit;
}

/// Checks every single value of a table; a visitor of `keys`.
class Checker
{
public:
  Checker(std::string path, std::vector<Complaint>& out)
      : _path(std::move(path)), _out(out)
  {
  }

  void operator()(const Key& key, double& x)
  {
    if (std::isnan(x))
      missing(key);
    else if (not key.range.holds(x))
      outside(key, x);
  }

  void operator()(const Key& key, std::optional<double>& x)
  {
    if (x)
      (*this)(key, *x);
  }

  void operator()(const Key& key, int& i)
  {
    if (not key.range.holds(i))
      outside(key, i);
  }

  void operator()(const Key&, bool&) {}

  template <Enumeration E>
  void operator()(const Key&, E&)
  {
  }

  void operator()(const Key& key, std::string& text)
  {
    if (text.empty() and key.needed)
      missing(key);
    else if (not text.empty() and not key.choices.empty()
             and std::ranges::find(key.choices, text) == key.choices.end())
      add(key, "unknown '" + text + "', " + suggestion(text, key.choices));
  }

  void operator()(const Key& key, Point& x)
  {
    if (std::isnan(x[0]) or std::isnan(x[1]))
      missing(key);
  }

  void operator()(const Key& key, std::vector<Point>& points)
  {
    if (points.empty())
      missing(key);
  }

  void operator()(const Key& key, std::optional<Point>& x)
  {
    if (x)
      (*this)(key, *x);
  }

  void operator()(const Key& key, std::array<Point, 4>& corners)
  {
    for (const Point& x : corners)
      if (std::isnan(x[0]) or std::isnan(x[1]))
        return missing(key);
  }

  void operator()(const Key& key, std::array<int, 2>& pair)
  {
    for (int i : pair)
      if (not key.range.holds(i))
        return outside(key, i);
  }

  void operator()(const Key&, std::vector<std::string>&) {}

  void operator()(const Key& key, std::optional<TimeSeries>& series)
  {
    if (series)
      this->series(key, *series);
  }

  void operator()(const Key& key,
                  std::optional<std::array<TimeSeries, 2>>& pair)
  {
    if (pair)
      for (TimeSeries& series : *pair)
        this->series(key, series);
  }

  template <Table T>
  void operator()(const Key& key, T& table)
  {
    enter(key.name, table);
  }

  template <Table T>
  void operator()(const Key& key, std::optional<T>& table)
  {
    if (table)
      enter(key.name, *table);
  }

  template <Table T>
  void operator()(const Key& key, std::map<std::string, T>& tables)
  {
    for (auto& [name, table] : tables)
      enter(key.name + "." + name, table);
  }

  void operator()(const Key& key, std::vector<Stage>& stages)
  {
    for (std::size_t i = 0; i < stages.size(); ++i)
      enter(key.name + "." + stage_label(stages, i), stages[i]);
  }

  template <Table T>
  void operator()(const Key& key, std::vector<T>& tables)
  {
    for (std::size_t i = 0; i < tables.size(); ++i)
      enter(key.name + "." + std::to_string(i), tables[i]);
  }

  void rest(const std::string&, Material&) {}

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
  void enter(const std::string& name, T& table)
  {
    Checker checker(_path + name + ".", _out);
    keys(checker, table);
  }

  void add(const Key& key, const std::string& what)
  {
    _out.push_back({_path + key.name, what, {}});
  }

  void missing(const Key& key)
  {
    add(key,
        scene::missing(key.sentence, key.unit,
                       key.choices.empty() ? key.range.words()
                                           : "one of " + join(key.choices)));
  }

  void outside(const Key& key, double x)
  {
    const std::string range = key.range.words();
    add(key,
        std::format("must be {}{}, is {}", range.empty() ? "finite" : range,
                    range.empty() ? "" : unit_word(key.unit), x));
  }

  void series(const Key& key, const TimeSeries& series)
  {
    const auto& time = series.time;
    if (series.amplitude != 0 and not(series.frequency > 0))
      add(key, std::format("frequency of the sine must be > 0 1/s, is {}",
                           series.frequency));
    if (series.value.empty())
      add(key, "has no value");
    else if (time.empty() and series.value.size() > 1)
      add(key, "several values need as many times");
    else if (not time.empty() and time.size() != series.value.size())
      add(key, std::format("{} times and {} values; give as many of each",
                           time.size(), series.value.size()));
    else if (std::ranges::adjacent_find(time, std::greater_equal())
             != time.end())
      add(key, "times must ascend");
    else if (not time.empty() and time.front() < 0)
      add(key, std::format("times count from the start of the stage, the first "
                           "is {} s",
                           time.front()));
  }

  std::string _path;
  std::vector<Complaint>& _out;
};
} // namespace mmale::scene
