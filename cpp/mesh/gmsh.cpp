// SPDX-License-Identifier: LGPL-3.0-or-later
#include "gmsh.h"

#include "gmsh_program.h"
#include "sides.h"
#include "sound.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace mmale::mesh
{
namespace
{
namespace fs = std::filesystem;

/// A folder of our own, removed at the end.
struct Temporary
{
  fs::path path;

  Temporary()
  {
    std::error_code error;
    std::string name = fs::temp_directory_path(error) / "mmale_gmsh_XXXXXX";
    if (not error and ::mkdtemp(name.data()))
      path = name;
  }
  ~Temporary()
  {
    std::error_code error;
    if (not path.empty())
      fs::remove_all(path, error);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
};

/// The grid of the file, or complaints.
Grid read_grid(const scene::Scene& scene, const fs::path& file,
               std::vector<scene::Complaint>& complaints)
{
  const auto complain = [&](const std::string& what)
  {
    complaints.push_back({"mesh.file", file.string() + ": " + what, {}});
    return Grid();
  };
  std::error_code error;
  if (not fs::exists(file, error))
    return complain("no such file");
  if (fs::is_directory(file, error))
    return complain("is a folder");
  if (std::ifstream probe(file); not probe)
    return complain("cannot be read");
  const bool geo = file.extension() == ".geo";
  const Temporary temporary; // outlives the reading
  if (geo)
  {
    if (temporary.path.empty())
      return complain("no folder for temporary files can be made");
    const auto trouble = run_gmsh(file, scene.mesh.refine, temporary.path);
    if (not trouble.empty())
      return complain(trouble);
  }
  std::ifstream text(geo ? temporary.path / "mesh.msh" : file,
                     std::ios::binary);
  const Msh msh = read_msh(text, file.string(), complaints);
  Grid grid;
  if (complaints.empty())
    grid = make_sound_grid(msh, file.string(),
                           scene.symmetry == scene::Symmetry::axisymmetric,
                           complaints);
  if (complaints.empty() and not scene.motion
      and grid.names == std::vector<std::string>{""})
    complaints.push_back({"",
                          "no boundary has a name; give physical curves names, "
                          "Physical Curve(\"left\") = {4}",
                          {file.string(), 0}});
  // Lines of gmsh's own output mean nothing to the user.
  for (scene::Complaint& complaint : complaints)
    if (geo)
      complaint.place.line = 0;
  return grid;
}

bool holds(const Grid& grid, const scene::Point& p)
{
  constexpr double outside = 1e-9; // as the probe allows
  const auto x = [&](std::int64_t n) { return &grid.x[2 * n]; };
  const auto cross = [](const double* o, const double* a, const double* b)
  { return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]); };
  for (std::size_t c = 0; c < grid.cells.size(); c += 3)
  {
    const double *i = x(grid.cells[c]), *j = x(grid.cells[c + 1]),
                 *k = x(grid.cells[c + 2]);
    const double room = -outside * cross(i, j, k);
    if (cross(i, j, p.data()) >= room and cross(j, k, p.data()) >= room
        and cross(k, i, p.data()) >= room)
      return true;
  }
  return false;
}

scene::Outline outline_of(const std::shared_ptr<const Grid>& grid)
{
  scene::Outline out;
  std::vector<Side> sides;
  find_sides(grid->x, grid->edges, sides);
  for (std::size_t b = 0; b < grid->names.size(); ++b)
  {
    if (grid->names[b].empty())
      continue;
    const int boundary = static_cast<int>(b);
    const auto line = common_line(sides, boundary);
    scene::Outline::Part part{grid->names[b], line[0][0] == line[0][0], {}};
    for (const Side& side : sides)
      for (int d = 0; side.boundary == boundary and d < 2; ++d)
        part.extends[d] = part.extends[d] or side.extends(d);
    out.boundary.push_back(std::move(part));
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    out.low[d] = scene::infinity;
    out.high[d] = -scene::infinity;
    for (std::size_t i = d; i < grid->x.size(); i += 2)
    {
      out.low[d] = std::min(out.low[d], grid->x[i]);
      out.high[d] = std::max(out.high[d], grid->x[i]);
    }
  }
  out.may_hold = [grid](const scene::Point& p) { return holds(*grid, p); };
  return out;
}
} // namespace

Loaded load_gmsh(const scene::Scene& scene)
{
  const fs::path file = fs::path(scene.mesh.folder) / scene.mesh.file;
  std::vector<scene::Complaint> complaints;
  const auto grid =
      std::make_shared<const Grid>(read_grid(scene, file, complaints));
  Loaded out{grid, complaints.empty() ? outline_of(grid) : scene::Outline()};
  out.outline.complaints = std::move(complaints);
  return out;
}

Grid obtain_grid(MPI_Comm comm, const scene::Scene& scene)
{
  if (scene.mesh.shape != "gmsh")
    return make_grid(scene.mesh);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Grid grid;
  std::string trouble;
  if (rank == 0)
  {
    const Loaded loaded = load_gmsh(scene);
    grid = *loaded.grid;
    for (const auto& complaint : loaded.outline.complaints)
      trouble += (trouble.empty() ? "" : "\n") + to_string(complaint);
  }
  auto size = static_cast<std::int64_t>(trouble.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, 0, comm);
  trouble.resize(size);
  MPI_Bcast(trouble.data(), static_cast<int>(size), MPI_CHAR, 0, comm);
  if (not trouble.empty())
    throw std::runtime_error(trouble);
  return grid;
}
} // namespace mmale::mesh
