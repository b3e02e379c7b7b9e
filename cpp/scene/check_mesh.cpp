// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/check_parts.h"
#include "scene/schema.h"
#include <algorithm>
#include <cmath>
#include <format>
#include <iterator>

namespace mmale::scene
{
namespace
{
constexpr double max_cells = 5e6;

double distance(const Point& a, const Point& b)
{
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/// Twice the area of the triangle a, b, c; > 0 counter-clockwise [m^2].
double turn(const Point& a, const Point& b, const Point& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool is_convex(const std::array<Point, 4>& x)
{
  for (std::size_t i = 0; i < 4; ++i)
    if (not(turn(x[i], x[(i + 1) % 4], x[(i + 2) % 4]) > 0))
      return false;
  return true;
}

/// About how many edges lie on a length that starts at the grading's point.
double graded_edges(const Grading& g, double size, double length)
{
  if (not(g.size < size) or not(length > 0))
    return length / std::min(g.size, size);
  const double fine = std::min(length, g.radius);
  double edges = fine / g.size;
  double rest = length - fine;
  const double growing = std::log(size / g.size) / std::log(g.growth);
  const double grown = g.growth * (size - g.size) / (g.growth - 1);
  if (rest <= grown)
    return edges
           + std::log1p(rest * (g.growth - 1) / (g.size * g.growth))
                 / std::log(g.growth);
  return edges + growing + (rest - grown) / size;
}

/// About how many triangles the mesh has; NaN when that is not known.
double count_cells(const Mesh& mesh)
{
  if (mesh.cells[0] > 0 and mesh.cells[1] > 0)
    return 2.0 * mesh.cells[0] * mesh.cells[1];
  const auto x = corners_of(mesh);
  const double width = 0.5 * (distance(x[0], x[1]) + distance(x[3], x[2]));
  const double height = 0.5 * (distance(x[0], x[3]) + distance(x[1], x[2]));
  if (not mesh.grading or not(mesh.grading->size > 0)
      or not(mesh.grading->growth > 1))
    return 2.0 * std::ceil(width / mesh.size) * std::ceil(height / mesh.size);
  double count = 2;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double length = d == 0 ? width : height;
    const double before =
        std::clamp(mesh.grading->towards[d] - x[0][d], 0.0, length);
    count *= graded_edges(*mesh.grading, mesh.size, before)
             + graded_edges(*mesh.grading, mesh.size, length - before);
  }
  return count;
}

void check_size(const Mesh& coarse, Complaints& out)
{
  const Mesh mesh = coarse.refined();
  const bool by_cells = mesh.cells[0] > 0 or mesh.cells[1] > 0;
  if (mesh.size > 0 and by_cells)
    out.push_back({"mesh.cells", "give size or cells, not both", {}});
  else if (by_cells and not(mesh.cells[0] > 0 and mesh.cells[1] > 0))
    out.push_back({"mesh.cells", "both must be > 0", {}});
  else if (mesh.size == 0 and not by_cells)
    out.push_back({"mesh.size",
                   "missing: Edge of the cells [m], > 0; or cells = [along x, "
                   "along y]",
                   {}});
  else
  {
    const auto x = corners_of(mesh);
    const double longest =
        std::max({distance(x[0], x[1]), distance(x[1], x[2]),
                  distance(x[2], x[3]), distance(x[3], x[0])});
    const double cells = count_cells(mesh);
    if (longest > 0 and mesh.size > longest)
      out.push_back({"mesh.size",
                     std::format("is {} m, longer than the longest side of "
                                 "{} m",
                                 mesh.size, longest),
                     {}});
    else if (cells > max_cells)
      out.push_back({coarse.refine > 1 ? "mesh.refine"
                     : by_cells        ? "mesh.cells"
                                       : "mesh.size",
                     std::format("makes about {:.3g} cells, more than {:.3g}",
                                 cells, max_cells),
                     {}});
  }
}

void check_grading(const Mesh& mesh, Complaints& out)
{
  const Grading& g = *mesh.grading;
  if (mesh.cells[0] > 0 or mesh.cells[1] > 0)
    out.push_back(
        {"mesh.grading", "needs mesh.size, cells leave no room for it", {}});
  if (not may_be_inside(mesh, g.towards))
    out.push_back({"mesh.grading.towards",
                   words(g.towards) + " lies outside the mesh",
                   {}});
  if (mesh.size > 0 and g.size > mesh.size)
    out.push_back({"mesh.grading.size",
                   std::format("is {} m, coarser than mesh.size of {} m",
                               g.size, mesh.size),
                   {}});
}

/// Can the mesh file be looked for at all?
bool is_readable(const Mesh& mesh)
{
  return is_geo(mesh) ? mesh.refine > 0 : is_msh(mesh);
}

void check_file(const Mesh& mesh, Complaints& out)
{
  if (mesh.file.empty())
    return; // a missing key
  if (not is_geo(mesh) and not is_msh(mesh))
    out.push_back(
        {"mesh.file", "must end in .geo or .msh, is '" + mesh.file + "'", {}});
  if (is_msh(mesh) and mesh.refine > 0 and mesh.refine != 1)
    out.push_back({"mesh.refine",
                   std::format("must be 1, is {}: a .msh is taken as it is; "
                               "only a .geo can be meshed anew",
                               mesh.refine),
                   {}});
}

/// Start and end of a boundary along its side, and those of the side [m].
struct Extent
{
  std::string name;
  double from, to, low, high;
};

Extent extent_of(const Scene& scene, const std::string& name,
                 const Boundary& boundary)
{
  const auto ends = side_ends(scene.mesh, boundary.side);
  const int d = boundary.side == "bottom" or boundary.side == "top" ? 0 : 1;
  const double low = std::min(ends[0][d], ends[1][d]);
  const double high = std::max(ends[0][d], ends[1][d]);
  return {name, std::max(boundary.from, low), std::min(boundary.to, high), low,
          high};
}

/// Boundaries of one side: no overlap, and whether they claim all of it.
void check_side(const Scene& scene, const std::string& side, Complaints& out)
{
  std::vector<Extent> parts;
  for (const auto& [name, boundary] : scene.boundary)
    if (boundary.side == side)
      parts.push_back(extent_of(scene, name, boundary));
  std::ranges::sort(parts, {}, &Extent::from);
  double reached = parts.empty() ? 0 : parts[0].low;
  bool gap = parts.empty();
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const double slack = 1e-9 * (parts[i].high - parts[i].low);
    if (i > 0 and parts[i].from < parts[i - 1].to - slack)
      out.push_back({"boundary." + parts[i].name,
                     std::format("overlaps '{}' on side '{}' from {} to {} m",
                                 parts[i - 1].name, side, parts[i].from,
                                 std::min(parts[i].to, parts[i - 1].to)),
                     {}});
    gap = gap or not(parts[i].from <= reached + slack);
    reached = std::max(reached, parts[i].to);
  }
  if (gap
      or not(reached >= parts[0].high - 1e-9 * (parts[0].high - parts[0].low)))
    return;
  for (std::size_t i = 0; i < scene.stage.size(); ++i)
    if (scene.stage[i].boundary.contains(side))
      out.push_back(
          {"stage." + stage_label(scene.stage, i) + ".boundary." + side,
           "nothing is left of this side: named boundaries claim all "
           "of it",
           {}});
}
} // namespace

bool is_geo(const Mesh& mesh)
{
  return mesh.file.ends_with(".geo");
}

bool is_msh(const Mesh& mesh)
{
  return mesh.file.ends_with(".msh");
}

std::array<Point, 4> corners_of(const Mesh& mesh)
{
  if (mesh.shape != "rectangle")
    return mesh.corners;
  const auto [x, y] = mesh.origin;
  return {{{x, y},
           {x + mesh.width, y},
           {x + mesh.width, y + mesh.height},
           {x, y + mesh.height}}};
}

bool may_be_inside(const Mesh& mesh, const Point& point)
{
  const auto x = corners_of(mesh);
  if (not is_convex(x))
    return true;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Point& a = x[i];
    const Point& b = x[(i + 1) % 4];
    // Distance of the point from the side, against the length of the side.
    if (turn(a, b, point) < -1e-9 * distance(a, b) * distance(a, b))
      return false;
  }
  return true;
}

