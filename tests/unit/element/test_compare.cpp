// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/compare.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace mmale::element;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace
{
struct Folder
{
  fs::path path = fs::temp_directory_path()
                  / ("mmale_element_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }

  Data write(const std::string& text, const std::string& x = "") const
  {
    std::ofstream(path / "data.csv") << text;
    return {.file = "data.csv", .folder = path.string(), .x = x};
  }
};

mmale::output::Curves curves(const std::vector<std::array<double, 2>>& rows)
{
  mmale::output::Curves out({"eps_a", "q"});
  for (const auto& row : rows)
    out.add(row);
  return out;
}
} // namespace

TEST_CASE("branches: a curve falls apart at the turns of its abscissa",
          "[element]")
{
  using Rows = std::vector<std::pair<std::size_t, std::size_t>>;
  const std::vector<double> up = {0, 1, 2, 3}, cycle = {0, 2, 4, 1, -2, 0, 3},
                            noisy = {0, 1, 0.995, 2, 3, 2.98, 1, 1.01, 0};
  CHECK(branches(up) == Rows{{0, 3}});
  CHECK(branches(cycle) == Rows{{0, 2}, {2, 4}, {4, 6}});
  // 1 % of 3 is 0.03: the smaller ways back are noise
  CHECK(branches(noisy) == Rows{{0, 4}, {4, 8}});
  CHECK(branches({}).empty());
}

TEST_CASE(
    "data: the difference is taken at the abscissa of each point, loading "
    "against loading",
    "[element]")
{
  const Folder folder;
  // q = 10 x upwards, q = 40 - 20 (3 - x) downwards, to -20 at 0
  const auto computed = curves({{0, 0}, {1, 10}, {3, 30}, {2, 20}, {0, -20}});
  const auto rms = [&](const std::string& text, const std::string& x = "")
  { return deviations(read_data(folder.write(text, x)), computed).at(0); };

  auto d = rms("eps_a,q\n0.5,5\n1.5,15\n3,30\n1,0\n");
  CHECK(d.points == 4);
  CHECK(d.outside == 0);
  CHECK(d.rms < 1e-12);

  d = rms(
      "# measured\r\n\r\neps_a, q\r\n0.5, 8\r\n1.5, 11\r\n3, 30\r\n1, 0\r\n");
  CHECK(d.rms == Approx(2.5)); // sqrt((9 + 16) / 4)

  d = rms("eps_a,q\n1,10\n2,22\n5,50\n");
  CHECK(d.points == 2);
  CHECK(d.outside == 1);
  CHECK(d.rms == Approx(std::sqrt(2.0)));

  d = rms("q,eps_a\n10,1\n30,2.5\n", "q");
  CHECK(d.column == "eps_a");
  CHECK(d.abscissa == "q");
  CHECK(d.rms == Approx(0.5 / std::sqrt(2.0)));
}

TEST_CASE("data: what is wrong with a file is told", "[element]")
{
  const Folder folder;
  const auto said = [&](const Data& data)
  {
    const auto all = read_data(data).complaints;
    REQUIRE(all.size() == 1);
    return all[0];
  };
  CHECK_THAT(said({.file = "no.csv", .folder = "some/where"}),
             ContainsSubstring("cannot read some/where/no.csv"));
  CHECK_THAT(said(folder.write("eps_a,q\n1,2\n3,x\n")),
             ContainsSubstring("data.csv:3: \"x\" is no number"));
  CHECK_THAT(said(folder.write("eps_a,q\n")), ContainsSubstring("has no row"));
  CHECK_THAT(said(folder.write("eps_a\n1\n")),
             ContainsSubstring("a column beside it"));
  CHECK_THAT(said(folder.write("eps_a,q\n1,2\n", "eps_b")),
             ContainsSubstring("did you mean 'eps_a'?"));
  const std::vector<std::string> known = {"eps_a", "sigma_a"};
  const auto table = read_data(folder.write("eps_a,sigma_b\n1,2\n"));
  const auto strange = strangers(table, known);
  REQUIRE(strange.size() == 1);
  CHECK_THAT(strange[0], ContainsSubstring("'sigma_b' is none of the test")
                             and ContainsSubstring("did you mean 'sigma_a'?"));
}
