// SPDX-License-Identifier: LGPL-3.0-or-later
#include "folder.h"
#include "output/curves.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <csignal>
#include <limits>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace mmale::output;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("curves: names first, then a row a step that reads back exactly")
{
  const Folder folder;
  const auto file = folder.path / "curves.csv";
  const double x[] = {0.1, 1e-300, -2.0 / 3.0};
  {
    Curves curves(file, {"time", "z_B", "p_sy"});
    curves.add(x);
    CHECK(read(file).starts_with("time,z_B,p_sy\n0.1,1e-300,-0.666"));
    curves.add(std::vector<double>{1, NAN, 2});
    CHECK(curves.rows() == 2);
  }
  const Curves back = read_curves(file);
  CHECK(back.rows() == 2);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(back.column(back.names()[i])[0] == x[i]);
  CHECK(std::isnan(back.column("z_B")[1]));
  CHECK_FALSE(back.has("q"));
  CHECK_THROWS_AS(back.column("q"), std::out_of_range);
}

TEST_CASE("curves: each row is in the file as soon as it is added")
{
  const Folder folder;
  const auto file = folder.path / "curves.csv";
  Curves curves(file, {"time"});
  for (int i = 0; i < 5; ++i)
  {
    curves.add(std::vector<double>{double(i)});
    const std::string text = read(file);
    CHECK(std::ranges::count(text, '\n') == i + 2);
  }
}

TEST_CASE("curves: a killed run leaves whole rows only")
{
  const Folder folder;
  const auto file = folder.path / "curves.csv";
  for (int delay : {3000, 7000, 20000}) // [us]
  {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
      Curves curves(file, {"time", "a", "b", "c"});
      for (double i = 0;; ++i)
        curves.add(std::vector<double>{i, 1 / (i + 1), std::sin(i), -i});
    }
    ::usleep(static_cast<useconds_t>(delay));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFSIGNALED(status));
    const std::string text = read(file);
    if (text.empty())
      continue; // killed before it began
    CHECK(text.back() == '\n');
    const Curves back = read_curves(file); // throws on a short row
    for (std::size_t i = 0; i < back.rows(); ++i)
      REQUIRE(back.column("c")[i] == -static_cast<double>(i));
  }
}

TEST_CASE("curves: a full disk is named, with the file")
{
  CHECK_THROWS_WITH(Curves("/dev/full", {"time"}),
                    ContainsSubstring("/dev/full")
                        and ContainsSubstring("No space left"));
}

TEST_CASE("curves: a row that fits in part is taken back")
{
  const Folder folder;
  const auto file = folder.path / "curves.csv";
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0)
  {
    // A limit on the file's size cuts a write short, as a full disk does.
    std::signal(SIGXFSZ, SIG_IGN);
    int code = 1;
    try
    {
      Curves curves(file, {"time", "load"});
      const rlimit limit = {.rlim_cur = 30, .rlim_max = RLIM_INFINITY};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      for (int i = 0; i < 100; ++i)
        curves.add(std::vector<double>{0.125, 0.25});
    }
    catch (const std::runtime_error& error)
    {
      const std::string words = error.what();
      code = words.find("curves.csv") != std::string::npos ? 42 : 2;
    }
    ::_exit(code);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WEXITSTATUS(status) == 42);
  // 10 bytes of header, 11 a row: 30 bytes hold one row and part of the next.
  CHECK(read(file) == "time,load\n0.125,0.25\n");
}

TEST_CASE("curves: an unwritable folder is named")
{
  const Folder folder;
  CHECK_THROWS_WITH(Curves(folder.path / "missing" / "curves.csv", {"time"}),
                    ContainsSubstring("missing/curves.csv")
                        and ContainsSubstring("No such file"));
  // A file in the folder's place stops even root.
  put(folder.path / "file", "");
  CHECK_THROWS_WITH(Curves(folder.path / "file" / "curves.csv", {"time"}),
                    ContainsSubstring("Not a directory"));
}

TEST_CASE("curves: names and rows that make no table are refused")
{
  CHECK_THROWS_WITH(Curves({"a", "a"}), ContainsSubstring("\"a\""));
  CHECK_THROWS_WITH(Curves({"a,b"}), ContainsSubstring("a,b"));
  CHECK_THROWS_WITH(Curves({""}), ContainsSubstring("cannot name"));
  Curves curves({"a", "b"});
  CHECK_THROWS_WITH(curves.add(std::vector<double>{1}),
                    ContainsSubstring("1 numbers for 2 columns"));
}

TEST_CASE("curves: a damaged file is refused with its line")
{
  const Folder folder;
  const auto file = folder.path / "curves.csv";
  put(file, "a,b\n1,2\n3\n");
  CHECK_THROWS_WITH(read_curves(file), ContainsSubstring("curves.csv:3"));
  put(file, "a,b\n1,x\n");
  CHECK_THROWS_WITH(read_curves(file), ContainsSubstring("curves.csv:2"));
}
