// SPDX-License-Identifier: LGPL-3.0-or-later
#include "paint.h"

#include "domains.h"
#include "output/on_root.h"
#include "remap/domain/drawing.h"
#include "remap/domain/paint.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <format>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace mmale::bridge
{
namespace
{
using ::remap::Coat;
using ::remap::Geometry;
using ::remap::Point;

Point to_point(const scene::Point& p)
{
  return {p[0], p[1]};
}

::remap::Ring ring_of(const scene::Region& region)
{
  ::remap::Ring out;
  for (const scene::Point& p : region.points)
    out.push_back(to_point(p));
  return out;
}

std::string key_of(std::size_t region)
{
  return std::format("region.{}", region);
}

/// What shapes without a size of their own have it from.
struct Extent
{
  Point low, high; ///< box around the body, and as much again [m]
  double edge = 0; ///< the shortest one of the mesh [m]
};

/// Collective.
Extent extent_of(const mesh::Domain& mesh)
{
  // The smallest of x, y, -x, -y and of the edges' squares.
  constexpr double far = std::numeric_limits<double>::infinity();
  std::array<double, 5> least = {far, far, far, far, far};
  for (const auto& cell : mesh.cells)
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Point p = ::remap::point(mesh.initial_x, cell[k]);
      const Point d = ::remap::point(mesh.initial_x, cell[(k + 1) % 3]) - p;
      for (const auto& [i, v] :
           {std::pair{0u, p.x}, std::pair{1u, p.y}, std::pair{2u, -p.x},
            std::pair{3u, -p.y}, std::pair{4u, dot(d, d)}})
        least[i] = std::min(least[i], v);
    }
  MPI_Allreduce(MPI_IN_PLACE, least.data(), 5, MPI_DOUBLE, MPI_MIN, mesh.comm);
  const Point low{least[0], least[1]}, high{-least[2], -least[3]};
  const Point size = high - low;
  return {low - size, high + size, std::sqrt(least[4])};
}

/// The drawing of a region, read on the first rank. Collective.
::remap::Domain drawing_of(const mesh::Domain& mesh, const std::string& key,
                           const scene::Domain& given)
{
  std::string text;
  output::on_root(mesh.comm,
                  [&]
                  {
                    const LoadedDomain loaded = load_domain(key, given);
                    std::string all;
                    for (const auto& complaint : loaded.complaints)
                      all += (all.empty() ? "" : "\n") + to_string(complaint);
                    if (not all.empty())
                      throw std::runtime_error(all);
                    text = ::remap::to_text(loaded.domain);
                  });
  return share_domain(mesh.comm, text);
}

/// Collective.
Coat coat_of(const scene::Scene& scene, std::size_t i, const mesh::Domain& mesh,
             const Extent& extent)
{
  const scene::Region& r = scene.region[i];
  const auto material = scene.material.find(r.material);
  if (material == scene.material.end())
    throw std::runtime_error(key_of(i) + ".material: no such material");
  Coat out;
  out.material =
      static_cast<int>(std::distance(scene.material.begin(), material));
  using ::remap::Domain;
  if (r.shape == "rectangle")
    out.domain = Domain::rectangle(to_point(r.low), to_point(r.high));
  else if (r.shape == "polygon")
    out.domain = Domain::polygon(ring_of(r));
  else if (r.shape == "circle")
    out.domain = Domain::circle(to_point(r.centre), r.radius,
                                std::min(1e-4 * r.radius, extent.edge / 100));
  else if (r.shape == "half_plane")
    out.domain = Domain::half_plane({to_point(r.normal), to_point(r.point)},
                                    extent.low, extent.high);
  else if (r.shape == "file")
    out.domain = drawing_of(mesh, key_of(i), r.drawing);
  else
    out.everywhere = true;
  return out;
}

/// Of the cells that some ranks have trouble with, the first in the mesh, and
/// a place in it. Collective.
/// @param[in] cells of this rank, its own, with places; may be empty
/// @return its place; nothing if there is no such cell
std::optional<Point>
first_place(const mesh::Domain& mesh,
            const std::vector<std::pair<std::int32_t, Point>>& cells)
{
  constexpr auto none = std::numeric_limits<std::int64_t>::max();
  std::int64_t mine = none;
  Point place;
  for (const auto& [c, at] : cells)
    if (const auto id = mesh.cell_id[static_cast<std::size_t>(c)]; id < mine)
    {
      mine = id;
      place = at;
    }
  std::int64_t first = mine;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT64_T, MPI_MIN, mesh.comm);
  if (first == none)
    return std::nullopt;
  std::array<double, 2> at = {0, 0};
  if (mine == first)
    at = {place.x, place.y};
  MPI_Allreduce(MPI_IN_PLACE, at.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return Point{at[0], at[1]};
}

/// Collective.
/// @throws std::runtime_error on all ranks if the regions are not fit for use
void judge(const ::remap::Painting& painting, const mesh::Domain& mesh,
           bool axisymmetric)
{
  std::vector<std::pair<std::int32_t, Point>> bare, crowded;
  double volume = 0;
  for (const ::remap::BarePlace& place : painting.bare)
    if (place.cell < mesh.num_owned_cells)
    {
      bare.emplace_back(place.cell, place.at);
      volume += (axisymmetric ? 2 * std::numbers::pi : 1) * place.volume;
    }
  for (const std::int32_t c : painting.crowded)
    if (c < mesh.num_owned_cells)
    {
      const auto& n = mesh.cells[static_cast<std::size_t>(c)];
      const auto at = [&](std::size_t k)
      { return ::remap::point(mesh.initial_x, n[k]); };
      crowded.emplace_back(c, 1.0 / 3 * (at(0) + at(1) + at(2)));
    }
  MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (const auto at = first_place(mesh, bare))
    throw std::runtime_error(std::format(
        "region: the body is covered by no region at ({:.6g}, {:.6g}), {:.6g} "
        "{} of it in all; a first region with shape = \"everywhere\" fills "
        "what the others leave",
        at->x, at->y, volume, axisymmetric ? "m3" : "m2"));
  if (const auto at = first_place(mesh, crowded))
    throw std::runtime_error(std::format(
        "region: the cell at ({:.6g}, {:.6g}) has more than {} materials; make "
        "the mesh finer there",
        at->x, at->y, ::remap::most_parts));
}
} // namespace

