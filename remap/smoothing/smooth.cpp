// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/smoothing/smooth.h"

#include "remap/smoothing/cell_quality.h"
#include "remap/smoothing/colouring.h"
#include "remap/smoothing/surface.h"
#include "remap/smoothing/untangle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

using namespace remap;

namespace
{
/// Halvings of a move that does harm, before the node stays.
constexpr int max_halvings = 4;
/// Steps shorter than this part of the patch are not made: a node at its best
/// place must stay there to the last bit.
constexpr double least_step = 1e-10;
/// Passes of untangling before it is given up.
constexpr int max_passes = 100;
/// Part of its patch's mean that a cell's area shall have after untangling.
constexpr double sound = 1e-3;
/// Part of its patch's mean that an area is raised to where a barrier is
/// softened. Doubled: faster from far away, and less sure in narrow places.
constexpr double softness = 0.1;
/// Quality at which a cell is taken for inverted: from nearer to zero a barrier
/// lets a node off by too small steps.
constexpr double thin = 1e-6;

} // namespace

std::vector<std::string> SmoothingOptions::complaints() const
{
  std::vector<std::string> out;
  if (not(threshold >= 0 and threshold <= 1))
    out.push_back("threshold: must lie in [0, 1]");
  if (rings < 0)
    out.push_back("rings: must not be negative");
  if (sweeps < 1)
    out.push_back("sweeps: must be at least 1");
  if (not(relaxation > 0 and relaxation < 2))
    out.push_back("relaxation: must lie in (0, 2)");
  return out;
}

Smoothing::Smoothing(const Mesh& mesh, SmoothingOptions options,
                     const Host& host)
    : _mesh(&mesh), _options(std::move(options)), _stars(mesh),
      _zigzag(mesh, host)
{
  if (const auto all = _options.complaints(); not all.empty())
  {
    std::string text;
    for (const std::string& line : all)
      text += line + "\n";
    throw std::invalid_argument(text);
  }
  _colour = colour_nodes(mesh, host);
  const auto last = std::max_element(_colour.begin(), _colour.end());
  _num_colours =
      static_cast<int>(host.max(last == _colour.end() ? 0.0 : 1.0 + *last));
  _patch.reserve(_stars.widest());
  _cells.reserve(mesh.num_cells());
  _near.resize(mesh.num_cells());
  _before.resize(2 * static_cast<std::size_t>(mesh.num_nodes()));
  _order.reserve(mesh.owned_nodes());
  _start.resize(_num_colours + 1);
  _flags.resize(mesh.num_nodes());
  _shifted.resize(mesh.num_nodes());
}

bool Smoothing::flag(std::span<const double> x,
                     std::span<const quality::Target> targets,
                     std::span<std::uint8_t> flags, const Host& host)
{
  const auto n = static_cast<std::size_t>(_mesh->num_nodes());
  const auto cells = static_cast<std::size_t>(_mesh->num_cells());
  if (x.size() != 2 * n or flags.size() != n
      or not(targets.empty() or targets.size() == cells))
    throw std::invalid_argument("flag: an array does not fit the mesh\n");
  const auto node_cells = [this](std::int32_t i)
  { return _mesh->node_cells()[i]; };
  std::fill(_flags.begin(), _flags.end(), 0.0);
  double any = 0;
  for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
    for (std::int32_t c : node_cells(i))
      if (not(quality_of(*_mesh, x, _options.measure, targets, c)
              >= _options.threshold))
        _flags[i] = any = 1;
  host.update_nodes(_flags, 1);
  for (int ring = 0; ring < _options.rings; ++ring)
  {
    // 2 is new in this ring and does not spread until the next.
    for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
      for (std::int32_t j : _mesh->node_nodes()[i])
        if (_flags[i] == 0 and _flags[j] == 1)
          _flags[i] = 2;
    for (double& f : _flags)
      f = std::min(f, 1.0);
    host.update_nodes(_flags, 1);
  }
  std::transform(_flags.begin(), _flags.end(), flags.begin(),
                 [](double f) { return static_cast<std::uint8_t>(f); });
  return host.max(any) > 0;
}

