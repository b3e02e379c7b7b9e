// SPDX-License-Identifier: LGPL-3.0-or-later
#include "placement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace mmale::bridge
{
using ::remap::Kind;

namespace
{
/// A side that bends by less, in parts of its length, is straight.
constexpr double straight = mesh::Side::straight;

/// A free surface that turns by more at a node when first laid has a corner
/// there, not a coarse curve [cosine].
constexpr double corner = 0.7071; // 45 degrees

/// What the boundary's facets say of each node, on all ranks: the side that
/// all of them are of, `none`, or one of the others.
enum : int
{
  none = -1,    ///< not on the boundary
  several = -2, ///< where two straight stretches or boundaries meet
  smooth = -3   ///< the same, but on one boundary that hardly turns there
};

std::vector<int> sides_of_nodes(const mesh::Domain& domain)
{
  const auto& x = domain.initial_x;
  std::vector<double> side(domain.num_nodes(), none);
  std::vector<const mesh::Facet*> seen(domain.num_nodes(), nullptr);
  for (const mesh::Facet& f : domain.facets)
    for (int n : {f.a, f.b})
    {
      const mesh::Facet* other = std::exchange(seen[n], &f);
      if (not other)
        side[n] = f.side;
      else if (f.side != other->side)
      {
        const auto u = ::remap::point(x, f.b) - ::remap::point(x, f.a),
                   v = ::remap::point(x, other->b)
                       - ::remap::point(x, other->a);
        const double turn =
            ::remap::dot(u, v)
            / std::sqrt(::remap::dot(u, u) * ::remap::dot(v, v));
        side[n] =
            f.boundary == other->boundary and turn > corner ? smooth : several;
      }
    }
  // A rank may hold a node without its facets; the owner tells it.
  domain.node_halo->update(side, 1);
  return {side.begin(), side.end()};
}
} // namespace

Placement::Placement(const mesh::Domain& domain, const ::remap::Mesh& mesh,
                     const std::vector<std::string>& surfaces)
    : _domain(domain), _kinds(domain.num_nodes(), Kind::free),
      _direction(2 * domain.num_nodes(), 0), _mesh(mesh), _curve(mesh),
      _motion(2 * domain.num_nodes(), 0)
{
  for (const std::string& name : domain.boundary_names)
    _is_surface.push_back(std::ranges::find(surfaces, name) != surfaces.end());
  const std::vector<int> side_of = sides_of_nodes(domain);
  for (std::size_t b = 0; b < domain.boundary_names.size(); ++b)
    if (const auto nodes = domain.boundary_nodes(static_cast<int>(b));
        _is_surface[b])
      for (int n : nodes)
        if (side_of[n] != several)
          _kinds[n] = Kind::surface;
  for (int n = 0; n < domain.num_nodes(); ++n)
    if (side_of[n] != none and _kinds[n] == Kind::free)
    {
      _kinds[n] = Kind::fixed; // `turn` lets those slide that may
      if (side_of[n] == smooth)
        _curved.push_back(n);
    }
  add_corners(side_of);
  add_sides(side_of);
  turn(domain.initial_x);
  const auto& around = mesh.node_nodes();
  for (int n = 0; n < mesh.num_nodes(); ++n)
    for (int m : around[n])
    {
      const auto edge = ::remap::point(domain.initial_x, m)
                        - ::remap::point(domain.initial_x, n);
      _weight.push_back(1 / ::remap::dot(edge, edge));
    }
}

/// Nodes at which two stretches meet that are both of free surfaces.
void Placement::add_corners(std::span<const int> side_of)
{
  std::vector<double> others(_domain.num_nodes(), 0);
  for (const mesh::Facet& f : _domain.facets)
    if (not _is_surface[f.boundary])
      others[f.a] = others[f.b] = 1;
  _domain.node_halo->update(others, 1);
  for (int n = 0; n < _domain.num_nodes(); ++n)
    if (side_of[n] == several and others[n] == 0)
      _corners.push_back(n);
}

void Placement::add_sides(std::span<const int> side_of)
{
  std::vector<int> index(_domain.sides.size(), -1);
  std::map<std::int64_t, int> local;
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
    if (side_of[n] < none)
      local[_domain.node_id[n]] = n;
  for (std::size_t s = 0; s < _domain.sides.size(); ++s)
  {
    // An edge alone has no nodes between its ends.
    if (_domain.sides[s].edges < 2)
      continue;
    index[s] = static_cast<int>(_sides.size());
    _sides.emplace_back();
    for (int e = 0; e < 2; ++e)
      if (const auto at = local.find(_domain.sides[s].end_nodes[e]);
          at != local.end())
        _sides.back().ends[e] = at->second;
  }
  for (int n = 0; n < _domain.num_nodes(); ++n)
  {
    if (_kinds[n] != Kind::fixed or side_of[n] < 0 or index[side_of[n]] < 0)
      continue;
    const mesh::Side& whole = _domain.sides[side_of[n]];
    const ::remap::Point a{whole.ends[0][0], whole.ends[0][1]},
        chord = ::remap::Point{whole.ends[1][0], whole.ends[1][1]} - a;
    Side& side = _sides[index[side_of[n]]];
    side.nodes.push_back(n);
    side.part.push_back(
        ::remap::dot(::remap::point(_domain.initial_x, n) - a, chord)
        / ::remap::dot(chord, chord));
  }
}

/// Both ends of all sides, on all ranks.
std::vector<std::array<double, 4>>
Placement::ends(std::span<const double> x) const
{
  std::vector<std::array<double, 4>> out(_sides.size(), {0, 0, 0, 0});
  for (std::size_t s = 0; s < _sides.size(); ++s)
    for (int e = 0; e < 2; ++e)
      for (int d = 0; d < 2; ++d)
        if (const int n = _sides[s].ends[e]; n >= 0)
          out[s][2 * e + d] = x[2 * n + d];
  MPI_Allreduce(MPI_IN_PLACE, out.data(), static_cast<int>(4 * out.size()),
                MPI_DOUBLE, MPI_SUM, _domain.comm);
  return out;
}

/// How far the nodes of each side are from the chord of its ends, in chords.
std::vector<double>
Placement::bends(std::span<const double> x,
                 std::span<const std::array<double, 4>> ends) const
{
  std::vector<double> out(_sides.size(), 0);
  for (std::size_t s = 0; s < _sides.size(); ++s)
  {
    const ::remap::Point a{ends[s][0], ends[s][1]},
        chord = ::remap::Point{ends[s][2], ends[s][3]} - a;
    for (int n : _sides[s].nodes)
      out[s] = std::max(
          out[s], std::abs(::remap::cross(chord, ::remap::point(x, n) - a))
                      / ::remap::dot(chord, chord));
  }
  MPI_Allreduce(MPI_IN_PLACE, out.data(), static_cast<int>(out.size()),
                MPI_DOUBLE, MPI_MAX, _domain.comm);
  return out;
}

void Placement::turn(std::span<const double> x)
{
  std::ranges::fill(_direction, 0.0);
  for (const mesh::Facet& f : _domain.facets)
    for (int d = 0; d < 2; ++d)
      for (int n : {f.a, f.b})
        _direction[2 * n + d] += x[2 * f.b + d] - x[2 * f.a + d];
  _domain.node_halo->update(_direction, 2);
  const auto bend = bends(x, ends(x));
  for (std::size_t s = 0; s < _sides.size(); ++s)
    for (int n : _sides[s].nodes)
      _kinds[n] = bend[s] < straight ? Kind::slide : on_curve(n, x);
  for (int n : _curved)
    _kinds[n] = on_curve(n, x);
  turn_corners(x);
  _placed = _kinds;
  std::ranges::replace(_placed, Kind::slide, Kind::fixed);
  ::remap::Host host;
  host.node_halo = [this](std::span<double> v, int block)
  { _domain.node_halo->update(v, block); };
  _curve.follow(x, _kinds, host);
}

/// Corners of free surfaces are nodes like others where they have become blunt,
/// or one of the sides that meet there has been used up.
void Placement::turn_corners(std::span<const double> x)
{
  std::vector<double> free(_domain.num_nodes(), 0);
  for (int n : _corners)
    free[n] = n < _domain.num_owned_nodes
              and (on_curve(n, x) == Kind::curve or used_up(n, x));
  _domain.node_halo->update(free, 1);
  for (int n : _corners)
    _kinds[n] = free[n] > 0 ? Kind::surface : Kind::fixed;
  _on_surface.clear();
  for (Kind k : _kinds)
    _on_surface.push_back(k == Kind::surface);
}

/// Are the facets at a node of ours, over their first lengths, further apart
/// than 1 : 2?
bool Placement::used_up(int node, std::span<const double> x) const
{
  const auto [in, out] = _mesh.boundary_facets(node);
  if (in < 0 or out < 0)
    return false;
  const auto grown = [&](std::int32_t f)
  {
    const auto length2 = [&](std::span<const double> at)
    {
      const auto d = ::remap::point(at, _mesh.facet(f)[1])
                     - ::remap::point(at, _mesh.facet(f)[0]);
      return ::remap::dot(d, d);
    };
    return length2(x) / length2(_domain.initial_x);
  };
  const double a = grown(in), b = grown(out);
  return std::max(a, b) > 4 * std::min(a, b);
}

/// `curve`, but for corners; of nodes of ours.
Kind Placement::on_curve(int node, std::span<const double> x) const
{
  const auto [in, out] = _mesh.boundary_facets(node);
  if (in < 0 or out < 0)
    return Kind::fixed;
  const auto u = ::remap::point(x, node)
                 - ::remap::point(x, _mesh.facet(in)[0]),
             v = ::remap::point(x, _mesh.facet(out)[1])
                 - ::remap::point(x, node);
  return ::remap::dot(u, v)
                 > corner * std::sqrt(::remap::dot(u, u) * ::remap::dot(v, v))
             ? Kind::curve
             : Kind::fixed;
}

/// The first spacing on sides that are straight now.
void Placement::place_sides(std::vector<double>& x) const
{
  const auto ends = this->ends(x);
  const auto bend = bends(x, ends);
  for (std::size_t s = 0; s < _sides.size(); ++s)
    for (std::size_t i = 0; bend[s] < straight and i < _sides[s].nodes.size();
         ++i)
      for (int d = 0; d < 2; ++d)
        x[2 * _sides[s].nodes[i] + d] =
            ends[s][d] + _sides[s].part[i] * (ends[s][2 + d] - ends[s][d]);
}

/// Average the motion into the body (Jacobi: the same on any number of ranks).
void Placement::follow_boundary()
{
  const auto& around = _mesh.node_nodes();
  std::vector<double> next = _motion;
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    for (int n = 0; n < _domain.num_owned_nodes; ++n)
    {
      if (_kinds[n] != Kind::free)
        continue;
      double sum[3] = {0, 0, 0};
      const auto nodes = around[n];
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        const double w = _weight[around.offsets[n] + i];
        sum[0] += w * _motion[2 * nodes[i]];
        sum[1] += w * _motion[2 * nodes[i] + 1];
        sum[2] += w;
      }
      next[2 * n] = sum[0] / sum[2];
      next[2 * n + 1] = sum[1] / sum[2];
    }
    _domain.node_halo->update(next, 2);
    _motion = next;
  }
}

