// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/check.h"
#include "scene/document.h"
#include "scene/schema.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

/// Visitor of `keys` that fills a scene from a document: types only, what a
/// value may be is checked on the scene itself.
namespace mmale::scene
{
/// What the visitors of all tables share.
struct Record
{
  std::vector<Complaint> complaints;
  std::map<std::string, Place> places; ///< of every key that was written
  std::set<std::string> failed;        ///< keys whose value was not read

  void fail(const std::string& key, const std::string& what, const Place& place)
  {
    complaints.push_back({key, what, place});
    failed.insert(key);
  }
};

inline std::string under(const std::string& path, const std::string& name)
{
  return path.empty() ? name : path + "." + name;
}

/// Fills one table from its node; a visitor of `keys`.
class Filler
{
public:
  Filler(const Node& node, std::string path, Record& record)
      : _node(node), _path(std::move(path)), _record(record)
  {
  }

  void operator()(const Key& key, double& x)
  {
    if (const Node* node = find(key.name))
      number(*node, under(_path, key.name), x);
  }

  void operator()(const Key& key, std::optional<double>& x)
  {
    double value = 0;
    if (const Node* node = find(key.name))
      if (number(*node, under(_path, key.name), value))
        x = value;
  }

  void operator()(const Key& key, int& i)
  {
    if (const Node* node = find(key.name))
      whole(*node, under(_path, key.name), i);
  }

  void operator()(const Key& key, bool& flag)
  {
    const Node* node = find(key.name);
    if (not node)
      return;
    if (node->kind == Node::Kind::boolean)
      flag = node->boolean;
    else
      wrong(*node, under(_path, key.name), "true or false");
  }

  void operator()(const Key& key, std::string& text)
  {
    if (const Node* node = find(key.name))
      word(*node, under(_path, key.name), text);
  }

  template <Enumeration E>
  void operator()(const Key& key, E& choice)
  {
    std::string text;
    const Node* node = find(key.name);
    if (not node)
    {
      if (key.needed)
        _record.fail(under(_path, key.name),
                     missing(key.sentence, "", "one of " + join(names<E>())),
                     _node.place);
      return;
    }
    const std::string path = under(_path, key.name);
    if (not word(*node, path, text))
      return;
    const auto& known = names<E>();
    const auto at = std::ranges::find(known, text);
    if (at == known.end())
      _record.fail(path, "unknown '" + text + "', " + suggestion(text, known),
                   node->place);
    else
      choice = static_cast<E>(at - known.begin());
  }

  void operator()(const Key& key, Point& x)
  {
    if (const Node* node = find(key.name))
      point(*node, under(_path, key.name), x);
  }

  void operator()(const Key& key, std::optional<Point>& x)
  {
    if (const Node* node = find(key.name))
      point(*node, under(_path, key.name), x.emplace(Point{0, 0}));
  }

  void operator()(const Key& key, std::vector<Point>& points)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (node->kind != Node::Kind::list)
      return wrong(*node, path, "a list of points [x, y]");
    for (const Node& item : node->items)
      if (not point(item, path, points.emplace_back()))
        return;
  }

