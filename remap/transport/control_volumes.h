// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Volumes that exchange swept regions: cells, or the dual volumes of nodes. All
// that transport needs to know about either, with the room it works in.
#pragma once

#include "remap/geometry/swept.h"
#include "remap/mesh.h"

#include <vector>

namespace remap
{
/// One swept region: it leaves `from` and enters `to`.
struct Piece
{
  std::int32_t from = -1;   ///< donor; -1: from outside
  std::int32_t to = -1;     ///< receiver; -1: to outside
  double volume = 0;        ///< > 0
  Point at;                 ///< its centroid
  std::int32_t next = -1;   ///< next piece of the same donor
  std::int32_t marker = -1; ///< of the boundary facet, if one end is outside
};

/// Swept volume below which round-off speaks, not motion.
template <Geometry G>
double sliver(const Motion& m)
{
  const Point e = m.q0 - m.p0;
  const double area = 1e-13 * dot(e, e);
  return G == Geometry::plane ? area : area * std::max(m.p0.x, m.q0.x);
}

/// Geometry and room for a set of volumes.
struct ControlVolumes
{
  std::int32_t num = 0;                  ///< with ghosts
  std::int32_t owned = 0;                ///< ours, first
  const Adjacency* neighbours = nullptr; ///< stencil of gradients and bounds

  std::vector<double> volume;  ///< now
  std::vector<double> next;    ///< after the sub-cycle
  std::vector<Point> centroid; ///< now
  std::vector<double> leaving; ///< sum of pieces out of a volume
  std::vector<double> fit; ///< inverse of the least-squares matrix, (num, 3)
  std::vector<std::int32_t> first; ///< first piece of a donor
  std::vector<Piece> pieces;
  std::vector<std::int32_t> outside; ///< pieces with one end outside

  std::vector<std::int32_t> touched; ///< volumes that change
  std::vector<std::int32_t> ring;    ///< neighbours of ours among them
  std::vector<std::uint8_t> mark;    ///< 1 touched, 2 ring

  std::vector<double> gradient; ///< (num, components, 2)
  std::vector<double> content;  ///< integrals, (num, components)

  /// @param[in] stencil    neighbours of every volume
  /// @param[in] num_owned  volumes that are ours
  /// @param[in] max_pieces swept regions at most
  /// @param[in] components of the widest field
  void reserve(const Adjacency& stencil, std::int32_t num_owned,
               std::size_t max_pieces, int components)
  {
    neighbours = &stencil;
    num = stencil.size();
    owned = num_owned;
    volume.assign(num, 0);
    next.assign(num, 0);
    centroid.assign(num, {});
    leaving.assign(num, 0);
    fit.assign(3 * num, 0);
    first.assign(num, -1);
    mark.assign(num, 0);
    pieces.reserve(max_pieces);
    outside.reserve(max_pieces);
    touched.reserve(num);
    ring.reserve(num);
    gradient.assign(std::size_t(2) * num * components, 0);
    content.assign(std::size_t(num) * components, 0);
  }

  /// Note a volume as changing.
  void touch(std::int32_t i)
  {
    if (mark[i] == 0)
    {
      mark[i] = 1;
      touched.push_back(i);
    }
  }

  /// Collect the ring around the volumes that change.
  void close_ring()
  {
    for (std::int32_t i : touched)
      for (std::int32_t j : (*neighbours)[i])
        if (mark[j] == 0)
        {
          mark[j] = 2;
          ring.push_back(j);
        }
  }

  /// Forget which volumes change.
  void clear()
  {
    for (std::int32_t i : touched)
      mark[i] = 0;
    for (std::int32_t i : ring)
      mark[i] = 0;
    touched.clear();
    ring.clear();
    pieces.clear();
    outside.clear();
  }

  /// Start a sub-cycle: no pieces yet.
  void drop_pieces()
  {
    pieces.clear();
    outside.clear();
    for (std::int32_t i : touched)
    {
      first[i] = -1;
      leaving[i] = 0;
    }
  }

  /// Add the region swept by a facet between two volumes; right = -1: outside.
  template <Geometry G>
  void sweep(const Motion& m, std::int32_t left, std::int32_t right,
             std::int32_t marker)
  {
    const SweptParts parts = swept_parts<G>(m);
    for (int k = 0; k < parts.count; ++k)
    {
      const Moments& part = parts.part[k];
      if (part.v == 0)
        continue;
      Piece p;
      p.from = part.v > 0 ? left : right;
      p.to = part.v > 0 ? right : left;
      p.volume = part.v > 0 ? part.v : -part.v;
      p.at = centroid_in(part, m);
      // Of round-off size: the centroid means nothing and must not limit a
      // gradient. Such a piece carries the mean.
      if (p.volume < sliver<G>(m) and p.from >= 0)
        p.at = centroid[p.from];
      p.marker = marker;
      if (p.from >= 0)
      {
        p.next = first[p.from];
        first[p.from] = static_cast<std::int32_t>(pieces.size());
        leaving[p.from] += p.volume;
      }
      if (right < 0)
        outside.push_back(static_cast<std::int32_t>(pieces.size()));
      pieces.push_back(p);
    }
  }

  /// Largest part of itself that one of our volumes loses.
  [[nodiscard]] double largest_loss() const
  {
    double loss = 0;
    for (std::int32_t i : touched)
      if (i < owned)
        loss = std::max(loss, leaving[i] / volume[i]);
    return loss;
  }
};
} // namespace remap
