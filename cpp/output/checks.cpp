// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <toml++/toml.hpp>

namespace mmale::output
{
namespace
{
constexpr std::array known = {"curve", "ledger",   "at",      "take",
                              "value", "at_least", "at_most", "rtol",
                              "atol",  "source",   "unit",    "made_by"};

/// A single insertion, removal or exchange counts 1.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j)
    row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t exchange = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({exchange, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// ", did you mean \"...\"?" if one name is near, else the names.
template <class Names>
std::string hint(std::string_view word, const Names& names)
{
  std::string best, all;
  std::size_t least = 1 + word.size() / 3;
  for (std::string_view name : names)
  {
    all += (all.empty() ? "" : ", ") + std::string(name);
    const std::size_t d = edit_distance(word, name);
    if (d <= least and (best.empty() or d < least))
    {
      least = d;
      best = name;
    }
  }
  if (not best.empty())
    return "; did you mean \"" + best + "\"?";
  return all.empty() ? "; there is none" : "; there are " + all;
}

/// Reads one entry and gathers what is wrong with it.
class Entry
{
public:
  Entry(std::string file, std::string_view name, const toml::table& table,
        References& out)
      : _file(std::move(file)), _table(table), _out(out)
  {
    reference.name = name;
  }

  Reference reference;
  bool good = true;

  void read(std::span<const std::string> curves,
            std::span<const std::string> ledger)
  {
    for (const auto& [key, node] : _table)
      if (std::ranges::find(known, key.str()) == known.end())
        complain(node, "no key \"" + std::string(key.str()) + "\" here"
                           + hint(key.str(), known));
    reference.source = text("source");
    reference.unit = text("unit");
    text("made_by");
    read_quantity(curves, ledger);
    read_relation();
  }

private:
  void complain(const toml::node& where, const std::string& what)
  {
    good = false;
    _out.complaints.push_back(_file + ":"
                              + std::to_string(where.source().begin.line)
                              + ": [" + reference.name + "] " + what);
  }

  std::string text(std::string_view key)
  {
    const toml::node* node = _table.get(key);
    if (not node)
      return {};
    const auto value = node->value_exact<std::string>();
    if (not value)
      complain(*node, std::string(key) + " must be a text");
    return value.value_or("");
  }

  std::optional<double> number(const toml::node* node, std::string_view key)
  {
    if (not node)
      return {};
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (not value or not std::isfinite(*value))
    {
      complain(*node, std::string(key) + " must be a finite number");
      return {};
    }
    return value;
  }

  /// Exactly one of the keys must be there; its node, or none.
  std::string one_of(std::initializer_list<const char*> keys)
  {
    std::string found, all;
    int count = 0;
    for (const char* key : keys)
    {
      all += (all.empty() ? "" : ", ") + std::string(key);
      if (_table.contains(key))
      {
        found = key;
        ++count;
      }
    }
    if (count == 1)
      return found;
    complain(_table, "needs one of " + all + ", and has "
                         + (count == 0 ? "none" : "more"));
    return {};
  }

  void read_quantity(std::span<const std::string> curves,
                     std::span<const std::string> ledger)
  {
    const std::string what = one_of({"curve", "ledger"});
    if (what == "ledger")
    {
      read_ledger(ledger);
      for (const char* key : {"at", "take"})
        if (const toml::node* node = _table.get(key))
          complain(*node, std::string(key) + " goes with curve only");
      return;
    }
    if (what.empty())
      return;
    reference.curve = text("curve");
    if (not reference.curve.empty()
        and std::ranges::find(curves, reference.curve) == curves.end())
      complain(*_table.get("curve"), "no curve \"" + reference.curve + "\""
                                         + hint(reference.curve, curves));
    const std::string place = one_of({"at", "take"});
    if (place == "take")
      read_take();
    else if (place == "at")
      read_at(curves);
  }

  void read_take()
  {
    constexpr std::array names = {"first", "last", "min", "max"};
    constexpr std::array takes = {Reference::Take::first, Reference::Take::last,
                                  Reference::Take::min, Reference::Take::max};
    const std::string word = text("take");
    const auto it = std::ranges::find(names, word);
    if (it != names.end())
      reference.take = takes[static_cast<std::size_t>(it - names.begin())];
    else if (_table.get("take")->is_string())
      complain(*_table.get("take"),
               "cannot take \"" + word + "\"" + hint(word, names));
  }

  void read_at(std::span<const std::string> curves)
  {
    reference.take = Reference::Take::at;
    const toml::node& node = *_table.get("at");
    const toml::table* at = node.as_table();
    if (not at or at->size() != 1)
      return complain(node, "at must be one curve and its value, "
                            "as in { z_B = 0.05 }");
    const auto entry = at->begin(); // owns what it points to
    const std::string name(entry->first.str());
    const toml::node& value = entry->second;
    if (std::ranges::find(curves, name) == curves.end())
      complain(node, "no curve \"" + name + "\"" + hint(name, curves));
    reference.at = {name, number(&value, "at." + name).value_or(0)};
  }

  void read_ledger(std::span<const std::string> ledger)
  {
    reference.ledger = text("ledger");
    const toml::node& node = *_table.get("ledger");
    if (not node.is_string())
      return;
    const std::size_t dot = reference.ledger.rfind('.');
    const std::string entry = reference.ledger.substr(0, dot);
    if (std::ranges::find(ledger, entry) == ledger.end())
      complain(node,
               "the ledger has no \"" + entry + "\"" + hint(entry, ledger));
    const std::string n =
        dot == std::string::npos ? "" : reference.ledger.substr(dot + 1);
    if (std::ranges::find(ledger_numbers, n) == std::end(ledger_numbers))
      complain(node, "\"" + reference.ledger + "\" must end in a number's name"
                         + hint(n, ledger_numbers));
  }

  void read_relation()
  {
    const std::string relation = one_of({"value", "at_least", "at_most"});
    if (relation.empty())
      return;
    reference.reference = number(_table.get(relation), relation).value_or(0);
    if (relation != "value")
    {
      reference.relation = relation == "at_least"
                               ? Reference::Relation::at_least
                               : Reference::Relation::at_most;
      for (const char* key : {"rtol", "atol"})
        if (const toml::node* node = _table.get(key))
          complain(*node, std::string(key) + " goes with value only");
      return;
    }
    const std::string kind = one_of({"rtol", "atol"});
    if (kind.empty())
      return;
    const toml::node& node = *_table.get(kind);
    const std::optional<double> tolerance = number(&node, kind);
    if (tolerance and not(*tolerance >= 0))
      complain(node, kind + " must not be negative");
    if (kind == "rtol" and reference.reference == 0)
      complain(node, "rtol means nothing beside value = 0; give atol");
    reference.tolerance =
        tolerance.value_or(0)
        * (kind == "rtol" ? std::abs(reference.reference) : 1);
  }

  std::string _file;
  const toml::table& _table;
  References& _out;
};

std::optional<double> ledger_number(const Ledger& ledger,
                                    const std::string& name)
{
  const std::size_t dot = name.rfind('.');
  for (const LedgerEntry& e : ledger)
  {
    if (dot == std::string::npos or e.name != name.substr(0, dot))
      continue;
    const std::array values = {e.start, e.end, e.through_surface, e.booked,
                               e.relative_change()};
    const auto it = std::ranges::find(ledger_numbers, name.substr(dot + 1));
    if (it != std::end(ledger_numbers))
      return values[static_cast<std::size_t>(it - std::begin(ledger_numbers))];
  }
  return {};
}

std::optional<double> curve_number(const Curves& curves, const Reference& r)
{
  if (curves.rows() == 0 or not curves.has(r.curve))
    return {};
  const std::span<const double> y = curves.column(r.curve);
  switch (r.take)
  {
  case Reference::Take::first:
    return y.front();
  case Reference::Take::last:
    return y.back();
  case Reference::Take::at:
    if (curves.has(r.at.first))
      return interpolate(curves.column(r.at.first), y, r.at.second);
    return {};
  case Reference::Take::min:
  case Reference::Take::max:
    break;
  }
  // A NaN on the way must not hide behind a comparison that it fails.
  if (std::ranges::any_of(y, [](double v) { return std::isnan(v); }))
    return {};
  return r.take == Reference::Take::min ? std::ranges::min(y)
                                        : std::ranges::max(y);
}

bool holds(const Reference& r, double value)
{
  switch (r.relation)
  {
  case Reference::Relation::near:
    return std::abs(value - r.reference) <= r.tolerance;
  case Reference::Relation::at_least:
    return value >= r.reference;
  case Reference::Relation::at_most:
    // What a ledger must not exceed is a gap, of either sign.
    return (r.ledger.empty() ? value : std::abs(value)) <= r.reference;
  }
  return false;
}
} // namespace

References read_references(const std::filesystem::path& file,
                           std::span<const std::string> curves,
                           std::span<const std::string> ledger)
{
  References out;
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (not in)
  {
    out.complaints.push_back(file.string() + ": cannot be read");
    return out;
  }
  toml::table root;
  try
  {
    root = toml::parse(text.view(), file.string());
  }
  catch (const toml::parse_error& error)
  {
    out.complaints.push_back(file.string() + ":"
                             + std::to_string(error.source().begin.line) + ": "
                             + std::string(error.description()));
    return out;
  }

  std::vector<std::pair<toml::source_index, Reference>> found;
  for (const auto& [key, node] : root)
  {
    const toml::table* table = node.as_table();
    const toml::source_index line = node.source().begin.line;
    if (not table)
    {
      out.complaints.push_back(file.string() + ":" + std::to_string(line)
                               + ": \"" + std::string(key.str())
                               + "\" must be a table, as in [name]");
      continue;
    }
    Entry entry(file.string(), key.str(), *table, out);
    entry.read(curves, ledger);
    if (entry.good)
      found.emplace_back(line, std::move(entry.reference));
  }
  // toml++ sorts by name; the reader wants the order of the file.
  std::ranges::stable_sort(found, {}, [](const auto& f) { return f.first; });
  for (auto& [line, reference] : found)
    out.entries.push_back(std::move(reference));
  return out;
}

std::optional<double> interpolate(std::span<const double> x,
                                  std::span<const double> y, double at)
{
  const std::size_t n = std::min(x.size(), y.size());
  if (n == 0)
    return {};
  const auto finite = [](double value) -> std::optional<double>
  { return std::isfinite(value) ? std::optional(value) : std::nullopt; };

  // A run ends at its time only up to round-off, and so does x.
  const auto [low, high] = std::ranges::minmax(x.first(n));
  const double near = 1e-9 * (high - low);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (std::abs(x[i] - at) <= near)
      return finite(y[i]);
    if (i + 1 < n and (x[i] - at) * (x[i + 1] - at) < 0
        and not(std::abs(x[i + 1] - at) <= near))
    {
      const double s = (at - x[i]) / (x[i + 1] - x[i]);
      return finite((1 - s) * y[i] + s * y[i + 1]);
    }
  }
  return {};
}

std::vector<Check> evaluate(std::span<const Reference> references,
                            const Curves& curves, const Ledger& ledger)
{
  std::vector<Check> out;
  for (const Reference& r : references)
  {
    Check check{.reference = r};
    check.value = r.ledger.empty() ? curve_number(curves, r)
                                   : ledger_number(ledger, r.ledger);
    check.holds = check.value and holds(r, *check.value);
    out.push_back(std::move(check));
  }
  return out;
}

bool all_hold(std::span<const Check> checks)
{
  return std::ranges::all_of(checks, &Check::holds);
}

std::string table(std::span<const Check> checks)
{
  std::string out;
  for (const Check& check : checks)
  {
    const Reference& r = check.reference;
    std::array<char, 320> line;
    std::array<char, 32> value = {"not reached"};
    if (check.value)
      std::snprintf(value.data(), value.size(), "%.6g", *check.value);
    std::array<char, 80> wanted;
    if (r.relation == Reference::Relation::near)
      std::snprintf(wanted.data(), wanted.size(), "%.6g +- %.2g", r.reference,
                    r.tolerance);
    else
      std::snprintf(wanted.data(), wanted.size(), "%s %.6g",
                    r.relation == Reference::Relation::at_least ? "at least"
                                                                : "at most",
                    r.reference);
    std::snprintf(line.data(), line.size(), "%-6s %-28s %12s  %s\n",
                  check.holds ? "holds" : "FAILS", r.name.c_str(), value.data(),
                  wanted.data());
    out += line.data();
  }
  return out;
}
} // namespace mmale::output
