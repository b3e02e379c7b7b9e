// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What every reconstruction in the library promises.

#include "remap/tests/partitions.h"
#include "remap/tests/ranks.h"

#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace remap;
using meshes::Diagonal;

namespace
{
template <class Check>
void each(Check&& check)
{
  [&]<class... R>(std::tuple<R...>*)
  { (check(R{}), ...); }(static_cast<Reconstructions*>(nullptr));
}

/// A mesh of no symmetry beside the axis.
struct Shaken
{
  meshes::Data data = meshes::rectangle(10, 10, Diagonal::crossed);
  std::vector<double> x = meshes::shaken(data.x, 0.03, 7);
  Mesh mesh = data.mesh();
};

template <Geometry G>
partitions::Misfit run(const Shaken& s, const Reconstruction& method,
                       const Partition& by, int num)
{
  const Materials materials = partitions::lay<G>(s.mesh, s.x, by, num);
  Interfaces interfaces(s.mesh, {.geometry = G, .method = method});
  interfaces.reconstruct(s.x, materials, {});
  return partitions::misfit<G>(s.mesh, s.x, materials, interfaces, by);
}

template <Geometry G>
void volumes(const Reconstruction& method)
{
  const Shaken s;
  for (int k = 0; k < 8; ++k)
  {
    const double angle = 0.3 + 0.77 * k;
    for (const auto& [by, num] :
         {std::pair{partitions::straight(angle, {0.51, 0.47}), 2},
          std::pair{partitions::tee(angle, {0.51, 0.47}), 3},
          std::pair{partitions::layers(angle, {0.49, 0.47}, 0.02), 3},
          std::pair{partitions::wye({0.51, 0.47}, angle), 3}})
    {
      INFO("angle " << angle << ", " << num << " parts");
      // Coordinates of size 1 are rounded by eps/2, cells are 0.1 wide, 0.02
      // at least across.
      CHECK(run<G>(s, method, by, num).fractions < 1e-13);
    }
  }
}
} // namespace

TEST_CASE("reconstruction: fractions are met to round-off", "[interfaces]")
{
  each(
      [](auto method)
      {
        INFO(method.name);
        volumes<Geometry::plane>(method);
        volumes<Geometry::axisymmetric>(method);
      });
}

TEST_CASE("reconstruction: straight interfaces are exact where promised, "
          "Youngs' are not",
          "[interfaces]")
{
  const Shaken s;
  each(
      [&](auto method)
      {
        INFO(method.name);
        double worst = 0;
        for (int k = 0; k < 12; ++k)
        {
          const auto by = partitions::straight(0.1 + 0.53 * k, {0.52, 0.46});
          worst = std::max(
              {worst, run<Geometry::plane>(s, method, by, 2).elsewhere,
               run<Geometry::axisymmetric>(s, method, by, 2).elsewhere});
        }
        if (method.exact)
          CHECK(worst < 1e-12);
        else
          CHECK(worst > 1e-3);
      });
}

TEST_CASE("reconstruction: parallel layers are exact where straight interfaces "
          "are",
          "[interfaces]")
{
  // Three materials in a cell, by every method.
  const Shaken s;
  each(
      [&](auto method)
      {
        if (not method.exact)
          return;
        INFO(method.name);
        for (int k = 0; k < 6; ++k)
        {
          const auto by = partitions::layers(0.2 + 1.03 * k, {0.5, 0.47}, 0.03);
          CHECK(run<Geometry::plane>(s, method, by, 3).elsewhere < 1e-12);
        }
      });
}

TEST_CASE("reconstruction: a turned mesh has turned interfaces", "[interfaces]")
{
  const Shaken s;
  const auto by = partitions::tee(0.4, {0.51, 0.47});
  const Materials materials =
      partitions::lay<Geometry::plane>(s.mesh, s.x, by, 3);
  const double angle = 0.7;
  const auto x = meshes::turned(s.x, angle, {});
  const auto turned = [angle](Point p)
  {
    return Point{std::cos(angle) * p.x - std::sin(angle) * p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.y};
  };
  Materials there = materials;
  const auto rows = static_cast<std::int32_t>(materials.mixed().size());
  for (std::int32_t r = 0; r < rows; ++r)
    for (Part& p : there.parts(r))
      p.centroid = turned(p.centroid);
  each(
      [&](auto method)
      {
        INFO(method.name);
        Interfaces here(s.mesh, {.method = method}),
            then(s.mesh, {.method = method});
        here.reconstruct(s.x, materials, {});
        then.reconstruct(x, there, {});
        double worst = 0;
        for (std::int32_t r = 0; r < rows; ++r)
        {
          const Polygon<3> t(
              partitions::triangle_of(s.mesh, s.x, materials.mixed()[r]));
          const Polygon<3> u(
              partitions::triangle_of(s.mesh, x, materials.mixed()[r]));
          const int num = static_cast<int>(materials.parts(r).size());
          const auto a = partitions::moments_of<Geometry::plane>(
              t, here.partition(r), num);
          const auto b = partitions::moments_of<Geometry::plane>(
              u, then.partition(r), num);
          for (int k = 0; k < num; ++k)
          {
            const Point d = turned(a[k].centroid()) - b[k].centroid();
            worst = std::max(worst, std::sqrt(dot(d, d)));
          }
        }
        // Angles are found to 1e-7 of a turn or better, where nothing is
        // straight.
        CHECK(worst < 1e-6);
      });
}

