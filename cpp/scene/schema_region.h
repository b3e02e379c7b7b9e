// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

/// The keys of a region; a part of schema.h, which includes it.
namespace mmale::scene
{
template <class V>
void keys(V& v, Region& r)
{
  const auto with = [&](std::size_t shape, auto visit_keys)
  { v.only_with("shape", r.shape, region_shapes, {shape}, visit_keys); };
  v({"material", "", "Material that fills it, by name.", {}, {}, true},
    r.material);
  v({"shape", "", "Shape of the region.", {}, region_shapes, true}, r.shape);
  with(0,
       [&]
       {
         v({"low", "m", "Lower left corner of the rectangle."}, r.low);
         v({"high", "m", "Upper right corner of the rectangle."}, r.high);
       });
  with(1,
       [&]
       {
         v({"points", "m", "Corners of the polygon, either way round."},
           r.points);
       });
  with(2,
       [&]
       {
         v({"centre", "m", "Centre of the circle."}, r.centre);
         v({"radius", "m", "Radius of the circle.", above(0)}, r.radius);
       });
  with(3,
       [&]
       {
         v({"point", "m", "A point of the straight edge."}, r.point);
         v({"normal", "-", "Across the edge, out of the material."}, r.normal);
       });
  with(4, [&] { keys(v, r.drawing); });
}
} // namespace mmale::scene