  void operator()(const Key& key, std::array<Point, 4>& corners)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (not is_list(*node, 4))
      return wrong(*node, path, "a list of 4 points [x, y]");
    for (std::size_t i = 0; i < 4; ++i)
      if (not point(node->items[i], path, corners[i]))
        return;
  }

  void operator()(const Key& key, std::array<int, 2>& pair)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (not is_list(*node, 2))
      return wrong(*node, path, "a list of 2 whole numbers");
    for (std::size_t i = 0; i < 2; ++i)
      if (not whole(node->items[i], path, pair[i]))
        return;
  }

  void operator()(const Key& key, std::vector<std::string>& texts)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (node->kind != Node::Kind::list)
      return wrong(*node, path, "a list of names");
    for (const Node& item : node->items)
      if (not word(item, path, texts.emplace_back()))
        return;
  }

  void operator()(const Key& key, std::optional<TimeSeries>& series)
  {
    if (const Node* node = find(key.name))
      if (not this->series(*node, under(_path, key.name), series.emplace()))
        series.reset(); // what has no values is not looked at any further
  }

  void operator()(const Key& key,
                  std::optional<std::array<TimeSeries, 2>>& pair)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (not is_list(*node, 2))
      return wrong(*node, path,
                   "a list of 2, each a number or {time = [...], value = "
                   "[...]}");
    pair.emplace();
    for (std::size_t i = 0; i < 2; ++i)
      if (not series(node->items[i], path, (*pair)[i]))
        return;
  }

  template <Table T>
  void operator()(const Key& key, T& table)
  {
    if (const Node* node = find(key.name))
      fill(*node, under(_path, key.name), table);
  }

  template <Table T>
  void operator()(const Key& key, std::optional<T>& table)
  {
    if (const Node* node = find(key.name))
      fill(*node, under(_path, key.name), table.emplace());
  }

  template <Table T>
  void operator()(const Key& key, std::map<std::string, T>& tables)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (node->kind != Node::Kind::table)
      return wrong(*node, path,
                   "tables with names, written [" + path + ".NAME]");
    for (const auto& [name, entry] : node->entries)
    {
      if (not is_name(name))
        _record.fail(under(path, name),
                     "a name is made of letters, digits, _ and -, and starts "
                     "with a letter or _",
                     entry.place);
      fill(entry, under(path, name), tables[name]);
    }
  }

  void operator()(const Key& key, std::vector<Stage>& stages)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (node->kind != Node::Kind::list)
      return wrong(*node, path, "a list of tables, written [[" + path + "]]");
    // Labels need all the names at hand, so these are read first.
    stages.resize(node->items.size());
    for (std::size_t i = 0; i < stages.size(); ++i)
      if (const auto name = node->items[i].entries.find("name");
          name != node->items[i].entries.end())
        stages[i].name = name->second.text;
    for (std::size_t i = 0; i < stages.size(); ++i)
      fill(node->items[i], under(path, stage_label(stages, i)), stages[i]);
    for (std::size_t i = 0; i < stages.size(); ++i)
      if (not stages[i].name.empty() and not is_name(stages[i].name))
        _record.fail(under(under(path, stage_label(stages, i)), "name"),
                     "a name is made of letters, digits, _ and -, and starts "
                     "with a letter or _",
                     node->items[i].entries.at("name").place);
  }

  template <Table T>
  void operator()(const Key& key, std::vector<T>& tables)
  {
    const Node* node = find(key.name);
    const std::string path = under(_path, key.name);
    if (not node)
      return;
    if (node->kind != Node::Kind::list)
      return wrong(*node, path, "a list of tables, written [{...}, {...}]");
    tables.resize(node->items.size());
    for (std::size_t i = 0; i < tables.size(); ++i)
      fill(node->items[i], under(path, std::to_string(i)), tables[i]);
  }

  /// Every key that is not named otherwise; call it last.
  void rest(const std::string&, Material& material)
  {
    _takes_rest = true;
    for (const auto& [name, entry] : _node.entries)
    {
      if (std::ranges::find(_known, name) != _known.end())
        continue;
      const std::string path = under(_path, name);
      _record.places[path] = entry.place;
      double x = 0;
      if (entry.kind == Node::Kind::text)
        material.texts[name] = entry.text;
      else if (entry.kind == Node::Kind::list)
        numbers(entry, path, material.lists[name]);
      else if (number(entry, path, x))
        material.parameters[name] = x;
    }
  }

  template <class F>
  void only_with(const std::string& selector, const std::string& chosen,
                 const std::vector<std::string>& choices,
                 std::initializer_list<std::size_t> wanted, F visit_keys)
  {
    // An unknown choice is a complaint of its own: then nothing is known
    // about these keys.
    if (std::ranges::find(choices, chosen) != choices.end()
        and not is_one_of(chosen, choices, wanted))
      _only_with = selector + " = " + alternatives(choices, wanted);
    visit_keys();
    _only_with.clear();
  }

  void finish()
  {
    if (_takes_rest)
      return;
    for (const auto& [name, entry] : _node.entries)
      if (std::ranges::find(_known, name) == _known.end())
        _record.fail(under(_path, name),
                     "unknown key, " + suggestion(name, _known), entry.place);
  }

