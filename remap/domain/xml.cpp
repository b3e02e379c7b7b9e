// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/xml.h"

#include <algorithm>

namespace remap::xml
{
namespace
{
bool is_space(char c)
{
  return c == ' ' or c == '\t' or c == '\n' or c == '\r';
}

std::string_view local(std::string_view name)
{
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}
} // namespace

const Attribute* Tag::find(std::string_view name) const
{
  const auto at = std::ranges::find(attributes, name, &Attribute::name);
  return at == attributes.end() ? nullptr : &*at;
}

void Reader::advance(std::size_t to)
{
  to = std::min(to, _text.size());
  for (; _at < to; ++_at)
    _line += _text[_at] == '\n';
}

void Reader::skip_space()
{
  while (_at < _text.size() and is_space(_text[_at]))
    advance(_at + 1);
}

bool Reader::fail(const char* why)
{
  _trouble = why;
  return false;
}

/// Something without interest; false if it does not stand here.
bool Reader::pass(std::string_view start, std::string_view end)
{
  if (not _text.substr(_at).starts_with(start))
    return false;
  const std::size_t to = _text.find(end, _at + start.size());
  if (to == std::string_view::npos)
    _trouble = "what begins with " + std::string(start) + " has no end";
  else
    advance(to + end.size());
  return true;
}

bool Reader::pass_doctype()
{
  if (not _text.substr(_at).starts_with("<!"))
    return false;
  int depth = 0;
  for (std::size_t i = _at; i < _text.size(); ++i)
  {
    depth += (_text[i] == '[') - (_text[i] == ']');
    if (_text[i] == '>' and depth == 0)
    {
      advance(i + 1);
      return true;
    }
  }
  _trouble = "what begins with <! has no end";
  return true;
}

std::string_view Reader::word()
{
  std::size_t end = _at;
  while (end < _text.size() and not is_space(_text[end])
         and std::string_view("<>/='\"").find(_text[end])
                 == std::string_view::npos)
    ++end;
  const std::string_view out = _text.substr(_at, end - _at);
  _at = end;
  return out;
}

bool Reader::attribute(Tag& tag)
{
  Attribute a{local(word()), {}, 0};
  skip_space();
  if (a.name.empty() or _at >= _text.size() or _text[_at] != '=')
    return fail("a tag is not written as XML: an attribute needs a name, = and "
                "a value");
  advance(_at + 1);
  skip_space();
  const char quote = _at < _text.size() ? _text[_at] : ' ';
  if (quote != '"' and quote != '\'')
    return fail("the value of an attribute must stand in quotation marks");
  advance(_at + 1);
  const std::size_t end = _text.find(quote, _at);
  if (end == std::string_view::npos)
    return fail("the value of an attribute has no end");
  a.line = _line;
  a.value = _text.substr(_at, end - _at);
  advance(end + 1);
  tag.attributes.push_back(a);
  return true;
}

bool Reader::next(Tag& tag)
{
  for (;;)
  {
    advance(_text.find('<', _at));
    if (_at >= _text.size())
      return false;
    if (not pass("<!--", "-->") and not pass("<![CDATA[", "]]>")
        and not pass("<?", "?>") and not pass_doctype())
      break;
    if (not _trouble.empty())
      return false;
  }
  tag = {};
  tag.line = _line;
  advance(_at + 1);
  if (_at < _text.size() and _text[_at] == '/')
  {
    tag.opens = false;
    tag.closes = true;
    advance(_at + 1);
  }
  tag.name = local(word());
  if (tag.name.empty())
    return fail("a < that begins no tag");
  for (;;)
  {
    skip_space();
    if (_at >= _text.size())
      return fail("the file ends within a tag");
    if (_text[_at] == '>')
    {
      advance(_at + 1);
      return true;
    }
    if (_text[_at] == '/' and tag.opens)
    {
      tag.closes = true;
      advance(_at + 1);
      if (_at >= _text.size() or _text[_at] != '>')
        return fail("a / within a tag");
      continue;
    }
    if (not attribute(tag))
      return false;
  }
}
} // namespace remap::xml
