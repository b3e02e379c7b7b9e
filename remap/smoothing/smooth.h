// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: move flagged nodes so that cells get a better shape. In: node
// positions and what each node may do; out: better positions. Kept: no cell
// inverts, the worst cell does not get worse (surface nodes: see `Kind`), nodes
// without a flag stay to the last bit, the result is the same on any number of
// ranks.
#pragma once

#include "remap/host.h"
#include "remap/mesh.h"
#include "remap/outcome.h"
#include "remap/smoothing/guide.h"
#include "remap/smoothing/kind.h"
#include "remap/smoothing/library.h"
#include "remap/smoothing/stars.h"
#include "remap/smoothing/zigzag.h"

#include <span>
#include <string>
#include <vector>

namespace remap
{
/// How to smooth.
struct SmoothingOptions
{
  Geometry geometry = Geometry::plane; ///< what a surface node keeps
  SmootherChoice smoother = smoother::Optimise{};
  /// How quality is judged; `shape` needs targets to be more than mean ratio.
  Measure measure = Measure::radius_ratio;
  /// Quality below which a cell asks for help. A patch whose worst cell is
  /// above may get a worse one where its mean distortion falls, but not below
  /// the threshold, nor below the worst cell of all.
  double threshold = 0.3;
  /// Rings of nodes around those of bad cells that move too. Doubled: larger
  /// patches, softer transitions, more cost.
  int rings = 1;
  /// Passes over the flagged nodes. Doubled: closer to the optimum, twice the
  /// cost.
  int sweeps = 5;
  /// Part of a proposed step that is taken, in (0, 2). Above 1 (1.5 … 1.7) the
  /// mesh as a whole settles in a third of the sweeps, single bad cells later.
  double relaxation = 1;

  /// Every problem, in words; empty is good.
  [[nodiscard]] std::vector<std::string> complaints() const;
};

/// What nodes may do and want.
struct Constraints
{
  /// Shape (num_nodes).
  std::span<const Kind> kinds;
  /// Of sliding nodes, any length > 0, shape (num_nodes, 2); empty if none
  /// slides.
  std::span<const double> direction = {};
  /// Of nodes of kind `curve`; none needed if there is no such node.
  const Guide* guide = nullptr;
  /// Wanted length of each facet (only ratios matter), shape (num_facets);
  /// empty: see `Kind::surface`.
  std::span<const double> spacing = {};
  /// Shape (num_cells); empty: equilateral.
  std::span<const quality::Target> targets = {};
};

/// What one call did. Qualities are over the cells around flagged nodes, and
/// like the largest step they are the same on all ranks; counts are ours.
struct SmoothingReport
{
  double worst_before = 1;
  double worst_after = 1;
  double largest_step = 0;      ///< of a node, over all sweeps [m]
  std::int32_t moved = 0;       ///< nodes of this rank
  std::int32_t untangled = 0;   ///< cells that were inverted at the start
  std::int64_t worst_cell = -1; ///< global number, where a cell is inverted
};

/// Smoother with all the room it needs; set up once for a mesh.
class Smoothing
{
public:
  /// Colours the nodes. Collective.
  /// @param[in] mesh kept by reference: must outlive this
  /// @throws std::invalid_argument with every complaint, before any collective
  Smoothing(const Mesh& mesh, SmoothingOptions options, const Host& host);

  /// Flag the nodes of cells below the threshold, and rings around. Collective.
  ///
  /// @param[in]  x     shape (num_nodes, 2), ghosts up to date [m]
  /// @param[in]  targets as in `Constraints`
  /// @param[out] flags 1 for nodes that shall move, shape (num_nodes)
  /// @return does any rank have a flagged node?
  /// @throws std::invalid_argument if an array does not fit, before any
  ///         collective
  bool flag(std::span<const double> x, std::span<const quality::Target> targets,
            std::span<std::uint8_t> flags, const Host& host);

  /// Move flagged nodes. Collective. Nothing moves unless the outcome is ok.
  /// Where cells are inverted at the start, flagged nodes around them go to
  /// where they are not, if there is such a place: `untangle.h`.
  ///
  /// @param[in,out] x     shape (num_nodes, 2), ghosts up to date in and out
  /// [m]
  /// @param[in]     flags shape (num_nodes)
  [[nodiscard]] Outcome smooth(std::span<double> x,
                               std::span<const std::uint8_t> flags,
                               const Constraints& constraints,
                               const Host& host);

  [[nodiscard]] const SmoothingReport& report() const { return _report; }
  [[nodiscard]] const SmoothingOptions& options() const { return _options; }
  /// Colour of each node.
  [[nodiscard]] std::span<const std::int32_t> colours() const
  {
    return _colour;
  }

private:
  [[nodiscard]] bool sizes_fit(std::span<const double> x,
                               std::span<const std::uint8_t> flags,
                               const Constraints& c) const;
  void collect(std::span<const std::uint8_t> flags, const Constraints& c);
  /// Qualities of the cells that are worked on.
  struct Worst
  {
    double quality = 1;
    double inverted = -1; ///< global number of an inverted cell
    double count = 0;     ///< inverted cells of ours
  };
  [[nodiscard]] Worst worst_of(std::span<const double> x,
                               const Constraints& c) const;
  Patch gather(std::int32_t node, std::span<const double> x,
               const Constraints& c);
  template <class S>
  double visit(std::int32_t node, std::span<double> x, const Constraints& c);
  template <class S>
  double visit_surface(std::int32_t node, std::span<double> x,
                       const Constraints& c);
  template <class Place, class Good>
  double accept(std::int32_t node, std::span<double> x, Place&& place,
                Good&& good);
  [[nodiscard]] bool no_worse(Point to, double floor) const;
  Point come_back(std::int32_t node, std::span<double> x, const Guide& guide);
  void put(std::int32_t node, std::span<double> x, Point to);
  bool untangle_once(std::span<double> x, const Constraints& c, bool all,
                     const Host& host);
  bool untangle(std::span<double> x, const Constraints& c, const Host& host);
  template <class S>
  void sweeps(std::span<double> x, std::span<const std::uint8_t> flags,
              const Constraints& c, bool surfaces, const Host& host);

  const Mesh* _mesh;
  SmoothingOptions _options;
  Stars _stars;
  Zigzag _zigzag;
  SmoothingReport _report;
  int _num_colours = 0;
  std::vector<std::int32_t> _colour;
  double _floor = 0;                  // no cell gets worse than that
  std::vector<std::int32_t> _order;   // flagged nodes of ours, by colour
  std::vector<std::int32_t> _start;   // first of each colour in _order
  std::vector<std::int32_t> _cells;   // around them, each once
  std::vector<std::uint8_t> _near;    // is a cell in _cells?
  std::vector<PatchCell> _patch;      // of one node
  std::vector<double> _flags;         // for the halo
  std::vector<double> _before;        // nodes before untangling
  std::vector<std::uint8_t> _shifted; // nodes that moved
};

/// Shape of every cell at the given coordinates, as targets that keep a graded
/// mesh graded.
std::vector<quality::Target> shapes(const Mesh& mesh,
                                    std::span<const double> x);

/// Length of every facet at the given coordinates, as spacing that keeps a
/// surface's grading.
std::vector<double> facet_lengths(const Mesh& mesh, std::span<const double> x);

/// Smallest quality of the owned cells, and over all ranks. Collective.
double worst_quality(const Mesh& mesh, std::span<const double> x,
                     Measure measure, std::span<const quality::Target> targets,
                     const Host& host);
} // namespace remap
