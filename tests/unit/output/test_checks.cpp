// SPDX-License-Identifier: LGPL-3.0-or-later
#include "folder.h"
#include "output/checks.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <limits>

using namespace mmale::output;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace
{
const std::vector<std::string> names = {"time", "z_B", "p_sy"};
const std::vector<std::string> ledger_names = {"mass", "volume"};

References references(const std::string& text)
{
  const Folder folder;
  put(folder.path / "reference.toml", text);
  return read_references(folder.path / "reference.toml", names, ledger_names);
}

/// z_B = t, p_sy = 1 + 10 z_B until 0.2, then 3.
Curves run(double end = 0.25)
{
  Curves out(names);
  for (double t : {0.0, 0.1, 0.2, 0.25})
    if (t <= end)
      out.add(std::vector<double>{t, t, std::min(1 + 10 * t, 3.0)});
  return out;
}

Check only(const std::string& text, const Curves& curves,
           const Ledger& ledger = {})
{
  const References r = references(text);
  for (const std::string& c : r.complaints)
    UNSCOPED_INFO(c);
  REQUIRE(r.complaints.empty());
  REQUIRE(r.entries.size() == 1);
  return evaluate(r.entries, curves, ledger).front();
}
} // namespace

TEST_CASE("checks: a curve is read where another passes a value")
{
  const std::string text = R"([p]
curve = "p_sy"
at = { z_B = 0.05 }
value = 1.5
rtol = 1e-12
source = "a straight line"
)";
  const Check c = only(text, run());
  CHECK(c.value.value() == Approx(1.5).epsilon(1e-14));
  CHECK(c.holds);
  CHECK(c.reference.source == "a straight line");
  CHECK(c.reference.name == "p");
}

TEST_CASE("checks: a place that the run did not reach does not hold")
{
  const std::string text = R"([p]
curve = "p_sy"
at = { z_B = 0.25 }
value = 3
atol = 100
)";
  CHECK(only(text, run(0.25)).holds);
  const Check c = only(text, run(0.2));
  CHECK_FALSE(c.holds);
  CHECK_FALSE(c.value.has_value());
  CHECK_FALSE(only(text, run(-1)).holds); // no row at all
}

TEST_CASE("checks: tolerances are sharp on both sides")
{
  const auto at = [](const std::string& tail)
  {
    return only("[p]\ncurve = \"p_sy\"\ntake = \"last\"\n" + tail, run()).holds;
  };
  CHECK(at("value = 3.1\natol = 0.11"));
  CHECK_FALSE(at("value = 3.1\natol = 0.09"));
  CHECK_FALSE(at("value = 2.9\natol = 0.09"));
  CHECK(at("value = 4.0\nrtol = 0.26"));
  CHECK_FALSE(at("value = 4.0\nrtol = 0.24"));
  CHECK_FALSE(at("value = -3.0\nrtol = 0.1"));
  CHECK(at("at_least = 3.0"));
  CHECK_FALSE(at("at_least = 3.0001"));
  CHECK(at("at_most = 3"));
  CHECK_FALSE(at("at_most = 2.9999"));
}

TEST_CASE("checks: first, last, min and max of a curve")
{
  Curves curves(names);
  for (double p : {2.0, 5.0, -1.0, 4.0})
    curves.add(std::vector<double>{0, 0, p});
  const auto take = [&](const std::string& word)
  {
    return only("[p]\ncurve = \"p_sy\"\ntake = \"" + word + "\"\nat_least = 0",
                curves)
        .value.value();
  };
  CHECK(take("first") == 2);
  CHECK(take("last") == 4);
  CHECK(take("min") == -1);
  CHECK(take("max") == 5);
}

TEST_CASE("checks: NaN holds nothing")
{
  Curves curves(names);
  for (double p : {1.0, double(NAN), 3.0})
    curves.add(std::vector<double>{p, p, p});
  for (const char* what :
       {"take = \"max\"", "take = \"min\"", "at = { time = 2.0 }"})
  {
    INFO(what);
    CHECK_FALSE(only("[p]\ncurve = \"p_sy\"\n" + std::string(what)
                         + "\nvalue = 2\natol = 100",
                     curves)
                    .holds);
  }
}

TEST_CASE("checks: the ledger is judged by name")
{
  const Ledger ledger = {
      {.name = "volume", .unit = "m^2", .start = 1},
      {.name = "mass", .unit = "kg/m", .start = 2, .end = 2 - 4e-12}};
  const auto most = [&](const std::string& bound)
  {
    return only("[mass]\nledger = \"mass.relative_change\"\nat_most = " + bound,
                ledger.empty() ? run() : run(), ledger);
  };
  CHECK(most("3e-12").holds);
  // The gap is a loss of 2e-12: a bound holds for either sign.
  CHECK_FALSE(most("1e-12").holds);
  CHECK(most("3e-12").value.value() == Approx(-2e-12).epsilon(1e-3));
}

