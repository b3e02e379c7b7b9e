// SPDX-License-Identifier: LGPL-3.0-or-later
// Runs on any number of processes; what it checks is the same on all.
#include "environment.h"
#include "mesh/domain.h"
#include "mesh/gmsh.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_session.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <set>

using namespace mmale;
using Catch::Approx;
using mesh::Domain;

namespace
{
const std::map<std::string, scene::Boundary> boundaries{
    {"punch", {.side = "top", .from = -scene::infinity, .to = 0.9}}};

mesh::Grid grid()
{
  scene::Mesh m;
  m.shape = "rectangle";
  m.width = 2;
  m.height = 1;
  m.cells = {10, 6};
  m.distortion = 0.3;
  m.diagonal = scene::Diagonal::alternating;
  return mesh::make_grid(m);
}

/// Sum over all processes.
std::vector<double> sum(std::vector<double> v)
{
  MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()), MPI_DOUBLE,
                MPI_SUM, MPI_COMM_WORLD);
  return v;
}

Domain domain()
{
  return mesh::make_domain(MPI_COMM_WORLD, grid(), boundaries);
}
} // namespace

TEST_CASE("every cell and node of the grid has one owner", "[unit][domain]")
{
  const Domain d = domain();
  std::vector<double> cells(2 * 10 * 6), nodes(11 * 7);
  for (int c = 0; c < d.num_owned_cells; ++c)
    cells.at(d.cell_id[c]) += 1;
  for (int n = 0; n < d.num_owned_nodes; ++n)
    nodes.at(d.node_id[n]) += 1;
  CHECK(std::ranges::all_of(sum(cells), [](double v) { return v == 1; }));
  CHECK(std::ranges::all_of(sum(nodes), [](double v) { return v == 1; }));
}

TEST_CASE("local cells are the grid's, counter-clockwise", "[unit][domain]")
{
  const Domain d = domain();
  const mesh::Grid g = grid();
  for (int c = 0; c < d.num_cells(); ++c)
  {
    std::set<std::int64_t> here, there;
    for (int v = 0; v < 3; ++v)
    {
      here.insert(d.node_id[d.cells[c][v]]);
      there.insert(g.cells[3 * d.cell_id[c] + v]);
    }
    CHECK(here == there);
    const auto [i, j, k] = d.cells[c];
    const auto& x = d.initial_x;
    CHECK((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
              - (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1])
          > 0);
  }
  for (int n = 0; n < d.num_nodes(); ++n)
    for (int k = 0; k < 2; ++k)
      CHECK(d.initial_x[2 * n + k] == g.x[2 * d.node_id[n] + k]);
}

TEST_CASE("all cells around the nodes of an owned cell are there",
          "[unit][domain]")
{
  const Domain d = domain();
  const mesh::Grid g = grid();
  std::vector<int> around_in_grid(g.x.size() / 2), around(d.num_nodes());
  for (auto n : g.cells)
    ++around_in_grid[n];
  for (const auto& cell : d.cells)
    for (int n : cell)
      ++around[n];
  for (int c = 0; c < d.num_owned_cells; ++c)
    for (int n : d.cells[c])
      CHECK(around[n] == around_in_grid[d.node_id[n]]);
}

TEST_CASE("named parts of a side are told from the rest of it",
          "[unit][domain]")
{
  const Domain d = domain();
  REQUIRE(
      d.boundary_names
      == std::vector<std::string>{"punch", "bottom", "right", "top", "left"});
  // lengths over owned cells: 0.8 of the top lies at midpoints below 0.9
  std::vector<double> length(5), nodes(5);
  for (const auto& f : d.facets)
  {
    const double *a = &d.initial_x[2 * f.a], *b = &d.initial_x[2 * f.b];
    if (f.cell < d.num_owned_cells)
      length[f.boundary] += std::hypot(b[0] - a[0], b[1] - a[1]);
    // the cell has the facet, opposite its local vertex, on the same way round
    CHECK(d.cells[f.cell][(f.local + 1) % 3] == f.a);
    CHECK(d.cells[f.cell][(f.local + 2) % 3] == f.b);
  }
  for (int b = 0; b < 5; ++b)
    for (int n : d.boundary_nodes(b))
      nodes[b] += n < d.num_owned_nodes;
  length = sum(length);
  nodes = sum(nodes);
  const double lengths[] = {0.8, 2, 1, 1.2, 1};
  const double counts[] = {5, 11, 7, 7, 7};
  for (int b = 0; b < 5; ++b)
  {
    INFO(d.boundary_names[b]);
    CHECK(length[b] == Approx(lengths[b]));
    CHECK(nodes[b] == counts[b]);
  }
  CHECK_THROWS_WITH(d.boundary("lid"),
                    Catch::Matchers::ContainsSubstring("'lid'"));
}