std::array<Point, 2> side_ends(const Mesh& mesh, const std::string& side)
{
  const auto x = corners_of(mesh);
  if (side == "left")
    return {x[3], x[0]};
  if (side == "bottom")
    return {x[0], x[1]};
  if (side == "right")
    return {x[1], x[2]};
  return {x[2], x[3]};
}

std::string words(const Point& x)
{
  return std::format("({}, {})", x[0], x[1]);
}

void check_mesh(const Scene& scene, Complaints& out)
{
  const Mesh& mesh = scene.mesh;
  if (mesh.shape == "gmsh")
    return check_file(mesh, out);
  const auto x = corners_of(mesh);
  const bool quadrilateral = mesh.shape == "quadrilateral";
  const bool known = std::ranges::none_of(x, [](const Point& p)
                                          { return std::isnan(p[0] + p[1]); });
  if (quadrilateral and known and not is_convex(x))
    out.push_back({"mesh.corners",
                   "must make a convex quadrilateral, counter-clockwise",
                   {}});
  check_size(mesh, out);
  if (mesh.grading)
    check_grading(mesh, out);
  const double least =
      std::ranges::min(x, {}, [](const Point& p) { return p[0]; })[0];
  if (scene.symmetry == Symmetry::axisymmetric and least < 0)
    out.push_back({quadrilateral ? "mesh.corners" : "mesh.origin",
                   std::format("the radius x must not be negative in "
                               "axisymmetry, is {} m",
                               least),
                   {}});
}