bool Smoothing::sizes_fit(std::span<const double> x,
                          std::span<const std::uint8_t> flags,
                          const Constraints& c) const
{
  const auto n = static_cast<std::size_t>(_mesh->num_nodes());
  const auto any = [&](Kind kind)
  { return std::find(c.kinds.begin(), c.kinds.end(), kind) != c.kinds.end(); };
  const auto facets = static_cast<std::size_t>(_mesh->num_facets());
  const auto cells = static_cast<std::size_t>(_mesh->num_cells());
  return x.size() == 2 * n and flags.size() == n and c.kinds.size() == n
         and (any(Kind::curve) ? c.guide != nullptr : true)
         and (any(Kind::slide)
                  ? c.direction.size() == 2 * n
                  : c.direction.empty() or c.direction.size() == 2 * n)
         and (c.spacing.empty() or c.spacing.size() == facets)
         and (c.targets.empty() or c.targets.size() == cells);
}

/// Flagged nodes of ours that may move, sorted by colour, and their cells.
void Smoothing::collect(std::span<const std::uint8_t> flags,
                        const Constraints& c)
{
  const auto moves = [&](std::int32_t i)
  { return flags[i] != 0 and c.kinds[i] != Kind::fixed; };
  std::fill(_start.begin(), _start.end(), 0);
  for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
    if (moves(i))
      ++_start[_colour[i] + 1];
  for (int k = 0; k < _num_colours; ++k)
    _start[k + 1] += _start[k];
  _order.resize(_start[_num_colours]);
  for (std::int32_t i = 0; i < _mesh->owned_nodes(); ++i)
    if (moves(i))
      _order[_start[_colour[i]]++] = i;
  for (int k = _num_colours; k > 0; --k)
    _start[k] = _start[k - 1];
  _start[0] = 0;
  _cells.clear();
  std::fill(_near.begin(), _near.end(), std::uint8_t(0));
  for (std::int32_t i : _order)
    for (std::int32_t cell : _mesh->node_cells()[i])
      if (not std::exchange(_near[cell], std::uint8_t(1)))
        _cells.push_back(cell);
}

Smoothing::Worst Smoothing::worst_of(std::span<const double> x,
                                     const Constraints& c) const
{
  Worst out;
  for (std::int32_t cell : _cells)
  {
    const double one = quality_of(*_mesh, x, _options.measure, c.targets, cell);
    out.quality = std::min(out.quality, one);
    if (not(one > 0))
    {
      out.inverted =
          std::max(out.inverted, static_cast<double>(_mesh->cell_ids()[cell]));
      out.count += cell < _mesh->owned_cells();
    }
  }
  return out;
}

/// The patch of a node; its cells are in _patch.
Patch Smoothing::gather(std::int32_t node, std::span<const double> x,
                        const Constraints& c)
{
  _stars.gather(node, x, c.targets, _patch);
  Patch out{point(x, node), _patch, {}};
  if (c.kinds[node] == Kind::slide or c.kinds[node] == Kind::curve)
  {
    const Point t = c.kinds[node] == Kind::slide
                        ? point(c.direction, node)
                        : c.guide->foot(node, out.x).along;
    out.along = (1 / std::sqrt(dot(t, t))) * t;
  }
  return out;
}

/// Is the worst cell of _patch at least so good with its node there? A worst
/// cell that the move leaves as it is differs in its last digits; these must
/// not decide, or the result would depend on them.
bool Smoothing::no_worse(Point to, double floor) const
{
  constexpr double round_off = 1e-12;
  const double q = worst(_patch, to, _options.measure);
  return q > 0 and q >= floor - round_off;
}

void Smoothing::put(std::int32_t node, std::span<double> x, Point to)
{
  x[2 * node] = to.x;
  x[2 * node + 1] = to.y;
  _shifted[node] = 1;
}

/// Try a move and halves of it: `place(part)` is where the node would be,
/// `good` tells if it may. Returns the length of the step that was made.
template <class Place, class Good>
double Smoothing::accept(std::int32_t node, std::span<double> x, Place&& place,
                         Good&& good)
{
  const Point old = point(x, node);
  double size = 0;
  for (const PatchCell& cell : _patch)
    size = std::max(size, dot(cell.a - old, cell.a - old));
  double part = _options.relaxation;
  for (int k = 0; k <= max_halvings; ++k, part /= 2)
  {
    const Point to = place(part);
    const double step = dot(to - old, to - old);
    if (not(step > least_step * least_step * size))
      return 0;
    if (not good(to))
      continue;
    put(node, x, to);
    return std::sqrt(step);
  }
  return 0;
}

