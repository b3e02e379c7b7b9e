// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/parameter.h"
#include "scene/scene.h"
#include <string>
#include <vector>

/// Everything that can be wrong with a scene, however it was built.
namespace mmale::scene
{
/// All complaints about a scene; empty is good. Places are left empty.
///
/// By value, because the schema visits through mutable references.
std::vector<Complaint> check(Scene scene, const Libraries& libraries);

/// Name of a stage in dotted keys: its own, or its number when it has none
/// of its own.
std::string stage_label(const std::vector<Stage>& stages, std::size_t i);
} // namespace mmale::scene
