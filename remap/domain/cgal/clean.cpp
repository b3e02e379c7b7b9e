// SPDX-License-Identifier: LGPL-3.0-or-later
#include "remap/domain/cgal/clean.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_with_history_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace remap
{
namespace
{
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Traits = CGAL::Arr_segment_traits_2<Kernel>;
using Plan = CGAL::Arrangement_with_history_2<Traits>;
using Times = std::vector<int>; ///< how often each shape's rings run around

class Arrangement
{
public:
  explicit Arrangement(std::span<const Shape> shapes) : _shapes(shapes)
  {
    for (std::size_t s = 0; s < shapes.size(); ++s)
      for (const Ring& ring : shapes[s].rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
          if (const Point a = ring[i], b = ring[(i + 1) % ring.size()]; a != b)
          {
            const auto curve =
                CGAL::insert(_plan, Traits::Curve_2(Kernel::Point_2(a.x, a.y),
                                                    Kernel::Point_2(b.x, b.y)));
            _shape_of[&*curve] = s;
          }
    wind();
  }

  /// Rings with what is filled on their left.
  std::vector<Ring> outline() const
  {
    std::vector<Ring> out;
    std::unordered_set<const void*> seen;
    for (auto h = _plan.halfedges_begin(); h != _plan.halfedges_end(); ++h)
      if (is_border(h) and not seen.contains(&*h))
      {
        Ring& ring = out.emplace_back();
        Plan::Halfedge_const_handle at = h;
        do
        {
          seen.insert(&*at);
          const auto& p = at->source()->point();
          ring.push_back({CGAL::to_double(CGAL::exact(p.x())),
                          CGAL::to_double(CGAL::exact(p.y()))});
          for (at = at->next(); not is_border(at);)
            at = at->twin()->next();
        } while (at != h);
      }
    return out;
  }

private:
  /// Adds what changes from the right of a halfedge to its left, `by` times.
  void cross(Plan::Halfedge_const_handle h, int by, Times& times) const
  {
    const bool right = h->direction() == CGAL::ARR_LEFT_TO_RIGHT;
    for (auto c = _plan.originating_curves_begin(h);
         c != _plan.originating_curves_end(h); ++c)
    {
      const bool along =
          (CGAL::compare_xy(c->source(), c->target()) == CGAL::SMALLER)
          == right;
      times[_shape_of.at(&*c)] += along ? by : -by;
    }
  }

  /// From face to face, from the one far away.
  void wind()
  {
    std::vector<Plan::Face_const_handle> to_do{_plan.unbounded_face()};
    _times[&*to_do.back()].assign(_shapes.size(), 0);
    const auto walk = [&](Plan::Ccb_halfedge_const_circulator first)
    {
      auto h = first;
      do
      {
        const auto beyond = h->twin()->face();
        if (_times.contains(&*beyond))
          continue;
        Times times = _times.at(&*h->face());
        cross(h, -1, times);
        _times[&*beyond] = std::move(times);
        to_do.push_back(beyond);
      } while (++h != first);
    };
    while (not to_do.empty())
    {
      const auto face = to_do.back();
      to_do.pop_back();
      for (auto c = face->outer_ccbs_begin(); c != face->outer_ccbs_end(); ++c)
        walk(*c);
      for (auto c = face->inner_ccbs_begin(); c != face->inner_ccbs_end(); ++c)
        walk(*c);
    }
  }

  [[nodiscard]] bool filled(Plan::Face_const_handle face) const
  {
    const Times& times = _times.at(&*face);
    for (std::size_t s = 0; s < times.size(); ++s)
      if (_shapes[s].rule == FillRule::nonzero ? times[s] != 0
                                               : times[s] % 2 != 0)
        return true;
    return false;
  }

  [[nodiscard]] bool is_border(Plan::Halfedge_const_handle h) const
  {
    return filled(h->face()) and not filled(h->twin()->face());
  }

  std::span<const Shape> _shapes;
  Plan _plan;
  std::unordered_map<const void*, std::size_t> _shape_of;
  std::unordered_map<const void*, Times> _times;
};
} // namespace

Cleaned clean(std::span<const Shape> shapes)
{
  Cleaned out;
  std::size_t number = 0;
  for (const Shape& shape : shapes)
    for (const Ring& ring : shape.rings)
    {
      // Of a ring alone: then crossings are the only other faults.
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (not(std::isfinite(ring[i].x) and std::isfinite(ring[i].y)))
        {
          out.faults.push_back({number, i, "a coordinate is not finite"});
          break;
        }
      ++number;
    }
  if (not out.faults.empty())
    return out;
  const Shape shape{Arrangement(shapes).outline(), FillRule::evenodd};
  if (shape.rings.empty())
    out.faults.push_back({0, 0, "the rings fill nothing"});
  else
    out.faults = Domain::faults({&shape, 1});
  if (out.faults.empty())
    out.domain = Domain({&shape, 1});
  return out;
}
} // namespace remap
