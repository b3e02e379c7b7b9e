// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/transport/overlay.h"

#include "remap/geometry/position.h"

#include <algorithm>
#include <limits>

using namespace remap;
using namespace remap::position;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();
/// Pieces for which room is made, per cell.
constexpr std::size_t usual_pieces = 8;
/// Walks never come to cells that do not change.
constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();
/// Steps of a search for the cell at a place; then `match` has to find it.
constexpr int max_steps = 2000;
} // namespace

Overlay::Overlay(const Mesh& mesh) : _mesh(&mesh), _outline(mesh.outline())
{
  const auto n = static_cast<std::size_t>(mesh.num_cells());
  _beside.resize(n);
  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
    for (int k = 0; k < 3; ++k)
    {
      const auto [left, right] = mesh.facet_cells(mesh.cell_facets(c)[k]);
      const std::int32_t other = left == c ? right : left;
      _beside[c][k] = other < 0 ? mesh.num_cells() : other;
    }
  _is_outline.assign(mesh.num_facets(), 0);
  for (std::int32_t f : _outline)
    _is_outline[f] = 1;
  _seen.assign(n + 1, never);
  _slot.assign(n, -1);
  _queue.resize(n + 1);
  _cuts.resize(n + 1);
  _rest.resize(n);
  _pieces.reserve(usual_pieces * n);
  _edges.reserve(n);
  _old_boxes.reserve(n);
  _new_boxes.reserve(n);
  for (Side* side : {&_old, &_new})
  {
    side->whole.resize(n);
    side->found.resize(n);
    side->length.resize(n);
    side->other.resize(n);
    side->range.resize(n);
    side->left.reserve(n);
    side->volume.reserve(n);
  }
}

Triangle Overlay::place(const Side& side, std::int32_t c) const
{
  const Triple& n = _mesh->cell(c);
  return {point(side.x, n[0]), point(side.x, n[1]), point(side.x, n[2])};
}

void Overlay::start(std::span<const double> x_old,
                    std::span<const double> x_new,
                    std::span<const std::int32_t> touched)
{
  _old.x = x_old;
  _new.x = x_new;
  _pieces.clear();
  _worst = -1;
  _matched = 0;
  _touched = touched;
  _walk = 0;
  for (std::int32_t c : touched)
  {
    _seen[c] = 0;
    _rest[c] = {};
  }
}

/// Sizes of touched cells; false if one has no volume.
template <Geometry G>
bool Overlay::measure(Side& side)
{
  for (std::int32_t c : _touched)
  {
    const Triangle t = place(side, c);
    side.whole[c] = about_first<G>(t);
    side.length[c] = longest_edge(t);
    side.found[c] = 0;
    side.other[c] = 0;
    side.range[c] = {0, 0};
    if (not(side.whole[c].v > 0))
      _worst = std::max(_worst, _mesh->cell_ids()[c]);
  }
  return _worst < 0;
}

/// Put a cell on the list of this walk, if it is not there; without a branch.
inline void Overlay::visit(std::int32_t c, std::uint32_t wanted)
{
  const std::uint32_t seen = _seen[c];
  const std::uint32_t is_new =
      wanted & static_cast<std::uint32_t>(seen < _walk);
  _queue[_queued] = c;
  _queued += is_new;
  _seen[c] = seen + is_new * (_walk - seen);
}

/// Cell of a mesh that holds the centroid of `target`, or the last one on the
/// way to it; -1 if the way goes in circles.
std::int32_t Overlay::locate(const Side& through, std::int32_t from,
                             const Triangle& target) const
{
  const Point g = 1.0 / 3 * (target[0] + target[1] + target[2]);
  std::int32_t at = from, before = -1;
  for (int step = 0; step < max_steps; ++step)
  {
    const Triangle p = place(through, at);
    std::int32_t next = -1;
    bool inside = true;
    for (int k = 0; k < 3 and next < 0; ++k)
    {
      if (not(depth(p[k], p[(k + 1) % 3], g) < 0))
        continue;
      inside = false;
      if (_beside[at][k] != before and _beside[at][k] < _mesh->num_cells())
        next = _beside[at][k];
    }
    if (inside or next < 0)
      return at;
    before = at;
    at = next;
  }
  return -1;
}

