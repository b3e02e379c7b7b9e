// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/geometry/volumes.h"

#include "remap/dual/dual.h"

using namespace remap;

namespace
{
/// Call with the geometry as a constant.
template <class F>
void with_geometry(Geometry geometry, F&& call)
{
  if (geometry == Geometry::plane)
    call.template operator()<Geometry::plane>();
  else
    call.template operator()<Geometry::axisymmetric>();
}

/// Store volume and, if wanted, centroid.
void store(const Moments& m, std::int32_t i, std::span<double> volumes,
           std::span<double> centroids)
{
  volumes[i] = m.v;
  if (centroids.empty())
    return;
  const Point c = m.centroid();
  centroids[2 * i] = c.x;
  centroids[2 * i + 1] = c.y;
}
} // namespace

void remap::cell_volumes(const Mesh& mesh, Geometry geometry,
                         std::span<const double> x, std::span<double> volumes,
                         std::span<double> centroids)
{
  with_geometry(
      geometry,
      [&]<Geometry G>()
      {
        for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
        {
          const Triple& n = mesh.cell(c);
          store(triangle<G>(point(x, n[0]), point(x, n[1]), point(x, n[2])), c,
                volumes, centroids);
        }
      });
}

void remap::dual_volumes(const Mesh& mesh, Geometry geometry,
                         std::span<const double> x, std::span<double> volumes,
                         std::span<double> centroids)
{
  with_geometry(geometry,
                [&]<Geometry G>()
                {
                  for (std::int32_t i = 0; i < mesh.num_nodes(); ++i)
                    store(dual::volume<G>(mesh, i, x), i, volumes, centroids);
                });
}

void remap::corner_volumes(const Mesh& mesh, Geometry geometry,
                           std::span<const double> x, std::span<double> volumes)
{
  with_geometry(geometry,
                [&]<Geometry G>()
                {
                  for (std::int32_t c = 0; c < mesh.num_cells(); ++c)
                    for (int i = 0; i < 3; ++i)
                    {
                      const Triple& n = mesh.cell(c);
                      volumes[3 * c + i] =
                          corner<G>(point(x, n[i]), point(x, n[(i + 1) % 3]),
                                    point(x, n[(i + 2) % 3]))
                              .v;
                    }
                });
}
