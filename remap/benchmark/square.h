// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What the benchmarks run on: 131 072 triangles (256² squares cut in two, built
// once), inner nodes moved at random by up to a quarter of a square.
#pragma once

#include "remap/tests/meshes.h"

#include <vector>

/// Squares along a side.
constexpr int n = 256;

struct Square
{
  meshes::Data data = meshes::rectangle(n, n, meshes::Diagonal::crossed);
  remap::Mesh mesh = data.mesh();
  std::vector<double> to = meshes::shaken(data.x, 0.25 / n, 1);

  static const Square& get()
  {
    static const Square square;
    return square;
  }
};
