// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/colouring.h"

#include <cstddef>

using namespace remap;

namespace
{
/// Smallest colour that no neighbour of higher priority has, -1 if one of them
/// waits for its own.
double colour_of(const Mesh& mesh, std::int32_t i,
                 std::span<const double> colour)
{
  const auto rank = [&mesh](std::int32_t j)
  { return hash(static_cast<std::uint64_t>(mesh.node_ids()[j])); };
  std::uint64_t used = 0; // a planar patch needs far fewer than 64 colours
  for (std::int32_t j : mesh.node_nodes()[i])
    if (rank(j) > rank(i))
    {
      if (colour[j] < 0)
        return -1;
      used |= std::uint64_t(1) << static_cast<int>(colour[j]);
    }
  int c = 0;
  while (used >> c & 1)
    ++c;
  return c;
}
} // namespace

std::vector<std::int32_t> remap::colour_nodes(const Mesh& mesh,
                                              const Host& host)
{
  std::vector<double> colour(mesh.num_nodes(), -1);
  double waiting = 1;
  while (waiting > 0)
  {
    waiting = 0;
    for (std::int32_t i = 0; i < mesh.owned_nodes(); ++i)
      if (colour[i] < 0)
      {
        colour[i] = colour_of(mesh, i, colour);
        if (colour[i] < 0)
          waiting = 1;
      }
    host.update_nodes(colour, 1);
    waiting = host.max(waiting);
  }
  return {colour.begin(), colour.end()};
}
