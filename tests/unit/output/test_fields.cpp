// SPDX-License-Identifier: LGPL-3.0-or-later
#include "compat.h"
#include "output/fields.h"
#include "output/on_root.h"
#include "output/probe.h"
#include "output/versions.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_session.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <dolfinx/fem/FunctionSpace.h>
#include <dolfinx/mesh/generation.h>
#include <fstream>
#include <mpi.h>
#include <petscsys.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

using namespace mmale::output;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using Mesh = dolfinx::mesh::Mesh<double>;

namespace
{
std::filesystem::path folder()
{
  const char* path = std::getenv("MMALE_TEST_FOLDER");
  REQUIRE(path);
  return path;
}

/// [0, 2] x [0, 1] in triangles, with a layer of ghosts.
std::shared_ptr<Mesh> rectangle(std::int64_t n = 6)
{
  return std::make_shared<Mesh>(dolfinx::mesh::create_rectangle<double>(
      MPI_COMM_WORLD, {{{0, 0}, {2, 1}}}, {2 * n, n},
      dolfinx::mesh::CellType::triangle,
      dolfinx::mesh::create_cell_partitioner(
          dolfinx::mesh::GhostMode::shared_facet)));
}

/// Coordinates of the P1 dofs, shape (local nodes, 3) [m].
std::vector<double> node_coordinates(std::shared_ptr<Mesh> mesh)
{
  return mmale::compat::lagrange_space(mesh, 1).tabulate_dof_coordinates(false);
}

/// Middles of the local cells, shape (local cells, 2) [m].
std::vector<mmale::scene::Point> middles(const Mesh& mesh)
{
  std::vector<mmale::scene::Point> out;
  const auto x = mesh.geometry().x();
  const auto cells = mesh.geometry().dofmap();
  for (std::size_t c = 0; c < cells.extent(0); ++c)
  {
    mmale::scene::Point m = {0, 0};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        m[k] += x[3 * static_cast<std::size_t>(cells(c, i)) + k] / 3;
    out.push_back(m);
  }
  return out;
}

/// u = (0.1 t x y, -0.2 t x), the motion of the mesh.
void move(Mesh& mesh, const std::vector<double>& start, double t)
{
  auto x = mesh.geometry().x();
  for (std::size_t i = 0; i < x.size(); i += 3)
  {
    x[i] = start[i] + 0.1 * t * start[i] * start[i + 1];
    x[i + 1] = start[i + 1] - 0.2 * t * start[i];
  }
}
} // namespace

TEST_CASE("fields: nodal and cell data on the moving mesh, for read_back.py")
{
  const auto mesh = rectangle();
  Fields fields(mesh, folder());
  const std::vector<double> start(mesh->geometry().x().begin(),
                                  mesh->geometry().x().end());
  const std::vector<double> at = node_coordinates(mesh);
  const auto middle = middles(*mesh);
  for (const double t : {0.0, 0.5, 1.0})
  {
    move(*mesh, start, t);
    std::vector<double> p, v, density, sigma;
    for (std::size_t i = 0; i < at.size(); i += 3)
    {
      p.push_back(3 + at[i] + t);
      v.insert(v.end(), {0.1 * at[i] * at[i + 1], -0.2 * at[i]});
    }
    for (const auto& m : middle)
    {
      density.push_back(m[0] + 10 * m[1]);
      sigma.insert(sigma.end(), {m[0], m[1], t, m[0] * m[1]});
    }
    const std::vector<NamedField> list = {
        {"p", Location::nodal, 1, p, "Pa"},
        {"velocity", Location::nodal, 2, v, "m/s"},
        {"density", Location::cell, 1, density, "kg/m^3"},
        {"stress", Location::cell, 4, sigma, "Pa"}};
    fields.write(t, list);
  }
  CHECK(fields.info().at("stress").unit == "Pa");
}

TEST_CASE("fields: an unwritable folder is told on all ranks")
{
  const auto file = folder() / "a_file";
  on_root(MPI_COMM_WORLD,
          [&]
          {
            std::filesystem::create_directories(folder());
            std::ofstream(file) << "";
          });
  CHECK_THROWS_AS(Fields(rectangle(), file / "results"), std::runtime_error);
}

