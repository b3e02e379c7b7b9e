// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Path data of an SVG, M L H V C S Q T A Z, absolute and relative, to closed
// rings: curves become chords that stay within a tolerance of them.
#pragma once

#include "remap/domain/drawing.h"

#include <string_view>

namespace remap::svg
{
/// x' = a x + c y + e, y' = b x + d y + f.
struct Affine
{
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;

  [[nodiscard]] constexpr Point operator()(Point p) const
  {
    return {a * p.x + c * p.y + e, b * p.x + d * p.y + f};
  }
  /// A direction.
  [[nodiscard]] constexpr Point turn(Point p) const
  {
    return {a * p.x + c * p.y, b * p.x + d * p.y};
  }
  /// First n, then this.
  [[nodiscard]] constexpr Affine operator*(const Affine& n) const
  {
    return {a * n.a + c * n.b, b * n.a + d * n.b,     a * n.c + c * n.d,
            b * n.c + d * n.d, a * n.e + c * n.f + e, b * n.e + d * n.f + f};
  }
};

/// Rings in the making: what pens draw, brought to the tolerance.
class Pen
{
public:
  /// @param[in] place where the drawing's points go; tolerance is measured
  ///                  there
  Pen(Affine place, double tolerance) : _place(place), _tolerance(tolerance) {}

  void move(Point p, int line);
  void line(Point p, int line);
  void quadratic(Point c, Point p, int line);
  void cubic(Point c, Point d, Point p, int line);
  /// From here around an ellipse, from angle to angle of its parameter.
  void arc(Point centre, Point u, Point v, double from, double to, int line);
  /// As SVG's A.
  void arc_to(Point radii, double turn_deg, bool large, bool sweep, Point p,
              int line);
  void close();

  [[nodiscard]] Point at() const { return _at; }
  [[nodiscard]] Point start() const { return _start; }

  std::vector<Ring> rings;
  std::vector<std::vector<int>> lines;

private:
  void put(Point p, int line);
  [[nodiscard]] int chords(double second) const;

  Affine _place;
  double _tolerance;
  Point _at, _start;
};

/// Numbers and words of path data, transforms and lists of points.
class Scanner
{
public:
  Scanner(std::string_view text, int line) : _text(text), _line(line) {}

  void skip(); ///< white space and commas
  [[nodiscard]] bool done();
  [[nodiscard]] char peek() const
  {
    return _at < _text.size() ? _text[_at] : '\0';
  }
  char take();
  std::string_view word();
  /// False, and nothing is taken, if no finite number stands here.
  bool number(double& x);
  /// One letter, 0 or 1: they may stand without space behind them.
  bool flag(bool& x);
  [[nodiscard]] int line() const { return _line; }
  /// What stands here, for a message.
  [[nodiscard]] std::string here() const;

private:
  std::string_view _text;
  std::size_t _at = 0;
  int _line;
};

/// Draw path data; what is wrong with it ends up in `troubles`.
void draw_path(std::string_view data, int line, Pen& pen,
               std::vector<Trouble>& troubles);

/// "translate(3 4) rotate(30)": false with a trouble if it cannot be read.
bool read_transform(std::string_view text, int line, Affine& out,
                    std::vector<Trouble>& troubles);
} // namespace remap::svg
