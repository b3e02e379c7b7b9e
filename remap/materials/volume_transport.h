// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: carry the materials of all cells, their volumes and centroids,
// from a mesh to its new place, by exact overlap of new cells with the
// materials' polygons in the old ones. In: both places, the materials and the
// interfaces in their mixed cells, maybe the volume that each facet sweeps.
// Out: the materials of the new cells. Conserved: the volume of each material,
// to round-off; what passes the boundary is booked.
//
// Only the zone that can change is worked on: cells with an interface, those
// around them, and on outwards as far as materials moved. A cell whose
// surroundings hold one material alone is not looked at. Fractions stay in
// [0, 1] and add up to 1 at any displacement, since pieces of a cell do.
#pragma once

#include "remap/host.h"
#include "remap/materials/materials.h"
#include "remap/materials/walk.h"
#include "remap/outcome.h"
#include "remap/transport/field.h"

#include <cstdint>
#include <span>
#include <vector>

namespace remap
{
/// How volumes of materials are carried.
struct VolumeOptions
{
  Geometry geometry = Geometry::plane;
  /// A smaller fraction than this is given to a neighbour that holds the
  /// material, for the same volume of another one. Doubled: fewer and smaller
  /// islands of dust, a shape that is less exact by as little. Must stay below
  /// 1e-2.
  double sliver = 1e-10;
  /// What each boundary marker does; a facet without a marker is closed.
  std::vector<Boundary> boundaries = {};
  /// Material beyond each marker: what comes in over open boundaries, void
  /// beyond a free surface; -1, or not given: that of the cell itself.
  std::vector<std::int32_t> beyond = {};
};

/// What one call did; counts are this rank's.
struct VolumeReport
{
  std::int32_t zone = 0;    ///< cells that were looked at
  std::int32_t clipped = 0; ///< of them, those that met two materials
  std::int64_t pieces = 0;  ///< overlaps of a new cell with an old one
  std::int32_t slivers_swept = 0;
  std::int32_t slivers_kept = 0; ///< no neighbour had what they need
  double sliver_volume = 0;      ///< that was swept up
  double merged_volume = 0; ///< of more materials than a cell can hold, given
                            ///< to the largest of the others
  std::int64_t worst_cell = -1; ///< global number, where a call failed
};

/// Book of what passed the boundary, by material; volume now = volume before +
/// net, for each. Summed over ranks and calls.
struct MaterialLedger
{
  std::vector<Exchange> volume; ///< shape (materials) [m³/m or m³/rad]
};

/// Carries volumes and centroids of materials, with the room it needs.
class VolumeTransport
{
public:
  /// @param[in] mesh kept by reference: must outlive this
  /// @throws std::invalid_argument with every complaint, one a line
  VolumeTransport(const Mesh& mesh, VolumeOptions options);

  /// Carry. Collective. When the outcome is not ok, materials and ledger are
  /// as they were.
  ///
  /// @param[in]     x_old, x_new   shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in]     facet_volumes  volume that each facet sweeps, positive when
  /// its left cell loses (`swept`), shape (num_facets), of ghosts' facets too;
  /// facets are bent to it. Empty: facets stay straight.
  /// @param[in]     partitions     of each row of `materials`, ghosts' too
  /// @param[in,out] materials      ghosts up to date, then too
  /// @param[in]     host           communication
  /// @param[in,out] ledger         grows by what passed the boundary
  /// @return ok, wrong_size (or a material beyond that does not exist),
  ///         not_finite, bad_materials, inverted_start, inverted_target (a
  ///         cell of the zone is not seen wholly from its middle), beyond_halo
  [[nodiscard]] Outcome carry(std::span<const double> x_old,
                              std::span<const double> x_new,
                              std::span<const double> facet_volumes,
                              std::span<const Partition> partitions,
                              Materials& materials, const Host& host,
                              MaterialLedger& ledger);

  /// What the last call did.
  [[nodiscard]] const VolumeReport& report() const { return _report; }

private:
  /// Of an area's scale: a smaller gap is round-off of many cuts.
  static constexpr double round_off = 1e-13;
  /// A larger one has to be explained.
  static constexpr double gap_size = 1e-9;

