// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <mpi.h>
#include <span>
#include <vector>

namespace mmale::output
{
/// Rows of entities in the order of their global numbers, and back.
///
/// In global order rank r has the r-th of as many runs of rows as there are
/// ranks; so a file does not know how the mesh was distributed.
class Blocks
{
public:
  /// Collective.
  /// @param[in] comm all ranks
  /// @param[in] id   global numbers of owned entities: 0 to their sum, each on
  ///                 one rank
  /// @throws std::runtime_error on all ranks if they are not
  Blocks(MPI_Comm comm, std::span<const std::int64_t> id);

  std::int64_t rows() const { return _rows; }   ///< of all ranks
  std::int64_t begin() const { return _begin; } ///< first of this rank's run
  std::int64_t count() const { return _count; } ///< in this rank's run

  /// Owned rows to this rank's run. Collective.
  /// @param[in] owned shape (owned entities, width)
  /// @return shape (count, width)
  std::vector<double> sorted(std::span<const double> owned, int width) const;

  /// The way back. Collective.
  std::vector<double> owned(std::span<const double> sorted, int width) const;

private:
  MPI_Comm _comm;
  std::int64_t _rows = 0, _begin = 0, _count = 0;
  std::vector<int> _order; ///< owned entities, by the rank that sorts them
  std::vector<int> _send, _receive; ///< entities for and from each rank
  std::vector<std::int64_t> _place; ///< in the run, of what is received
};
} // namespace mmale::output
