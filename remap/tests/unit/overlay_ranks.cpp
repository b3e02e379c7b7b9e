// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The overlay on ranks: the same answer as on one, or the outcome that says
// that the halo is too thin; never a wrong value.

#include "remap/tests/carry.h"
#include "remap/tests/ranks.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace remap;
using meshes::Diagonal;

namespace
{
constexpr int n = 16;
constexpr double h = 1.0 / n;

/// What all ranks start from, in global numbers.
struct Start
{
  Geometry geometry;
  double cells; ///< displacement in cells
  bool outline; ///< does the outline move too?
  meshes::Data data = meshes::rectangle(n, n, Diagonal::crossed);
  std::vector<double> from = meshes::shaken(data.x, 0.15 * h, 7);
  std::vector<double> to = target();
  std::vector<double> field = noise();

  [[nodiscard]] std::vector<double> target() const
  {
    auto out = meshes::shaken(data.x, 0.15 * h, 8);
    for (std::size_t i = 0; i < out.size(); i += 2)
    {
      const double x = data.x[i], y = data.x[i + 1];
      const double s =
          std::sin(std::numbers::pi * x) * std::sin(std::numbers::pi * y);
      out[i] += cells * h * (0.8 * s + (outline ? 0.2 + 0.1 * y : 0));
      out[i + 1] -= cells * h * 0.6 * s;
    }
    return out;
  }
  [[nodiscard]] std::vector<double> noise() const
  {
    std::mt19937 engine(9);
    std::uniform_real_distribution<double> draw(0, 1);
    std::vector<double> u(data.cells.size() / 3);
    std::generate(u.begin(), u.end(), [&] { return draw(engine); });
    return u;
  }
};

/// What one rank has in the end.
struct Result
{
  Outcome local = Outcome::ok; ///< of this rank alone
  bool all_ok = false;         ///< of all ranks
  int matched = 0;             ///< pairs that no walk found
  std::vector<double> field;
  /// Volume and centroid of what goes between two cells, by global numbers.
  std::map<std::pair<std::int64_t, std::int64_t>, std::array<double, 3>> pairs;
};

Result run(const Start& start, const ranks::Part& part, const Host& host)
{
  const Mesh mesh = part.mesh();
  const auto from = ranks::Part::take(start.from, part.nodes, 2);
  const auto to = ranks::Part::take(start.to, part.nodes, 2);
  Overlay overlay(mesh);
  Result out;
  out.local = carry::intersect(overlay, start.geometry, from, to,
                               carry::touched(mesh, from, to));
  out.matched = overlay.matched();
  out.all_ok = host.max(static_cast<double>(out.local)) == 0;
  if (not out.all_ok)
    return out;
  const carry::Carrier carrier(mesh, start.geometry, from, to);
  const auto u = ranks::Part::take(start.field, part.cells, 1);
  out.field = carrier.apply(overlay, u, carrier.limited(overlay, u, host));
  for (const auto& p : overlay.pieces())
    if (p.from >= 0 and p.to >= 0)
      out.pairs[{part.cells[p.from], part.cells[p.to]}] = {p.volume, p.at.x,
                                                           p.at.y};
  return out;
}

/// In stripes, or one by one at random.
std::vector<int> deal(const meshes::Data& data, int size, bool stripes)
{
  std::mt19937 engine(99);
  std::vector<int> out;
  for (std::size_t c = 0; c < data.cells.size(); c += 3)
  {
    const double at = stripes ? data.x[2 * data.cells[c]]
                              : std::generate_canonical<double, 32>(engine);
    out.push_back(std::min(size - 1, static_cast<int>(at * size)));
  }
  return out;
}
} // namespace

TEST_CASE("overlay on ranks: equal to one process, or a clear outcome",
          "[overlay][ranks]")
{
  const auto geometry = GENERATE(Geometry::plane, Geometry::axisymmetric);
  const int size = GENERATE(2, 3);
  const bool stripes = GENERATE(true, false);
  const bool outline = GENERATE(false, true);
  const double cells = GENERATE(0.1, 0.4, 1.0, 2.0, 3.0);
  INFO("size " << size << " stripes " << stripes << " outline " << outline
               << " displacement " << cells);
  const Start start{geometry, cells, outline};
  ranks::World one(start.data, deal(start.data, 1, true), 1);
  Result alone;
  one.run([&](int, const ranks::Part& p, const Host& host)
          { alone = run(start, p, host); });
  REQUIRE(alone.all_ok);
  std::vector<double> expected(alone.field.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[one.parts[0].cells[i]] = alone.field[i];

  ranks::World world(start.data, deal(start.data, size, stripes), size);
  std::vector<Result> results(size);
  world.run([&](int r, const ranks::Part& p, const Host& host)
            { results[r] = run(start, p, host); });
  // Small moves stay in the halo; long ones do not, but where cells are dealt
  // out at random and each rank sees nearly all.
  if (cells <= 0.1)
    REQUIRE(results[0].all_ok);
  if (cells >= 2 and stripes)
    REQUIRE(not results[0].all_ok);
  for (int r = 0; r < size; ++r)
  {
    const Result& result = results[r];
    if (not result.all_ok)
    {
      CHECK((result.local == Outcome::ok
             or result.local == Outcome::beyond_halo));
      continue;
    }
    if (stripes and not outline)
      CHECK(result.matched == 0);
    const ranks::Part& p = world.parts[r];
    for (std::size_t i = 0; i < p.owned_cells; ++i)
      CHECK(std::abs(result.field[i] - expected[p.cells[i]]) < 1e-13);
    // A pair is the same to the last bit wherever it is computed.
    for (const auto& [pair, piece] : result.pairs)
    {
      REQUIRE(alone.pairs.contains(pair));
      CHECK(alone.pairs.at(pair) == piece);
    }
  }
}
