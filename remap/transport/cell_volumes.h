// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the cells of a mesh as control volumes: which change when nodes
// move, how large they are, what their facets sweep. Used for the cells and for
// the triangles of their points.
#pragma once

#include "remap/transport/control_volumes.h"

#include <algorithm>
#include <numeric>

namespace remap
{
template <Geometry G>
Moments cell_moments(const Mesh& mesh, std::int32_t c,
                     std::span<const double> x)
{
  const Triple& n = mesh.cell(c);
  return triangle<G>(point(x, n[0]), point(x, n[1]), point(x, n[2]));
}

/// Neighbours of every cell across its facets.
inline Adjacency sides_of(const Mesh& mesh)
{
  Adjacency out;
  out.offsets.push_back(0);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    for (std::int32_t f : mesh.cell_facets(c))
      for (std::int32_t other : mesh.facet_cells(f))
        if (other >= 0 and other != c)
          out.entries.push_back(other);
    out.offsets.push_back(static_cast<std::int32_t>(out.entries.size()));
  }
  return out;
}

/// Facets with one cell.
inline std::size_t outer_facets(const Mesh& mesh)
{
  std::size_t n = 0;
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
    n += mesh.facet_cells(f)[1] < 0 ? 1 : 0;
  return n;
}

/// Cells of one mesh as control volumes.
struct CellVolumes : ControlVolumes
{
  const Mesh* mesh = nullptr;
  Adjacency across; ///< empty if no limiter looks there
  /// Facets that sweep, in the cells' order: between cells, on the boundary.
  std::vector<std::int32_t> facets, boundary;

  /// @param[in] with_sides  does a limiter look across facets?
  /// @param[in] with_pieces will `split` be asked for?
  void reserve(const Mesh& of, bool with_sides, bool with_pieces,
               int components)
  {
    mesh = &of;
    if (with_sides)
      across = sides_of(of);
    const std::size_t outer = outer_facets(of);
    const auto all = static_cast<std::size_t>(of.num_facets());
    ControlVolumes::reserve(of.cell_cells(), across, of.owned_cells(),
                            all - outer, outer, components);
    const auto ids = of.cell_ids();
    if (not std::is_sorted(ids.begin(), ids.end()))
    {
      at_place.resize(ids.size());
      place.resize(ids.size());
      std::iota(at_place.begin(), at_place.end(), 0);
      std::sort(at_place.begin(), at_place.end(),
                [&ids](std::int32_t a, std::int32_t b)
                { return ids[a] < ids[b]; });
      for (std::size_t k = 0; k < ids.size(); ++k)
        place[at_place[k]] = static_cast<std::int32_t>(k);
    }
    facets.reserve(all - outer);
    boundary.reserve(outer);
    if (with_pieces)
      pieces_of.resize(all - outer);
  }

  /// The list of facets that sweep: an end moved, and a cell beside is ours.
  /// @param[in] moved flag of every node
  void find_facets(std::span<const std::uint8_t> moved)
  {
    facets.clear();
    boundary.clear();
    for (std::int32_t c : touched)
      for (std::int32_t f : mesh->cell_facets(c))
      {
        const auto [left, right] = mesh->facet_cells(f);
        const auto [p, q] = mesh->facet(f);
        // A facet with a moved end has both its cells in the list: once is
        // enough.
        if (left == c and (moved[p] or moved[q])
            and (left < owned or (right >= 0 and right < owned)))
          (right < 0 ? boundary : facets).push_back(f);
      }
  }

  template <Geometry G>
  void measure(std::span<const std::int32_t> list, std::span<const double> x)
  {
    for (std::int32_t c : list)
    {
      const Moments m = cell_moments<G>(*mesh, c, x);
      volume[c] = m.v;
      centroid[c] = m.centroid();
    }
  }

  /// Volumes at y.
  template <Geometry G>
  void measure_next(std::span<const double> y)
  {
    for (std::int32_t c : touched)
      next[c] = cell_moments<G>(*mesh, c, y).v;
  }

  /// Regions swept between x and y.
  template <Geometry G>
  void sweep_all(std::span<const double> x, std::span<const double> y)
  {
    drop_pieces();
    const auto motion = [&](std::int32_t f) -> Motion
    {
      const auto [p, q] = mesh->facet(f);
      return {point(x, p), point(x, q), point(y, p), point(y, q)};
    };
    for (std::int32_t f : facets)
    {
      const auto [left, right] = mesh->facet_cells(f);
      sweep<G>(motion(f), left, right);
    }
    flush<G>();
    for (std::int32_t f : boundary)
      sweep_boundary<G>(motion(f), mesh->facet_cells(f)[0], f, mesh->marker(f));
    settle_pieces();
  }

  /// What passed over the two halves of each facet, out of its left cell.
  ///
  /// A region swept by a facet whose ends move by different lengths has its
  /// centroid off the middle by b/12 and its halves differ by b/4, b the
  /// difference over the sum: one tells the other.
  ///
  /// @param[in]  amount_inner, amount_outer of each piece
  /// @param[out] passing shape (num_facets, 2)
  void split(std::span<const double> x, std::span<const double> y,
             std::span<const double> amount_inner,
             std::span<const double> amount_outer,
             std::span<double> passing) const
  {
    // Part of a piece that is on the side of the facet's first end.
    const auto first = [&](std::int32_t f, Point at)
    {
      const auto [p, q] = mesh->facet(f);
      const Point a = middle(point(x, p), point(y, p));
      const Point along = middle(point(x, q), point(y, q)) - a;
      return 0.5 - 1.5 * (dot(at - a, along) / dot(along, along) - 0.5);
    };
    const auto add = [&](std::int32_t f, double amount, Point at)
    {
      const double part = first(f, at);
      passing[std::size_t(2) * f] += part * amount;
      passing[std::size_t(2) * f + 1] += (1 - part) * amount;
    };
    for (const auto* list : {&facets, &boundary})
      for (std::int32_t f : *list)
        passing[std::size_t(2) * f] = passing[std::size_t(2) * f + 1] = 0;
    for (std::size_t k = 0; k < facets.size(); ++k)
      for (std::int32_t i = pieces_of[k][0]; i < pieces_of[k][1]; ++i)
        add(facets[k],
            inner.from[i] == mesh->facet_cells(facets[k])[0] ? amount_inner[i]
                                                             : -amount_inner[i],
            inner.at[i]);
    for (std::size_t i = 0; i < outer.count; ++i)
      add(facet[i], outer.from[i] >= 0 ? amount_outer[i] : -amount_outer[i],
          outer.at[i]);
  }

  /// Global number of one of our cells without positive volume, or -1.
  [[nodiscard]] double inverted(std::span<const double> volumes) const
  {
    double worst = -1;
    for (std::int32_t c : touched)
      if (c < owned and not(volumes[c] > 0))
        worst = std::max(worst, static_cast<double>(mesh->cell_ids()[c]));
    return worst;
  }
};
} // namespace remap
