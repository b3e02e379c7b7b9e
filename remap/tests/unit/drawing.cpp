// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/domain/drawing.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace remap;
using Catch::Approx;

namespace
{
constexpr double pi = std::numbers::pi;

std::string svg(const std::string& inner)
{
  return "<svg xmlns=\"http://www.w3.org/2000/svg\">\n" + inner + "\n</svg>\n";
}

std::string path(const std::string& d, const std::string& more = "")
{
  return svg("<path " + more + " d=\"" + d + "\"/>");
}

Domain domain(const std::string& text, double tolerance = 1e-6)
{
  const Drawing drawing = read_svg(text, tolerance);
  for (const Trouble& t : drawing.judge())
    FAIL_CHECK("line " << t.line << ": " << t.what);
  return drawing.judge().empty() ? Domain(drawing.shapes) : Domain();
}

double area(const Domain& d)
{
  return d.moments<Geometry::plane>().v;
}

/// "line: what", the first trouble of a drawing.
std::string first(const Drawing& drawing)
{
  const auto troubles = drawing.judge();
  return troubles.empty()
             ? ""
             : std::to_string(troubles[0].line) + ": " + troubles[0].what;
}
} // namespace

TEST_CASE("text: rings, holes and comments", "[domain]")
{
  const Drawing d = read_text("# a box\n0 0\n 4\t0 # corner\n4,4\n0 +4\n"
                              "\n\n1 1\n# within a ring\n2 1\n1 2\r\n");
  REQUIRE(d.judge().empty());
  const Domain domain(d.shapes);
  CHECK(area(domain) == Approx(15.5));
  CHECK(d.lines[0] == std::vector{2, 3, 4, 5});
  CHECK(d.lines[1] == std::vector{8, 10, 11});
}

TEST_CASE("text: every mistake has its line", "[domain]")
{
  CHECK(first(read_text("")) == "0: has no points");
  CHECK(first(read_text("# nothing\n")) == "0: has no points");
  CHECK(first(read_text("0 0\n1 x\n0 1\n")) == "2: 'x' is no number");
  CHECK(first(read_text("0 0\n1\n0 1\n"))
        == "2: a point is two numbers, x and y; found one");
  CHECK(first(read_text("0 0\n1 2 3\n0 1\n"))
        == "2: a point is two numbers, x and y; found more");
  CHECK(first(read_text("0 0\n1 nan\n0 1\n")) == "2: 'nan' is not finite");
  CHECK(first(read_text("0 0\n1 1e999\n0 1\n"))
        == "2: '1e999' is out of the range of numbers");
  CHECK(first(read_text("0 0\n1 0\n1 1\n0 1\n\n5 5\n6 6\n"))
        == "6: ring 2: has 2 points; a ring needs 3 that differ");
  CHECK(first(read_text("\n0 0\n2 2\n2 0\n0 2\n"))
        == "2: ring 1: the ring crosses itself near (1, 1)");
  const Drawing two = read_text("a b\n0 0\nc 1\n");
  CHECK(two.troubles.size() == 2);
}

TEST_CASE("text: what is written is read again to the last bit", "[domain]")
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> radius(0.1, 1);
  Ring star;
  for (int i = 0; i < 40; ++i)
  {
    const double a = 2 * pi * i / 40;
    star.push_back(radius(random) * Point{std::cos(a), std::sin(a)});
  }
  const Domain d({star, {{0.01, 0}, {0.02, 0}, {0, 0.02}}});
  const Domain again(read_text(to_text(d)).shapes);
  CHECK(std::ranges::equal(d.rings(), again.rings()));
}

TEST_CASE("svg: each command of a path, absolute and relative", "[domain]")
{
  // The same box of 3 by 2, y down, all ways of writing lines.
  for (const char* d :
       {"M1 1 L4 1 L4 3 L1 3 Z", "M1,1 4,1 4,3 1,3", "m1 1 3 0 0 2-3 0z",
        "M1 1H4V3H1Z", "m1 1h3v2h-3z", "M1 1h1 2v1,1H1z",
        "M 1e0 .1e1 L 4.0 1 L+4 3 L 1 3 Z", "m.5.5m.5.5h3v2h-3z"})
  {
    INFO(d);
    const Domain box = domain(path(d));
    REQUIRE(box.rings().size() == 1);
    CHECK(area(box) == Approx(6));
    CHECK(box.low() == Point{1, -3}); // turned over
    CHECK(box.high() == Point{4, -1});
  }
}

