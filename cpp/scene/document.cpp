// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/document.h"
#include <algorithm>
#include <charconv>
#include <format>
#include <optional>
#include <sstream>
#include <toml++/toml.hpp>

namespace mmale::scene
{
namespace
{
Node convert(const toml::node& source, const std::string& file)
{
  Node node;
  node.place = {file, static_cast<int>(source.source().begin.line)};
  if (const auto* table = source.as_table())
    for (const auto& [key, value] : *table)
      node.entries.emplace(std::string(key.str()), convert(value, file));
  else if (const auto* list = source.as_array())
  {
    node.kind = Node::Kind::list;
    for (const toml::node& item : *list)
      node.items.push_back(convert(item, file));
  }
  else if (const auto* boolean = source.as_boolean())
  {
    node.kind = Node::Kind::boolean;
    node.boolean = boolean->get();
  }
  else if (const auto* integer = source.as_integer())
  {
    node.kind = Node::Kind::integer;
    node.integer = integer->get();
    node.number = static_cast<double>(integer->get());
  }
  else if (const auto* number = source.as_floating_point())
  {
    node.kind = Node::Kind::number;
    node.number = number->get();
  }
  else if (const auto* text = source.as_string())
  {
    node.kind = Node::Kind::text;
    node.text = text->get();
  }
  else
  {
    node.kind = Node::Kind::other;
    std::ostringstream out;
    out << toml::node_view<const toml::node>(source);
    node.text = out.str();
  }
  return node;
}

/// All of `text` as a number, also as ".5" or "1." which TOML does not know.
std::optional<double> as_number(std::string_view text)
{
  double x = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, x);
  if (error != std::errc() or stop != end)
    return std::nullopt;
  return x;
}

/// The value of an override: TOML, or a number or a word as people type it.
std::optional<Node> value_of(const std::string& text)
{
  if (text.empty() or text.find('\n') != std::string::npos)
    return std::nullopt;
  const Document line = parse("x = " + text, "command line");
  Node node;
  if (line.complaints.empty() and line.root.entries.size() == 1)
    node = line.root.entries.at("x");
  else if (const auto x = as_number(text))
  {
    node.kind = Node::Kind::number;
    node.number = *x;
  }
  else if (text.find_first_of("[]{}\"'#=") == std::string::npos)
  {
    node.kind = Node::Kind::text;
    node.text = text;
  }
  else
    return std::nullopt;
  return node;
}

void set_place(Node& node, const Place& place)
{
  node.place = place;
  for (Node& item : node.items)
    set_place(item, place);
  for (auto& [key, entry] : node.entries)
    set_place(entry, place);
}

/// The part of `node` that a path's next word names; null if there is none.
Node* child(Node& node, const std::string& word)
{
  if (node.kind == Node::Kind::table)
  {
    const auto [entry, is_new] = node.entries.try_emplace(word);
    if (is_new)
      entry->second.place = {"command line", 0};
    return &entry->second;
  }
  if (node.kind != Node::Kind::list)
    return nullptr;
  std::size_t index = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, index);
  if (error == std::errc() and stop == end)
    return index < node.items.size() ? &node.items[index] : nullptr;
  for (Node& item : node.items)
    if (const auto name = item.entries.find("name");
        name != item.entries.end() and name->second.text == word)
      return &item;
  return nullptr;
}

/// What a list offers to a path: its numbers, and names where it has them.
std::string offers(const Node& node)
{
  if (node.kind != Node::Kind::list)
    return "is " + words(node) + ", it has no keys";
  std::vector<std::string> known;
  for (std::size_t i = 0; i < node.items.size(); ++i)
  {
    const auto& entries = node.items[i].entries;
    const auto name = entries.find("name");
    known.push_back(name == entries.end() ? std::to_string(i)
                                          : name->second.text);
  }
  return "has only: " + join(known);
}
} // namespace

std::string words(const Node& node)
{
  switch (node.kind)
  {
  case Node::Kind::boolean:
    return node.boolean ? "true" : "false";
  case Node::Kind::integer:
    return std::to_string(node.integer);
  case Node::Kind::number:
    return std::format("{}", node.number);
  case Node::Kind::text:
    return "the text \"" + node.text + "\"";
  case Node::Kind::list:
    return std::format("a list of {}", node.items.size());
  case Node::Kind::table:
    return "a table";
  case Node::Kind::other:
    break;
  }
  return node.text;
}

Document parse(std::string_view text, const std::string& file)
{
  Document document;
  document.root.place = {file, 1};
  try
  {
    document.root = convert(toml::parse(text), file);
    document.root.place = {file, 1};
  }
  catch (const toml::parse_error& error)
  {
    const auto line = static_cast<int>(error.source().begin.line);
    document.complaints.push_back(
        {"",
         "not valid TOML: " + std::string(error.description()),
         {file, line}});
  }
  return document;
}

void put(Document& document, const Override& change)
{
  const Place place = {"command line", 0};
  const auto value = value_of(change.value);
  if (not value)
  {
    document.complaints.push_back({change.key,
                                   "cannot read the value '" + change.value
                                       + "'; write texts with spaces or signs "
                                         "in quotes",
                                   place});
    return;
  }
  Node* node = &document.root;
  std::istringstream path(change.key);
  std::string walked, word;
  while (std::getline(path, word, '.'))
  {
    Node* next = child(*node, word);
    if (not next)
    {
      document.complaints.push_back(
          {change.key, "no '" + word + "': " + walked + " " + offers(*node),
           place});
      return;
    }
    walked += (walked.empty() ? "" : ".") + word;
    node = next;
  }
  *node = *value;
  set_place(*node, place);
}
} // namespace mmale::scene
