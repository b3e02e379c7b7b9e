// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once
#include "mesh/domain.h"
#include "remap/materials/materials.h"
#include "scene/scene.h"
namespace mmale::bridge
{
::remap::Materials paint(const scene::Scene& scene, const mesh::Domain& domain);
}
