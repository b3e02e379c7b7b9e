// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Volumes that exchange regions: cells, the triangles of their points, or the
// dual volumes of nodes. All that transport needs to know about either, with
// the room it works in. What a region is, a swept one or the overlap of an old
// and a new cell, makes no difference here; where masses are exchanged instead
// (velocity), `volume` is a mass.
#pragma once

#include "remap/geometry/swept.h"
#include "remap/mesh.h"

#include <array>
#include <cmath>
#include <vector>

namespace remap
{
/// Rows of a list of lists where they stand now: those of an Adjacency, or of a
/// copy of it whose rows may stand anywhere (stride 2: begin and end of each).
struct Rows
{
  const std::int32_t* bounds = nullptr;
  int stride = 1;
  const std::int32_t* entries = nullptr;

  Rows() = default;
  Rows(const Adjacency& all)
      : bounds(all.offsets.data()), entries(all.entries.data())
  {
  }
  [[nodiscard]] std::span<const std::int32_t> operator[](std::int32_t i) const
  {
    const std::int32_t* row = bounds + std::ptrdiff_t(stride) * i;
    return {entries + row[0], entries + row[1]};
  }
};

/// Regions that leave one volume and enter another; arrays of equal length,
/// because most fields need only some of them.
struct Pieces
{
  std::vector<std::int32_t> from; ///< donor; outer pieces: -1 from outside
  std::vector<std::int32_t> to;   ///< receiver; outer pieces: -1 to outside
  std::vector<double> volume;     ///< > 0
  std::vector<Point> at;          ///< centroid
  std::size_t count = 0;

  void reserve(std::size_t most)
  {
    from.resize(most);
    to.resize(most);
    volume.resize(most);
    at.resize(most);
  }
};

/// Swept volume below which round-off speaks, not motion.
/// @param[in] e facet
/// @param[in] r larger radius of its ends
template <Geometry G>
double sliver(Point e, double r)
{
  const double area = 1e-13 * dot(e, e);
  return G == Geometry::plane ? area : area * r;
}

/// Geometry and room for a set of volumes.
struct ControlVolumes
{
  std::int32_t num = 0;   ///< with ghosts
  std::int32_t owned = 0; ///< ours, first
  Rows neighbours;        ///< stencil of gradients and bounds
  Rows beside;            ///< neighbours across a facet

  /// Volumes behind the cells, if they are parts of them (materials/slots.h):
  /// the cell and the kind of each; a kind of volumes has its own book.
  std::int32_t first_part = 0;
  std::int32_t first_new = 0; ///< those that hold nothing yet stand last
  std::vector<std::int32_t> cell_of_part;
  std::vector<std::int32_t> kinds;
  int width = 1; ///< components of the widest field

  /// Is a volume ours, not a ghost?
  [[nodiscard]] bool ours(std::int32_t i) const
  {
    return i < owned
           or (i >= first_part and cell_of_part[i - first_part] < owned);
  }
  /// Kind of a volume: 0, if there is but one.
  [[nodiscard]] std::size_t kind(std::int32_t i) const
  {
    return kinds.empty() ? 0 : static_cast<std::size_t>(kinds[i]);
  }

  std::vector<double> volume;  ///< now
  std::vector<double> next;    ///< after the sub-cycle
  std::vector<Point> centroid; ///< now
  std::vector<double> leaving; ///< sum of pieces out of a volume
  std::vector<Point> remains;  ///< centroid of what stays, from `centroid`
  std::vector<double> fit;     ///< least squares, (num, 4): see gradient.h
  /// Which volumes have the `fit` of where they are now?
  enum
  {
    nobody,
    donors,   ///< volumes that give something away
    everybody ///< all that change, and the rings around them
  } fitted = nobody;
  Pieces inner;                     ///< between two volumes
  Pieces outer;                     ///< with one end outside
  std::vector<std::int32_t> marker; ///< of the boundary facet of outer pieces
  std::vector<std::int32_t> facet;  ///< that swept each outer piece
  /// First inner piece and the one after the last of each facet in the order of
  /// `sweep`; empty if nobody asks.
  std::vector<Pair> pieces_of;
  std::size_t num_swept = 0;                ///< facets so far
  SweptBatch batch;                         ///< facets that wait
  std::array<Pair, SweptBatch::room> sides; ///< volumes beside them