/// Put all cells that overlap `target` on the list, outwards from those that
/// are on it from `first` on.
void Overlay::spread(const Side& through, const Triangle& target,
                     std::size_t first)
{
  for (std::size_t i = first; i < _queued; ++i)
  {
    const std::int32_t e = _queue[i];
    const auto [edges, cuts] = position::of(place(through, e), target);
    _cuts[i] = static_cast<std::uint8_t>(cuts);
    for (unsigned k = 0; k < 3; ++k)
      visit(_beside[e][k], edges >> k & 1u);
  }
}

/// Visit all cells of one mesh that overlap cell c at its place in the other,
/// from c, or from the cell that is there now, outwards.
/// @param[in] use use(cell, its place, half-planes of the target that cut it):
/// does it overlap?
template <class Use>
void Overlay::walk(const Side& through, std::int32_t c, const Triangle& target,
                   Use&& use)
{
  ++_walk;
  _queued = 0;
  visit(c, 1);
  spread(through, target, 0);
  // The list first, then the overlaps: what comes next on the list hangs on
  // what is there, overlaps do not hang on each other.
  if (not use(c, place(through, c), _cuts[0]))
    if (const std::int32_t there = locate(through, c, target); there >= 0)
    {
      const std::size_t behind = _queued;
      visit(there, 1);
      spread(through, target, behind);
    }
  for (std::size_t i = 1; i < _queued; ++i)
    use(_queue[i], place(through, _queue[i]), _cuts[i]);
}

/// Overlap of old cell c with new cell d, into the books of both.
template <Geometry G>
bool Overlay::add(std::int32_t c, std::int32_t d, const Triangle& old_place,
                  const Triangle& new_place, unsigned cuts)
{
  const Moments m = polygon::overlap_from<G>(old_place, new_place, cuts);
  if (not(m.v > 0))
    return false;
  _new.found[d] += m.v;
  _old.found[c] += m.v;
  const double lc = _old.length[c], ld = _new.length[d];
  _new.other[d] = std::max(_new.other[d], lc);
  _old.other[c] = std::max(_old.other[c], ld);
  // Of round-off size: the centroid means nothing and must not limit a
  // gradient. Such a piece carries the mean.
  const bool sliver = m.v < 1e-13 * lc * ld * weight<G>(old_place);
  const Point at = sliver ? old_place[0] + _old.whole[c].centroid()
                          : held_in(old_place, new_place[0] + m.centroid());
  if (c == d)
    _rest[c] = {m.v, at};
  else
    _pieces.push_back({.from = c, .to = d, .volume = m.v, .at = at});
  return true;
}

/// Cells of ours that overlaps do not fill; false if one is more than full.
template <Geometry G>
bool Overlay::collect_left(Side& side)
{
  side.left.clear();
  side.volume.clear();
  bool good = true;
  for (std::int32_t c : _touched)
  {
    if (c >= _mesh->owned_cells())
      continue;
    const double gap = side.whole[c].v - side.found[c];
    const double scale = side.length[c]
                         * std::max(side.length[c], side.other[c])
                         * weight<G>(place(side, c));
    if (gap > 64 * eps * scale)
    {
      side.left.push_back(c);
      side.volume.push_back(gap);
    }
    else if (not(gap > -1e-9 * scale))
    {
      _worst = std::max(_worst, _mesh->cell_ids()[c]);
      good = false;
    }
  }
  return good;
}

void Overlay::boxes(const Side& side, bool ghosts, std::vector<Box>& out) const
{
  out.clear();
  const auto add = [&](std::int32_t c)
  {
    const Triangle t = place(side, c);
    Box b{t[0], t[0], c};
    for (const Point& p : t)
    {
      b.lo = {std::min(b.lo.x, p.x), std::min(b.lo.y, p.y)};
      b.hi = {std::max(b.hi.x, p.x), std::max(b.hi.y, p.y)};
    }
    out.push_back(b);
  };
  std::for_each(side.left.begin(), side.left.end(), add);
  if (ghosts)
    for (std::int32_t c : _touched)
      if (c >= _mesh->owned_cells())
        add(c);
  std::sort(out.begin(), out.end(),
            [](const Box& a, const Box& b) { return a.lo.x < b.lo.x; });
}