TEST_CASE("fields: a file cut short by a full disk is told on all ranks")
{
  const auto mesh = rectangle();
  Fields fields(mesh, folder() / "full");
  const std::vector<double> x(middles(*mesh).size(), 1.0);
  const NamedField field{"x", Location::cell, 1, x, ""};
  fields.write(0, std::span(&field, 1));
  rlimit limit;
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small = {.rlim_cur = 1000, .rlim_max = limit.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string words;
  try
  {
    fields.write(1, std::span(&field, 1));
  }
  catch (const std::runtime_error& error)
  {
    words = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &limit);
  CHECK_THAT(words, ContainsSubstring("full/fields"));
}

TEST_CASE("fields: files of an older run go")
{
  const auto old = folder() / "again" / "fields_p7_000042.vtu";
  on_root(MPI_COMM_WORLD,
          [&]
          {
            std::filesystem::create_directories(old.parent_path());
            std::ofstream(old) << "";
          });
  const Fields fields(rectangle(2), folder() / "again");
  CHECK_FALSE(std::filesystem::exists(old));
}

TEST_CASE("fields: a resumed run keeps the earlier outputs it knows of")
{
  const auto mesh = rectangle();
  const auto place = folder() / "resumed";
  on_root(MPI_COMM_WORLD, [&] { std::filesystem::remove_all(place); });
  const std::vector<double> x(middles(*mesh).size(), 1.0);
  const NamedField field{"x", Location::cell, 1, x, ""};
  std::vector<FieldOutput> known;
  {
    Fields fields(mesh, place);
    for (const double t : {0.0, 1.0, 2.0, 3.0})
      fields.write(t, std::span(&field, 1));
    known = fields.outputs();
  }
  REQUIRE(known.size() == 4);
  known.resize(3); // the checkpoint is older than the last output
  for (const double t : {2.5, 2.75})
  {
    Fields fields(mesh, place, known);
    fields.write(t, std::span(&field, 1));
    known = fields.outputs();
  }
  MPI_Barrier(MPI_COMM_WORLD);
  std::ifstream in(place / "fields.pvd");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::size_t at = 0;
  for (const char* t : {"\"0\"", "\"1\"", "\"2\"", "\"2.5\"", "\"2.75\""})
  {
    INFO(t);
    at = text.find(std::string("timestep=") + t, at);
    REQUIRE(at != std::string::npos);
    const auto name = text.find("file=\"", at) + 6;
    CHECK(std::filesystem::exists(
        place / text.substr(name, text.find('"', name) - name)));
  }
  int ranks = 1, files = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (const auto& entry : std::filesystem::directory_iterator(place))
    files += entry.path().filename().string().starts_with("fields");
  CHECK(files == 1 + 5 * (1 + ranks));
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST_CASE("fields: wrong lists are refused on all ranks")
{
  const auto mesh = rectangle(2);
  Fields fields(mesh, folder() / "wrong");
  const std::size_t n = middles(*mesh).size();
  const std::vector<double> good(n), bad(n + 1);
  const auto write =
      [&](std::string name, int components, std::span<const double> values)
  {
    const NamedField field{std::move(name), Location::cell, components, values,
                           ""};
    fields.write(0, std::span(&field, 1));
  };
  CHECK_THROWS_WITH(write("a", 3, good), ContainsSubstring("3 components"));
  CHECK_THROWS_WITH(write("a", 1, bad), ContainsSubstring("values for"));
  write("a", 1, good);
  CHECK_THROWS_WITH(write("b", 1, good), ContainsSubstring("has changed"));
  int size = 1, rank = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // Wrong on the last rank alone: nobody may be left waiting.
  CHECK_THROWS_AS(write("a", 1, rank == size - 1 ? bad : good),
                  std::runtime_error);
}

TEST_CASE("fields: a failing root fails on all ranks with its words")
{
  CHECK_THROWS_WITH(
      on_root(MPI_COMM_WORLD, [] { throw std::runtime_error("disk full"); }),
      "disk full");
  int calls = 0;
  on_root(MPI_COMM_WORLD, [&] { ++calls; });
  MPI_Allreduce(MPI_IN_PLACE, &calls, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  CHECK(calls == 1);
}

TEST_CASE("probe: linear fields are exact on the moved mesh")
{
  const auto mesh = rectangle();
  const Probe probe(mesh);
  const std::vector<double> start(mesh->geometry().x().begin(),
                                  mesh->geometry().x().end());
  move(*mesh, start, 1.0);
  const std::vector<double> at = node_coordinates(mesh);
  std::vector<double> f;
  for (std::size_t i = 0; i < at.size(); i += 3)
    f.insert(f.end(), {2 * at[i] - 3 * at[i + 1], 1 + at[i + 1]});

  // A node, points inside, and two outside: the mesh has left (1.9, 0.9).
  const std::vector<mmale::scene::Point> points = {
      {0, 0}, {0.3, 0.4}, {1.0, 0.123}, {0.77, 0.5}, {1.9, 0.9}, {-1, 0}};
  const std::vector<Spot> spots = probe.locate(points);
  const std::vector<double> v =
      probe.sample(spots, {"f", Location::nodal, 2, f, ""});
  for (std::size_t i = 0; i < 4; ++i)
  {
    INFO("point " << i);
    CHECK(spots[i].found);
    // 3 weights and 2 products each.
    CHECK(std::abs(v[2 * i] - (2 * points[i][0] - 3 * points[i][1])) < 1e-13);
    CHECK(std::abs(v[2 * i + 1] - (1 + points[i][1])) < 1e-13);
  }
  for (std::size_t i = 4; i < 6; ++i)
  {
    CHECK_FALSE(spots[i].found);
    CHECK(std::isnan(v[2 * i]));
  }
  for (const Spot& spot : spots)
  {
    int owners = spot.cell >= 0 ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &owners, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    CHECK(owners == (spot.found ? 1 : 0));
  }
}

TEST_CASE("probe: cell values come from the cell around the point")
{
  const auto mesh = rectangle();
  const Probe probe(mesh);
  const auto middle = middles(*mesh);
  std::vector<double> x;
  for (const auto& m : middle)
    x.push_back(m[0]);
  // The middle of the lower left cell, whose right angle is at (1/6, 0).
  const std::vector<mmale::scene::Point> points = {{1. / 9 + 0.01, 1. / 18}};
  const auto v =
      probe.sample(probe.locate(points), {"x", Location::cell, 1, x, ""});
  CHECK(v[0] == Approx(1. / 9).epsilon(1e-12));
}

TEST_CASE("probe: lines are written with names and nan outside")
{
  const auto mesh = rectangle();
  const Probe probe(mesh);
  const std::vector<double> at = node_coordinates(mesh);
  std::vector<double> p;
  for (std::size_t i = 0; i < at.size(); i += 3)
    p.push_back(at[i] + at[i + 1]);
  const NamedField field{"p", Location::nodal, 1, p, "Pa"};
  write_lines(probe, MPI_COMM_WORLD, folder(), 3,
              {{"axis", {.from = {0, 0.5}, .to = {4, 0.5}, .points = 5}}},
              std::span(&field, 1));
  const Curves table = read_curves(folder() / "lines" / "axis_3.csv");
  CHECK(table.names()[0] == "s");
  REQUIRE(table.rows() == 5);
  for (std::size_t i = 0; i < 3; ++i)
  {
    CHECK(table.column("s")[i] == static_cast<double>(i));
    CHECK(table.column("p")[i]
          == Approx(static_cast<double>(i) + 0.5).epsilon(1e-13));
  }
  CHECK(std::isnan(table.column("p")[4]));
}

TEST_CASE("fields: versions name what runs")
{
  const auto v = versions();
  CHECK(v.at("dolfinx").starts_with("0."));
  CHECK(v.at("petsc").starts_with("3."));
  CHECK_FALSE(v.at("mpi").empty());
}

int main(int argc, char** argv)
{
  spdlog::set_level(spdlog::level::warn);
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  const int failed = Catch::Session().run(argc, argv);
  PetscFinalize();
  return failed;
}
