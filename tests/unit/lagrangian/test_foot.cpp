// SPDX-License-Identifier: LGPL-3.0-or-later
// Where a free surface lies on a wall in line with a straight side, the side
// goes on; the outline stays as it is.
#include "bridge/foot.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

using namespace mmale;
using Catch::Approx;

namespace
{
/// Square of 4 x 4 cells, its right side the free surface.
struct Column
{
  Column()
  {
    scene::Mesh m;
    m.shape = "rectangle";
    m.width = m.height = 1;
    m.cells = {4, 4};
    domain = mesh::make_domain(MPI_COMM_WORLD, mesh::make_grid(m), {});
    x = domain.initial_x;
    at_wall.resize(domain.num_nodes(), 0);
  }

  int node(double px, double py) const
  {
    for (int n = 0; n < domain.num_nodes(); ++n)
      if (std::hypot(domain.initial_x[2 * n] - px,
                     domain.initial_x[2 * n + 1] - py)
          < 1e-12)
        return n;
    return -1;
  }
  void put(double height, double px, double py, bool wall)
  {
    const int n = node(1, height);
    x[2 * n] = px;
    x[2 * n + 1] = py;
    at_wall[n] = wall;
  }
  double area() const
  {
    double twice = 0;
    for (const mesh::Facet& f : domain.facets)
      twice += x[2 * f.a] * x[2 * f.b + 1] - x[2 * f.b] * x[2 * f.a + 1];
    return twice / 2;
  }

  mesh::Domain domain;
  std::vector<double> x;
  std::vector<std::uint8_t> at_wall;
};
} // namespace

TEST_CASE("the foot of a surface goes on along its wall", "[unit][foot]")
{
  Column c;
  c.put(0.25, 1.2, 0, true);
  c.put(0.5, 1.3, 0, true);
  c.put(0.75, 1.1, 0.6, false);
  const double area = c.area();
  const bridge::Foot foot(c.domain, {"right"});
  CHECK(foot.move(c.at_wall, c.x) == 2);
  const int end = c.node(1, 0);
  CHECK(c.x[2 * end] == Approx(1.3));
  CHECK(c.x[2 * end + 1] == 0);
  // and its nodes up the surface, in equal parts
  CHECK(c.x[2 * c.node(1, 0.25) + 1] == Approx(0.2));
  CHECK(c.x[2 * c.node(1, 0.5) + 1] == Approx(0.4));
  CHECK(c.x[2 * c.node(1, 0.5)] == Approx(1.3 - 0.4 / 3));
  CHECK(c.area() == Approx(area).epsilon(1e-14));
}

TEST_CASE("what no wall holds, or lies behind a gap, leaves the foot",
          "[unit][foot]")
{
  Column free, gap;
  free.put(0.25, 1.2, 0, false);
  gap.put(0.25, 1.2, 0.01, false);
  gap.put(0.5, 1.3, 0, true);
  for (Column* c : {&free, &gap})
  {
    const auto before = c->x;
    CHECK(bridge::Foot(c->domain, {"right"}).move(c->at_wall, c->x) == 0);
    CHECK(c->x == before);
  }
}