/// Has a walk found this pair?
bool Overlay::known(std::int32_t c, std::int32_t d) const
{
  if (c == d)
    return _rest[c].volume > 0;
  const auto [first, behind] =
      d < _mesh->owned_cells() ? _new.range[d] : _old.range[c];
  return std::any_of(_pieces.begin() + first, _pieces.begin() + behind,
                     [c, d](const Piece& p)
                     { return p.from == c and p.to == d; });
}

/// What walks have missed: a new cell that leaves the old mesh and enters it
/// again, or one that lies far away across a bay. Only cells of both meshes
/// that are not all found can overlap: by boxes, swept along x.
template <Geometry G>
void Overlay::match()
{
  const std::int32_t owned = _mesh->owned_cells();
  const bool any_old = not _old.left.empty(), any_new = not _new.left.empty();
  boxes(_old, any_new, _old_boxes);
  boxes(_new, any_old, _new_boxes);
  const auto pair = [&](const Box& o, const Box& n)
  {
    if (o.hi.y > n.lo.y and n.hi.y > o.lo.y
        and (o.cell < owned or n.cell < owned) and not known(o.cell, n.cell))
      _matched +=
          add<G>(o.cell, n.cell, place(_old, o.cell), place(_new, n.cell), 7)
              ? 1
              : 0;
  };
  auto o = _old_boxes.begin();
  auto n = _new_boxes.begin();
  while (o != _old_boxes.end() and n != _new_boxes.end())
    if (o->lo.x <= n->lo.x)
    {
      for (auto k = n; k != _new_boxes.end() and k->lo.x < o->hi.x; ++k)
        pair(*o, *k);
      ++o;
    }
    else
    {
      for (auto k = o; k != _old_boxes.end() and k->lo.x < n->hi.x; ++k)
        pair(*k, *n);
      ++n;
    }
}

/// Does the outline, or the halo's edge, of a mesh pass through `target` along
/// cell c?
Overlay::Edge Overlay::edge_inside(const Side& through, std::int32_t c,
                                   const Triangle& target, Edge found) const
{
  const Triangle p = place(through, c);
  for (int k = 0; k < 3; ++k)
  {
    if (_beside[c][k] < _mesh->num_cells())
      continue;
    const double length = length_inside(p[k], p[(k + 1) % 3], target);
    const std::int32_t f = _mesh->cell_facets(c)[k];
    if (not(length > 0))
      continue;
    if (_is_outline[f] == 0)
      found.halo = true;
    else
    {
      found.outline = true;
      if (length > found.length)
      {
        found.length = length;
        found.facet = f;
      }
    }
  }
  return found;
}

std::int32_t Overlay::nearest_outline(const Side& side, Point p) const
{
  double best = std::numeric_limits<double>::infinity();
  std::int32_t nearest = -1;
  for (std::int32_t f : _outline)
  {
    const auto [a, b] = _mesh->facet(f);
    const Point d = p - middle(point(side.x, a), point(side.x, b));
    if (dot(d, d) < best)
    {
      best = dot(d, d);
      nearest = f;
    }
  }
  return nearest;
}