/// A node that has left its curve goes back to it, with the right of a surface
/// node. Returns where it is now.
Point Smoothing::come_back(std::int32_t node, std::span<double> x,
                           const Guide& guide)
{
  const Point old = point(x, node);
  const double floor =
      std::min(worst(_patch, old, _options.measure), _options.threshold);
  accept(
      node, x, [&](double part)
      { return old + std::min(part, 1.0) * (guide.foot(node, old).at - old); },
      [&](Point to) { return no_worse(to, floor); });
  return point(x, node);
}

template <class S>
double Smoothing::visit(std::int32_t node, std::span<double> x,
                        const Constraints& c)
{
  Patch patch = gather(node, x, c);
  if (c.kinds[node] == Kind::curve)
    patch.x = come_back(node, x, *c.guide);
  const Point old = patch.x;
  const Point goal = S::propose(patch);
  const double q = worst(_patch, old, _options.measure);
  const double least = std::max(_floor, std::min(q, _options.threshold));
  return accept(
      node, x,
      [&](double part)
      {
        const Point to = old + part * (goal - old);
        return c.kinds[node] == Kind::curve ? c.guide->foot(node, to).at : to;
      },
      [&](Point to)
      {
        return no_worse(to, q)
               or (no_worse(to, least)
                   and distortion(_patch, to) < distortion(_patch, old));
      });
}

template <class S>
double Smoothing::visit_surface(std::int32_t node, std::span<double> x,
                                const Constraints& c)
{
  const auto [in, out] = _mesh->boundary_facets(node);
  if (in < 0)
    return 0;
  Patch patch = gather(node, x, c);
  const Point old = patch.x;
  const Point before = point(x, _mesh->facet(in)[0]);
  const Point after = point(x, _mesh->facet(out)[1]);
  const Point chord = after - before;
  const double length2 = dot(chord, chord);
  const double now = dot(old - before, chord) / length2;
  double floor = worst(_patch, old, _options.measure);
  double tau = now;
  if (c.spacing.empty())
  {
    patch.along = (1 / std::sqrt(length2)) * chord;
    tau = dot(S::propose(patch) - before, chord) / length2;
  }
  else
  {
    tau = surface::part(before, old, after, c.spacing[in], c.spacing[out]);
    floor = std::min(floor, _options.threshold);
  }
  return accept(
      node, x,
      [&](double part)
      {
        const double to = now + part * (tau - now);
        return _options.geometry == Geometry::plane
                   ? surface::at<Geometry::plane>(before, old, after, to)
                   : surface::at<Geometry::axisymmetric>(before, old, after,
                                                         to);
      },
      [&](Point to) { return no_worse(to, floor); });
}

/// One pass of untangling, of our nodes with inverted or very thin cells, or of
/// all if that has come to its end. Did any node of any rank move?
bool Smoothing::untangle_once(std::span<double> x, const Constraints& c,
                              bool all, const Host& host)
{
  double moved = 0;
  for (int colour = 0; colour < _num_colours; ++colour)
  {
    for (std::int32_t k = _start[colour]; k < _start[colour + 1]; ++k)
    {
      const std::int32_t i = _order[k];
      if (c.kinds[i] == Kind::surface) // area would be lost or gained
        continue;
      const Patch patch = gather(i, x, c);
      const double least = smallest_area(patch.cells, patch.x);
      const double enough = sound * std::abs(mean_area(patch));
      if (not all and least > enough)
        continue;
      Point to = all ? softened(patch, softness) : untangled(patch);
      if (c.kinds[i] == Kind::curve)
        to = c.guide->foot(i, to).at;
      if (not all
          and not(smallest_area(patch.cells, to) > least + sound * enough))
        continue;
      put(i, x, to);
      moved = 1;
    }
    host.update_nodes(x, 2);
  }
  return host.max(moved) > 0;
}

/// Until no cell that is worked on is inverted, nor so thin that a barrier has
/// no hold on it. False if some remain inverted.
bool Smoothing::untangle(std::span<double> x, const Constraints& c,
                         const Host& host)
{
  for (int pass = 0; pass < max_passes; ++pass)
    if (not untangle_once(x, c, false, host))
    {
      if (host.max(worst_of(x, c).inverted) < 0)
        return true;
      untangle_once(x, c, true, host);
    }
  return host.max(worst_of(x, c).inverted) < 0;
}

