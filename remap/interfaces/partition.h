// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: what tells the materials of a cell apart: straight cuts, in a
// binary tree. A chain of cuts is the nested reconstruction; filaments (the
// same part on both sides of another) and points where three parts meet are
// trees too. Any convex polygon is split by it, also one that leaves the cell:
// a region that a facet sweeps. Pieces add up to the polygon to round-off.
#pragma once

#include "remap/geometry/polygon.h"

#include <array>
#include <cstdint>
#include <span>

namespace remap
{
/// Most materials that one cell can hold.
inline constexpr int most_parts = 8;

/// Room for a triangle, or a swept region, after all cuts of a partition.
using Piece = Polygon<20>;

/// One cut: what lies in the half-plane, and what does not.
struct Cut
{
  HalfPlane plane;
  /// >= 0: number of the next cut there; < 0: the part there is ~in, ~out.
  std::int8_t in = ~0;
  std::int8_t out = ~0;
};

/// The parts of a cell, numbered as its materials are (`Materials::parts`).
/// Without a cut all is part 0.
struct Partition
{
  static constexpr int most_cuts = 12;
  std::array<Cut, most_cuts> cuts; ///< the first `count`; 0 is the root
  int count = 0;

  /// Add a cut; its number.
  int add(const Cut& cut)
  {
    assert(count < most_cuts);
    cuts[count] = cut;
    return count++;
  }
};

namespace detail
{
template <class Use>
void split_by(const Piece& p, const Partition& by, int node, Use& use)
{
  if (node < 0)
    return use(~node, p);
  const Cut& cut = by.cuts[node];
  Piece in, out;
  split(p, cut.plane, in, out);
  if (in.size > 2)
    split_by(in, by, cut.in, use);
  if (out.size > 2)
    split_by(out, by, cut.out, use);
}
} // namespace detail

/// Pieces of a convex polygon by parts: use(part, piece), a part maybe more
/// than once, in the order of the tree. Slivers of round-off come too.
///
/// @param[in] p convex, counter-clockwise, at most 8 vertices
template <int N, class Use>
void split(const Polygon<N>& p, const Partition& by, Use&& use)
{
  static_assert(N <= Piece::capacity);
  Piece all;
  for (int i = 0; i < p.size; ++i)
    all.push(p[i]);
  detail::split_by(all, by, by.count > 0 ? 0 : ~0, use);
}

/// Volume and first moments of a convex polygon by parts.
///
/// @param[in]     p       convex, counter-clockwise, at most 8 vertices
/// @param[in,out] moments shape (parts); grows by what is found
template <Geometry G, int N>
void add_moments(const Polygon<N>& p, const Partition& by,
                 std::span<Moments> moments)
{
  split(p, by, [&](int part, const Piece& piece)
        { moments[part] += remap::moments<G>(piece); });
}
} // namespace remap
