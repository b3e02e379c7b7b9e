// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What a call of the library can end with. Never thrown, never printed: the
// host looks at it and recovers. All ranks get the same value.
#pragma once

#include <string_view>

namespace remap
{
/// How smoothing or remapping ended.
enum class Outcome
{
  ok,              ///< done
  wrong_size,      ///< a span does not fit the mesh, or a field the options;
                   ///< nothing was changed
  not_finite,      ///< a coordinate is NaN or infinite; nothing was changed
  inverted_start,  ///< a cell to be worked on has no positive volume at start
  inverted_target, ///< a cell would have no positive volume at its new place
  inverted_path,   ///< a cell loses its volume between two valid places
  too_many_cycles, ///< the stated loss needs more sub-cycles than allowed
  beyond_halo,     ///< overlay: a cell meets cells that this rank does not see
  bad_materials,   ///< fractions that do not add up, a part outside its cell;
                   ///< nothing was changed
  no_mass,         ///< a node with a velocity has no mass around it: void needs
                   ///< a small density; nothing was changed
};

/// The outcome in words.
constexpr std::string_view describe(Outcome outcome)
{
  switch (outcome)
  {
  case Outcome::ok:
    return "done";
  case Outcome::wrong_size:
    return "an array does not fit the mesh, or a field the options";
  case Outcome::not_finite:
    return "a coordinate is not finite";
  case Outcome::inverted_start:
    return "a cell has no positive volume before the remap";
  case Outcome::inverted_target:
    return "a cell would have no positive volume after the remap";
  case Outcome::inverted_path:
    return "a cell loses its volume on the way to its new place";
  case Outcome::too_many_cycles:
    return "the move needs more sub-cycles than allowed";
  case Outcome::bad_materials:
    return "a cell's fractions do not add up, or a part lies outside its cell";
  case Outcome::no_mass:
    return "a node with a velocity has no mass around it";
  case Outcome::beyond_halo:
    return "a cell moved to where this rank does not see the mesh";
  }
  return "unknown";
}
} // namespace remap
