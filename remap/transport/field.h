// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What travels, and the book of what passed the boundary.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace remap
{
/// A field given per volume (density, momentum density, a state that is a mean
/// over the volume), over cells or over the dual volumes of nodes.
struct Field
{
  /// In: before the remap; out: after. Shape (num, components), ghosts included
  /// and up to date on entry; the mean over each volume.
  std::span<double> values;
  int components = 1;
  /// So many consecutive components share one limiting factor (the smallest):
  /// 1 limits each by itself, `components` scales a tensor as one.
  int group = 1;
  /// What flows in at open boundaries, shape (markers, components); may be
  /// empty if no boundary is open.
  std::span<const double> inflow = {};
};

/// What a boundary facet with some marker does.
enum class Boundary
{
  closed,       ///< a wall; what a sliding node leaves over is booked
  free_surface, ///< beyond is void: gained volume takes the volume's own value
  open,         ///< gained volume takes the inflow, lost volume leaves
};

/// Ways over the boundary. What comes in counts positive, out negative.
enum class Way
{
  closed,  ///< over closed boundaries, net
  gained,  ///< taken from the void
  lost,    ///< left to the void
  inflow,  ///< in over open boundaries
  outflow, ///< out over open boundaries
};
inline constexpr std::size_t num_ways = 5;

/// Integral of one component (or the volume itself) that passed, by way.
using Exchange = std::array<double, num_ways>;

/// Net gain over all ways.
inline double net(const Exchange& e)
{
  double sum = 0;
  for (double part : e)
    sum += part;
  return sum;
}

/// Book of all exchange with the outside, summed over ranks and remaps.
/// After each remap: integral now = integral before + net, for every component.
struct Ledger
{
  Exchange cell_volume{};      ///< of the cells [m³/m or m³/rad]
  Exchange node_volume{};      ///< of the dual volumes
  std::vector<Exchange> cells; ///< components of all cell fields, in order
  std::vector<Exchange> nodes; ///< components of all nodal fields, in order
};
} // namespace remap
