// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What the library asks of the program that calls it: fill ghosts, agree on a
// number. The default is one process: every call does nothing. Called once per
// batch of work, never inside a loop over cells.
#pragma once

#include <functional>
#include <span>

namespace remap
{
/// Communication, supplied by the host. An empty function means "one process".
///
/// Every call is collective: all ranks make the same calls in the same order.
class Host
{
public:
  /// Fill the ghost part of an array from its owners.
  /// Arguments: values, shape (num, block), owned first; block.
  using Halo = std::function<void(std::span<double>, int)>;
  /// Replace each number by its maximum, or its sum, over all ranks.
  using Reduce = std::function<void(std::span<double>)>;

  Halo cell_halo;    ///< ghosts of an array over cells
  Halo node_halo;    ///< ghosts of an array over nodes
  Reduce global_max; ///< maximum over ranks, number by number
  Reduce global_sum; ///< sum over ranks, number by number

  void update_cells(std::span<double> values, int block) const
  {
    if (cell_halo)
      cell_halo(values, block);
  }

  void update_nodes(std::span<double> values, int block) const
  {
    if (node_halo)
      node_halo(values, block);
  }

  void sum(std::span<double> values) const
  {
    if (global_sum)
      global_sum(values);
  }

  void max(std::span<double> values) const
  {
    if (global_max)
      global_max(values);
  }

  [[nodiscard]] double max(double value) const
  {
    max(std::span<double>(&value, 1));
    return value;
  }
};
} // namespace remap
