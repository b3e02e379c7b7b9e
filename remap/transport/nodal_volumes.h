// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: the dual volumes of nodes as control volumes, for fields per
// volume (pressure) and, after them in the same sub-cycle, for fields per mass
// (velocity).
//
// Masses. The mass of a node is that of the corners around it. What cells
// exchange over half a facet goes from corner to corner of the same node; so in
// each cell three flows between its corners are left, and the balances of the
// corners, with the new density, give them but for a part that runs in a
// circle. Node masses are then those of the new cells to round-off, not masses
// of their own; a new velocity is a mean of old ones, and momentum is
// conserved.
// @source after Loubère & Shashkov (2005), whose subcells have densities of
// their own.
#pragma once

#include "remap/dual/dual.h"
#include "remap/host.h"
#include "remap/transport/cell_volumes.h"

#include <array>

namespace remap
{
struct NodalVolumes : ControlVolumes
{
  static constexpr int flows = 9;

  const Mesh* mesh = nullptr;
  /// Mass flows of a cell: between its corners i and i + 1, then over boundary
  /// facet i at its first and at its second vertex; shape (num_cells, 9).
  std::vector<double> flow;
  std::vector<double> density; ///< of cells before the sub-cycle
  std::vector<double> passing; ///< mass out over half facets, (facets, 2)
  std::vector<double> mass;    ///< of nodes before the sub-cycle
  /// Mass that left a cell at each corner for another cell there, not over a
  /// facet, (cells, 3); empty if that cannot be.
  std::vector<double> jump;

  /// @param[in] masses will there be fields per mass?
  void reserve(const Mesh& of, bool masses, int components)
  {
    mesh = &of;
    const auto cells = static_cast<std::size_t>(of.num_cells());
    ControlVolumes::reserve(of.node_nodes(), of.node_nodes(), of.owned_nodes(),
                            (masses ? 5 : 3) * cells,
                            (masses ? 4 : 2) * outer_facets(of), components);
    if (not masses)
      return;
    flow.assign(std::size_t(flows) * cells, 0);
    density.assign(cells, 0);
    passing.assign(std::size_t(2) * of.num_facets(), 0);
    mass.assign(of.num_nodes(), 0);
  }

  template <Geometry G>
  void measure(std::span<const std::int32_t> list, std::span<const double> x)
  {
    for (std::int32_t i : list)
    {
      const Moments m = dual::volume<G>(*mesh, i, x);
      volume[i] = m.v;
      centroid[i] = m.centroid();
    }
  }

  /// The corners around a ghost node are not all here.
  void update_centroids(const Host& host)
  {
    host.update_nodes(std::span(&centroid[0].x, std::size_t(2) * num), 2);
  }

  template <Geometry G>
  void measure_next(std::span<const double> y)
  {
    for (std::int32_t i : touched)
      next[i] = dual::volume<G>(*mesh, i, y).v;
  }

  /// Regions swept by the dual facets of the cells that change.
  template <Geometry G>
  void sweep_all(std::span<const std::int32_t> cells,
                 std::span<const std::uint8_t> moved, std::span<const double> x,
                 std::span<const double> y)
  {
    drop_pieces();
    for (std::int32_t c : cells)
      sweep_cell<G>(c, moved, x, y);
    flush<G>();
    settle_pieces();
  }

  /// Before the cells' density travels: keep it, and the nodes' masses.
  template <Geometry G>
  void keep_density(std::span<const std::int32_t> cells,
                    std::span<const double> rho, std::span<const double> x)
  {
    for (std::int32_t c : cells)
      density[c] = rho[c];
    for (std::int32_t i : touched)
      if (i < owned)
      {
        mass[i] = 0;
        for (std::int32_t c : mesh->node_cells()[i])
          mass[i] += rho[c] * corner_volume<G>(c, corner_of(c, i), x);
      }
  }

  /// After it has: the flows of mass in the cells that change.
  /// `passing` tells what went over the facets.
  template <Geometry G>
  void find_flows(std::span<const std::int32_t> cells, std::int32_t owned_cells,
                  std::span<const double> rho, std::span<const double> x,
                  std::span<const double> y, const Host& host)
  {
    for (std::int32_t c : cells)
      if (c < owned_cells)
        balance<G>(c, rho[c], x, y);
    host.update_cells(flow, flows);
  }

  /// Make the pieces those of mass, and the volumes masses.
  template <Geometry G>
  void exchange_masses(std::span<const std::int32_t> cells,
                       std::span<const std::uint8_t> moved,
                       std::span<const double> x, std::span<const double> y)
  {
    for (std::int32_t i : touched)
      volume[i] = next[i] = mass[i];
    drop_pieces();
    for (std::int32_t c : cells)
      exchange_cell<G>(c, moved, x, y);
    settle_pieces();
  }

private:
  [[nodiscard]] int corner_of(std::int32_t c, std::int32_t i) const
  {
    const Triple& n = mesh->cell(c);
    return n[0] == i ? 0 : (n[1] == i ? 1 : 2);
  }

  template <Geometry G>
  [[nodiscard]] double corner_volume(std::int32_t c, int i,
                                     std::span<const double> x) const
  {
    const Triple& n = mesh->cell(c);
    return corner<G>(point(x, n[i]), point(x, n[(i + 1) % 3]),
                     point(x, n[(i + 2) % 3]))
        .v;
  }

