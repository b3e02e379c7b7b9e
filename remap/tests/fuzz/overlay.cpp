// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The overlay on meshes and moves made to break it, fit for sanitizers: parts
// add up to old cells and fill new ones, each pair once, centroids where they
// can be. A failure names the number that makes the meshes again.

#include "remap/tests/fuzz/meshes.h"

#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <set>

using namespace remap;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

template <Geometry G>
void check(std::uint64_t seed)
{
  const fuzz::Move m(seed);
  INFO("meshes " << seed << " (" << m.what() << ")");
  Overlay overlay(m.mesh);
  const auto touched = m.touched();
  REQUIRE(overlay.intersect<G>(m.from, m.to, touched) == Outcome::ok);
  const auto size = static_cast<std::size_t>(m.mesh.num_cells());
  std::vector<Moments> out(size), in(size);
  std::set<std::pair<std::int32_t, std::int32_t>> pairs;
  double gained = 0, lost = 0;
  bool once = true, positive = true, held = true;
  const auto book =
      [&](std::vector<Moments>& to, std::int32_t c, double v, Point at)
  {
    if (c >= 0)
      to[c] += {v, v * at.x, v * at.y};
  };
  for (const auto& p : overlay.pieces())
  {
    once = once and pairs.emplace(p.from, p.to).second and p.from != p.to;
    positive = positive and p.volume > 0;
    gained += p.from < 0 ? p.volume : 0;
    lost += p.to < 0 ? p.volume : 0;
    book(out, p.from, p.volume, p.at);
    book(in, p.to, p.volume, p.at);
    const Triangle t =
        m.place(p.from < 0 ? m.to : m.from, p.from < 0 ? p.to : p.from);
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    held = held and p.at.x >= x0 and p.at.x <= x1 and p.at.y >= y0
           and p.at.y <= y1;
  }
  CHECK(once);
  CHECK(positive);
  CHECK(held);
  double worst = 0;
  for (std::int32_t c : touched)
  {
    const auto& rest = overlay.rest(c);
    book(out, c, rest.volume, rest.at);
    book(in, c, rest.volume, rest.at);
    for (const auto& [x, sum] : {std::pair(&m.from, out[c]), {&m.to, in[c]}})
    {
      const Moments whole = moments<G>(Polygon<3>(m.place(*x, c)));
      // Cells are at most 1/6 wide and lie between 0 and 1.5.
      const double scale = eps / 36;
      worst = std::max({worst, std::abs(sum.v - whole.v) / scale,
                        std::abs(sum.x - whole.x) / scale,
                        std::abs(sum.y - whole.y) / scale});
    }
  }
  INFO("largest error in eps of a cell's box: " << worst);
  CHECK(worst < 256);
  if (not m.outline_moves)
    CHECK(gained + lost < 1e-12);
}
} // namespace

TEST_CASE("overlay: parts are the whole on 100 meshes made to break it",
          "[fuzz]")
{
  for (std::uint64_t seed = 0; seed < 100; ++seed)
  {
    check<Geometry::plane>(seed);
    check<Geometry::axisymmetric>(seed);
  }
}

TEST_CASE("overlay: parts are the whole on 10 000 meshes made to break it",
          "[fuzz][slow]")
{
  for (std::uint64_t seed = 10'000; seed < 20'000; ++seed)
  {
    check<Geometry::plane>(seed);
    check<Geometry::axisymmetric>(seed);
  }
}