  std::vector<std::int32_t> touched; ///< volumes that change
  /// Place of a volume in the order of global numbers, and the volume at a
  /// place; empty if that is the local order.
  std::vector<std::int32_t> place, at_place;
  std::vector<std::int32_t> ring; ///< neighbours of ours among them
  std::vector<std::uint8_t> mark; ///< 1 touched, 2 ring

  std::vector<double> gradient; ///< (num, components, 2)
  std::vector<double> content;  ///< integrals, (num, components)
  std::vector<double> lo, hi;   ///< fall and rise to neighbours, as content
  std::vector<double> factor;   ///< of gradients, as content

  /// @param[in] stencil    neighbours of every volume
  /// @param[in] sides      neighbours across a facet
  /// @param[in] num_owned  volumes that are ours
  /// @param[in] num_inner  facets between volumes, each two pieces at most
  /// @param[in] num_outer  facets on the boundary
  /// @param[in] components of the widest field
  void reserve(const Adjacency& stencil, const Adjacency& sides,
               std::int32_t num_owned, std::size_t num_inner,
               std::size_t num_outer, int components)
  {
    neighbours = stencil;
    beside = sides;
    num = first_part = first_new = stencil.size();
    owned = num_owned;
    width = components;
    volume.assign(num, 0);
    next.assign(num, 0);
    centroid.assign(num, {});
    leaving.assign(num, 0);
    remains.assign(num, {});
    fit.assign(std::size_t(4) * num, 0);
    mark.assign(num, 0);
    // One more: a part that is not there is written and not counted.
    inner.reserve(2 * num_inner + 2);
    outer.reserve(2 * num_outer + 2);
    marker.resize(2 * num_outer + 2);
    facet.resize(2 * num_outer + 2);
    touched.reserve(num);
    ring.reserve(num);
    const std::size_t size = std::size_t(num) * components;
    gradient.assign(2 * size, 0);
    content.assign(size, 0);
    lo.assign(size, 0);
    hi.assign(size, 0);
    factor.assign(size, 0);
  }