template <class S>
void Smoothing::sweeps(std::span<double> x, std::span<const std::uint8_t> flags,
                       const Constraints& c, bool surfaces, const Host& host)
{
  for (int sweep = 0; sweep < _options.sweeps; ++sweep)
  {
    _floor = _report.worst_after;
    double longest = 0;
    for (int colour = 0; colour < _num_colours; ++colour)
    {
      for (std::int32_t k = _start[colour]; k < _start[colour + 1]; ++k)
      {
        const std::int32_t i = _order[k];
        longest = std::max(longest, c.kinds[i] == Kind::surface
                                        ? visit_surface<S>(i, x, c)
                                        : visit<S>(i, x, c));
      }
      host.update_nodes(x, 2);
    }
    if (surfaces)
      longest =
          std::max(longest, _zigzag.remove(x, flags, c.kinds,
                                           {_options.geometry, _options.measure,
                                            _options.threshold, c.targets},
                                           host));
    double state[2] = {longest, -worst_of(x, c).quality};
    host.max(std::span(state, 2));
    _report.largest_step = std::max(_report.largest_step, state[0]);
    _report.worst_after = -state[1];
    if (state[0] == 0)
      return;
  }
}

Outcome Smoothing::smooth(std::span<double> x,
                          std::span<const std::uint8_t> flags,
                          const Constraints& c, const Host& host)
{
  _report = {};
  const bool fit = sizes_fit(x, flags, c);
  const bool finite = std::all_of(x.begin(), x.end(),
                                  [](double v) { return std::isfinite(v); });
  _order.clear();
  if (fit)
    collect(flags, c);
  const Worst first = fit and finite ? worst_of(x, c) : Worst{};
  double state[5] = {fit ? 0.0 : 1.0, finite ? 0.0 : 1.0, first.inverted,
                     -first.quality,
                     std::ranges::count(c.kinds, Kind::surface) > 0 ? 1. : 0.};
  host.max(std::span(state, 5));
  if (state[0] > 0)
    return Outcome::wrong_size;
  if (state[1] > 0)
    return Outcome::not_finite;
  _report.worst_before = _report.worst_after = -state[3];
  _report.worst_cell = static_cast<std::int64_t>(state[2]);
  std::fill(_shifted.begin(), _shifted.end(), std::uint8_t(0));
  if (not(_report.worst_before > thin))
  {
    std::copy(x.begin(), x.end(), _before.begin());
    if (not untangle(x, c, host))
    {
      std::copy(_before.begin(), _before.end(), x.begin());
      return Outcome::inverted_start;
    }
    _report.untangled = static_cast<std::int32_t>(first.count);
    _report.worst_after = -host.max(-worst_of(x, c).quality);
  }
  std::visit([&]<class S>(const S&)
             { sweeps<S>(x, flags, c, state[4] > 0, host); },
             _options.smoother);
  _report.moved = static_cast<std::int32_t>(
      std::count(_shifted.begin(), _shifted.end(), 1));
  return Outcome::ok;
}

std::vector<quality::Target> remap::shapes(const Mesh& mesh,
                                           std::span<const double> x)
{
  std::vector<quality::Target> out;
  out.reserve(mesh.num_cells());
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
  {
    const Triple& n = mesh.cell(c);
    const Point a = point(x, n[0]);
    out.push_back(quality::Target::of(point(x, n[1]) - a, point(x, n[2]) - a));
  }
  return out;
}

std::vector<double> remap::facet_lengths(const Mesh& mesh,
                                         std::span<const double> x)
{
  std::vector<double> out;
  out.reserve(mesh.num_facets());
  for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
  {
    const Point d = point(x, mesh.facet(f)[1]) - point(x, mesh.facet(f)[0]);
    out.push_back(std::sqrt(dot(d, d)));
  }
  return out;
}

double remap::worst_quality(const Mesh& mesh, std::span<const double> x,
                            Measure measure,
                            std::span<const quality::Target> targets,
                            const Host& host)
{
  double q = 1;
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
  {
    const double one = quality_of(mesh, x, measure, targets, c);
    q = not(one >= q) ? one : q;
  }
  return -host.max(-q);
}
