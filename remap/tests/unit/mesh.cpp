// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/tests/meshes.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <stdexcept>

using namespace remap;
using meshes::Diagonal;

TEST_CASE("mesh: a rectangle has the facets that Euler's formula wants",
          "[mesh]")
{
  const Mesh mesh = meshes::rectangle(4, 3, Diagonal::right).mesh();
  REQUIRE(mesh.num_cells() == 24);
  REQUIRE(mesh.num_nodes() == 20);
  // V − E + F = 1 without the outer face.
  CHECK(mesh.num_facets() == 20 + 24 - 1);
  int boundary = 0;
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    boundary += mesh.on_boundary(f);
  CHECK(boundary == 14);
}

TEST_CASE(
    "mesh: the left cell of a facet walks it forwards, the right backwards",
    "[mesh]")
{
  const Mesh mesh = meshes::rectangle(5, 4, Diagonal::crossed).mesh();
  const auto walks = [&mesh](std::int32_t c, std::int32_t a, std::int32_t b)
  {
    const Triple& n = mesh.cell(c);
    for (int i = 0; i < 3; ++i)
      if (n[i] == a and n[(i + 1) % 3] == b)
        return true;
    return false;
  };
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
  {
    const auto [a, b] = mesh.facet(f);
    const auto [left, right] = mesh.facet_cells(f);
    CHECK(walks(left, a, b));
    if (right >= 0)
      CHECK(walks(right, b, a));
  }
}

TEST_CASE("mesh: neighbours are those that share a vertex", "[mesh]")
{
  const Mesh mesh = meshes::rectangle(5, 4, Diagonal::crossed).mesh();
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    std::set<std::int32_t> wanted;
    for (std::int32_t d = 0; d < mesh.num_cells(); ++d)
      for (std::int32_t i : mesh.cell(c))
        for (std::int32_t j : mesh.cell(d))
          if (i == j and c != d)
            wanted.insert(d);
    const auto got = mesh.cell_cells()[c];
    CHECK(std::set<std::int32_t>(got.begin(), got.end()) == wanted);
    CHECK(got.size() == wanted.size());
  }
}

TEST_CASE("mesh: clockwise cells are turned and say so", "[mesh]")
{
  meshes::Data data = meshes::rectangle(2, 2, Diagonal::right);
  std::swap(data.cells[4], data.cells[5]); // cell 1
  const Mesh mesh = data.mesh();
  CHECK(mesh.flipped(1));
  CHECK(not mesh.flipped(0));
  const Triple& n = mesh.cell(1);
  CHECK(
      twice_area(point(data.x, n[0]), point(data.x, n[1]), point(data.x, n[2]))
      > 0);
}

TEST_CASE("mesh: boundary facets carry their markers and chain up", "[mesh]")
{
  const meshes::Data data = meshes::rectangle(3, 3, Diagonal::crossed);
  const Mesh mesh = data.mesh();
  CHECK(mesh.num_markers() == 4);
  int count[4] = {};
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    if (mesh.on_boundary(f))
      ++count[mesh.marker(f)];
    else
      CHECK(mesh.marker(f) == -1);
  CHECK(std::all_of(count, count + 4, [](int n) { return n == 3; }));
  // Node 1 is on the bottom, between nodes 0 and 2.
  const auto [in, out] = mesh.boundary_facets(1);
  CHECK(mesh.facet(in) == Pair{0, 1});
  CHECK(mesh.facet(out) == Pair{1, 2});
  CHECK(mesh.boundary_facets(5) == Pair{-1, -1});
}

TEST_CASE("mesh: all complaints come at once", "[mesh]")
{
  meshes::Data data = meshes::rectangle(2, 2, Diagonal::right);
  MeshInput input = data.input();
  input.owned_cells = 100;
  input.owned_nodes = 100;
  data.markers.front() = -1;
  input.markers = data.markers;
  CHECK(Mesh::complaints(input).size() == 3);
  CHECK_THROWS_AS(Mesh(input), std::invalid_argument);
}

TEST_CASE("mesh: bad cells are named", "[mesh]")
{
  meshes::Data data = meshes::rectangle(2, 2, Diagonal::right);
  data.cells[0] = 77;
  CHECK(Mesh::complaints(data.input())
        == std::vector<std::string>{"cell 0: no such node"});
  data = meshes::rectangle(2, 2, Diagonal::right);
  data.cells[3] = data.cells[4];
  CHECK(Mesh::complaints(data.input())
        == std::vector<std::string>{"cell 1: no area"});
  data = meshes::rectangle(2, 2, Diagonal::right);
  // The first cell once more.
  data.cells.insert(data.cells.end(), data.cells.begin(),
                    data.cells.begin() + 3);
  CHECK_THROWS_AS(data.mesh(), std::invalid_argument);
}
