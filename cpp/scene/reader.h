// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/document.h"
#include "scene/outline.h"
#include "scene/parameter.h"
#include "scene/scene.h"
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// TOML text and overrides in, a scene and every complaint about it out.
namespace mmale::scene
{
/// A scene as read; it may run when there are no complaints.
struct Reading
{
  Scene scene;
  std::vector<Complaint> complaints; ///< in the order of the file's lines
};

/// Text of a file, or why it cannot be had.
struct FileText
{
  std::string text;
  std::vector<Complaint> complaints;
};

/// Load a file: missing, a folder, empty and unreadable are complaints.
/// @param kind what it is to be, in folders named `kind`.toml
FileText load(const std::filesystem::path& path,
              const std::string& kind = "scene");

/// Read a scene and check it.
///
/// @param text       TOML
/// @param file       its name for messages
/// @param overrides  changes, in order; the last on a key holds
/// @param libraries  laws, smoothers and schemes that may be named
/// @param read_mesh    for a gmsh mesh, see `check`
/// @param read_domain  for domains, see `check`
/// @param read_region  for regions, see `check`
Reading read(std::string_view text, const std::string& file,
             std::span<const Override> overrides, const Libraries& libraries,
             const OutlineReader& read_mesh = {},
             const DomainReader& read_domain = {},
             const RegionReader& read_region = {});
} // namespace mmale::scene
