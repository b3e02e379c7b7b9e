// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What travels, and the book of what passed the boundary.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace remap
{
/// What a vector or tensor that is limited as one stays in.
enum class Bound
{
  hull, ///< the convex hull of its neighbours: no value outside, order 1 where
        ///< values turn on a curved surface
  ball, ///< the smallest ball about its neighbours' mean that holds them: order
        ///< 2 there, and a value may leave a convex set by a little
};

/// A field given per volume (density, momentum density, a state that is a mean
/// over the volume), over cells or over the dual volumes of nodes.
struct Field
{
  /// In: before the remap; out: after. Shape (num, components), ghosts included
  /// and up to date on entry; the mean over each volume.
  std::span<double> values;
  int components = 1;
  /// So many consecutive components are one vector or tensor, at most
  /// `largest_group`. 1: each is limited by itself, between the least and the
  /// largest of its neighbours. More: together, see `bound`; no frame is
  /// preferred, and in the hull what lies in a convex set (a yield surface)
  /// stays there.
  int group = 1;
  /// Of groups; schemes that keep smooth extrema always take the ball.
  Bound bound = Bound::hull;
  /// Weights of a group's components in the square of its length, shape
  /// (group): 1, 1, 1, 2 for a tensor xx, yy, zz, xy. Empty: all 1.
  std::span<const double> weights = {};
  /// What flows in at open boundaries, shape (markers, components); may be
  /// empty if no boundary is open.
  std::span<const double> inflow = {};
  /// Range that no value may leave, shape (components), infinite where it has
  /// no end, or empty: none. A scheme that does not keep it by itself is
  /// repaired at the end of a remap.
  std::span<const double> least = {};
  std::span<const double> most = {};
};

/// Widest vector or tensor that is limited as one.
inline constexpr int largest_group = 6;

class Materials;

/// A field that each material has for itself: one value per volume in each slot
/// of the materials (materials/materials.h), limited within its material.
struct MaterialField
{
  /// Shape (slots, components), ghosts up to date on entry; resized as mixed
  /// cells come and go. Slots of mixed cells, in front of the parts, are 0, and
  /// so are slots of materials that do not have the field.
  std::vector<double>& values;
  int components = 1;
  int group = 1;                        ///< as `Field`
  Bound bound = Bound::hull;            ///< as `Field`
  std::span<const double> weights = {}; ///< as `Field`
  std::span<const double> inflow = {};  ///< as `Field`
  std::span<const double> least = {};   ///< as `Field`
  std::span<const double> most = {};    ///< as `Field`
  /// Does a material have it? Shape (materials), empty: all have. Void has
  /// none.
  std::span<const std::uint8_t> carriers = {};
};

/// All that travels in one remap, over regions that are computed once.
struct Fields
{
  std::span<const Field> cells = {};
  /// Over the triangles that the points of a cell stand for, shape
  /// (num_cells · points, components); see points.h.
  std::span<const Field> points = {};
  /// Over the dual volumes of nodes.
  std::span<const Field> nodes = {};
  /// At nodes too, but per mass (velocity): what is conserved is
  /// Σ mass · value, with the masses of the corners around a node.
  std::span<const Field> per_mass = {};
  /// Which of `cells` is the density that makes these masses; one component,
  /// > 0 everywhere.
  int density = -1;
  /// What cells hold; it travels too. Null: nothing is told apart.
  Materials* materials = nullptr;
  std::span<const MaterialField> of_materials = {};
  /// Which of `of_materials` is the density that makes the masses of corners,
  /// as a cell's mixture; then `density` is not looked at.
  int material_density = -1;
};

/// What a boundary facet with some marker does.
enum class Boundary
{
  closed,       ///< a wall; what a sliding node leaves over is booked
  free_surface, ///< beyond is void: gained volume takes the volume's own value
  open,         ///< gained volume takes the inflow, lost volume leaves
};

/// Does material come in with a given state somewhere?
inline bool any_open(std::span<const Boundary> kinds)
{
  return std::find(kinds.begin(), kinds.end(), Boundary::open) != kinds.end();
}

/// Does a field over so many volumes fit: its lengths, group and range?
/// @param[in] components of the widest field there is room for
/// @param[in] boundaries by marker; if one is open, a field brings what flows
/// in
template <class F>
[[nodiscard]] bool fits(const F& field, std::size_t num, int components,
                        std::span<const Boundary> boundaries)
{
  if (field.components < 1 or field.components > components or field.group < 1
      or field.group > largest_group or field.components % field.group != 0)
    return false;
  const auto n = static_cast<std::size_t>(field.components);
  return field.values.size() == n * num
         and (field.weights.empty()
              or field.weights.size() == static_cast<std::size_t>(field.group))
         and (field.least.empty() or field.least.size() == n)
         and std::equal(field.least.begin(), field.least.end(),
                        field.most.begin(), field.most.end(),
                        [](double a, double b) { return a <= b; })
         and (not any_open(boundaries)
              or field.inflow.size() == n * boundaries.size());
}

/// Ways over the boundary. What comes in counts positive, out negative.
enum class Way
{
  closed,  ///< over closed boundaries, net
  gained,  ///< taken from the void
  lost,    ///< left to the void
  inflow,  ///< in over open boundaries
  outflow, ///< out over open boundaries
};
inline constexpr std::size_t num_ways = 5;

/// Which way a piece over the boundary goes in the book.
inline Way way(Boundary kind, bool inwards)
{
  switch (kind)
  {
  case Boundary::free_surface:
    return inwards ? Way::gained : Way::lost;
  case Boundary::open:
    return inwards ? Way::inflow : Way::outflow;
  case Boundary::closed:
    break;
  }
  return Way::closed;
}

/// What a boundary with some marker does; without a marker it is closed.
inline Boundary kind_of(std::span<const Boundary> kinds, std::int32_t marker)
{
  return marker >= 0 and marker < static_cast<std::int32_t>(kinds.size())
             ? kinds[marker]
             : Boundary::closed;
}

/// Integral of one component (or the volume itself) that passed, by way.
using Exchange = std::array<double, num_ways>;

/// Net gain over all ways.
inline double net(const Exchange& e)
{
  double sum = 0;
  for (double part : e)
    sum += part;
  return sum;
}

/// Book of all exchange with the outside, summed over ranks and remaps.
/// After each remap: integral now = integral before + net, for every component.
struct Ledger
{
  Exchange cell_volume{};         ///< of the cells [m³/m or m³/rad]
  Exchange node_volume{};         ///< of the dual volumes
  std::vector<Exchange> cells;    ///< components of all cell fields, in order
  std::vector<Exchange> points;   ///< of all point fields
  std::vector<Exchange> nodes;    ///< of all nodal fields
  std::vector<Exchange> per_mass; ///< of all fields per mass: Σ mass · value
  std::vector<Exchange> material_volume; ///< of each material
  /// Components of all fields of materials, in order; of each field a row of
  /// components for each material.
  std::vector<Exchange> of_materials;
};
} // namespace remap
