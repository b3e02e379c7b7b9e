// SPDX-License-Identifier: LGPL-3.0-or-later
#include "state_file.h"

#include "on_root.h"
#include <dolfinx/common/MPI.h>
#include <dolfinx/io/HDF5Interface.h>
#include <span>

namespace mmale::output
{
namespace
{
/// Datasets of one file, each rank its own rows.
class Writer
{
public:
  Writer(hid_t file, MPI_Comm comm) : _file(file), _comm(comm) {}

  /// Rows of owned entities from an array with ghosts behind them.
  template <class T>
  void rows(const std::string& name, const std::vector<T>& values, int owned,
            std::int64_t width = 1) const
  {
    std::int64_t begin = 0, count = owned, all = 0;
    MPI_Exscan(&count, &begin, 1, MPI_INT64_T, MPI_SUM, _comm);
    MPI_Allreduce(&count, &all, 1, MPI_INT64_T, MPI_SUM, _comm);
    std::vector<std::int64_t> shape{all};
    if (width > 1)
      shape.push_back(width);
    dolfinx::io::hdf5::write_dataset(_file, "/" + name, values.data(),
                                     {begin, begin + count}, shape,
                                     dolfinx::MPI::size(_comm) > 1, false);
  }

private:
  hid_t _file;
  MPI_Comm _comm;
};
} // namespace

void write_state(const std::filesystem::path& file, const mesh::Domain& domain,
                 const State& state)
{
  std::filesystem::path part = file;
  part += ".part";
  const int nodes = domain.num_owned_nodes, cells = domain.num_owned_cells;
  const hid_t h5 = dolfinx::io::hdf5::open_file(
      domain.comm, part, "w", dolfinx::MPI::size(domain.comm) > 1);
  const Writer write(h5, domain.comm);
  const bool root = dolfinx::MPI::rank(domain.comm) == 0;
  write.rows("time", std::vector<double>(root, state.time), root);
  write.rows("node_id", domain.node_id, nodes);
  write.rows("x", state.x, nodes, 2);
  write.rows("v", state.v, nodes, 2);
  write.rows("cell_id", domain.cell_id, cells);
  if (not state.P.empty())
  {
    write.rows("p", state.p, nodes);
    write.rows("s", state.s, cells, 4);
    write.rows("P", state.P, cells);
    write.rows("density", state.density, cells);
    const std::size_t h = state.history.size() / state.P.size();
    if (h > 0)
      write.rows("history", state.history, cells, static_cast<std::int64_t>(h));
  }
  for (const auto& [name, values] : state.tracer)
    write.rows("tracer_" + name, values, cells);
  dolfinx::io::hdf5::close_file(h5);
  on_root(domain.comm, [&] { std::filesystem::rename(part, file); });
}
} // namespace mmale::output
