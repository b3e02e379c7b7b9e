// SPDX-License-Identifier: LGPL-3.0-or-later
#include "folder.h"
#include "output/polygons.h"

#include <catch2/catch_test_macros.hpp>
#include <cstdlib>

using namespace mmale::output;

// A triangle and a square, whose coordinates need all digits; read back by VTK
// in read_back_polygons.py.
TEST_CASE("polygons: written for ParaView")
{
  const char* folder = std::getenv("MMALE_TEST_FOLDER");
  REQUIRE(folder);
  std::filesystem::create_directories(folder);
  const double third = 1. / 3;
  Polygons p;
  p.points = {0, 0,         third, 0,         0,   third, 1,
              1, 1 + third, 1,     1 + third, 1.5, 1,     1.5};
  p.offsets = {0, 3, 7};
  p.data["cell"] = {7, 123456789};
  p.data["share"] = {0.1, 1e-300};
  write(std::filesystem::path(folder) / "polygons.vtp", p);
  write(std::filesystem::path(folder) / "none.vtp", Polygons());
  CHECK_THROWS_AS(write("/no/such/folder/p.vtp", p), std::runtime_error);
}
