// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/progress.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <sstream>

using namespace mmale::output;
using Catch::Matchers::ContainsSubstring;

namespace
{
/// A progress whose wall clock the test moves by hand.
struct Bench
{
  explicit Bench(Progress::Style style, int columns = 100)
      : progress(
            0, 2, style, out, [columns] { return columns; },
            [this] { return now; })
  {
  }

  /// What was written since the last call.
  std::string said()
  {
    std::string text = out.str();
    out.str("");
    return text;
  }

  double now = 100; // [s]
  std::ostringstream out;
  Progress progress;
};
} // namespace

TEST_CASE("progress: plain lines come every tenth of the run")
{
  Bench b(Progress::Style::lines);
  int lines = 0;
  for (int i = 1; i <= 1000; ++i)
  {
    b.now += 0.001;
    b.progress.show({.time = 0.002 * i, .size = 0.002, .number = i});
  }
  const std::string text = b.said();
  lines = static_cast<int>(std::ranges::count(text, '\n'));
  CHECK(lines == 10);
  CHECK(text.find_first_of("\r\x1b") == std::string::npos);
}

TEST_CASE("progress: a slow run gives a sign of life every 30 s")
{
  Bench b(Progress::Style::lines);
  b.now += 10;
  b.progress.show({.time = 0.01, .number = 1});
  CHECK(b.said().empty());
  b.now += 20;
  b.progress.show({.time = 0.02, .size = 0.01, .number = 2, .iterations = 5});
  const std::string text = b.said();
  CHECK_THAT(text, ContainsSubstring("step 2"));
  CHECK_THAT(text, ContainsSubstring("Newton 5"));
  CHECK_THAT(text, ContainsSubstring("dt 0.01 s"));
  // A hundredth took 30 s: 99 more of them, 2970 s.
  CHECK_THAT(text, ContainsSubstring("left 49 min 30 s"));
}

TEST_CASE("progress: a resumed run knows that the first part took no time")
{
  Bench b(Progress::Style::lines);
  b.progress.resume({.time = 1, .number = 10}); // half of the run
  b.now += 40;
  b.progress.show({.time = 1.2, .size = 0.1, .number = 12});
  // a tenth took 40 s: four more of them
  CHECK_THAT(b.said(), ContainsSubstring("left 2 min 40 s"));
}

TEST_CASE("progress: the bar is redrawn in place and fits the terminal")
{
  for (int columns : {20, 40, 80, 200})
  {
    Bench b(Progress::Style::bar, columns);
    b.now += 5;
    b.progress.show({.time = 1, .size = 0.1, .number = 10, .iterations = 3});
    const std::string text = b.said();
    CHECK(text.front() == '\r');
    CHECK(text.find('\n') == std::string::npos);
    CHECK(text.size() - 1 - std::string("\x1b[K").size()
          < static_cast<std::size_t>(columns));
    CHECK_THAT(text, ContainsSubstring("50 %"));
    if (columns >= 80)
    {
      CHECK_THAT(text, ContainsSubstring("left 5 s"));
      CHECK(std::ranges::count(text, '=') > 0);
      CHECK(std::ranges::count(text, ' ') > std::ranges::count(text, '='));
    }
  }
}

TEST_CASE("progress: a quick run does not spend its time on the bar")
{
  Bench b(Progress::Style::bar);
  for (int i = 1; i <= 1000; ++i)
  {
    b.now += 0.001;
    b.progress.show({.time = 0.0019 * i});
  }
  // 1 s at 10 pictures a second, and the first.
  CHECK(std::ranges::count(b.said(), '\r') <= 11);
}

TEST_CASE("progress: a note stands above the bar")
{
  Bench b(Progress::Style::bar);
  b.progress.show({.time = 1});
  b.said();
  b.progress.note("step halved");
  const std::string text = b.said();
  CHECK(text.starts_with("\r\x1b[Kstep halved\n\r 50 %"));
}

TEST_CASE("progress: quiet says nothing but a bad end")
{
  {
    Bench b(Progress::Style::quiet);
    b.progress.show({.time = 1});
    b.progress.note("step halved");
    b.progress.finish("completed");
    CHECK(b.said().empty());
  }
  Bench b(Progress::Style::quiet);
  b.progress.finish("stopped: cell 7 inverts");
  CHECK_THAT(b.said(), ContainsSubstring("cell 7 inverts"));
}

TEST_CASE("progress: durations read as one would say them")
{
  CHECK(duration(0.2) == "0 s");
  CHECK(duration(59.4) == "59 s");
  CHECK(duration(185) == "3 min 05 s");
  CHECK(duration(7620) == "2 h 07 min");
}