/// What is still not found lies outside the other mesh, or beyond the halo.
template <Geometry G>
Outcome Overlay::close(Side& side, const Side& through)
{
  const bool is_new = &side == &_new;
  const bool ghosts = _mesh->num_cells() > _mesh->owned_cells();
  _edges.assign(side.left.size(), {});
  for (std::size_t i = 0; i < side.left.size(); ++i)
    _slot[side.left[i]] = static_cast<std::int32_t>(i);
  const auto look =
      [&](std::int32_t c, std::int32_t across, double volume, Point at)
  {
    if (c < 0 or _slot[c] < 0 or across < 0)
      return;
    Edge& edge = _edges[_slot[c]];
    const Triangle t = place(side, c);
    edge = edge_inside(through, across, t, edge);
    const Point d = at - t[0];
    edge.found += {volume, volume * d.x, volume * d.y};
  };
  for (const Piece& p : _pieces)
    is_new ? look(p.to, p.from, p.volume, p.at)
           : look(p.from, p.to, p.volume, p.at);
  for (std::int32_t c : side.left)
    look(c, c, _rest[c].volume, _rest[c].at);

  Outcome outcome = Outcome::ok;
  for (std::size_t i = 0; i < side.left.size(); ++i)
  {
    const std::int32_t c = side.left[i];
    const Edge& edge = _edges[i];
    _slot[c] = -1;
    const Triangle t = place(side, c);
    const double scale =
        side.length[c] * std::max(side.length[c], side.other[c]) * weight<G>(t);
    // Away from any edge a small gap is round-off.
    if (not edge.outline and not edge.halo and side.volume[i] < 1e-12 * scale)
      continue;
    if (edge.halo or (ghosts and not edge.outline))
    {
      outcome = Outcome::beyond_halo;
      _worst = std::max(_worst, _mesh->cell_ids()[c]);
      continue;
    }
    const Moments rest = side.whole[c] - edge.found;
    const double volume = side.volume[i];
    const Moments& m = volume < 1e-13 * scale ? side.whole[c] : rest;
    const Point at = held_in(t, t[0] + m.centroid());
    const std::int32_t facet =
        edge.outline ? edge.facet : nearest_outline(through, at);
    _pieces.push_back({.from = is_new ? -1 : c,
                       .to = is_new ? c : -1,
                       .volume = volume,
                       .at = at,
                       .facet = facet,
                       .marker = facet < 0 ? -1 : _mesh->marker(facet)});
  }
  return outcome;
}

template <Geometry G>
Outcome Overlay::intersect(std::span<const double> x_old,
                           std::span<const double> x_new,
                           std::span<const std::int32_t> touched)
{
  start(x_old, x_new, touched);
  const auto end = [this](Outcome outcome)
  {
    for (std::int32_t c : _touched)
      _seen[c] = never;
    return outcome;
  };
  if (not measure<G>(_old))
    return end(Outcome::inverted_start);
  if (not measure<G>(_new))
    return end(Outcome::inverted_target);

  const std::int32_t owned = _mesh->owned_cells();
  const auto behind = [this]
  { return static_cast<std::int32_t>(_pieces.size()); };
  for (std::int32_t d : touched)
  {
    if (d >= owned)
      continue;
    const Triangle target = place(_new, d);
    _new.range[d][0] = behind();
    walk(_old, d, target, [&](std::int32_t c, const Triangle& p, unsigned cuts)
         { return add<G>(c, d, p, target, cuts); });
    _new.range[d][1] = behind();
  }
  if (not collect_left<G>(_old))
    return end(Outcome::inverted_target);
  // What our cells gave to ghosts: walks through the new mesh.
  if (_mesh->num_cells() > owned)
  {
    for (std::int32_t c : _old.left)
    {
      const Triangle target = place(_old, c);
      _old.range[c][0] = behind();
      walk(_new, c, target,
           [&](std::int32_t d, const Triangle& p, unsigned)
           {
             return d < owned ? d != c or _rest[c].volume > 0
                              : add<G>(c, d, target, p, 7);
           });
      _old.range[c][1] = behind();
    }
    if (not collect_left<G>(_old))
      return end(Outcome::inverted_target);
  }
  if (not collect_left<G>(_new))
    return end(Outcome::inverted_start);
  // A partner among ghosts need not be on a list of ours.
  const bool ghosts = _mesh->num_cells() > owned;
  if ((ghosts or not _old.left.empty()) and (ghosts or not _new.left.empty()))
  {
    match<G>();
    if (not collect_left<G>(_old))
      return end(Outcome::inverted_target);
    if (not collect_left<G>(_new))
      return end(Outcome::inverted_start);
  }
  const Outcome gained = close<G>(_new, _old);
  const Outcome lost = close<G>(_old, _new);
  return end(gained != Outcome::ok ? gained : lost);
}

template Outcome
    Overlay::intersect<Geometry::plane>(std::span<const double>,
                                        std::span<const double>,
                                        std::span<const std::int32_t>);
template Outcome
    Overlay::intersect<Geometry::axisymmetric>(std::span<const double>,
                                               std::span<const double>,
                                               std::span<const std::int32_t>);
