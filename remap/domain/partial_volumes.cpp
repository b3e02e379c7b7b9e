// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/partial_volumes.h"

#include "remap/domain/order.h"
#include "remap/domain/outline_walk.h"
#include "remap/domain/trapezoids.h"
#include "remap/geometry/position.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remap
{
namespace
{
template <Geometry G>
class Parts
{
public:
  Parts(const Domain& domain, const outline::Cells& cells, DomainPieces* pieces)
      : _cells(cells), _wants_pieces(pieces != nullptr)
  {
    _out.parts.resize(cells.size());
    outline::Walk walk(_cells, *this);
    for (const Ring& ring : domain.rings())
      walk.add(0, ring);
    walk.run();
    std::ranges::sort(_out.mixed);
    if (pieces)
      collect(*pieces);
  }

  PartialVolumes result() { return std::move(_out); }

  /// As the walk wants it: all or nothing, by one point.
  void apart(std::span<const std::int32_t> cells, const outline::Box& box,
             const outline::Seen& seen)
  {
    const Point p = middle(box.low, box.high);
    int n = 0;
    seen.each([&](int, std::span<const Point> ring)
              { n += rings::winding(ring, p); });
    if (n > 0)
      for (const std::int32_t c : cells)
        fill(c);
  }

  /// Cut the rings by the cell's edges; sums of signed areas do not care about
  /// the ways to and fro along its edges that this leaves between parts.
  void cut(std::int32_t c, const outline::Box&, const outline::Seen& seen)
  {
    const Triangle t = _cells.place(c);
    const Point o = t[0];
    const Point corner[3] = {{}, t[1] - o, t[2] - o};
    double size = 0;
    for (const Point p : corner)
      size = std::max({size, std::abs(p.x), std::abs(p.y)});
    double reach = size;
    rings::Sums<G> sums(o);
    _kept.clear();
    seen.each(
        [&](int, std::span<const Point> ring)
        {
          _ring.clear();
          for (const Point p : ring)
          {
            _ring.push_back(p - o);
            reach = std::max(
                {reach, std::abs(_ring.back().x), std::abs(_ring.back().y)});
          }
          for (int k = 0; k < 3 and not _ring.empty(); ++k)
            clip(HalfPlane::left_of(corner[k], corner[(k + 1) % 3]));
          if (_ring.size() < 3)
            return;
          sums.add(_ring);
          if (_wants_pieces)
            _kept.push_back(_ring);
        });
    const Moments all = position::about_first<G>(t);
    const Moments part = sums.local();
    const double noise = 16 * std::numeric_limits<double>::epsilon() * reach
                         * size * position::weight<G>(t);
    if (not(part.v > noise))
      return;
    if (not(all.v - part.v > noise))
      return fill(c);
    const Point g =
        position::held_in({Point{}, corner[1], corner[2]}, part.centroid());
    _out.parts[static_cast<std::size_t>(c)] =
        polygon::shifted({part.v, part.v * g.x, part.v * g.y}, o);
    _out.mixed.push_back(c);
    if (not _wants_pieces)
      return;
    // Smaller ones could turn over when they are put in their place.
    const double far = std::max(std::abs(o.x), std::abs(o.y)) + reach;
    trapezoids(_kept, 4 * std::numeric_limits<double>::epsilon() * far * size,
               [&](std::span<const Point> piece) { keep(c, piece, o); });
  }

private:
  /// All of a cell.
  void fill(std::int32_t c)
  {
    const Triangle t = _cells.place(c);
    _out.parts[static_cast<std::size_t>(c)] =
        polygon::shifted(position::about_first<G>(t), t[0]);
    ++_out.full;
    if (_wants_pieces)
      keep(c, t);
  }

  /// `_ring` cut by a half-plane.
  /// @source Sutherland & Hodgman (1974)
  void clip(const HalfPlane& h)
  {
    _next.clear();
    Point a = _ring.back();
    double da = h.depth(a.x, a.y);
    for (const Point b : _ring)
    {
      const double db = h.depth(b.x, b.y);
      // From the end inside, so that two cells find the same place.
      if (da > 0 and not(db > 0))
        _next.push_back(a + (da / (da - db)) * (b - a));
      else if (not(da > 0) and db > 0)
        _next.push_back(b + (db / (db - da)) * (a - b));
      if (db > 0)
        _next.push_back(b);
      a = b;
      da = db;
    }
    _ring.swap(_next);
  }

  void keep(std::int32_t c, std::span<const Point> piece, Point origin = {})
  {
    for (const Point p : piece)
      _pieces.points.push_back(p + origin);
    _pieces.offsets.push_back(static_cast<std::int32_t>(_pieces.points.size()));
    _pieces.cells.push_back(c);
  }

  /// The pieces in order of cells.
  void collect(DomainPieces& out) const
  {
    out = {};
    for (const std::size_t i : order_by(_pieces.size(), [this](std::size_t k)
                                        { return _pieces.cells[k]; }))
    {
      const auto piece = _pieces[i];
      out.points.insert(out.points.end(), piece.begin(), piece.end());
      out.offsets.push_back(static_cast<std::int32_t>(out.points.size()));
      out.cells.push_back(_pieces.cells[i]);
    }
  }

  const outline::Cells& _cells;
  bool _wants_pieces;
  Ring _ring, _next;
  std::vector<Ring> _kept;
  DomainPieces _pieces;
  PartialVolumes _out;
};
} // namespace

template <Geometry G>
PartialVolumes partial_volumes(const Domain& domain,
                               std::span<const std::int32_t> cells,
                               std::span<const double> x, DomainPieces* pieces)
{
  const outline::Cells all{cells, x};
  return Parts<G>(domain, all, pieces).result();
}

template PartialVolumes
partial_volumes<Geometry::plane>(const Domain&, std::span<const std::int32_t>,
                                 std::span<const double>, DomainPieces*);
template PartialVolumes
partial_volumes<Geometry::axisymmetric>(const Domain&,
                                        std::span<const std::int32_t>,
                                        std::span<const double>, DomainPieces*);
} // namespace remap