  /// So many volumes from now on, with parts behind the cells; more room is
  /// made when there are more than ever before.
  void hold(std::int32_t number)
  {
    num = number;
    const auto room = [](auto& all, std::size_t size)
    {
      if (all.size() < size)
        all.resize(size);
    };
    const auto n = static_cast<std::size_t>(num);
    for (auto* all : {&volume, &next, &leaving})
      room(*all, n);
    for (auto* all : {&centroid, &remains})
      room(*all, n);
    room(fit, 4 * n);
    room(gradient, 2 * n * static_cast<std::size_t>(width));
    for (auto* all : {&content, &lo, &hi, &factor})
      room(*all, n * static_cast<std::size_t>(width));
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

  /// Volumes that change, in the order of their global numbers, whichever way
  /// they were found: sums over what they exchange are then the same on any
  /// number of ranks, to the last bit.
  void order()
  {
    const auto before = [this](std::int32_t a, std::int32_t b)
    { return place.empty() ? a < b : place[a] < place[b]; };
    // Sorting is dearer than looking at all once they are many.
    if (touched.size() * 16 < static_cast<std::size_t>(num))
      return std::sort(touched.begin(), touched.end(), before);
    touched.clear();
    for (std::int32_t k = 0; k < num; ++k)
      if (const std::int32_t i = at_place.empty() ? k : at_place[k];
          mark[i] == 1)
        touched.push_back(i);
  }

  /// Collect so many rings around the volumes that change.
  void close_rings(int rings)
  {
    const auto around = [this](std::int32_t i)
    {
      for (std::int32_t j : neighbours[i])
        if (mark[j] == 0)
        {
          mark[j] = 2;
          ring.push_back(j);
        }
    };
    if (rings > 0)
      for (std::int32_t i : touched)
        around(i);
    for (std::size_t k = 1, first = 0; k < static_cast<std::size_t>(rings); ++k)
      for (const std::size_t last = ring.size(); first < last; ++first)
        around(ring[first]);
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
    inner.count = outer.count = 0;
  }

  /// Start a sub-cycle: no pieces yet.
  void drop_pieces()
  {
    inner.count = outer.count = num_swept = 0;
    fitted = nobody;
    for (std::int32_t i : touched)
    {
      leaving[i] = 0;
      remains[i] = {};
    }
  }

  /// Note that a region at `at` leaves volume i.
  void leave(std::int32_t i, double v, Point at)
  {
    leaving[i] += v;
    remains[i] = remains[i] - v * (at - centroid[i]);
  }

  /// Make room for one more piece of each kind, beyond what facets can sweep.
  void make_room()
  {
    if (inner.count + 2 > inner.from.size())
      inner.reserve(2 * inner.from.size());
    if (outer.count + 2 <= outer.from.size())
      return;
    outer.reserve(2 * outer.from.size());
    facet.resize(outer.from.size());
    marker.resize(outer.from.size());
  }

  /// Add a region that goes from one volume to another.
  void exchange(std::int32_t from, std::int32_t to, double v, Point at)
  {
    const std::size_t k = inner.count++;
    inner.from[k] = from;
    inner.to[k] = to;
    inner.volume[k] = v;
    inner.at[k] = at;
    leave(from, v, at);
  }

  /// Add a region that comes from outside (from = -1) or goes there.
  void pass(std::int32_t from, std::int32_t to, double v, Point at,
            std::int32_t over, std::int32_t boundary)
  {
    const std::size_t k = outer.count++;
    outer.from[k] = from;
    outer.to[k] = to;
    outer.volume[k] = v;
    outer.at[k] = at;
    facet[k] = over;
    marker[k] = boundary;
    if (from >= 0)
      leave(from, v, at);
  }

  /// Add the region swept by a facet between two volumes, with others of its
  /// kind: see `flush`.
  template <Geometry G>
  void sweep(const Motion& m, std::int32_t left, std::int32_t right)
  {
    if (batch.count == SweptBatch::room)
      flush<G>();
    sides[batch.count] = {left, right};
    batch.add(m);
  }

  /// Pieces of all facets given to `sweep` since the last call, in their order.
  /// No branch depends on the motion.
  template <Geometry G>
  void flush()
  {
    batch.sweep<G>();
    for (int k = 0; k < batch.count; ++k)
    {
      const Point e = {batch.q0x[k] - batch.p0x[k],
                       batch.q0y[k] - batch.p0y[k]};
      const double least = sliver<G>(e, std::max(batch.p0x[k], batch.q0x[k]));
      const auto [left, right] = sides[k];
      const auto start = static_cast<std::int32_t>(inner.count);
      for (int part = 0; part < 2; ++part)
      {
        const bool out = batch.v[part][k] > 0;
        const std::int32_t from = out ? left : right;
        const double v = std::abs(batch.v[part][k]);
        const Point own = centroid[from];
        // Of round-off size: the centroid means nothing and must not limit a
        // gradient. Such a piece carries the mean.
        const Point at = {v > least ? batch.x[part][k] : own.x,
                          v > least ? batch.y[part][k] : own.y};
        const std::size_t p = inner.count;
        inner.from[p] = from;
        inner.to[p] = out ? right : left;
        inner.volume[p] = v;
        inner.at[p] = at;
        inner.count += v > 0 ? 1 : 0;
        leave(from, v, at);
      }
      if (not pieces_of.empty())
        pieces_of[num_swept++] = {start,
                                  static_cast<std::int32_t>(inner.count)};
    }
    batch.count = 0;
  }

  /// Add the region swept by a facet on the boundary, with its marker.
  template <Geometry G>
  void sweep_boundary(const Motion& m, std::int32_t i, std::int32_t over,
                      std::int32_t boundary)
  {
    const SweptParts parts = swept_parts<G>(m);
    const double least = sliver<G>(m.q0 - m.p0, std::max(m.p0.x, m.q0.x));
    for (int k = 0; k < 2; ++k)
      if (const double v = std::abs(parts.v[k]); v > 0)
        pass(parts.v[k] > 0 ? i : -1, parts.v[k] > 0 ? -1 : i, v,
             v > least ? parts.at[k] : centroid[i], over, boundary);
  }

  /// All pieces are there: find the centroids of what remains.
  void settle_pieces()
  {
    for (std::int32_t i : touched)
    {
      const double rest = volume[i] - leaving[i];
      // Of a volume that leaves its place wholly nothing remains.
      remains[i] = (rest > 1e-12 * volume[i] ? 1 / rest : 0.0) * remains[i];
    }
  }

  /// Largest part of itself that one of our volumes loses.
  [[nodiscard]] double largest_loss() const
  {
    double loss = 0;
    for (std::int32_t i : touched)
      if (ours(i))
        loss = std::max(loss, leaving[i] / volume[i]);
    return loss;
  }
};
} // namespace remap