private:
  const Node* find(const std::string& name)
  {
    _known.push_back(name);
    const auto entry = _node.entries.find(name);
    if (entry == _node.entries.end())
      return nullptr;
    const Node& node = entry->second;
    const std::string path = under(_path, name);
    _record.places[path] = node.place;
    if (_only_with.empty())
      return &node;
    _record.fail(path, "is for " + _only_with + " only", node.place);
    return nullptr;
  }

  void wrong(const Node& node, const std::string& path,
             const std::string& wanted)
  {
    _record.fail(path, "must be " + wanted + ", is " + words(node), node.place);
  }

  static bool is_list(const Node& node, std::size_t size)
  {
    return node.kind == Node::Kind::list and node.items.size() == size;
  }

  bool number(const Node& node, const std::string& path, double& x)
  {
    if (node.kind != Node::Kind::integer and node.kind != Node::Kind::number)
      wrong(node, path, "a number");
    else if (not std::isfinite(node.number))
      wrong(node, path, "finite");
    else
    {
      x = node.number;
      return true;
    }
    return false;
  }

  bool whole(const Node& node, const std::string& path, int& i)
  {
    const bool numeric =
        node.kind == Node::Kind::integer or node.kind == Node::Kind::number;
    if (not numeric or not(std::abs(node.number) <= 2e9)
        or node.number != std::floor(node.number))
    {
      wrong(node, path, "a whole number up to 2e9");
      return false;
    }
    i = static_cast<int>(node.number);
    return true;
  }

  void numbers(const Node& node, const std::string& path,
               std::vector<double>& list)
  {
    for (const Node& item : node.items)
      if (not number(item, path, list.emplace_back()))
        return;
  }

  bool word(const Node& node, const std::string& path, std::string& text)
  {
    if (node.kind != Node::Kind::text)
    {
      wrong(node, path, "a text");
      return false;
    }
    text = node.text;
    return true;
  }

  bool point(const Node& node, const std::string& path, Point& x)
  {
    if (not is_list(node, 2))
    {
      wrong(node, path, "a point [x, y]");
      return false;
    }
    return number(node.items[0], path, x[0])
           and number(node.items[1], path, x[1]);
  }

  void check_known(const Node& node, const std::string& path,
                   const std::vector<std::string>& known)
  {
    for (const auto& [name, entry] : node.entries)
      if (std::ranges::find(known, name) == known.end())
        _record.fail(under(path, name),
                     "unknown key, " + suggestion(name, known), entry.place);
  }

  bool sine(const Node& node, const std::string& path, TimeSeries& series)
  {
    check_known(node, path, {"mean", "amplitude", "frequency", "phase_deg"});
    series.value = {0};
    bool good = true;
    for (const auto& [name, x] : {std::pair{"mean", &series.value.front()},
                                  std::pair{"amplitude", &series.amplitude},
                                  std::pair{"frequency", &series.frequency},
                                  std::pair{"phase_deg", &series.phase_deg}})
      if (const auto entry = node.entries.find(name);
          entry != node.entries.end())
      {
        _record.places[under(path, name)] = entry->second.place;
        good = number(entry->second, under(path, name), *x) and good;
      }
    if (not node.entries.contains("amplitude")
        or not node.entries.contains("frequency"))
      _record.fail(path, "missing: amplitude and frequency of the sine",
                   node.place);
    return good;
  }

  bool series(const Node& node, const std::string& path, TimeSeries& series)
  {
    if (node.kind != Node::Kind::table)
    {
      if (node.kind == Node::Kind::list or node.kind == Node::Kind::text)
      {
        wrong(node, path, "a number or {time = [...], value = [...]}");
        return false;
      }
      return number(node, path, series.value.emplace_back());
    }
    if (node.entries.contains("amplitude") or node.entries.contains("mean"))
      return sine(node, path, series);
    const std::vector<std::string> known = {"time", "value"};
    check_known(node, path, known);
    for (const std::string& name : known)
    {
      const auto entry = node.entries.find(name);
      if (entry == node.entries.end())
      {
        _record.fail(path, "missing: " + name + " of the series", node.place);
        return false;
      }
      _record.places[under(path, name)] = entry->second.place;
      if (entry->second.kind != Node::Kind::list or entry->second.items.empty())
      {
        wrong(entry->second, under(path, name), "a list of numbers");
        return false;
      }
      for (const Node& item : entry->second.items)
        if (not number(
                item, path,
                (name == "time" ? series.time : series.value).emplace_back()))
          return false;
    }
    return true;
  }

  template <Table T>
  void fill(const Node& node, const std::string& path, T& table)
  {
    _record.places[path] = node.place;
    if (node.kind != Node::Kind::table)
      return wrong(node, path, "a table");
    Filler filler(node, path, _record);
    keys(filler, table);
    filler.finish();
  }

  const Node& _node;
  std::string _path;
  Record& _record;
  std::vector<std::string> _known;
  std::string _only_with;
  bool _takes_rest = false;
};
} // namespace mmale::scene
