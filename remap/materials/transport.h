// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 4: materials through one sub-cycle of a remap, with what they carry.
// In: what cells exchange, swept or overlaid. Regions that leave a mixed cell
// are cut by its interfaces, so that each piece goes from the slot of a
// material to the slot of the same material. Out: new fractions, centroids and
// fields. Conserved: the volume of each material, and the integral of every
// field over each material.
#pragma once

#include "remap/interfaces/interfaces.h"
#include "remap/materials/options.h"
#include "remap/materials/regions.h"
#include "remap/materials/slots.h"
#include "remap/transport/carrier.h"
#include "remap/transport/overlay.h"
#include "remap/transport/repair.h"

namespace remap
{
/// Materials in the world of a Remapper, with the room they need.
class MaterialTransport
{
public:
  /// A mass that went from cell to cell at a corner, not over a facet.
  struct Jump
  {
    std::int32_t cell;
    int corner;
    double mass; ///< out of the cell
  };

  /// @param[in] mesh, cells kept by reference: must outlive this
  /// @param[in] boundaries by marker
  MaterialTransport(const Mesh& mesh, CellVolumes& cells, Geometry geometry,
                    MaterialOptions options,
                    std::span<const Boundary> boundaries);

  /// Do the sizes of a call fit?
  [[nodiscard]] bool fits(const Fields& fields) const;

  /// A call begins.
  void start(const Fields& fields);
  /// Number of entries in the book: volumes, then fields.
  [[nodiscard]] std::size_t entries() const;

  /// One sub-cycle from x to y, after all that looks at cells.
  ///
  /// @param[in]  overlaid did the overlay make the pieces? Else they are swept
  /// @param[out] amounts what the cells' pieces take of the density, if wanted
  /// @param[in,out] book see `entries`
  template <Geometry G>
  void carry(std::span<const double> x, std::span<const double> y,
             bool overlaid, const Scheme& scheme, const Host& host,
             Amounts* amounts, std::span<Exchange> book);

  /// Density of a cell as a mixture.
  [[nodiscard]] double mixture(std::int32_t c) const;
  /// Mass that sliver sweeping moved in the last sub-cycle.
  [[nodiscard]] std::span<const Jump> jumps() const { return _jumps; }
  [[nodiscard]] const MaterialReport& report() const { return _report; }
  /// After the last sub-cycle: fields with a range back into it, each material
  /// by itself.
  /// @param[in]     x          coordinates now
  /// @param[in,out] repaired   grows by our values that were out of range
  /// @param[in,out] unrepaired largest amount that found no room
  void repair(std::span<const double> x, Repair& repair, const Host& host,
              double& repaired, double& unrepaired);
  /// After the last sub-cycle: add up the report.
  void count(const Host& host);

private:
  /// A part of a cell below this fraction is round-off.
  static constexpr double round_off = 1e-15;

  /// What one slot gives to another: a piece, or a part of one.
  struct Share
  {
    std::int32_t piece; ///< of the cells' inner pieces, or ~ of the outer ones
    std::int32_t from, to; ///< slots, -1: outside
    bool first;            ///< of its piece
    double volume;
    Point at;
  };
  /// A material that comes to a cell which did not hold it.
  struct Newcomer
  {
    std::int32_t cell, material, next;
  };
  /// A part of a new mixture, and the slot where its values stand; -1: unknown.
  struct Entry
  {
    std::int32_t cell, slot;
    Part part;
  };
  /// A piece as cells exchange it.
  struct Saved
  {
    std::int32_t piece, from, to;
    double volume;
    Point at;
  };
  /// A slot of which little is left: round-off of what was there speaks in its
  /// values.
  struct Thin
  {
    std::int32_t slot = -1;
    std::vector<std::int32_t> givers = {}; ///< slots that gave to it
    bool given = false;                    ///< did an inflow?
    std::size_t first = 0, last = 0;       ///< rows of `_ranges`
  };
  /// A parcel that comes to a slot, or (volume < 0) leaves it.
  struct Parcel
  {
    std::int32_t slot;
    double volume;
    Point at;
    std::int32_t values; ///< row in `_parcel_values`
  };

  // transport.cpp
  void widen_fields();
  void book_volumes(std::span<Exchange> book) const;
  void add_up(Amounts& amounts) const;

