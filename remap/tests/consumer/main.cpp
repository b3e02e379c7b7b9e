// SPDX-License-Identifier: LGPL-3.0-or-later
//
// A program outside: two triangles, one smoothing and one remap. Returns 0 if
// the mass stayed.

#include <remap/remap.h>
#include <remap/smoothing/smooth.h>

#include <cmath>

int main()
{
  const std::vector<double> x = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<double> y = {0, 0, 1, 0, 1.1, 1.1, 0, 1};
  const std::vector<std::int32_t> cells = {0, 1, 2, 0, 2, 3};
  const remap::Mesh mesh(
      {.cells = cells, .x = x, .owned_cells = 2, .owned_nodes = 4});
  remap::Remapper remapper(mesh, {});
  std::vector<double> density = {1, 2};
  const remap::Field field{.values = density};
  remap::Ledger ledger;
  if (remapper.remap(x, y, {&field, 1}, {}, {}, ledger) != remap::Outcome::ok)
    return 1;
  // Both triangles grow from 0.5 to 0.55 over a boundary that takes their
  // value.
  const double mass = 0.55 * (density[0] + density[1]);
  remap::Smoothing smoothing(mesh, {}, {});
  std::vector<std::uint8_t> flags(4);
  smoothing.flag(y, {}, flags, {});
  return std::abs(mass - 1.65) < 1e-14 ? 0 : 2;
}
