// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/scene.h"
#include <array>
#include <functional>
#include <string>
#include <vector>

/// What the checks want to know of the body's first outline. The built-in
/// shapes tell it by themselves; of a gmsh mesh only its file does.
namespace mmale::scene
{
struct Outline
{
  /// A boundary that stages and curves may name.
  struct Part
  {
    std::string name;
    bool straight = true; ///< all of it on one line
    /// Is any straight stretch of it longer along x (along y) than 1e-9 of its
    /// length? Both: slanted or curved.
    std::array<bool, 2> extends = {false, false};
  };
  std::vector<Part> boundary;
  Point low, high; ///< box around the body [m]
  /// False when a point lies outside the body by more than round-off; true
  /// too where the scene does not tell.
  std::function<bool(const Point&)> may_hold;
  std::vector<Complaint> complaints; ///< about the mesh itself

  const Part* find(const std::string& name) const;
  std::vector<std::string> names() const;
};

/// Reads the mesh of a scene with shape "gmsh". It may call programs, so one
/// process does it. When the outline has complaints, the rest of it is not
/// looked at.
using OutlineReader = std::function<Outline(const Scene&)>;

/// What the checks want to know of a domain's file.
struct DomainOutline
{
  Point low, high; ///< box around it, as it is placed [m]
  std::vector<Complaint> complaints;
};

/// Reads the file of a domain; the name is the scene's. When there are
/// complaints, the rest is not looked at.
using DomainReader =
    std::function<DomainOutline(const std::string& name, const Domain&)>;

/// The same for a region with shape "polygon" or "file"; the key is its
/// table's.
using RegionReader =
    std::function<DomainOutline(const std::string& key, const Region&)>;
} // namespace mmale::scene
