// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Mixed cells to break a reconstruction: one number makes one cell, so that a
// failure can be replayed.
#pragma once

#include "remap/interfaces/moment_of_fluid.h"
#include "remap/tests/fuzz/pairs.h"

#include <numbers>
#include <vector>

namespace fuzz
{
using namespace remap;

inline constexpr int num_cell_kinds = 7;
inline constexpr std::array<const char*, num_cell_kinds> cell_kinds = {
    "cuts",  "cuts in a sliver",  "tiny fractions", "wedges",
    "strip", "strip in a sliver", "any numbers"};

struct MixedCell
{
  std::uint64_t seed;
  int kind;
  bool axisymmetric;
  Triangle t;
  std::vector<Part> parts;
};

/// In [0, 1).
inline double draw(Random& r)
{
  return static_cast<double>(r() >> 11) * 0x1p-53;
}

/// Within a box of this aspect, nowhere thinner than a fiftieth of it; in
/// axisymmetry one in four touches the axis.
inline Triangle triangle(Random& r, double aspect, bool axisymmetric)
{
  while (true)
  {
    Triangle t;
    for (Point& p : t)
    {
      p.x = draw(r);
      p.y = aspect * draw(r);
    }
    if (axisymmetric and r.below(4) == 0)
      t[0].x = 0;
    t = polygon::turned(t);
    if (twice_area(t[0], t[1], t[2]) > 0.02 * aspect)
      return t;
  }
}

/// A line through a piece, at a fraction of it.
template <Geometry G>
HalfPlane line(Random& r, const Piece& p, double aspect, double fraction)
{
  const double angle = 2 * std::numbers::pi * draw(r);
  const Point n = {aspect * std::cos(angle), std::sin(angle)}, o = p[0];
  Piece about;
  for (int i = 0; i < p.size; ++i)
    about.push(p[i] - o);
  HalfPlane out = place_fraction<G>(about, n, fraction, 1 - fraction, o.x);
  out.at = out.at + o;
  return out;
}

/// Pieces by random cuts of random pieces.
template <Geometry G>
std::vector<Moments> cut_up(Random& r, const Triangle& t, int num,
                            double aspect, double decades)
{
  std::vector<Piece> pieces(1);
  for (const Point& p : t)
    pieces[0].push(p);
  while (static_cast<int>(pieces.size()) < num)
  {
    const auto k = static_cast<std::size_t>(r.below(pieces.size()));
    const double f = decades > 0 ? std::pow(10, -decades * draw(r)) : draw(r);
    Piece in, out;
    split(pieces[k], line<G>(r, pieces[k], aspect, 0.98 * f), in, out);
    pieces[k] = in;
    pieces.push_back(out);
  }
  std::vector<Moments> m;
  for (const Piece& p : pieces)
    m.push_back(moments<G>(p));
  return m;
}

/// Parts of a partition.
template <Geometry G>
std::vector<Moments> moments_by(const Triangle& t, const Partition& by, int num)
{
  std::vector<Moments> m(num);
  add_moments<G>(Polygon<3>(t), by, m);
  return m;
}

template <Geometry G>
std::vector<Moments> wedges(Random& r, const Triangle& t, double aspect)
{
  double p = draw(r), q = draw(r);
  if (p + q > 1)
    p = 1 - p, q = 1 - q;
  Junction y;
  y.at = t[0] + p * (t[1] - t[0]) + q * (t[2] - t[0]);
  const double first = 2 * std::numbers::pi * draw(r);
  const double wide[3] = {1 + draw(r), 1 + draw(r), 1 + draw(r)};
  const double all = wide[0] + wide[1] + wide[2];
  double angle = first;
  for (int i = 0; i < 3; ++i)
  {
    y.angle[i] = std::atan2(aspect * std::sin(angle), std::cos(angle));
    angle += 2 * std::numbers::pi * wide[i] / all;
  }
  Partition by;
  y.cuts(by);
  return moments_by<G>(t, by, 3);
}

template <Geometry G>
std::vector<Moments> strip(Random& r, const Triangle& t, double aspect)
{
  Piece p, in, out;
  for (const Point& v : t)
    p.push(v);
  const HalfPlane low = line<G>(r, p, aspect, 0.1 + 0.7 * draw(r));
  split(p, low, in, out);
  // The same direction, a thin part of what is left.
  const double f = std::pow(10, -0.5 - 2.5 * draw(r));
  Piece about;
  for (int i = 0; i < out.size; ++i)
    about.push(out[i] - low.at);
  HalfPlane high = place_fraction<G>(about, low.normal, f, 1 - f, low.at.x);
  high.at = high.at + low.at;
  Partition by;
  by.add({low, ~1, 1});
  by.add({high, ~0, ~1});
  return moments_by<G>(t, by, 2);
}

template <Geometry G>
MixedCell mixed_cell(std::uint64_t seed)
{
  Random r(seed);
  MixedCell out{seed,
                static_cast<int>(seed % num_cell_kinds),
                G == Geometry::axisymmetric,
                {},
                {}};
  const bool thin = out.kind == 1 or out.kind == 5;
  const double aspect = thin ? 1e-3 : 1;
  while (true)
  {
    out.t = triangle(r, aspect, out.axisymmetric);
    std::vector<Moments> m;
    const int num = 2 + static_cast<int>(r.below(4));
    if (out.kind < 3)
      m = cut_up<G>(r, out.t, num, aspect, out.kind == 2 ? 14 : 0);
    else if (out.kind == 3)
      m = wedges<G>(r, out.t, aspect);
    else if (out.kind < 6)
      m = strip<G>(r, out.t, aspect);
    else
    {
      // Fractions and centroids that belong to nothing.
      m.resize(2 + r.below(most_parts - 1));
      for (Moments& k : m)
      {
        k.v = r.below(5) == 0 ? 1e-14 : draw(r);
        k.x = k.v * (r.below(9) == 0 ? 7.0 : draw(r));
        k.y = k.v * (r.below(9) == 0 ? -3.0 : draw(r));
      }
      if (r.below(4) == 0)
        for (Moments& k : m)
          k.x = 0.4 * k.v, k.y = 0.3 * k.v;
    }
    double all = 0, least = 1;
    for (const Moments& k : m)
      all += k.v;
    out.parts.clear();
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      least = std::min(least, m[k].v / all);
      out.parts.push_back(
          {static_cast<std::int32_t>(k), m[k].v / all, m[k].centroid()});
    }
    // Exact data of parts that are there; the centroid of a tiny one is known
    // no better than its corners.
    const double smallest = out.kind == 2 ? 1e-14 : out.kind == 6 ? 0 : 1e-3;
    if (all > 0 and least > smallest)
      return out;
  }
}
} // namespace fuzz