TEST_CASE("checks: the order of the file is kept")
{
  const References r = references("[z]\ncurve = \"z_B\"\ntake = \"last\"\n"
                                  "at_least = 0\n[a]\ncurve = \"p_sy\"\n"
                                  "take = \"last\"\nat_least = 0\n");
  REQUIRE(r.entries.size() == 2);
  CHECK(r.entries[0].name == "z");
  CHECK(r.entries[1].name == "a");
}

TEST_CASE("checks: wrong entries are told with file, line and remedy")
{
  struct Case
  {
    const char* text;
    const char* line;
    const char* words;
  };
  const auto c = GENERATE(
      Case{"[p]\ncurve = \"p_ys\"\ntake = \"last\"\nat_least = 0",
           ":2:", "no curve \"p_ys\"; did you mean \"p_sy\"?"},
      Case{"[p]\ncurve = \"p_sy\"\nat = { z_D = 1 }\nat_least = 0",
           ":3:", "no curve \"z_D\"; did you mean \"z_B\"?"},
      Case{"[p]\ncurve = \"p_sy\"\nat = 1\nat_least = 0",
           ":3:", "one curve and its value"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"lats\"\nat_least = 0",
           ":3:", "cannot take \"lats\"; did you mean \"last\"?"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nat_least = 0\nat_most=1",
           ":1:", "needs one of value, at_least, at_most, and has more"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nvalue = 1",
           ":1:", "needs one of rtol, atol, and has none"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nvalue = 0\nrtol = 1",
           ":5:", "give atol"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nvalue = 1\nrtol = -1",
           ":5:", "negative"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nvalue = \"3\"\nrtol = 1",
           ":4:", "value must be a finite number"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nvalue = nan\nrtol = 1",
           ":4:", "value must be a finite number"},
      Case{"[p]\ncurve = \"p_sy\"\ntake = \"last\"\nat_leats = 1",
           ":4:", "did you mean \"at_least\"?"},
      Case{"[p]\nledger = \"mas.end\"\nat_least = 1",
           ":2:", "the ledger has no \"mas\"; did you mean \"mass\"?"},
      Case{"[p]\nledger = \"mass\"\nat_least = 1",
           ":2:", "must end in a number's name"},
      Case{"[p]\nat_least = 1", ":1:", "needs one of curve, ledger"},
      Case{"\np = 1", ":2:", "must be a table"},
      Case{"[p]\ncurve = \"p_sy", ":2:", ""});
  const References r = references(c.text);
  REQUIRE_FALSE(r.complaints.empty());
  CHECK(r.entries.empty());
  std::string all;
  for (const std::string& complaint : r.complaints)
    all += complaint + '\n';
  CHECK_THAT(all, ContainsSubstring("reference.toml" + std::string(c.line)));
  CHECK_THAT(all, ContainsSubstring(c.words));
}

TEST_CASE("checks: all complaints come at once")
{
  const References r =
      references("[a]\ncurve = \"no\"\ntake = \"last\"\nat_least = 0\n"
                 "[b]\nledger = \"no.end\"\nat_least = 0\n");
  CHECK(r.complaints.size() == 2);
  const References missing =
      read_references("/nowhere/reference.toml", names, ledger_names);
  REQUIRE(missing.complaints.size() == 1);
  CHECK_THAT(missing.complaints[0], ContainsSubstring("cannot be read"));
}

TEST_CASE("checks: interpolation finds the first passage, up and down")
{
  const std::vector<double> x = {0, 2, 1, 3}, y = {0, 4, 10, 20};
  CHECK(interpolate(x, y, 1.5).value() == 3);
  CHECK(interpolate(x, y, 2.5).value() == 17.5);
  CHECK(interpolate(x, y, 3).value() == 20);
  CHECK_FALSE(interpolate(x, y, 3.1).has_value());
  CHECK_FALSE(interpolate(x, y, -0.1).has_value());
  CHECK_FALSE(interpolate({}, {}, 0).has_value());
  const std::vector<double> down = {1, 0}, z = {5, 7};
  CHECK(interpolate(down, z, 0.25).value() == 6.5);
  // The end of a run, short of its place by round-off.
  const std::vector<double> t = {0, 0.25 * (1 - 1e-15)}, p = {0, 3};
  CHECK(interpolate(t, p, 0.25).value() == 3);
}

TEST_CASE("checks: the table for the screen tells what failed")
{
  const References r =
      references("[here]\ncurve = \"z_B\"\ntake = \"last\"\nat_least = 0.2\n"
                 "[there]\ncurve = \"p_sy\"\nat = { z_B = 0.9 }\n"
                 "value = 3\nrtol = 0.1\n");
  const std::vector<Check> checks = evaluate(r.entries, run(), {});
  CHECK_FALSE(all_hold(checks));
  const std::string text = table(checks);
  CHECK_THAT(text, ContainsSubstring("holds  here"));
  CHECK_THAT(text, ContainsSubstring("FAILS  there"));
  CHECK_THAT(text, ContainsSubstring("not reached"));
}
