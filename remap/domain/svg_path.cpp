// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/svg_path.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace remap::svg
{
namespace
{
constexpr double radian = std::numbers::pi / 180;

double length(Point p)
{
  return std::hypot(p.x, p.y);
}
} // namespace

// --- pen
// ----------------------------------------------------------------------

void Pen::put(Point p, int line)
{
  rings.back().push_back(_place(p));
  lines.back().push_back(line);
}

void Pen::move(Point p, int line)
{
  _at = _start = p;
  rings.emplace_back();
  lines.emplace_back();
  put(p, line);
}

void Pen::line(Point p, int line)
{
  put(p, line);
  _at = p;
}

void Pen::close()
{
  _at = _start;
}

/// Chords of a curve over t in [0, 1] with this bound of its second derivative:
/// none is farther from it than second / (8 n²). A few at least: then the box
/// around them tells the size of the drawing, whatever the tolerance.
int Pen::chords(double second) const
{
  constexpr double least = 8, most = 1e5;
  const double n = std::ceil(std::sqrt(second / (8 * _tolerance)));
  return static_cast<int>(std::clamp(n, least, most));
}

void Pen::quadratic(Point c, Point p, int line)
{
  const Point a = _at;
  const int n = chords(2 * length(_place.turn(a - 2 * c + p)));
  for (int i = 1; i < n; ++i)
  {
    const double t = static_cast<double>(i) / n, s = 1 - t;
    put(s * s * a + 2 * s * t * c + t * t * p, line);
  }
  this->line(p, line);
}

void Pen::cubic(Point c, Point d, Point p, int line)
{
  const Point a = _at;
  const int n = chords(6
                       * std::max(length(_place.turn(a - 2 * c + d)),
                                  length(_place.turn(c - 2 * d + p))));
  for (int i = 1; i < n; ++i)
  {
    const double t = static_cast<double>(i) / n, s = 1 - t;
    put(s * s * s * a + 3 * s * s * t * c + 3 * s * t * t * d + t * t * t * p,
        line);
  }
  this->line(p, line);
}

void Pen::arc(Point centre, Point u, Point v, double from, double to, int line)
{
  const Point p = _place.turn(u), q = _place.turn(v);
  const double angle = to - from;
  const int n = chords(std::hypot(length(p), length(q)) * angle * angle);
  for (int i = 1; i < n; ++i)
  {
    const double t = from + angle * i / n;
    put(centre + std::cos(t) * u + std::sin(t) * v, line);
  }
}

/// @source SVG 2, implementation notes B.2.4 and B.2.5
void Pen::arc_to(Point radii, double turn_deg, bool large, bool sweep, Point p,
                 int line)
{
  double rx = std::abs(radii.x), ry = std::abs(radii.y);
  if (rx == 0 or ry == 0 or p == _at)
    return this->line(p, line);
  const double c = std::cos(turn_deg * radian), s = std::sin(turn_deg * radian);
  const Point h = 0.5 * (_at - p);
  const Point q{c * h.x + s * h.y, c * h.y - s * h.x};
  const double over = q.x * q.x / (rx * rx) + q.y * q.y / (ry * ry);
  if (over > 1)
    rx *= std::sqrt(over), ry *= std::sqrt(over);
  const double away = std::sqrt(std::max(0.0, 1 / std::min(over, 1.0) - 1))
                      * (large == sweep ? -1 : 1);
  const Point k{away * rx * q.y / ry, -away * ry * q.x / rx};
  const Point centre =
      middle(_at, p) + Point{c * k.x - s * k.y, s * k.x + c * k.y};
  const double from = std::atan2((q.y - k.y) / ry, (q.x - k.x) / rx);
  double to = std::atan2((-q.y - k.y) / ry, (-q.x - k.x) / rx);
  if (sweep and to < from)
    to += 2 * std::numbers::pi;
  if (not sweep and to > from)
    to -= 2 * std::numbers::pi;
  arc(centre, {rx * c, rx * s}, {-ry * s, ry * c}, from, to, line);
  this->line(p, line);
}

// --- scanner
// -------------------------------------------------------------------

char Scanner::take()
{
  const char c = _text[_at++];
  _line += c == '\n';
  return c;
}

void Scanner::skip()
{
  while (
      _at < _text.size()
      and (std::isspace(static_cast<unsigned char>(peek())) or peek() == ','))
    take();
}

bool Scanner::done()
{
  skip();
  return _at >= _text.size();
}

std::string_view Scanner::word()
{
  skip();
  const std::size_t from = _at;
  while (std::isalpha(static_cast<unsigned char>(peek())))
    take();
  return _text.substr(from, _at - from);
}

bool Scanner::number(double& x)
{
  skip();
  std::size_t from = _at;
  if (peek() == '+')
    ++from;
  // Words such as "inf" are none.
  const char first =
      from + (from < _text.size() and _text[from] == '-') < _text.size()
          ? _text[from + (_text[from] == '-')]
          : '\0';
  if (not std::isdigit(static_cast<unsigned char>(first)) and first != '.')
    return false;
  const auto [end, error] =
      std::from_chars(_text.data() + from, _text.data() + _text.size(), x);
  if (error != std::errc() or not std::isfinite(x))
    return false;
  _at = static_cast<std::size_t>(end - _text.data());
  return true;
}

bool Scanner::flag(bool& x)
{
  skip();
  if (peek() != '0' and peek() != '1')
    return false;
  x = take() == '1';
  return true;
}

std::string Scanner::here() const
{
  return _at >= _text.size() ? "its end"
                             : "'" + std::string(_text.substr(_at, 12)) + "'";
}

// --- path
// ----------------------------------------------------------------------

namespace
{
class Path
{
public:
  Path(std::string_view data, int line, Pen& pen,
       std::vector<Trouble>& troubles)
      : _in(data, line), _pen(pen), _troubles(troubles)
  {
  }

  void draw()
  {
    while (not _in.done())
    {
      const char c = _in.peek();
      if (std::isalpha(static_cast<unsigned char>(c)))
        _command = _in.take();
      else if (_command == '\0' or _command == 'Z' or _command == 'z')
        return complain("a command is expected");
      if (not _moved and _command != 'M' and _command != 'm')
        return complain("path data begin with M", _command);
      if (not step())
        return;
    }
    if (not _moved)
      _troubles.push_back({_in.line(), "path data: are empty"});
  }

private:
  void complain(const std::string& what, char found = '\0')
  {
    _troubles.push_back(
        {_in.line(),
         "path data: " + what + ", found "
             + (found == '\0' ? _in.here()
                              : "'" + std::string(1, found) + "'")});
  }

  bool number(double& x)
  {
    if (_in.number(x))
      return true;
    complain("a number is expected after " + std::string(1, _command));
    return false;
  }

  /// A point, as the case of the command has it.
  bool point(Point& p)
  {
    if (not number(p.x) or not number(p.y))
      return false;
    if (relative())
      p = p + _pen.at();
    return true;
  }

  [[nodiscard]] bool relative() const { return _command >= 'a'; }

  /// After Z a new subpath may begin without M.
  void begin()
  {
    if (_closed)
      _pen.move(_pen.start(), _in.line());
    _closed = false;
  }

  /// The control point that goes on smoothly from the last one's.
  [[nodiscard]] Point mirrored(std::string_view after) const
  {
    const bool known = after.find(_before) != std::string_view::npos;
    return known ? 2 * _pen.at() - _control : _pen.at();
  }

  bool step()
  {
    const char kind =
        static_cast<char>(std::toupper(static_cast<unsigned char>(_command)));
    if (std::string_view("MLHVCSQTAZ").find(kind) == std::string_view::npos)
    {
      complain("unknown command", _command);
      return false;
    }
    if (kind == 'Z')
    {
      _pen.close();
      _closed = true;
    }
    else if (not draw(kind))
      return false;
    _before = kind;
    return true;
  }

  bool draw(char kind)
  {
    Point c, d, p = _pen.at();
    if (kind == 'M')
    {
      if (not point(p))
        return false;
      _pen.move(p, _in.line());
      _moved = true;
      _closed = false;
      _command = relative() ? 'l' : 'L'; // what follows without a letter
      return true;
    }
    const Point mirror = mirrored(kind == 'S' ? "CS" : "QT");
    if (kind == 'A')
      return arc();
    if (kind == 'H' or kind == 'V')
    {
      double& x = kind == 'H' ? p.x : p.y;
      const double from = x;
      if (not number(x))
        return false;
      x += relative() ? from : 0;
    }
    if ((kind == 'C' or kind == 'Q') and not point(c))
      return false;
    if ((kind == 'C' or kind == 'S') and not point(d))
      return false;
    if (kind != 'H' and kind != 'V' and not point(p))
      return false;
    begin();
    if (kind == 'S' or kind == 'T')
      c = mirror;
    if (kind == 'C' or kind == 'S')
      _pen.cubic(c, d, p, _in.line());
    else if (kind == 'Q' or kind == 'T')
      _pen.quadratic(c, p, _in.line());
    else
      _pen.line(p, _in.line());
    _control = kind == 'C' or kind == 'S' ? d : c;
    return true;
  }

  bool arc()
  {
    Point radii, p;
    double turn = 0;
    bool large = false, sweep = false;
    if (not number(radii.x) or not number(radii.y) or not number(turn))
      return false;
    if (not _in.flag(large) or not _in.flag(sweep))
    {
      complain("a flag of an arc is 0 or 1");
      return false;
    }
    if (not point(p))
      return false;
    begin();
    _pen.arc_to(radii, turn, large, sweep, p, _in.line());
    return true;
  }

  Scanner _in;
  Pen& _pen;
  std::vector<Trouble>& _troubles;
  char _command = '\0', _before = '\0';
  bool _moved = false, _closed = false;
  Point _control;
};

/// One function of a transform; nothing if it is none.
std::optional<Affine> transform(std::string_view name,
                                std::span<const double> n)
{
  if (name == "matrix" and n.size() == 6)
    return Affine{n[0], n[1], n[2], n[3], n[4], n[5]};
  if (name == "translate" and (n.size() == 1 or n.size() == 2))
    return Affine{1, 0, 0, 1, n[0], n.size() == 2 ? n[1] : 0};
  if (name == "scale" and (n.size() == 1 or n.size() == 2))
    return Affine{n[0], 0, 0, n.size() == 2 ? n[1] : n[0], 0, 0};
  if (name == "rotate" and (n.size() == 1 or n.size() == 3))
  {
    const double c = std::cos(n[0] * radian), s = std::sin(n[0] * radian);
    const Point o = n.size() == 3 ? Point{n[1], n[2]} : Point{};
    return Affine{1, 0, 0, 1, o.x, o.y} * Affine{c, s, -s, c, 0, 0}
           * Affine{1, 0, 0, 1, -o.x, -o.y};
  }
  if (name == "skewX" and n.size() == 1)
    return Affine{1, 0, std::tan(n[0] * radian), 1, 0, 0};
  if (name == "skewY" and n.size() == 1)
    return Affine{1, std::tan(n[0] * radian), 0, 1, 0, 0};
  return {};
}
} // namespace

void draw_path(std::string_view data, int line, Pen& pen,
               std::vector<Trouble>& troubles)
{
  Path(data, line, pen, troubles).draw();
}

bool read_transform(std::string_view text, int line, Affine& out,
                    std::vector<Trouble>& troubles)
{
  Scanner in(text, line);
  while (not in.done())
  {
    const std::string_view name = in.word();
    std::vector<double> numbers;
    bool good = false;
    if (in.skip(), in.peek() == '(')
    {
      in.take();
      for (double x = 0; in.number(x);)
        numbers.push_back(x);
      in.skip();
      good = in.peek() == ')';
    }
    if (good)
      in.take();
    const auto step = good ? transform(name, numbers) : std::nullopt;
    if (not step)
    {
      troubles.push_back(
          {in.line(),
           "transform: cannot be read at "
               + (name.empty() ? in.here() : "'" + std::string(name) + "'")});
      return false;
    }
    out = out * *step;
  }
  return true;
}
} // namespace remap::svg
