// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/outline.h"
#include "scene/parameter.h"
#include "scene/scene.h"
#include <string>
#include <vector>

/// Everything that can be wrong with a scene, however it was built.
namespace mmale::scene
{
/// All complaints about a scene; empty is good. Places in the scene's own text
/// are left empty.
///
/// By value, because the schema visits through mutable references.
///
/// @param read_mesh  for shape "gmsh"; without it, what only the mesh tells
///                   (names of boundaries) is not checked
/// @param read_domain  for domains; without it their files are not looked at
/// @param read_region  for regions; without it neither polygons that cross
///                     themselves nor files are looked at
std::vector<Complaint> check(Scene scene, const Libraries& libraries,
                             const OutlineReader& read_mesh = {},
                             const DomainReader& read_domain = {},
                             const RegionReader& read_region = {});

/// Names become columns, folders and parts of dotted keys: letters, digits, _
/// and -, the first a letter or _.
bool is_name(const std::string& name);

/// Name of a stage in dotted keys: its own, or its number when it has none
/// of its own.
std::string stage_label(const std::vector<Stage>& stages, std::size_t i);
} // namespace mmale::scene
