// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/on_root.h"

#include <stdexcept>
#include <string>

namespace mmale::output
{
void on_root(MPI_Comm comm, const std::function<void()>& work)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string error;
  bool failed = false;
  if (rank == 0)
  {
    try
    {
      work();
    }
    catch (const std::exception& e)
    {
      failed = true;
      error = e.what();
    }
  }
  int size = failed ? static_cast<int>(error.size()) : -1;
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  if (size < 0)
    return;
  error.resize(static_cast<std::size_t>(size));
  MPI_Bcast(error.data(), size, MPI_CHAR, 0, comm);
  throw std::runtime_error(error);
}
} // namespace mmale::output