std::vector<double> Placement::start(std::span<const double> moved,
                                     std::span<const double> home)
{
  std::vector<double> x(moved.begin(), moved.end());
  place_sides(x);
  // The last motion, brought to the size of this one, is the first guess.
  double size[2] = {0, 0};
  for (std::size_t n = 0; n < _kinds.size(); ++n)
    for (std::size_t i = 2 * n; _kinds[n] != Kind::free and i < 2 * n + 2; ++i)
    {
      size[0] = std::max(size[0], std::abs(_motion[i]));
      _motion[i] = x[i] - home[i];
      size[1] = std::max(size[1], std::abs(_motion[i]));
    }
  MPI_Allreduce(MPI_IN_PLACE, size, 2, MPI_DOUBLE, MPI_MAX, _domain.comm);
  for (std::size_t n = 0; n < _kinds.size(); ++n)
    for (std::size_t i = 2 * n; _kinds[n] == Kind::free and i < 2 * n + 2; ++i)
      _motion[i] *= size[0] > 0 ? size[1] / size[0] : 0;
  follow_boundary();
  for (std::size_t n = 0; n < _kinds.size(); ++n)
    for (std::size_t i = 2 * n; _kinds[n] == Kind::free and i < 2 * n + 2; ++i)
      x[i] = home[i] + _motion[i];
  return x;
}
} // namespace mmale::bridge