  /// What is known of a new cell.
  enum Status : std::uint8_t
  {
    unseen,
    looked,  ///< its middle lies in what the cell holds already
    waiting, ///< on the list
    mixed,   ///< it met an interface, or the outside
    pure,    ///< it met one material alone
  };
  /// Volume and moment of one material in a new cell.
  struct Share
  {
    std::int32_t material;
    Moments moments; ///< about the cell's origin
  };
  /// A new cell of ours, done.
  struct Result
  {
    std::int32_t cell, first, count; ///< shares; none: pure
    Point origin;
    double length;
  };
  /// An old cell with an interface, or on a moved outline.
  struct Front
  {
    std::int32_t cell, first, count; ///< volumes given, by part
    double whole, length;
    bool done = false; ///< all of it found, or looked for
  };
  /// All that one call reads.
  struct Call
  {
    std::span<const double> x_old, x_new, facet_volumes;
    std::span<const Partition> partitions;
    const Materials* materials;
    const Host* host;
  };

  template <Geometry G>
  Outcome run(Materials& materials, MaterialLedger& ledger);
  void reset();
  template <Geometry G>
  void find_fronts();
  template <Geometry G>
  [[nodiscard]] bool outline_moved(std::int32_t f) const;
  template <Geometry G>
  void add_front(std::int32_t c);
  void put(std::int32_t c);
  template <Geometry G>
  void work_off();
  template <Geometry G>
  void exchange_status();
  template <Geometry G>
  void carry_cell(std::int32_t d);
  [[nodiscard]] bool alone(std::int32_t& material) const;
  [[nodiscard]] std::int32_t material_of_rest() const;
  template <Geometry G>
  void gather(const bent::Cell& target, bool count_only);
  void share(std::int32_t material, const Moments& m);
  template <Geometry G>
  void close(std::int32_t d, const bent::Cell& target);
  template <Geometry G>
  [[nodiscard]] std::int32_t
  facet_beyond(std::int32_t d, const bent::Cell& target, double scale);
  void gain(std::int32_t d, const bent::Cell& target, std::int32_t facet);
  void settle(std::int32_t d, const bent::Cell& target);
  [[nodiscard]] std::int32_t edge_inside(const CellWalk& walk,
                                         std::span<const double> x,
                                         Point origin, const Triangle& place,
                                         bool& halo) const;
  bool spread_zone();
  bool search_missing();
  [[nodiscard]] double missing(const Front& front) const;
  template <Geometry G>
  [[nodiscard]] double kept(std::int32_t c);
  template <Geometry G>
  bool book_lost(const Front& f);
  template <Geometry G>
  void book_all_lost();
  void book(std::int32_t material, std::int32_t facet, bool inwards,
            double volume);
  void write(Materials& materials);
  void fail(Outcome outcome, std::int32_t c);

  const Mesh* _mesh;
  VolumeOptions _options;
  CellWalk _walk, _back; ///< through the old mesh, through the new one
  Call _call;
  VolumeReport _report;
  Outcome _outcome = Outcome::ok;
  std::vector<std::uint8_t> _status;   ///< of all cells, as new ones
  std::vector<std::int32_t> _pure_of;  ///< material, where status is pure
  std::vector<std::int32_t> _front_of; ///< front of an old cell, or -1
  std::vector<Front> _fronts;
  std::vector<double> _given; ///< by fronts' parts
  std::vector<std::int32_t> _queue, _listed;
  bool _outline_moved = false; ///< by more than sliding
  std::size_t _spread = 0;     ///< of the listed cells, those spread from
  std::vector<Result> _results;
  std::vector<Share> _shares;
  std::size_t _first = 0; ///< share of the cell at work
  double _other = 0;      ///< longest edge that it met
  std::vector<std::pair<std::int32_t, double>> _taken; ///< from fronts, by it
  std::vector<Exchange> _passed; ///< by material, of this call and rank
  std::vector<double> _flags;    ///< of cells, for halos
};
} // namespace remap
