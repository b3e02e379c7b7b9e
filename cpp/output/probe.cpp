// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/probe.h"

#include "compat.h"
#include "output/on_root.h"
#include "output/summary.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace mmale::output
{
namespace
{
using Triangle = std::array<scene::Point, 3>;

// A point on the boundary may lie outside by round-off.
constexpr double outside = 1e-9;

double cross(const scene::Point& o, const scene::Point& a,
             const scene::Point& b)
{
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/// Barycentric coordinates; a flat triangle gives no number.
std::array<double, 3> barycentric(const Triangle& t, const scene::Point& x)
{
  const double area = cross(t[0], t[1], t[2]);
  const double w1 = cross(t[0], x, t[2]) / area;
  const double w2 = cross(t[0], t[1], x) / area;
  return {1 - w1 - w2, w1, w2};
}

/// Points sorted by x, so that a cell finds those in its breadth at once.
class Sorted
{
public:
  explicit Sorted(std::span<const scene::Point> points) : _points(points)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      _order.push_back(i);
    std::ranges::sort(_order, {}, [&](std::size_t i) { return points[i][0]; });
  }

  std::span<const std::size_t> between(double low, double high) const
  {
    const auto x = [&](std::size_t i) { return _points[i][0]; };
    const auto begin = std::ranges::lower_bound(_order, low, {}, x);
    const auto end = std::ranges::upper_bound(_order, high, {}, x);
    return {begin, end};
  }

private:
  std::span<const scene::Point> _points;
  std::vector<std::size_t> _order;
};

/// Best cell of this rank for each point: the one it lies deepest in.
std::vector<double> best_cells(const dolfinx::mesh::Mesh<double>& mesh,
                               std::span<const scene::Point> points,
                               std::vector<Spot>& spots)
{
  std::vector<double> depth(points.size(), -std::numeric_limits<double>::max());
  const Sorted sorted(points);
  const auto x = mesh.geometry().x();
  const auto cells = mesh.geometry().dofmap();
  const std::int32_t owned = mesh.topology()->index_map(2)->size_local();
  for (std::int32_t c = 0; c < owned; ++c)
  {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto v =
          static_cast<std::size_t>(cells(static_cast<std::size_t>(c), i));
      t[i] = {x[3 * v], x[3 * v + 1]};
    }
    const auto [low, high] = std::minmax({t[0][0], t[1][0], t[2][0]});
    const double room = outside * (high - low);
    for (const std::size_t k : sorted.between(low - room, high + room))
    {
      const std::array<double, 3> w = barycentric(t, points[k]);
      const double d = std::ranges::min(w);
      if (d >= -outside and d > depth[k])
      {
        depth[k] = d;
        spots[k] = {.found = true, .cell = c, .weights = w};
      }
    }
  }
  return depth;
}

void append(std::string& line, double value)
{
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line.append(text.data(), end);
}

std::string header(std::span<const NamedField> fields)
{
  std::string out = "s,x,y";
  for (const NamedField& f : fields)
  {
    static constexpr std::array vector = {"_x", "_y"};
    static constexpr std::array tensor = {"_xx", "_yy", "_zz", "_xy"};
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.components); ++c)
      out += ',' + f.name
             + (f.components == 1   ? ""
                : f.components == 2 ? vector[c]
                                    : tensor[c]);
  }
  return out + '\n';
}
} // namespace

Probe::Probe(std::shared_ptr<dolfinx::mesh::Mesh<double>> mesh)
    : _mesh(std::move(mesh)), _nodes(compat::lagrange_space(_mesh, 1).dofmap())
{
}

std::vector<Spot> Probe::locate(std::span<const scene::Point> points) const
{
  std::vector<Spot> spots(points.size());
  const std::vector<double> depth = best_cells(*_mesh, points, spots);

  // The rank whose cell has the point deepest inside gets it; of equals the
  // lowest. (MPI_DOUBLE_INT's own layout.)
  struct Bid
  {
    double depth;
    int rank;
  };
  int rank = 0;
  MPI_Comm_rank(_mesh->comm(), &rank);
  std::vector<Bid> bids;
  for (double d : depth)
    bids.push_back({d, rank});
  MPI_Allreduce(MPI_IN_PLACE, bids.data(), static_cast<int>(bids.size()),
                MPI_DOUBLE_INT, MPI_MAXLOC, _mesh->comm());
  for (std::size_t i = 0; i < spots.size(); ++i)
  {
    spots[i].found = bids[i].depth >= -outside;
    if (bids[i].rank != rank)
      spots[i].cell = -1;
  }
  return spots;
}

std::vector<double> Probe::sample(std::span<const Spot> spots,
                                  const NamedField& field) const
{
  const auto n = static_cast<std::size_t>(field.components);
  std::vector<double> out(spots.size() * n, 0.0);
  const auto nodes = _nodes->map();
  for (std::size_t i = 0; i < spots.size(); ++i)
  {
    const Spot& spot = spots[i];
    if (spot.cell < 0)
      continue;
    const auto cell = static_cast<std::size_t>(spot.cell);
    for (std::size_t c = 0; c < n; ++c)
    {
      double& value = out[i * n + c];
      if (field.location == Location::cell)
        value = field.values[cell * n + c];
      else
        for (std::size_t k = 0; k < 3; ++k)
          value +=
              spot.weights[k]
              * field.values[static_cast<std::size_t>(nodes(cell, k)) * n + c];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, out.data(), static_cast<int>(out.size()),
                MPI_DOUBLE, MPI_SUM, _mesh->comm());
  for (std::size_t i = 0; i < spots.size(); ++i)
    if (not spots[i].found)
      std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                  std::numeric_limits<double>::quiet_NaN());
  return out;
}

void write_lines(const Probe& probe, MPI_Comm comm,
                 const std::filesystem::path& folder, int k,
                 const std::map<std::string, scene::Line>& lines,
                 std::span<const NamedField> fields)
{
  for (const auto& [name, line] : lines)
  {
    const auto n = static_cast<std::size_t>(line.points);
    const double dx = line.to[0] - line.from[0];
    const double dy = line.to[1] - line.from[1];
    std::vector<double> s(n);
    std::vector<scene::Point> points(n);
    for (std::size_t i = 0; i < n; ++i)
    {
      s[i] = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
      points[i] = {line.from[0] + s[i] * dx, line.from[1] + s[i] * dy};
    }
    const std::vector<Spot> spots = probe.locate(points);
    std::vector<std::vector<double>> values;
    for (const NamedField& field : fields)
      values.push_back(probe.sample(spots, field));

    std::string text = header(fields);
    for (std::size_t i = 0; i < n; ++i)
    {
      append(text, s[i] * std::hypot(dx, dy));
      for (const double coordinate : points[i])
        append(text += ',', coordinate);
      for (std::size_t f = 0; f < fields.size(); ++f)
      {
        const auto m = static_cast<std::size_t>(fields[f].components);
        for (std::size_t c = 0; c < m; ++c)
          append(text += ',', values[f][i * m + c]);
      }
      text += '\n';
    }
    on_root(comm,
            [&]
            {
              std::filesystem::create_directories(folder / "lines");
              write_atomically(folder / "lines"
                                   / (name + "_" + std::to_string(k) + ".csv"),
                               text);
            });
  }
}
} // namespace mmale::output
