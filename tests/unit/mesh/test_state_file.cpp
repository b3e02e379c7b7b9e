// SPDX-License-Identifier: LGPL-3.0-or-later
// The saved state holds every number once, whatever the number of processes.
#include "mesh/grid.h"
#include "output/state_file.h"

#include <catch2/catch_test_macros.hpp>
#include <dolfinx/io/HDF5Interface.h>
#include <filesystem>
#include <fstream>

namespace
{
namespace h5 = dolfinx::io::hdf5;
namespace fs = std::filesystem;

mmale::mesh::Domain small_domain()
{
  mmale::scene::Mesh m;
  m.shape = "rectangle";
  m.width = 2;
  m.height = 1;
  m.cells = {6, 4};
  return mmale::mesh::make_domain(MPI_COMM_WORLD, mmale::mesh::make_grid(m),
                                  {});
}

/// Numbers that tell which entity and component they belong to.
std::vector<double> tagged(const std::vector<std::int64_t>& id, int width)
{
  std::vector<double> out;
  for (std::int64_t i : id)
    for (int k = 0; k < width; ++k)
      out.push_back(100.0 * static_cast<double>(i) + k);
  return out;
}

mmale::State state_of(const mmale::mesh::Domain& d)
{
  mmale::State s;
  s.time = 0.75;
  s.x = tagged(d.node_id, 2);
  s.v = tagged(d.node_id, 2);
  s.p = tagged(d.node_id, 1);
  s.s = tagged(d.cell_id, 4);
  s.P = tagged(d.cell_id, 1);
  s.density = tagged(d.cell_id, 1);
  s.history = tagged(d.cell_id, 3);
  s.tracer["dye"] = tagged(d.cell_id, 1);
  return s;
}

/// A whole dataset, read by this process alone.
template <class T>
std::vector<T> read(const fs::path& file, const std::string& name)
{
  const hid_t f = h5::open_file(MPI_COMM_SELF, file, "r", false);
  const hid_t set = h5::open_dataset(f, "/" + name);
  const auto shape = h5::get_dataset_shape(f, "/" + name);
  auto out = h5::read_dataset<T>(set, {0, shape.at(0)}, false);
  H5Dclose(set);
  h5::close_file(f);
  return out;
}

void check_tagged(const fs::path& file, const std::string& ids,
                  const std::string& name, int width, std::size_t entities)
{
  INFO(name);
  const auto id = read<std::int64_t>(file, ids);
  CHECK(id.size() == entities);
  CHECK(read<double>(file, name) == tagged(id, width));
}
} // namespace

TEST_CASE("a saved state is read back number by number", "[unit][state]")
{
  const auto d = small_domain();
  const fs::path file = "test_state_file.h5";
  mmale::output::write_state(file, d, state_of(d));
  MPI_Barrier(MPI_COMM_WORLD);
  CHECK(read<double>(file, "time") == std::vector<double>{0.75});
  for (const auto& [name, width] : {std::pair{"x", 2}, {"v", 2}, {"p", 1}})
    check_tagged(file, "node_id", name, width, 7 * 5);
  for (const auto& [name, width] : {std::pair{"s", 4},
                                    {"P", 1},
                                    {"density", 1},
                                    {"history", 3},
                                    {"tracer_dye", 1}})
    check_tagged(file, "cell_id", name, width, 6 * 4 * 2);
  CHECK_FALSE(fs::exists(file.string() + ".part"));
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST_CASE("a state that cannot be written is said on all processes",
          "[unit][state]")
{
  const auto d = small_domain();
  std::ofstream("test_state_file.blocked") << "a file where a folder is wanted";
  MPI_Barrier(MPI_COMM_WORLD);
  CHECK_THROWS(mmale::output::write_state("test_state_file.blocked/state.h5", d,
                                          state_of(d)));
}