TEST_CASE("svg: curves have their areas, to the tolerance", "[domain]")
{
  struct Case
  {
    const char* d;
    double area;
  };
  const double tolerance = 1e-6;
  // Parabola over a chord: two thirds of the box of its height, which is half
  // of its control point's. Cubic from Green's theorem: for control points
  // (0,0) (0,h) (b,h) (b,0) it is 3/5 b h. Arcs: half discs and ellipses.
  for (const Case& c :
       {Case{"M0 0Q1 2 2 0Z", 4. / 3},
        {"m0 0q1 2 2 0z", 4. / 3},
        // T goes on with the mirrored control: up, then down.
        {"M0 0Q1 2 2 0T4 0V-4H0Z", 16},
        {"M0 0q1 2 2 0t2 0v-4h-4z", 16},
        {"M0 0C0 1 3 1 3 0Z", 1.8},
        {"m0 0c0 1 3 1 3 0z", 1.8},
        {"M0 0C0 1 3 1 3 0S6-1 6 0V-4H0Z", 24},
        {"m0 0c0 1 3 1 3 0s3-1 3 0v-4h-6z", 24},
        {"M-1 0A1 1 0 0 1 1 0Z", pi / 2},
        {"M-1 0a1 1 0 002 0z", pi / 2},
        {"M-2 0A2 1 0 1 1 2 0A2 1 0 1 1-2 0", 2 * pi},
        // turned by 90 degrees, and radii too small for their chord
        {"M0-2A2 1 90 0 1 0 2Z", pi},
        {"M-1 0A.1.1 0 0 1 1 0Z", pi / 2},
        // three quarters of a disc with two radii
        {"M0 0H1A1 1 0 1 1 0-1Z", 0.75 * pi},
        {"M0 0h1a1 1 0 0 0-1-1z", 0.25 * pi}})
  {
    INFO(c.d);
    CHECK(area(domain(path(c.d), tolerance))
          == Approx(c.area).margin(16 * tolerance));
  }
}

TEST_CASE("svg: chords come as near to the curve as asked", "[domain]")
{
  double before = 1;
  for (const double tolerance : {1e-2, 1e-4, 1e-6})
  {
    const Domain d =
        domain(path("M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0Z"), tolerance);
    const auto ring = d.rings()[0];
    double worst = 0;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Point m = middle(ring[i], ring[(i + 1) % ring.size()]);
      worst = std::max(worst, 1 - std::hypot(m.x, m.y));
    }
    CHECK(worst < tolerance);
    CHECK(worst > 0.2 * tolerance); // and not for far too many points
    CHECK(worst < 0.1 * before);
    before = worst;
  }
  // Tolerances are of the place where the drawing ends up.
  const std::string d = "M0 0C0 1 3 1 3 0Z";
  const auto small = domain(path(d), 1e-3).rings()[0].size();
  const auto large =
      domain(path(d, "transform=\"scale(100)\""), 1e-3).rings()[0].size();
  CHECK(large > 9 * small);
  CHECK(large < 11 * small);
}

TEST_CASE("svg: transforms of paths and groups", "[domain]")
{
  const Domain d = domain(
      svg("<g transform=\"translate(10 0)\"><g transform='scale(2,3)'>"
          "<path transform=\"rotate(90)\" d=\"M0 0h1v2h-1z\"/></g></g>"));
  // y down: (x, y) → (−y, x) → (−2y, 3x) → 10 beside, then turned over
  CHECK(area(d) == Approx(12));
  CHECK(d.low().x == Approx(6));
  CHECK(d.high().x == Approx(10));
  CHECK(d.low().y == Approx(-3));
  CHECK(std::abs(d.high().y) < 1e-15);
  CHECK(area(domain(path("M0 0h1v1h-1z", "transform=\"matrix(2 0 1 3 5 6)\"")))
        == Approx(6));
  CHECK(area(domain(path("M0 0h1v1h-1z", "transform=\"skewX(30) skewY(20)\"")))
        == Approx(1));
  const Domain about = domain(
      path("M2 1h1v1h-1z", "transform=\"rotate(180, 2, 1), translate(1)\""));
  CHECK(std::abs(about.low().x) < 1e-14);
  CHECK(about.high().x == Approx(1));
}