TEST_CASE("boundary nodes are known on ranks that hold no facet of it",
          "[unit][domain]")
{
  const Domain d = domain();
  const auto held = d.boundary_nodes(d.boundary("right")); // collective
  for (int n = 0; n < d.num_nodes(); ++n)
  {
    const bool right = std::abs(d.initial_x[2 * n] - 2) < 1e-12;
    CHECK(std::ranges::binary_search(held, n) == right);
  }
}

TEST_CASE("ghosts get their owner's values", "[unit][domain]")
{
  const Domain d = domain();
  std::vector<double> at_cells(2 * d.num_cells(), -1);
  for (int c = 0; c < d.num_owned_cells; ++c)
    for (int k = 0; k < 2; ++k)
      at_cells[2 * c + k] = 2.0 * d.cell_id[c] + k;
  d.cell_halo->update(at_cells, 2);
  for (int c = 0; c < d.num_cells(); ++c)
    for (int k = 0; k < 2; ++k)
      CHECK(at_cells[2 * c + k] == 2.0 * d.cell_id[c] + k);
  std::vector<double> at_nodes(d.num_nodes(), -1);
  for (int n = 0; n < d.num_owned_nodes; ++n)
    at_nodes[n] = static_cast<double>(d.node_id[n]);
  d.node_halo->update(at_nodes, 1);
  for (int n = 0; n < d.num_nodes(); ++n)
    CHECK(at_nodes[n] == static_cast<double>(d.node_id[n]));
}

TEST_CASE("a mesh from gmsh is the same body on any number of processes",
          "[unit][domain]")
{
  scene::Scene scene;
  scene.mesh.shape = "gmsh";
  scene.mesh.file = "ring.msh";
  scene.mesh.folder = MESHES;
  const Domain d = mesh::make_domain(
      MPI_COMM_WORLD, mesh::obtain_grid(MPI_COMM_WORLD, scene), {});
  REQUIRE(d.boundary_names
          == std::vector<std::string>{"inner", "level", "outer", "upright"});
  std::vector<double> length(4), edges(4), area(1);
  const auto& x = d.initial_x;
  for (const auto& f : d.facets)
  {
    const mesh::Side& side = d.sides.at(f.side);
    CHECK(side.boundary == f.boundary);
    if (f.cell >= d.num_owned_cells)
      continue;
    edges[f.boundary] += 1;
    length[f.boundary] +=
        std::hypot(x[2 * f.b] - x[2 * f.a], x[2 * f.b + 1] - x[2 * f.a + 1]);
  }
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    const auto [i, j, k] = d.cells[c];
    area[0] += 0.5
               * ((x[2 * j] - x[2 * i]) * (x[2 * k + 1] - x[2 * i + 1])
                  - (x[2 * k] - x[2 * i]) * (x[2 * j + 1] - x[2 * i + 1]));
  }
  length = sum(length);
  edges = sum(edges);
  area = sum(area);
  // arcs in n equal edges: 2 r n sin(pi / 4 n); the body between the polygons
  const double pi = std::acos(-1.0);
  const auto chords = [&](double r, double n)
  { return 2 * r * n * std::sin(pi / 4 / n); };
  const auto sector = [&](double r, double n)
  { return 0.5 * r * r * n * std::sin(pi / 2 / n); };
  CHECK(length[0] == Approx(chords(0.1, edges[0])).epsilon(1e-9));
  CHECK(length[2] == Approx(chords(0.2, edges[2])).epsilon(1e-9));
  CHECK(length[1] == Approx(0.1).epsilon(1e-9));
  CHECK(length[3] == Approx(0.1).epsilon(1e-9));
  CHECK(area[0]
        == Approx(sector(0.2, edges[2]) - sector(0.1, edges[0])).epsilon(1e-9));
  CHECK(d.extends(0) == std::array{true, true});
  CHECK(d.extends(1) == std::array{true, false});
  CHECK(d.extends(3) == std::array{false, true});

  scene.mesh.file = "missing.msh";
  CHECK_THROWS_WITH(mesh::obtain_grid(MPI_COMM_WORLD, scene),
                    Catch::Matchers::ContainsSubstring("no such file"));
}

TEST_CASE("the moved mesh can be written into the output's geometry",
          "[unit][domain]")
{
  Domain d = domain();
  std::vector<double> x = d.initial_x;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 2 * x[i] + 1;
  d.put_geometry(x);
  const auto points = d.mesh->geometry().dofmap();
  for (int c = 0; c < d.num_cells(); ++c)
  {
    double here[2] = {0, 0}, there[2] = {0, 0};
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 2; ++k)
      {
        here[k] += d.mesh->geometry().x()[3 * points(c, v) + k];
        there[k] += x[2 * d.cells[c][v] + k];
      }
    CHECK(here[0] == Approx(there[0]));
    CHECK(here[1] == Approx(there[1]));
  }
}

int main(int argc, char** argv)
{
  const Environment environment(argv[0], {});
  return Catch::Session().run(argc, argv);
}
