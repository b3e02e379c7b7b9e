// SPDX-License-Identifier: LGPL-3.0-or-later
//
// How far a ray stays in a convex hull, against hulls whose answer is known.

#include "remap/transport/hull.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <random>
#include <vector>

using namespace remap;
using Catch::Approx;

namespace
{
template <int N>
struct Dimension
{
  static constexpr int n = N;
};

template <int N>
using Points = std::vector<hull::Vector<N>>;

template <int N>
auto visit(const Points<N>& points)
{
  return [&points](const auto& call)
  {
    for (const auto& p : points)
      call(p.data());
  };
}

template <int N>
hull::Vector<N> draw(std::mt19937& engine)
{
  std::normal_distribution<double> one;
  hull::Vector<N> out;
  for (double& v : out)
    v = one(engine);
  return out;
}
} // namespace

TEMPLATE_TEST_CASE("hull: a ray leaves a cube and a cross where it must",
                   "[hull]", Dimension<2>, Dimension<3>, Dimension<4>,
                   Dimension<6>)
{
  constexpr int N = TestType::n;
  const unsigned seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed);
  std::mt19937 engine(seed);
  Points<N> cube, cross;
  for (int k = 0; k < 1 << N; ++k)
  {
    hull::Vector<N> p;
    for (int j = 0; j < N; ++j)
      p[j] = k >> j & 1 ? 1 : -1;
    cube.push_back(p);
  }
  for (int j = 0; j < N; ++j)
    for (const double s : {-1, 1})
    {
      hull::Vector<N> p{};
      p[j] = s;
      cross.push_back(p);
    }
  for (int k = 0; k < 200; ++k)
  {
    const auto way = draw<N>(engine);
    double largest = 0, sum = 0;
    for (double v : way)
    {
      largest = std::max(largest, std::abs(v));
      sum += std::abs(v);
    }
    CHECK(hull::reach<N>(visit<N>(cube), {}, way, 1e-14)
          == Approx(std::min(1.0, 1 / largest)).epsilon(1e-8));
    CHECK(hull::reach<N>(visit<N>(cross), {}, way, 1e-14)
          == Approx(std::min(1.0, 1 / sum)).epsilon(1e-8));
  }
}

TEST_CASE("hull: flat, single and repeated points", "[hull]")
{
  using V = hull::Vector<4>;
  const Points<4> same(5, V{1, 2, 3, 4});
  CHECK(hull::reach<4>(visit<4>(same), V{1, 2, 3, 4}, V{1, 0, 0, 0}, 1e-14)
        < 1e-12);
  CHECK(hull::reach<4>(visit<4>(same), V{1, 2, 3, 4}, V{}, 1e-14) == 1);
  // A segment in four dimensions: along it, and off it.
  const Points<4> line{{0, 0, 0, 0}, {2, 2, 0, 0}, {1, 1, 0, 0}};
  CHECK(hull::reach<4>(visit<4>(line), V{1, 1, 0, 0}, V{2, 2, 0, 0}, 1e-14)
        == Approx(0.5).epsilon(1e-8));
  CHECK(hull::reach<4>(visit<4>(line), V{1, 1, 0, 0}, V{0, 0, 1, 0}, 1e-14)
        < 1e-12);
  // From outside there is no way in.
  CHECK(hull::reach<4>(visit<4>(line), V{5, 5, 0, 0}, V{-4, -4, 0, 0}, 1e-14)
        == 1);
  CHECK(hull::reach<4>(visit<4>(line), V{5, 5, 0, 0}, V{-1, -1, 0, 0}, 1e-14)
        == 0);
}