scene::DomainOutline region_outline(const std::string& key,
                                    const scene::Region& region)
{
  const auto outline = [](const ::remap::Domain& domain)
  {
    const Point low = domain.low(), high = domain.high();
    return scene::DomainOutline{{low.x, low.y}, {high.x, high.y}, {}};
  };
  if (region.shape == "file")
  {
    LoadedDomain loaded = load_domain(key, region.drawing);
    scene::DomainOutline out = outline(loaded.domain);
    out.complaints = std::move(loaded.complaints);
    return out;
  }
  const ::remap::Shape shape{{ring_of(region)}};
  scene::DomainOutline out;
  for (const auto& fault : ::remap::Domain::faults({&shape, 1}))
    out.complaints.push_back(
        {key + ".points",
         std::format("point {}: {}", fault.vertex + 1, fault.what),
         {}});
  return out.complaints.empty() ? outline(::remap::Domain({&shape, 1})) : out;
}

::remap::Materials paint(const scene::Scene& scene, const mesh::Domain& mesh)
{
  const auto num_materials =
      std::max(static_cast<int>(scene.material.size()), 1);
  if (scene.region.empty())
    return ::remap::Materials(mesh.num_cells(), num_materials);
  const Extent extent = extent_of(mesh);
  std::vector<Coat> coats;
  for (std::size_t i = 0; i < scene.region.size(); ++i)
    coats.push_back(coat_of(scene, i, mesh, extent));
  std::vector<std::int32_t> cells;
  for (const auto& cell : mesh.cells)
    cells.insert(cells.end(), cell.begin(), cell.end());
  const bool axisymmetric = scene.symmetry == scene::Symmetry::axisymmetric;
  ::remap::Painting out =
      axisymmetric
          ? ::remap::paint<Geometry::axisymmetric>(coats, cells, mesh.initial_x,
                                                   num_materials)
          : ::remap::paint<Geometry::plane>(coats, cells, mesh.initial_x,
                                            num_materials);
  judge(out, mesh, axisymmetric);
  return std::move(out.materials);
}
} // namespace mmale::bridge
