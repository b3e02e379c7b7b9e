// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/parameter.h"
#include "scene/scene.h"
#include <string>
#include <vector>

/// A scene, and the language of scenes, for people and for summary.json.
namespace mmale::scene
{
/// The scene as understood: JSON text with the layout of the TOML file,
/// defaults filled in, what does not apply left out.
std::string describe(Scene scene);

/// One key of the language.
struct KeyInfo
{
  std::string key;      ///< dotted, NAME stands for a name of the user's
  std::string kind;     ///< "number", "text", ...
  std::string unit;     ///< "m"; "-" without dimension; "" when not a number
  std::string allowed;  ///< range or choices; may be empty
  std::string standard; ///< default; "required", or empty for nothing
  std::string sentence;
};

/// All keys in the order of the schema, then the numbers of every law.
std::vector<KeyInfo> key_reference(const Libraries& libraries);

/// What the laws take, as keys of a material whose table is `path`; its key
/// `law` is in the reference already.
/// @param path with the dot at its end
void add_laws(const std::string& path, const Libraries& libraries,
              std::vector<KeyInfo>& reference);

/// The reference as text: the key and its facts on one line, the sentence
/// below.
std::string to_string(const std::vector<KeyInfo>& reference);
} // namespace mmale::scene
