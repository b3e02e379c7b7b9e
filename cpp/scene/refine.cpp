// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace mmale::scene
{
Mesh Mesh::refined() const
{
  Mesh mesh = *this;
  mesh.refine = 1;
  mesh.size /= refine;
  if (mesh.grading)
    mesh.grading->size /= refine;
  constexpr double most = 1e9; // so that the number stays one
  for (int& n : mesh.cells)
    if (n > 0)
      n = static_cast<int>(std::clamp(std::round(n * refine), 1.0, most));
  return mesh;
}
} // namespace mmale::scene
