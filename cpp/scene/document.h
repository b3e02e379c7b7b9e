// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// TOML text as a tree of plain values that know where they were written.
///
/// The only part of the project that sees the TOML library.
namespace mmale::scene
{
/// A value with its place.
struct Node
{
  enum class Kind
  {
    boolean,
    integer,
    number,
    text,
    list,
    table,
    other ///< a date or a time, as text
  };
  Kind kind = Kind::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0; ///< of an integer too
  std::string text;
  std::vector<Node> items;             ///< of a list
  std::map<std::string, Node> entries; ///< of a table
  Place place;
};

/// "text \"abc\"", "the list of 3": a value in a message.
std::string words(const Node& node);

/// A tree and what was wrong with its text.
struct Document
{
  Node root;
  std::vector<Complaint> complaints;
};

/// A change to a scene: dotted key and value as typed.
struct Override
{
  std::string key;
  std::string value;
};

/// Parse TOML text.
///
/// @param text  content of the file
/// @param file  its name for messages
Document parse(std::string_view text, const std::string& file);

/// Put a value into the tree, in place of what is there.
///
/// Words need no quotes; entries of a list are named by number or by their
/// `name`, as in stage.0.step and stage.push.step. Missing tables are made.
void put(Document& document, const Override& change);
} // namespace mmale::scene
