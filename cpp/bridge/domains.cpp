// SPDX-License-Identifier: LGPL-3.0-or-later
#include "domains.h"

#include "output/on_root.h"
#include "remap/domain/drawing.h"
#include "remap/domain/partial_volumes.h"
#include "remap/geometry/position.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#ifdef MMALE_CGAL
#include "remap/domain/cgal/clean.h"
#endif

namespace mmale::bridge
{
namespace
{
namespace fs = std::filesystem;
using ::remap::Drawing;
using ::remap::Geometry;
using ::remap::Moments;
using ::remap::Point;

/// The file's text; why it cannot be had otherwise.
std::string read_file(const fs::path& path, std::string& text)
{
  std::error_code error;
  if (not fs::exists(path, error))
    return "no such file";
  if (fs::is_directory(path, error))
    return "is a folder";
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  if (file and file.peek() == std::ifstream::traits_type::eof())
    return "is empty";
  if (not file or not(all << file.rdbuf()))
    return "cannot be read";
  text = all.str();
  return {};
}

bool is_svg(const fs::path& path)
{
  std::string ending = path.extension();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c)
                         { return static_cast<char>(std::tolower(c)); });
  return ending == ".svg";
}

template <class Visit>
void for_each_point(Drawing& drawing, Visit visit)
{
  for (auto& shape : drawing.shapes)
    for (auto& ring : shape.rings)
      for (Point& p : ring)
        visit(p);
}

struct Box
{
  Point low, high;
};

Box box_of(Drawing& drawing)
{
  constexpr double far = std::numeric_limits<double>::infinity();
  Box b{{far, far}, {-far, -far}};
  for_each_point(drawing,
                 [&](Point p)
                 {
                   b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y)};
                   b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y)};
                 });
  return b;
}

/// Read, scaled and put in its place. An SVG is read twice: what the tolerance
/// means in its units shows when its size is known.
Drawing read_drawing(const std::string& text, bool svg,
                     const scene::Domain& given)
{
  const auto read = [&](double tolerance)
  {
    return svg ? ::remap::read_svg(text, tolerance) : ::remap::read_text(text);
  };
  Drawing drawing = read(1e300);
  if (not drawing.troubles.empty())
    return drawing;
  const auto height = [&]
  {
    const Box b = box_of(drawing);
    return b.high.y - b.low.y;
  };
  // A flat drawing has faults of its own.
  const auto scale = [&]
  {
    return given.height > 0 and height() > 0 ? given.height / height()
                                             : given.scale;
  };
  if (svg)
    drawing =
        read(given.tolerance > 0 ? given.tolerance / scale() : 1e-4 * height());
  const double by = scale();
  const Point low = by * box_of(drawing).low;
  const Point to = given.at ? Point{(*given.at)[0], (*given.at)[1]} : low;
  for_each_point(drawing, [&](Point& p) { p = by * p + (to - low); });
  return drawing;
}

/// What rings that cross fill, where the build has the means to tell.
#ifdef MMALE_CGAL
bool clean(const Drawing& drawing, ::remap::Domain& domain)
{
  auto cleaned = ::remap::clean(drawing.shapes);
  domain = std::move(cleaned.domain);
  return cleaned.faults.empty();
}
constexpr const char* cure = "its rings cross, and rounding the places where "
                             "they do makes them cross again";
#else
bool clean(const Drawing&, ::remap::Domain&)
{
  return false;
}
constexpr const char* cure =
    "its rings cross: unite its paths in a drawing program, or build with "
    "-DREMAP_CGAL=ON (CGAL's arrangements, under the GPL), which does it";
#endif

/// All ranks' numbers one behind the other, on the first rank.
std::vector<double> gather(MPI_Comm comm, const std::vector<double>& mine)
{
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int size = static_cast<int>(mine.size());
  std::vector<int> sizes(static_cast<std::size_t>(ranks)), starts;
  MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, comm);
  starts.assign(sizes.size(), 0);
  std::exclusive_scan(sizes.begin(), sizes.end(), starts.begin(), 0);
  std::vector<double> all(static_cast<std::size_t>(starts.back())
                          + static_cast<std::size_t>(sizes.back()));
  MPI_Gatherv(mine.data(), size, MPI_DOUBLE, all.data(), sizes.data(),
              starts.data(), MPI_DOUBLE, 0, comm);
  return all;
}

/// Pieces of owned cells from all ranks, on the first one.
output::Polygons gather_pieces(const mesh::Domain& mesh,
                               const ::remap::DomainPieces& pieces,
                               std::span<const double> share)
{
  // cell, share, number of points, points
  std::vector<double> mine;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const auto cell = static_cast<std::size_t>(pieces.cells[i]);
    if (pieces.cells[i] >= mesh.num_owned_cells)
      continue;
    mine.insert(mine.end(),
                {static_cast<double>(mesh.cell_id[cell]), share[cell],
                 static_cast<double>(pieces[i].size())});
    for (const Point p : pieces[i])
      mine.insert(mine.end(), {p.x, p.y});
  }
  const std::vector<double> all = gather(mesh.comm, mine);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < all.size();
       i += 3 + 2 * static_cast<std::size_t>(all[i + 2]))
    starts.push_back(i);
  std::ranges::stable_sort(starts, {}, [&](std::size_t i) { return all[i]; });
  output::Polygons out;
  for (const std::size_t i : starts)
  {
    const auto n = 2 * static_cast<std::size_t>(all[i + 2]);
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(i) + 3;
    out.points.insert(out.points.end(), first,
                      first + static_cast<std::ptrdiff_t>(n));
    out.offsets.push_back(static_cast<std::int64_t>(out.points.size() / 2));
    out.data["cell"].push_back(all[i]);
    out.data["share"].push_back(all[i + 1]);
  }
  return out;
}