TEST_CASE("svg: other figures, what is not filled, rules", "[domain]")
{
  CHECK(area(domain(svg("<rect x='1' y=\"2\" width='3px' height='4'/>")))
        == Approx(12));
  CHECK(area(domain(svg("<rect width='4' height='4' rx='1'/>")))
        == Approx(12 + pi).epsilon(1e-5));
  CHECK(area(domain(svg("<circle cx='1' cy='1' r='2'/>")))
        == Approx(4 * pi).epsilon(1e-5));
  CHECK(area(domain(svg("<ellipse rx='2' ry='3'/>")))
        == Approx(6 * pi).epsilon(1e-5));
  CHECK(area(domain(svg("<polygon points='0,0 2,0 2,1 0,1'/>"))) == Approx(2));
  // Only drawn lines, hidden or defined things are no area.
  const std::string box = "M0 0h1v1h-1z", far = "M5 5h1v1h-1z";
  CHECK(area(domain(svg("<!-- <path d='M9 9h9v9z'/> --><defs><path d='" + far
                        + "'/></defs><path fill='none' d='" + far
                        + "'/><g style='stroke:red; fill : none'><path d='"
                        + far + "'/></g><path style='display:none' d='" + far
                        + "'/><path d='" + box + "'/>")))
        == Approx(1));
  const std::string nested = "M0 0h4v4h-4zM1 1h2v2h-2z";
  CHECK(area(domain(path(nested))) == Approx(16));
  CHECK(area(domain(path(nested, "fill-rule=\"evenodd\""))) == Approx(12));
  CHECK(area(domain(path(nested, "style=\"fill-rule:evenodd\"")))
        == Approx(12));
  CHECK(area(domain(path("M0 0h4v4h-4zM1 1v2h2v-2z"))) == Approx(12));
  CHECK(area(domain("<?xml version=\"1.0\"?>\n<!DOCTYPE svg [ <!ENTITY a "
                    "\"b>\"> ]>\n"
                    + path(box)))
        == Approx(1));
}

TEST_CASE("svg: every mistake has its line", "[domain]")
{
  const auto of = [](const std::string& text)
  { return first(read_svg(text, 1e-3)); };
  CHECK(of("") == "0: is no SVG: it has no <svg> element");
  CHECK(of("0 0\n1 1\n") == "0: is no SVG: it has no <svg> element");
  CHECK(of("<html></html>") == "0: is no SVG: it has no <svg> element");
  CHECK(of(svg("<g/>")) == "0: has no filled path");
  CHECK(of(svg("<text>A</text>"))
        == "2: <text> cannot be read; make it a path");
  CHECK(of(path("M0 0L1 0\n1 x"))
            .starts_with(
                "3: path data: a number is expected after L, found 'x'"));
  CHECK(of(path("L1 0")) == "2: path data: path data begin with M, found 'L'");
  CHECK(of(path("M0 0h1v1z 5 5"))
            .starts_with("2: path data: a command is expected, found '5 5'"));
  CHECK(of(path("M0 0B1 1")) == "2: path data: unknown command, found 'B'");
  CHECK(of(path("M0 0A1 1 0 2 0 1 1"))
            .starts_with("2: path data: a flag of an arc is 0 or 1"));
  CHECK(
      of(path("M0 0L1 inf")).starts_with("2: path data: a number is expected"));
  CHECK(of(path("M0 0L1 1e999"))
            .starts_with("2: path data: a number is expected"));
  CHECK(of(path("M0 0L1")).ends_with("found its end"));
  CHECK(of(path("")) == "2: path data: are empty");
  CHECK(of(svg("<path/>")) == "2: a <path> without d");
  CHECK(of(path("M0 0h1v1z", "transform=\"turn(3)\""))
        == "2: transform: cannot be read at 'turn'");
  CHECK(of(path("M0 0h1v1z", "fill-rule=\"odd\""))
        == "2: fill-rule must be evenodd or nonzero, is 'odd'");
  CHECK(of(svg("<circle r='0'/>")) == "2: <circle>: r must be > 0");
  CHECK(of(svg("<circle r='1m'/>"))
        == "2: <circle>: r must be a number, is '1m'");
  CHECK(of("<svg>\n<path d='M0 0h1v1z'/>\n") == "3: <svg> has no end");
  CHECK(of("<svg>\n<g></svg>") == "2: </svg> closes <g>");
  CHECK(of("<svg>\n<path d=M0></svg>")
        == "2: the value of an attribute must stand in quotation marks");
  CHECK(of("<svg>\n<!-- no end") == "2: what begins with <!-- has no end");
  CHECK(of(path("M0 0L2 2L2 0\nL0 2z"))
            .ends_with("ring 1: the ring crosses itself near (1, -1)"));
}

TEST_CASE("svg: any bytes are read without a crash", "[domain]")
{
  const std::string good =
      svg("<g transform=\"translate(1 2)\"><path fill-rule='evenodd' "
          "d=\"M0 0C1 1 2 2 3 0S1 4 2 5Q3 4 1 2T5 5A1 2 30 0 1 9 "
          "9Z\"/><rect width='1' height='1'/></g>");
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> at(0, good.size() - 1);
  std::uniform_int_distribution<int> letter(1, 255);
  for (int i = 0; i < 3000; ++i)
  {
    std::string bad = good.substr(0, i < 500 ? at(random) : good.size());
    for (int k = 0; k < i % 5 and not bad.empty(); ++k)
      bad[at(random) % bad.size()] = static_cast<char>(letter(random));
    const Drawing d = read_svg(bad, 1e-2);
    CHECK((not d.judge().empty() or not d.shapes.empty()));
    CHECK_NOTHROW(read_text(bad).judge());
  }
}