const Outline::Part* Outline::find(const std::string& name) const
{
  const auto at = std::ranges::find(boundary, name, &Part::name);
  return at == boundary.end() ? nullptr : &*at;
}

std::vector<std::string> Outline::names() const
{
  std::vector<std::string> list;
  for (const Part& part : boundary)
    list.push_back(part.name);
  return list;
}

std::optional<Outline>
outline_of(const Scene& scene, const OutlineReader& read_mesh, Complaints& out)
{
  if (scene.mesh.shape == "gmsh")
  {
    if (not read_mesh or not is_readable(scene.mesh))
      return std::nullopt;
    Outline outline = read_mesh(scene);
    std::ranges::move(outline.complaints, std::back_inserter(out));
    return outline.complaints.empty() ? std::optional(std::move(outline))
                                      : std::nullopt;
  }
  Outline outline;
  const auto add = [&](const std::string& name, const std::string& side)
  {
    const auto [a, b] = side_ends(scene.mesh, side);
    const double slack = 1e-9 * distance(a, b);
    outline.boundary.push_back(
        {name,
         true,
         {std::abs(b[0] - a[0]) > slack, std::abs(b[1] - a[1]) > slack}});
  };
  for (const std::string& side : sides)
    add(side, side);
  for (const auto& [name, boundary] : scene.boundary)
    add(name, boundary.side);
  const auto corners = corners_of(scene.mesh);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto along = [d](const Point& x) { return x[d]; };
    const auto [low, high] = std::ranges::minmax(corners, {}, along);
    outline.low[d] = low[d];
    outline.high[d] = high[d];
  }
  outline.may_hold = [mesh = scene.mesh](const Point& x)
  { return may_be_inside(mesh, x); };
  return outline;
}

void check_boundaries(const Scene& scene, Complaints& out)
{
  if (scene.mesh.shape == "gmsh")
  {
    for (const auto& [name, boundary] : scene.boundary)
      out.push_back({"boundary." + name,
                     "is for the built-in shapes: of a gmsh mesh the physical "
                     "curves are the boundaries, by their names",
                     {}});
    return;
  }
  for (const auto& [name, boundary] : scene.boundary)
  {
    const std::string key = "boundary." + name;
    if (std::ranges::find(sides, name) != sides.end())
      out.push_back({key, "is the name of a side; take another", {}});
    if (std::ranges::find(sides, boundary.side) == sides.end())
      continue;
    if (boundary.from >= boundary.to)
      out.push_back({key + ".to",
                     std::format("must be > from of {} m, is {}", boundary.from,
                                 boundary.to),
                     {}});
    else if (const Extent e = extent_of(scene, name, boundary); e.from >= e.to)
      out.push_back({key,
                     std::format("lies off its side '{}', which reaches from "
                                 "{} to {} m",
                                 boundary.side, e.low, e.high),
                     {}});
  }
  for (const std::string& side : sides)
    check_side(scene, side, out);
}
} // namespace mmale::scene
