// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The tags of an XML file one by one, as far as drawings need them: names,
// attributes and lines; text, comments, declarations and CDATA are passed over.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remap::xml
{
struct Attribute
{
  std::string_view name; ///< without its namespace
  std::string_view value;
  int line; ///< of the value's first letter
};

struct Tag
{
  std::string_view name; ///< without its namespace
  std::vector<Attribute> attributes;
  int line = 0;
  bool opens = true;   ///< <a> or <a/>
  bool closes = false; ///< </a> or <a/>

  /// Null without such an attribute.
  [[nodiscard]] const Attribute* find(std::string_view name) const;
};

class Reader
{
public:
  explicit Reader(std::string_view text) : _text(text) {}

  /// The next tag; false at the end, or where the file is no XML.
  bool next(Tag& tag);

  /// Why the file is no XML; empty: it has come to its end.
  [[nodiscard]] const std::string& trouble() const { return _trouble; }
  [[nodiscard]] int line() const { return _line; }

private:
  bool pass(std::string_view start, std::string_view end);
  bool pass_doctype();
  bool fail(const char* why);
  void advance(std::size_t to);
  void skip_space();
  std::string_view word();
  bool attribute(Tag& tag);

  std::string_view _text;
  std::size_t _at = 0;
  int _line = 1;
  std::string _trouble;
};
} // namespace remap::xml
