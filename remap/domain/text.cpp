// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/drawing.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace remap
{
namespace
{
std::string_view trimmed(std::string_view s)
{
  s = s.substr(0, s.find('#'));
  const std::size_t from = s.find_first_not_of(" \t\r");
  if (from == std::string_view::npos)
    return {};
  return s.substr(from, s.find_last_not_of(" \t\r") - from + 1);
}

/// Two numbers and nothing else; otherwise what is wrong.
std::string read_point(std::string_view line, Point& p)
{
  double* const to[2] = {&p.x, &p.y};
  for (int k = 0; k < 2; ++k)
  {
    const std::size_t from = line.find_first_not_of(" \t,;");
    if (from == std::string_view::npos)
      return "a point is two numbers, x and y; found one";
    line.remove_prefix(from);
    const std::size_t end = std::min(line.find_first_of(" \t,;"), line.size());
    std::string_view word = line.substr(0, end);
    line.remove_prefix(end);
    const std::string said = "'" + std::string(word) + "'";
    if (word.size() > 1 and word[0] == '+')
      word.remove_prefix(1);
    const auto [last, error] =
        std::from_chars(word.data(), word.data() + word.size(), *to[k]);
    if (error == std::errc::result_out_of_range)
      return said + " is out of the range of numbers";
    if (error != std::errc() or last != word.data() + word.size())
      return said + " is no number";
    if (not std::isfinite(*to[k]))
      return said + " is not finite";
  }
  if (line.find_first_not_of(" \t,;") != std::string_view::npos)
    return "a point is two numbers, x and y; found more";
  return {};
}
} // namespace

Drawing read_text(std::string_view text)
{
  Drawing out;
  Shape shape;
  bool in_ring = false;
  int number = 0;
  while (not text.empty())
  {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, end);
    const std::string_view line = trimmed(whole);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty())
    {
      // A comment on a line of its own ends no ring.
      in_ring = in_ring and whole.find('#') != std::string_view::npos;
      continue;
    }
    Point p;
    if (const auto why = read_point(line, p); not why.empty())
    {
      out.troubles.push_back({number, why});
      continue;
    }
    if (not in_ring)
    {
      shape.rings.emplace_back();
      out.lines.emplace_back();
    }
    in_ring = true;
    shape.rings.back().push_back(p);
    out.lines.back().push_back(number);
  }
  if (shape.rings.empty() and out.troubles.empty())
    out.troubles.push_back({0, "has no points"});
  if (not shape.rings.empty())
    out.shapes.push_back(std::move(shape));
  return out;
}

std::string to_text(const Domain& domain)
{
  std::string out;
  char line[64];
  for (const Ring& ring : domain.rings())
  {
    out += out.empty() ? "" : "\n";
    for (const Point p : ring)
    {
      std::snprintf(line, sizeof line, "%.17g %.17g\n", p.x, p.y);
      out += line;
    }
  }
  return out;
}

std::vector<Trouble> Drawing::judge() const
{
  if (not troubles.empty())
    return troubles;
  std::vector<Trouble> out;
  for (const Fault& f : Domain::faults(shapes))
  {
    const bool known =
        f.ring < lines.size() and f.vertex < lines[f.ring].size();
    out.push_back({known ? lines[f.ring][f.vertex] : 0,
                   "ring " + std::to_string(f.ring + 1) + ": " + f.what,
                   f.crossing});
  }
  return out;
}
} // namespace remap
