// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A user's mistake, in words that say where it is and what is allowed.
namespace mmale::scene
{
/// Where something was written.
struct Place
{
  std::string file; ///< as the user named it, or "command line"
  int line = 0;     ///< 1 is the first; 0 where lines mean nothing
};

/// One mistake.
struct Complaint
{
  std::string key;  ///< dotted, "stage.push.step"; empty: the file as a whole
  std::string what; ///< what is wrong and what is allowed
  Place place;      ///< empty for a scene that a program built
};

/// "demos/x/scene.toml:12: mesh.size: must be > 0 m, is -1".
std::string to_string(const Complaint& complaint);

/// The known name that is reached with the fewest edits (insert, delete,
/// replace, swap of neighbours) for its length; "" when half of the letters
/// or more would have to change, for then it is no slip of the finger.
std::string nearest(std::string_view name, std::span<const std::string> known);

/// "did you mean 'size'? (known: height, size, width)", for a message; the
/// question is left out when no name is near.
std::string suggestion(std::string_view name,
                       std::span<const std::string> known);

/// "missing: Width of the rectangle [m], > 0".
///
/// @param sentence  what is missing
/// @param unit      "" or "-" when there is none
/// @param allowed   range or choices, may be empty
std::string missing(const std::string& sentence, const std::string& unit,
                    const std::string& allowed);

/// "a, b, c".
std::string join(std::span<const std::string> words);
} // namespace mmale::scene
