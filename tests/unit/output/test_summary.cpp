// SPDX-License-Identifier: LGPL-3.0-or-later
#include "folder.h"
#include "output/summary.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace mmale::output;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

TEST_CASE("summary: a run that has just begun says so")
{
  const Folder folder;
  const auto file = folder.path / "summary.json";
  Summary summary;
  summary.title = "Rotating pulse, 360°";
  write(file, summary);
  const json j = json::parse(read(file));
  CHECK(j["outcome"] == "running");
  CHECK(j["title"] == "Rotating pulse, 360°");
  CHECK(j["checks"].empty());
  CHECK_FALSE(j["versions"]["compiler"].get<std::string>().empty());
  CHECK_FALSE(j["versions"]["mmale"].get<std::string>().empty());
}

TEST_CASE("summary: what the run knows is in the file")
{
  Summary s;
  s.outcome = "completed";
  s.scene = R"({"title": "x", "mesh": {"size": 0.5}})";
  s.checks.push_back({.reference = {.name = "reached",
                                    .relation = Reference::Relation::at_least,
                                    .reference = 0.25},
                      .value = 0.26,
                      .holds = true});
  s.checks.push_back({.reference = {.name = "pressure",
                                    .reference = 3,
                                    .tolerance = 0.1,
                                    .source = "Prandtl"}});
  s.ledger.push_back({.name = "mass",
                      .unit = "kg/m",
                      .start = 4,
                      .end = 5,
                      .through_surface = 0.5,
                      .booked = 0.25});
  s.timers.push_back({.name = "2 smooth", .seconds = 1.5, .calls = 7});
  const json j = json::parse(to_json(s));
  CHECK(j["scene"]["mesh"]["size"] == 0.5);
  CHECK(j["checks"][0]["value"] == 0.26);
  CHECK(j["checks"][0]["relation"] == "at_least");
  CHECK(j["checks"][0]["holds"] == true);
  CHECK(j["checks"][1]["value"].is_null());
  CHECK(j["checks"][1]["holds"] == false);
  CHECK(j["checks"][1]["tolerance"] == 0.1);
  CHECK(j["checks"][1]["source"] == "Prandtl");
  // (5 - 4 - 0.5 - 0.25) / 4
  CHECK(j["ledger"][0]["relative_change"] == 0.0625);
  CHECK(j["timers"][0]["calls"] == 7);
}

TEST_CASE("summary: numbers that are none become null, not a broken file")
{
  Summary s;
  s.time = INFINITY;
  s.title = "\xff";
  s.scene = "no JSON";
  s.ledger.push_back({.name = "momentum", .unit = "Ns", .end = 1});
  const json j = json::parse(to_json(s));
  CHECK(j["time"].is_null());
  CHECK(j["ledger"][0]["relative_change"].is_null());
  CHECK(j["scene"] == "no JSON");
}

TEST_CASE("summary: a ledger's gap from nothing is measured by its scale")
{
  const LedgerEntry e{.name = "momentum", .unit = "Ns", .end = 1, .scale = 8};
  CHECK(e.relative_change() == 0.125);
}

TEST_CASE("summary: the commit comes from the launcher")
{
  ::setenv("MMALE_COMMIT", "abc123", 1);
  CHECK(Summary{}.commit == "abc123");
  ::unsetenv("MMALE_COMMIT");
  CHECK(Summary{}.commit == "unknown");
}

TEST_CASE("summary: a failed write leaves the older file whole")
{
  const Folder folder;
  const auto file = folder.path / "summary.json";
  write_atomically(file, "old\n");
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0)
  {
    // Stands for a disk that fills up.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {.rlim_cur = 30, .rlim_max = RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try
    {
      write_atomically(file, std::string(1000, 'x'));
    }
    catch (const std::runtime_error& error)
    {
      const std::string words = error.what();
      code = words.find("summary.json: File too large") != std::string::npos
                 ? 42
                 : 2;
    }
    ::_exit(code);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WEXITSTATUS(status) == 42);
  CHECK(read(file) == "old\n");
  CHECK_FALSE(std::filesystem::exists(folder.path / "summary.json.part"));
}

TEST_CASE("summary: an unwritable place is named")
{
  const Folder folder;
  CHECK_THROWS_WITH(write_atomically(folder.path / "no" / "summary.json", "x"),
                    ContainsSubstring("no/summary.json")
                        and ContainsSubstring("No such file"));
  std::filesystem::create_directory(folder.path / "summary.json");
  CHECK_THROWS_WITH(write_atomically(folder.path / "summary.json", "x"),
                    ContainsSubstring("Is a directory"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "summary.json.part"));
}