  /// Motions of a cell's dual facets and of the halves of its boundary facets.
  /// @param[in] inner called with i, the motion between vertices i and i + 1
  /// @param[in] outer called with facet i, its end 0 or 1, that half's motion
  template <class Inner, class Outer>
  void each_facet(std::int32_t c, std::span<const std::uint8_t> moved,
                  std::span<const double> x, std::span<const double> y,
                  const Inner& inner, const Outer& outer) const
  {
    const Triple& n = mesh->cell(c);
    const dual::Corners before = dual::corners(*mesh, c, x);
    const dual::Corners after = dual::corners(*mesh, c, y);
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      inner(i, dual::facet(before, after, i));
      if (not mesh->on_boundary(mesh->cell_facets(c)[i])
          or not(moved[n[i]] or moved[n[j]]))
        continue;
      const Point m0 = middle(before.v[i], before.v[j]);
      const Point m1 = middle(after.v[i], after.v[j]);
      outer(i, 0, Motion{before.v[i], m0, after.v[i], m1});
      outer(i, 1, Motion{m0, before.v[j], m1, after.v[j]});
    }
  }

  template <Geometry G>
  void sweep_cell(std::int32_t c, std::span<const std::uint8_t> moved,
                  std::span<const double> x, std::span<const double> y)
  {
    const Triple& n = mesh->cell(c);
    each_facet(
        c, moved, x, y,
        [&](int i, const Motion& m)
        {
          const int j = (i + 1) % 3;
          if (n[i] < owned or n[j] < owned)
            sweep<G>(m, n[i], n[j]);
        },
        [&](int i, int end, const Motion& m)
        {
          const std::int32_t f = mesh->cell_facets(c)[i];
          if (const std::int32_t node = n[(i + end) % 3]; node < owned)
            sweep_boundary<G>(m, node, f, mesh->marker(f));
        });
  }

  /// Mass that leaves a cell over the half of its facet k at its vertex i.
  [[nodiscard]] double over_half(std::int32_t c, int k, int i) const
  {
    const std::int32_t f = mesh->cell_facets(c)[k];
    const int end = mesh->facet(f)[0] == mesh->cell(c)[i] ? 0 : 1;
    const double out = passing[std::size_t(2) * f + end];
    return mesh->facet_cells(f)[0] == c ? out : -out;
  }

  /// Flows of a cell from vertex i to i + 1.
  template <Geometry G>
  void balance(std::int32_t c, double rho, std::span<const double> x,
               std::span<const double> y)
  {
    const dual::Corners before = dual::corners(*mesh, c, x);
    const dual::Corners after = dual::corners(*mesh, c, y);
    double rest[3], circle = 0;
    for (int i = 0; i < 3; ++i)
    {
      rest[i] = density[c] * corner_volume<G>(c, i, x)
                - rho * corner_volume<G>(c, i, y) - over_half(c, i, i)
                - over_half(c, (i + 2) % 3, i);
      if (not jump.empty())
        rest[i] -= jump[std::size_t(3) * c + static_cast<std::size_t>(i)];
      circle += swept<G>(dual::facet(before, after, i)).v;
    }
    // What runs in a circle is what the dual facets sweep so.
    circle *= 0.5 * (density[c] + rho) / 3;
    double* out = &flow[std::size_t(flows) * c];
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      const bool last = mesh->on_boundary(mesh->cell_facets(c)[i]);
      out[i] = circle + (rest[i] - rest[j]) / 3;
      out[3 + 2 * i] = last ? over_half(c, i, i) : 0;
      out[4 + 2 * i] = last ? over_half(c, i, j) : 0;
    }
  }

  /// Mass m > 0 goes from a to b, m < 0 the other way.
  void give(std::int32_t a, std::int32_t b, double m, Point at)
  {
    if (m == 0 or (a >= owned and b >= owned))
      return;
    next[a] -= m;
    next[b] += m;
    exchange(m > 0 ? a : b, m > 0 ? b : a, std::abs(m), at);
  }

  void give_out(std::int32_t i, double m, Point at, std::int32_t over,
                std::int32_t boundary)
  {
    if (m == 0 or i >= owned)
      return;
    next[i] -= m;
    pass(m > 0 ? i : -1, m > 0 ? -1 : i, std::abs(m), at, over, boundary);
  }

  /// What a moved facet exchanges: the swept parts with the cell's density, and
  /// what is left of its flow in its middle. A facet that turns has no flow,
  /// but what it sweeps to either side is exchanged.
  template <Geometry G, class Give>
  static void exchange_facet(const Motion& m, double rho, double flow,
                             const Give& give)
  {
    const SweptParts parts = swept_parts<G>(m);
    for (int k = 0; k < 2; ++k)
    {
      give(rho * parts.v[k], parts.at[k]);
      flow -= rho * parts.v[k];
    }
    give(flow, 0.25 * (m.p0 + m.q0 + m.p1 + m.q1));
  }

  template <Geometry G>
  void exchange_cell(std::int32_t c, std::span<const std::uint8_t> moved,
                     std::span<const double> x, std::span<const double> y)
  {
    const Triple& n = mesh->cell(c);
    const double* out = &flow[std::size_t(flows) * c];
    each_facet(
        c, moved, x, y,
        [&](int i, const Motion& m)
        {
          exchange_facet<G>(m, density[c], out[i], [&](double mass, Point at)
                            { give(n[i], n[(i + 1) % 3], mass, at); });
        },
        [&](int i, int end, const Motion& m)
        {
          const std::int32_t f = mesh->cell_facets(c)[i];
          exchange_facet<G>(
              m, density[c], out[3 + 2 * i + end], [&](double mass, Point at)
              { give_out(n[(i + end) % 3], mass, at, f, mesh->marker(f)); });
        });
  }
};
} // namespace remap
