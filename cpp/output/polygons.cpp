// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/polygons.h"

#include "output/summary.h"
#include <format>

namespace mmale::output
{
void write(const std::filesystem::path& file, const Polygons& polygons)
{
  const std::size_t points = polygons.points.size() / 2;
  std::string text = std::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<Points>\n"
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n",
      points, polygons.size());
  // Shortest text that reads back to the last bit.
  for (std::size_t i = 0; i < points; ++i)
    text += std::format("{} {} 0\n", polygons.points[2 * i],
                        polygons.points[2 * i + 1]);
  text += "</DataArray>\n</Points>\n<Polys>\n"
          "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
  for (std::size_t i = 0; i < points; ++i)
    text += std::format("{}\n", i);
  text += "</DataArray>\n"
          "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
  for (std::size_t i = 0; i < polygons.size(); ++i)
    text += std::format("{}\n", polygons.offsets[i + 1]);
  text += "</DataArray>\n</Polys>\n<CellData>\n";
  for (const auto& [name, values] : polygons.data)
  {
    text += std::format(
        "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
    for (const double v : values)
      text += std::format("{}\n", v);
    text += "</DataArray>\n";
  }
  text += "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  write_atomically(file, text);
}
} // namespace mmale::output