  // pieces.cpp
  void begin();
  template <Geometry G>
  void open(std::span<const double> x, std::span<const double> y, bool overlaid,
            const Host& host);
  template <Geometry G>
  void cut_swept(std::span<const double> x, std::span<const double> y);
  template <Geometry G>
  void cut_overlaid(std::span<const double> x, std::span<const double> y);
  template <Geometry G>
  [[nodiscard]] ByPart by_parts(const Motion& m, bool out,
                                std::int32_t c) const;
  void cut_boundary(std::int32_t p, const ByPart& parts);
  void share_piece(std::int32_t p, std::int32_t c, std::int32_t d, double v,
                   Point at, const ByPart& parts);
  void share(std::int32_t p, std::int32_t from, std::int32_t to, bool first,
             double v, Point at);
  [[nodiscard]] std::int32_t slot_for(std::int32_t c, std::int32_t material);
  [[nodiscard]] bool given(std::int32_t p) const;
  void grow();
  void set_slot(std::int32_t slot, std::int32_t c, std::int32_t material,
                double volume, Point at);
  void set_parts(const std::vector<double>& volume);
  void set_newcomers();
  void cap(const Host& host);
  void apply_caps();
  void leave_parts(std::span<const double> x, const Host& host);
  void write_shares();
  void write(const Share& s);
  void find_rows(std::span<const double> x);
  void restore();

  // thin.cpp
  void find_thin();
  void note_ranges(const MaterialField& field);
  void hold_thin(const MaterialField& field, bool extends) const;
  [[nodiscard]] double part_in_range(const Thin& t, std::size_t n,
                                     std::size_t first, int group,
                                     const double* u, double more) const;
  template <int N>
  [[nodiscard]] double part_in_hull(const Thin& t, std::size_t n,
                                    std::size_t first, const double* u) const;

  // settle.cpp
  void update(std::span<double> values, int block, const Host& host);
  template <Geometry G>
  void collect(std::span<const double> y);
  template <Geometry G>
  void collect_cell(std::int32_t c, std::span<const double> y);
  void exchange_entries(const Host& host);
  void assign();
  void keep_row(std::int32_t row);

  // slivers.cpp
  void sweep_slivers(std::span<const double> volume, std::span<const double> y,
                     const Host& host);
  [[nodiscard]] bool choose(std::span<const double> volume);
  void collect_parcels(std::span<const double> volume);
  void send(std::int32_t from, std::int32_t to, double v);
  void note_jump(std::int32_t c, std::int32_t d, double mass);
  void deliver(std::span<const double> volume, std::span<const double> y);

  [[nodiscard]] std::int32_t cell_of(std::int32_t slot) const
  {
    return slot < _cv->first_part ? slot
                                  : _cv->cell_of_part[slot - _cv->first_part];
  }

  const Mesh* _mesh;
  CellVolumes* _cv;
  MaterialOptions _options;
  std::span<const Boundary> _boundaries;
  Interfaces _interfaces;
  NearCells _near;
  SlotRows _rows, _sides;
  MaterialReport _report;

  Materials* _materials = nullptr;
  std::span<const MaterialField> _fields;
  int _density = -1;

  std::vector<std::int32_t> _kinds; // material of each slot
  std::vector<Newcomer> _newcomers;
  std::vector<std::int32_t> _head;   // first newcomer of each cell, or -1
  std::vector<std::int32_t> _guests; // cells with newcomers
  std::vector<double> _guests_next;  // their volumes after the sub-cycle
  std::vector<Share> _shares;
  std::vector<Saved> _saved;
  std::vector<ByPart> _left; // of each row: what an overlay took
  std::size_t _inner = 0, _outer = 0, _touched = 0, _ring = 0; // of cells
  // Piece of the cells that each piece behind theirs is a part of.
  std::vector<std::int32_t> _parent, _outer_parent;
  std::vector<Point> _moment; // of slots behind the cells, from their cell's
                              // old centroid
  std::vector<double> _caps;  // scale and share of each slot
  std::vector<double> _shift; // of the pieces of each slot
  std::vector<Thin> _thin;
  std::vector<double> _ranges; // old values in and around thin slots
  std::vector<Entry> _entries;
  std::vector<double> _buffer, _sent, _choice;
  std::vector<Parcel> _parcels;
  std::vector<double> _parcel_values;
  std::vector<Jump> _jumps;
  double _swept_number = 0, _swept_volume = 0; // slivers of this call
};
} // namespace remap
