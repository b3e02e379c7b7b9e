// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/sweep.h"
#include <algorithm>
#include <format>
#include <set>

namespace mmale::scene
{
namespace
{
constexpr std::size_t max_members = 10000;

/// Parts of a text between commas that no bracket or quote protects.
std::vector<std::string> split(const std::string& text)
{
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (char c : text)
  {
    if (quote)
      quote = c == quote ? 0 : quote;
    else if (c == '"' or c == '\'')
      quote = c;
    else if (c == '[' or c == '{')
      ++depth;
    else if (c == ']' or c == '}')
      --depth;
    else if (c == ',' and depth == 0)
    {
      parts.emplace_back();
      continue;
    }
    parts.back() += c;
  }
  return parts;
}

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// What a folder may be called: no separators, no spaces.
std::string folder_name(std::span<const Override> swept)
{
  std::string name;
  for (const Override& o : swept)
    name += (name.empty() ? "" : ",") + o.key + "=" + o.value;
  std::erase_if(name, [](char c) { return c == '"' or c == '\''; });
  std::ranges::replace_if(
      name, [](char c) { return c == '/' or c == '\\' or c == ' '; }, '_');
  return name;
}

std::string quoted(const std::string& cell)
{
  if (cell.find_first_of(",\"\n") == std::string::npos)
    return cell;
  std::string text = "\"";
  for (char c : cell)
    text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}
} // namespace

Sweep expand(std::span<const std::string> arguments)
{
  Sweep sweep;
  sweep.members.resize(1);
  std::set<std::string> seen;
  for (const std::string& argument : arguments)
  {
    const auto complain = [&](const std::string& key, const std::string& what)
    { sweep.complaints.push_back({key, what, {"command line", 0}}); };
    const auto sign = argument.find('=');
    const std::string key = trimmed(argument.substr(0, sign));
    if (sign == std::string::npos or key.empty() or key.front() == '.'
        or key.back() == '.' or key.find("..") != std::string::npos)
    {
      complain("", "'" + argument + "' is not key=value");
      continue;
    }
    if (not seen.insert(key).second)
      complain(key, "is given twice");
    const auto values = split(argument.substr(sign + 1));
    if (sweep.members.size() * values.size() > max_members)
    {
      complain(key,
               std::format("the sweep has more than {} runs", max_members));
      return sweep;
    }
    std::vector<Member> product;
    for (const Member& member : sweep.members)
      for (const std::string& value : values)
      {
        Member& next = product.emplace_back(member);
        next.overrides.push_back({key, trimmed(value)});
        if (values.size() > 1)
          next.swept.push_back(next.overrides.back());
      }
    sweep.members = std::move(product);
  }
  std::set<std::string> folders;
  for (Member& member : sweep.members)
  {
    member.folder = folder_name(member.swept);
    if (not folders.insert(member.folder).second)
      sweep.complaints.push_back(
          {"",
           "two runs of the sweep are the same: " + member.folder,
           {"command line", 0}});
  }
  return sweep;
}

std::string to_csv(std::span<const Row> rows)
{
  std::set<std::string> curves;
  for (const Row& row : rows)
    for (const auto& [name, x] : row.last)
      curves.insert(name);
  std::string text;
  if (not rows.empty())
    for (const Override& o : rows.front().swept)
      text += quoted(o.key) + ",";
  text += "outcome";
  for (const std::string& name : curves)
    text += "," + quoted(name);
  text += "\n";
  for (const Row& row : rows)
  {
    for (const Override& o : row.swept)
      text += quoted(o.value) + ",";
    text += quoted(row.outcome);
    for (const std::string& name : curves)
      text +=
          row.last.contains(name) ? std::format(",{}", row.last.at(name)) : ",";
    text += "\n";
  }
  return text;
}
} // namespace mmale::scene
