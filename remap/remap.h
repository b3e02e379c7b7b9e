// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: carry fields from a mesh to the same mesh with other node
// positions. In: old and new coordinates, means over cells, over the triangles
// of their points, over dual volumes, and velocities. Out: new means, and a
// ledger of what passed the boundary. Conserved: the integral of every
// component, momentum for a velocity.
#pragma once

#include "remap/geometry/volumes.h"
#include "remap/host.h"
#include "remap/materials/transport.h"
#include "remap/mesh.h"
#include "remap/outcome.h"
#include "remap/points.h"
#include "remap/transport/carrier.h"
#include "remap/transport/cell_volumes.h"
#include "remap/transport/nodal_volumes.h"
#include "remap/transport/overlap.h"
#include "remap/transport/repair.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace remap
{
/// How old volumes and new ones exchange what they hold.
enum class Method
{
  swept, ///< regions that facets sweep, in sub-cycles where needed; where they
         ///< would be too many, overlay takes the rest of the way
  overlay, ///< exact overlap of old and new volumes, of any length of way
};

/// How to remap.
struct Options
{
  Geometry geometry = Geometry::plane;
  Method method = Method::swept;
  Scheme scheme = scheme::LimitedLinear{};       ///< of cells and points
  Scheme nodal_scheme = scheme::LimitedLinear{}; ///< of nodal fields
  /// Largest part of itself that a volume may lose in one sub-cycle. Bounds
  /// hold below 1. Doubled: half the sub-cycles, less smearing, less stability.
  /// Infinite: never sub-cycle.
  double max_loss = 0.5;
  /// More sub-cycles than this, or a way on which a cell inverts, go to the
  /// overlay if that is ready, or end in `too_many_cycles`, `inverted_path`.
  int max_cycles = 200;
  /// Keep the overlay ready? It takes memory; fields per mass cannot use it,
  /// on more than one process nodal fields cannot either.
  bool overlay_ready = false;
  /// What each boundary marker does; a facet without a marker is closed.
  std::vector<Boundary> boundaries = {};
  /// Triangles of the cells' points, if there are any: must outlive this.
  const PointMesh* points = nullptr;
  int cell_components = 1;  ///< of the widest cell field that will come; or 0
  int point_components = 0; ///< of the widest point field
  int nodal_components = 0; ///< of the widest nodal field, or field per mass
  bool per_mass = false;    ///< will there be fields per mass?
  MaterialOptions materials = {}; ///< do cells hold materials?

  /// Every problem, in words; empty is good.
  [[nodiscard]] std::vector<std::string> complaints() const;
};

/// What one call did; the same on all ranks but for the counts, which are ours.
struct Report
{
  int cycles = 0;                 ///< sub-cycles
  bool overlaid = false;          ///< did the overlay take (part of) the way?
  double loss = 0;                ///< largest part lost by a volume, undivided
  std::int32_t moved_nodes = 0;   ///< of this rank, with ghosts
  std::int32_t touched_cells = 0; ///< of this rank, with ghosts
  std::int64_t worst_cell = -1;   ///< global number, where a cell inverts
  /// Least part of a velocity's limited correction that its kinetic energy let
  /// through.
  double kinetic_part = 1;
  /// Largest part of its mass that a node lost in a sub-cycle. Velocities keep
  /// their bounds below 1.
  double mass_loss = 0;
  /// Values of all ranks that were out of their range by more than round-off.
  std::int64_t repaired = 0;
  /// Largest amount of a component that found no room in its range.
  double unrepaired = 0;
  MaterialReport materials = {};
};

/// Remap with all the room it needs; set up once for a mesh.
class Remapper
{
public:
  /// @param[in] mesh    kept by reference: must outlive this
  /// @param[in] options see there
  /// @throws std::invalid_argument with every complaint, one a line
  Remapper(const Mesh& mesh, Options options);

  /// Carry fields from x_old to x_new. Collective. Only volumes next to a node
  /// that moved are worked on. When the outcome is not ok, fields are as they
  /// were if the report tells of no sub-cycle; else they stand part of the way,
  /// the ledger does not know of it, and the host goes back to its copy.
  ///
  /// @param[in]     x_old, x_new shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in,out] fields       what travels
  /// @param[in]     host         communication
  /// @param[in,out] ledger       grows by what passed the boundary; sized here
  ///                             at its first use
  [[nodiscard]] Outcome remap(std::span<const double> x_old,
                              std::span<const double> x_new,
                              const Fields& fields, const Host& host,
                              Ledger& ledger);

  /// Fields over cells and over dual volumes alone.
  [[nodiscard]] Outcome remap(std::span<const double> x_old,
                              std::span<const double> x_new,
                              std::span<const Field> cells,
                              std::span<const Field> nodes, const Host& host,
                              Ledger& ledger)
  {
    return remap(x_old, x_new, {.cells = cells, .nodes = nodes}, host, ledger);
  }

  /// What the last call did.
  [[nodiscard]] const Report& report() const { return _report; }
  [[nodiscard]] const Options& options() const { return _options; }

private:
  /// The triangles of the points, where they are asked for.
  struct Points
  {
    CellVolumes volumes;
    std::vector<double> x, y;        // of the triangles' nodes
    std::vector<std::uint8_t> moved; // of them
  };

  template <Geometry G>
  Outcome run(const Fields& fields, const Host& host, Ledger& ledger);
  /// Do materials make the density of fields per mass?
  static bool mixture(const Fields& fields)
  {
    return fields.material_density >= 0;
  }
  [[nodiscard]] bool sizes_fit(std::span<const double> x_old,
                               std::span<const double> x_new,
                               const Fields& fields) const;
  [[nodiscard]] bool some_node_is_massless() const;
  void find_touched(std::span<const double> x_old,
                    std::span<const double> x_new);
  void exchange_touched(const Host& host);
  void touch_points();
  void place_points(std::span<const std::int32_t> cells,
                    std::span<const double> from, std::vector<double>& to);
  void prepare_halos(const Host& host);
  template <Geometry G>
  void measure(bool with_ring, const Host& host);
  template <Geometry G>
  void measure_next(std::span<const double> y);
  [[nodiscard]] bool inverted(bool at_end, const Host& host);
  template <Geometry G>
  void sweep();
  template <Geometry G>
  Outcome sweep_on(const Fields& fields, const Host& host);
  template <Geometry G>
  Outcome overlay_on(const Fields& fields, const Host& host);
  template <Geometry G>
  Outcome choose_cycle(double at, double& left, double& loss, const Host& host);
  void place(double at);
  template <Geometry G>
  void carry(const Fields& fields, const Host& host);
  template <Geometry G>
  void carry_masses(const Fields& fields, std::size_t entry, const Host& host);
  std::size_t carry_all(ControlVolumes& volumes, std::span<const Field> fields,
                        const Scheme& scheme, const Halo& halo,
                        const Host& host, std::size_t entry,
                        int with_amounts = -1);
  template <Geometry G>
  void repair(const Fields& fields, const Host& host);
  void settle(const Fields& fields, const Host& host, Ledger& ledger);

  const Mesh* _mesh;
  Options _options;
  Report _report;
  CellVolumes _cells;
  NodalVolumes _nodes;
  std::unique_ptr<Points> _points;
  std::unique_ptr<MaterialTransport> _materials;
  std::vector<double> _mixture; // density of cells, if materials make it
  bool _dual = false;           // are there nodal fields in this call?
  bool _masses = false;         // are there fields per mass?
  bool _fine = false;           // are there fields at points?
  Amounts _amounts;             // of the density
  std::span<const double> _x_old, _x_new;
  std::vector<double> _x, _y;             // before and after a sub-cycle
  std::vector<std::uint8_t> _moved;       // per node
  std::vector<std::int32_t> _moved_nodes; // list of them
  std::vector<double> _flags;             // per node, for the halo
  std::vector<Exchange> _book;            // this call: volumes, all fields
  Halo _cell_halo, _point_halo, _node_halo;
  Repair _repair;
  std::unique_ptr<Overlap> _overlap;
};
} // namespace remap
