// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 0: the outline of a domain from a file: points in a text, or the paths
// of an SVG. In: the file's text. Out: shapes in the file's units, y up, with
// the line that each point stands on, and every trouble with its line. Nothing
// is thrown, and no file is opened.
#pragma once

#include "remap/domain/domain.h"

#include <string>
#include <string_view>
#include <vector>

namespace remap
{
/// What is wrong with a file, and where.
struct Trouble
{
  int line = 0; ///< from 1; 0: the file as a whole
  std::string what;
  bool crossing = false; ///< as of a Fault
};

/// Shapes of a file.
struct Drawing
{
  std::vector<Shape> shapes;
  /// Line of each point, for each ring counted through all shapes.
  std::vector<std::vector<int>> lines;
  std::vector<Trouble> troubles; ///< empty: it has been read

  /// Faults of the shapes as troubles of the file; those of the reading if
  /// there were any.
  [[nodiscard]] std::vector<Trouble> judge() const;
};

/// A text: a point a line, "x y", y up; an empty line ends a ring; from # on a
/// comment. Ring in ring is a hole (even-odd).
[[nodiscard]] Drawing read_text(std::string_view text);

/// An SVG: its filled paths, polygons, rectangles, circles and ellipses with
/// their transforms and fill rules. SVG has y down: it is turned over, so that
/// the drawing stands as it is seen.
///
/// @param[in] tolerance how far from a curve its chords may be, in the
///                      drawing's units, > 0
[[nodiscard]] Drawing read_svg(std::string_view text, double tolerance);

/// The rings of a domain as `read_text` reads them, to the last bit.
[[nodiscard]] std::string to_text(const Domain& domain);
} // namespace remap
