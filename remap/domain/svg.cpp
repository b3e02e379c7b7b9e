// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/drawing.h"
#include "remap/domain/svg_path.h"
#include "remap/domain/xml.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace remap
{
namespace
{
using svg::Affine;
using svg::Pen;
using xml::Tag;

/// What an element hands on to those inside it.
struct Style
{
  std::string_view name;
  Affine place;
  FillRule rule = FillRule::nonzero; // SVG's own default
  bool filled = true;
  bool hidden = false; ///< only defined, not drawn
};

/// `key` of style="…; key: value; …", or the attribute of that name.
std::string_view property(const Tag& tag, std::string_view key)
{
  const auto trimmed = [](std::string_view s)
  {
    const std::size_t from = s.find_first_not_of(" \t\r\n");
    if (from == std::string_view::npos)
      return std::string_view();
    return s.substr(from, s.find_last_not_of(" \t\r\n") - from + 1);
  };
  if (const auto* style = tag.find("style"))
    for (std::string_view rest = style->value; not rest.empty();)
    {
      const std::size_t end = std::min(rest.find(';'), rest.size());
      const std::string_view part = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const std::size_t colon = part.find(':');
      if (colon != std::string_view::npos
          and trimmed(part.substr(0, colon)) == key)
        return trimmed(part.substr(colon + 1));
    }
  const auto* attribute = tag.find(key);
  return attribute ? trimmed(attribute->value) : std::string_view();
}

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& of)
{
  return std::ranges::find(of, name) != of.end();
}

constexpr std::array<std::string_view, 6> figures = {
    "path", "polygon", "polyline", "rect", "circle", "ellipse"};
constexpr std::array<std::string_view, 8> definitions = {
    "defs",    "clipPath", "mask",           "symbol",
    "pattern", "marker",   "linearGradient", "radialGradient"};
constexpr std::array<std::string_view, 4> unreadable = {"text", "use", "image",
                                                        "foreignObject"};

class Svg
{
public:
  Svg(std::string_view text, double tolerance)
      : _in(text), _tolerance(tolerance)
  {
  }

  Drawing read()
  {
    Tag tag;
    while (_in.next(tag))
    {
      if (tag.opens)
        open(tag);
      if (tag.closes)
        close(tag);
    }
    if (not _in.trouble().empty())
      trouble(_in.line(), _in.trouble());
    else if (not _is_svg)
      trouble(0, "is no SVG: it has no <svg> element");
    else if (not _open.empty())
      trouble(_in.line(),
              "<" + std::string(_open.back().name) + "> has no end");
    else if (_out.shapes.empty() and _out.troubles.empty())
      trouble(0, "has no filled path");
    return std::move(_out);
  }

private:
  void trouble(int line, std::string what)
  {
    _out.troubles.push_back({line, std::move(what)});
  }

  void open(const Tag& tag)
  {
    _is_svg = _is_svg or tag.name == "svg";
    // The drawing's y points down, ours up.
    Style style;
    style.place = {1, 0, 0, -1, 0, 0};
    if (not _open.empty())
      style = _open.back();
    style.name = tag.name;
    if (const auto* t = tag.find("transform"))
      svg::read_transform(t->value, t->line, style.place, _out.troubles);
    const std::string_view rule = property(tag, "fill-rule");
    if (rule == "evenodd")
      style.rule = FillRule::evenodd;
    else if (rule == "nonzero")
      style.rule = FillRule::nonzero;
    else if (not rule.empty() and rule != "inherit")
      trouble(tag.line, "fill-rule must be evenodd or nonzero, is '"
                            + std::string(rule) + "'");
    if (const auto fill = property(tag, "fill"); not fill.empty())
      style.filled = fill != "none" and fill != "transparent";
    style.hidden = style.hidden or is_one_of(tag.name, definitions)
                   or property(tag, "display") == "none";
    _open.push_back(style);
    if (style.hidden)
      return;
    if (is_one_of(tag.name, unreadable))
      trouble(tag.line,
              "<" + std::string(tag.name) + "> cannot be read; make it a path");
    else if (style.filled and is_one_of(tag.name, figures))
      draw(tag, style);
  }

  void close(const Tag& tag)
  {
    if (_open.empty() or _open.back().name != tag.name)
      trouble(tag.line,
              "</" + std::string(tag.name) + "> closes "
                  + (_open.empty()
                         ? "nothing"
                         : "<" + std::string(_open.back().name) + ">"));
    if (not _open.empty())
      _open.pop_back();
  }

  void draw(const Tag& tag, const Style& style)
  {
    Pen pen(style.place, _tolerance);
    if (tag.name == "path")
    {
      if (const auto* d = tag.find("d"))
        svg::draw_path(d->value, d->line, pen, _out.troubles);
      else
        trouble(tag.line, "a <path> without d");
    }
    else if (tag.name == "polygon" or tag.name == "polyline")
      polygon(tag, pen);
    else if (tag.name == "rect")
      rectangle(tag, pen);
    else
      ellipse(tag, pen);
    // A move that draws nothing makes no ring.
    Shape shape{{}, style.rule};
    for (std::size_t r = 0; r < pen.rings.size(); ++r)
      if (pen.rings[r].size() > 1)
      {
        shape.rings.push_back(std::move(pen.rings[r]));
        _out.lines.push_back(std::move(pen.lines[r]));
      }
    if (not shape.rings.empty())
      _out.shapes.push_back(std::move(shape));
  }

  /// A number, the user's units; px after it mean the same.
  bool number(const Tag& tag, std::string_view name, double standard, double& x)
  {
    x = standard;
    const auto* a = tag.find(name);
    if (not a)
      return true;
    svg::Scanner in(a->value, a->line);
    if (in.number(x) and (in.done() or in.word() == "px") and in.done())
      return true;
    trouble(a->line, "<" + std::string(tag.name) + ">: " + std::string(name)
                         + " must be a number, is '" + std::string(a->value)
                         + "'");
    return false;
  }

  bool positive(const Tag& tag, std::string_view name, double x)
  {
    if (x > 0)
      return true;
    trouble(tag.line, "<" + std::string(tag.name) + ">: " + std::string(name)
                          + " must be > 0");
    return false;
  }

  void polygon(const Tag& tag, Pen& pen)
  {
    const auto* a = tag.find("points");
    if (not a)
      return trouble(tag.line, "a <polygon> without points");
    svg::Scanner in(a->value, a->line);
    for (bool first = true; not in.done(); first = false)
    {
      Point p;
      if (not in.number(p.x) or not in.number(p.y))
        return trouble(in.line(),
                       "points: two numbers are expected, found " + in.here());
      if (first)
        pen.move(p, in.line());
      else
        pen.line(p, in.line());
    }
  }

  void rectangle(const Tag& tag, Pen& pen)
  {
    double x = 0, y = 0, w = 0, h = 0, rx = 0, ry = 0;
    if (not(number(tag, "x", 0, x) and number(tag, "y", 0, y)
            and number(tag, "width", 0, w) and number(tag, "height", 0, h)
            and number(tag, "rx", -1, rx) and number(tag, "ry", rx, ry)
            and positive(tag, "width", w) and positive(tag, "height", h)))
      return;
    rx = std::clamp(rx < 0 ? ry : rx, 0.0, w / 2);
    ry = std::clamp(ry < 0 ? rx : ry, 0.0, h / 2);
    const int line = tag.line;
    const Point r{rx, ry};
    pen.move({x + rx, y}, line);
    pen.line({x + w - rx, y}, line);
    pen.arc_to(r, 0, false, true, {x + w, y + ry}, line);
    pen.line({x + w, y + h - ry}, line);
    pen.arc_to(r, 0, false, true, {x + w - rx, y + h}, line);
    pen.line({x + rx, y + h}, line);
    pen.arc_to(r, 0, false, true, {x, y + h - ry}, line);
    pen.line({x, y + ry}, line);
    pen.arc_to(r, 0, false, true, {x + rx, y}, line);
  }

  void ellipse(const Tag& tag, Pen& pen)
  {
    double x = 0, y = 0, rx = 0, ry = 0;
    const bool round = tag.name == "circle";
    if (not(number(tag, "cx", 0, x) and number(tag, "cy", 0, y)
            and number(tag, round ? "r" : "rx", 0, rx)
            and number(tag, round ? "r" : "ry", 0, ry)
            and positive(tag, round ? "r" : "rx", rx)
            and positive(tag, round ? "r" : "ry", ry)))
      return;
    pen.move({x + rx, y}, tag.line);
    pen.arc({x, y}, {rx, 0}, {0, ry}, 0, 2 * std::numbers::pi, tag.line);
  }

  xml::Reader _in;
  double _tolerance;
  std::vector<Style> _open;
  bool _is_svg = false;
  Drawing _out;
};
} // namespace

Drawing read_svg(std::string_view text, double tolerance)
{
  return Svg(text, tolerance).read();
}
} // namespace remap