template <Geometry G>
LaidDomain lay_over(const mesh::Domain& mesh, const ::remap::Domain& domain)
{
  std::vector<std::int32_t> cells;
  for (const auto& cell : mesh.cells)
    cells.insert(cells.end(), cell.begin(), cell.end());
  ::remap::DomainPieces pieces;
  const auto laid =
      ::remap::partial_volumes<G>(domain, cells, mesh.initial_x, &pieces);
  LaidDomain out;
  // Sums with more digits than the parts have.
  std::array<long double, 3> sum = {0, 0, 0};
  std::array<std::int64_t, 2> count = {0, 0};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const ::remap::Triangle t = {
        ::remap::point(mesh.initial_x, mesh.cells[c][0]),
        ::remap::point(mesh.initial_x, mesh.cells[c][1]),
        ::remap::point(mesh.initial_x, mesh.cells[c][2])};
    const Moments all =
        ::remap::polygon::shifted(::remap::position::about_first<G>(t), t[0]);
    const Moments& part = laid.parts[c];
    out.share.push_back(part.v / all.v);
    const Point g = part.v > 0 ? part.centroid() : all.centroid();
    out.centroids.insert(out.centroids.end(), {g.x, g.y});
    if (static_cast<int>(c) >= mesh.num_owned_cells)
      continue;
    sum[0] += part.v, sum[1] += part.x, sum[2] += part.y;
    count[1] += part.v > 0;
  }
  count[0] = std::ranges::count_if(laid.mixed, [&](std::int32_t c)
                                   { return c < mesh.num_owned_cells; });
  count[1] -= count[0];
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_LONG_DOUBLE, MPI_SUM,
                mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, count.data(), 2, MPI_INT64_T, MPI_SUM, mesh.comm);
  const double turn = G == Geometry::axisymmetric ? 2 * std::numbers::pi : 1;
  out.volume = turn * domain.moments<G>().v;
  out.in_cells = turn * static_cast<double>(sum[0]);
  out.centroid = {static_cast<double>(sum[1] / sum[0]),
                  static_cast<double>(sum[2] / sum[0])};
  out.mixed = count[0];
  out.full = count[1];
  out.pieces = gather_pieces(mesh, pieces, out.share);
  return out;
}
} // namespace

::remap::Domain share_domain(MPI_Comm comm, std::string& text)
{
  auto size = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, 0, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, 0, comm);
  return ::remap::Domain(::remap::read_text(text).shapes);
}

LoadedDomain load_domain(const std::string& key, const scene::Domain& given)
{
  const fs::path file = fs::path(given.folder) / given.file;
  LoadedDomain out;
  std::string text;
  if (const auto why = read_file(file, text); not why.empty())
  {
    out.complaints.push_back({key + ".file", file.string() + ": " + why, {}});
    return out;
  }
  const Drawing drawing = read_drawing(text, is_svg(file), given);
  const auto troubles = drawing.judge();
  const bool crossing =
      std::ranges::any_of(troubles, [](const auto& t) { return t.crossing; });
  if (crossing and clean(drawing, out.domain))
    return out;
  for (const auto& trouble : troubles)
    out.complaints.push_back({"", trouble.what, {file.string(), trouble.line}});
  if (crossing)
    out.complaints.push_back({key + ".file", cure, {}});
  if (out.complaints.empty())
    out.domain = ::remap::Domain(drawing.shapes);
  return out;
}

scene::DomainOutline outline_of(const std::string& name,
                                const scene::Domain& given)
{
  const LoadedDomain loaded = load_domain("domain." + name, given);
  const Point low = loaded.domain.low(), high = loaded.domain.high();
  return {{low.x, low.y}, {high.x, high.y}, loaded.complaints};
}

LaidDomain lay(const mesh::Domain& mesh, const std::string& name,
               const scene::Domain& given, bool axisymmetric)
{
  std::string text;
  output::on_root(mesh.comm,
                  [&]
                  {
                    const LoadedDomain loaded =
                        load_domain("domain." + name, given);
                    std::string all;
                    for (const auto& complaint : loaded.complaints)
                      all += (all.empty() ? "" : "\n") + to_string(complaint);
                    if (not all.empty())
                      throw std::runtime_error(all);
                    text = ::remap::to_text(loaded.domain);
                  });
  const ::remap::Domain domain = share_domain(mesh.comm, text);
  LaidDomain out = axisymmetric ? lay_over<Geometry::axisymmetric>(mesh, domain)
                                : lay_over<Geometry::plane>(mesh, domain);
  out.outline = std::move(text);
  return out;
}
} // namespace mmale::bridge
