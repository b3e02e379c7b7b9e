// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: takes the zigzag out of a free surface. A node that keeps the
// area between its two neighbours keeps a zigzag too; two neighbours that move
// together can lose it, and keep the area (the volume) to round-off.
#pragma once

#include "remap/host.h"
#include "remap/mesh.h"
#include "remap/smoothing/kind.h"
#include "remap/smoothing/patch.h"

#include <span>
#include <vector>

namespace remap
{
/// Moves the two nodes of a surface facet against each other, across the line
/// through the neighbours beside them, until one of the two turns is gone.
/// @source the idea of moving two nodes at once: Kuprat et al. (2001), volume
///         conserving smoothing; they smooth every edge, this only zigzags
class Zigzag
{
public:
  /// A facet is one of a zigzag if the boundary turns by more at both its ends,
  /// there to the left and here to the right [sine]. Halved: a wave of four
  /// facets is taken for a zigzag earlier.
  static constexpr double turn = 0.1;

  /// Colours the facets. Collective.
  /// @param[in] mesh kept by reference: must outlive this
  Zigzag(const Mesh& mesh, const Host& host);

  /// What the pairs have to keep.
  struct Rules
  {
    Geometry geometry = Geometry::plane;
    Measure measure = Measure::radius_ratio;
    double threshold = 0; ///< see `Kind::surface`
    std::span<const quality::Target> targets;
  };

  /// One pass over the facets between two surface nodes with flags. Collective.
  ///
  /// @param[in,out] x     shape (num_nodes, 2), ghosts up to date in and out
  /// @param[in]     flags shape (num_nodes), ghosts up to date
  /// @param[in]     kinds shape (num_nodes), ghosts up to date
  /// @return longest step of a node of ours
  double remove(std::span<double> x, std::span<const std::uint8_t> flags,
                std::span<const Kind> kinds, const Rules& rules,
                const Host& host);

private:
  /// A facet of a cell of ours, and the facets before and after on the
  /// boundary.
  struct Pair
  {
    std::int32_t cell, local, before, first, second, after;
  };
  void colour(const Host& host);
  [[nodiscard]] bool wanted(const Pair& p, std::span<const double> x,
                            std::span<const std::uint8_t> flags,
                            std::span<const Kind> kinds) const;
  bool move(const Pair& p, std::span<double> x, const Rules& rules) const;
  [[nodiscard]] double worst_around(const Pair& p, std::span<const double> x,
                                    const Rules& rules) const;

  const Mesh* _mesh;
  std::vector<Pair> _pairs;         // by colour
  std::vector<std::int32_t> _start; // first of each colour in _pairs
  std::vector<std::int32_t> _cells; // local cells on the boundary
  std::vector<double> _moves;       // per cell: facet + 1, two new places
};
} // namespace remap
