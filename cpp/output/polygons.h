// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// Material polygons as their own dataset: a .vtp that ParaView opens.
namespace mmale::output
{
/// Convex polygons in the plane with numbers for each.
struct Polygons
{
  std::vector<double> points;              ///< shape (n, 2) [m]
  std::vector<std::int64_t> offsets = {0}; ///< size num + 1, into points
  std::map<std::string, std::vector<double>> data; ///< by name, shape (num)

  std::size_t size() const { return offsets.size() - 1; }
};

/// Write polygons as VTK PolyData in ASCII, whole or not at all; on one rank.
/// @throws std::runtime_error naming the file and the cause
void write(const std::filesystem::path& file, const Polygons& polygons);
} // namespace mmale::output
