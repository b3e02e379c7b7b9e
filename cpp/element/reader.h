// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/test.h"
#include "scene/complaint.h"
#include "scene/describe.h"
#include "scene/document.h"
#include "scene/parameter.h"
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// TOML text and overrides in, an element test and every complaint about it
/// out.
namespace mmale::element
{
struct Reading
{
  Test test;
  std::vector<scene::Complaint> complaints; ///< in the order of the lines
};

/// Read a test and check it.
///
/// @param text       TOML
/// @param file       its name for messages
/// @param overrides  changes, in order; the last on a key holds
/// @param libraries  laws that may be named
Reading read(std::string_view text, const std::string& file,
             std::span<const scene::Override> overrides,
             const scene::Libraries& libraries);

/// Everything that can be wrong with a test, however it was built.
std::vector<scene::Complaint> check(Test test,
                                    const scene::Libraries& libraries);

/// The test as understood, JSON text.
std::string describe(Test test);

/// All keys, then the numbers of every law.
std::vector<scene::KeyInfo> key_reference(const scene::Libraries& libraries);

/// A path in words: "path 2 (shear)".
std::string label(const std::vector<Path>& paths, std::size_t i);
} // namespace mmale::element