TEST_CASE("reconstruction: names of materials make no difference",
          "[interfaces]")
{
  const Shaken s;
  each(
      [&](auto method)
      {
        INFO(method.name);
        for (const auto& by : {partitions::tee(0.4, {0.51, 0.47}),
                               partitions::wye({0.51, 0.47}, 0.3)})
        {
          Partition other = by;
          const auto name = [](std::int8_t k) -> std::int8_t
          { return k >= 0 ? k : static_cast<std::int8_t>(~((~k + 1) % 3)); };
          for (Cut& c : other.cuts)
            c.in = name(c.in), c.out = name(c.out);
          const Materials a = partitions::lay<Geometry::plane>(s.mesh, s.x, by,
                                                               3),
                          b = partitions::lay<Geometry::plane>(s.mesh, s.x,
                                                               other, 3);
          Interfaces of_a(s.mesh, {.method = method}),
              of_b(s.mesh, {.method = method});
          of_a.reconstruct(s.x, a, {});
          of_b.reconstruct(s.x, b, {});
          double worst = 0;
          for (std::int32_t r = 0;
               r < static_cast<std::int32_t>(a.mixed().size()); ++r)
          {
            const Polygon<3> t(
                partitions::triangle_of(s.mesh, s.x, a.mixed()[r]));
            const auto pa = a.parts(r), pb = b.parts(r);
            const auto ma = partitions::moments_of<Geometry::plane>(
                t, of_a.partition(r), 3);
            const auto mb = partitions::moments_of<Geometry::plane>(
                t, of_b.partition(r), 3);
            for (std::size_t i = 0; i < pa.size(); ++i)
              for (std::size_t k = 0; k < pb.size(); ++k)
                if (pb[k].material == (pa[i].material + 1) % 3)
                {
                  const Point d = ma[i].centroid() - mb[k].centroid();
                  worst = std::max(worst, std::sqrt(dot(d, d)));
                }
          }
          CHECK(worst < 1e-9);
        }
      });
}

TEST_CASE("reconstruction: one, two and three ranks have the same interfaces",
          "[interfaces][ranks]")
{
  const Shaken s;
  meshes::Data all = s.data;
  all.x = s.x;
  const auto by = partitions::tee(0.4, {0.51, 0.47});
  const Materials materials =
      partitions::lay<Geometry::plane>(s.mesh, s.x, by, 3);
  each(
      [&](auto method)
      {
        INFO(method.name);
        Interfaces one(s.mesh, {.method = method});
        one.reconstruct(s.x, materials, {});
        for (int size : {2, 3})
        {
          std::vector<int> owner(s.mesh.num_cells());
          for (std::size_t c = 0; c < owner.size(); ++c)
            owner[c] = static_cast<int>(c * size / owner.size());
          ranks::World world(all, owner, size);
          std::vector<double> worst(size);
          world.run(
              [&](int rank, const ranks::Part& part, const Host& host)
              {
                const Mesh mesh = part.mesh();
                Materials own(mesh.num_cells(), 3);
                for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
                {
                  const auto global = static_cast<std::int32_t>(part.cells[c]);
                  if (materials.pure(global) >= 0)
                    own.set_pure(c, materials.pure(global));
                  else
                    own.add_row(c, materials.parts(materials.row(global)));
                }
                Interfaces mine(mesh, {.method = method});
                mine.reconstruct(part.data.x, own, host);
                for (std::int32_t r = 0;
                     r < static_cast<std::int32_t>(own.mixed().size()); ++r)
                {
                  const std::int32_t c = own.mixed()[r];
                  const Partition& p = mine.partition(r);
                  const Partition& q = one.partition(
                      materials.row(static_cast<std::int32_t>(part.cells[c])));
                  if (p.count != q.count)
                    worst[rank] = 1;
                  for (int k = 0; k < std::min(p.count, q.count); ++k)
                  {
                    const Point n =
                        p.cuts[k].plane.normal - q.cuts[k].plane.normal;
                    const Point d = p.cuts[k].plane.at - q.cuts[k].plane.at;
                    worst[rank] =
                        std::max({worst[rank], std::abs(n.x), std::abs(n.y),
                                  std::abs(d.x), std::abs(d.y)});
                  }
                }
              });
          for (double w : worst)
            CHECK(w < 1e-13);
        }
      });
}
