// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Materials carried through a given flow on a mesh that stays: each step goes
// from the mesh at home to the places where its cells come from, traced back
// along the flow, and home again with the cells. Volumes that facets sweep come
// from the stream function, so no cell gains or loses any.
#pragma once

#include "remap/geometry/volumes.h"
#include "remap/interfaces/interfaces.h"
#include "remap/materials/move.h"
#include "remap/materials/volume_transport.h"

#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <vector>

namespace eulerian
{
using remap::Point;

/// A flow without divergence: velocity (∂ψ/∂y, −∂ψ/∂x) times a function of
/// time.
struct Flow
{
  std::function<double(Point)> stream;
  std::function<Point(Point)> velocity;
  std::function<double(double)> pace; ///< of time
};

/// LeVeque's vortex in the unit square, back to where it was at T.
/// @source LeVeque (1996); Rider & Kothe (1998)
inline Flow vortex(double period)
{
  constexpr double pi = std::numbers::pi;
  return {[](Point p)
          {
            const double s = std::sin(pi * p.x), t = std::sin(pi * p.y);
            return s * s * t * t / pi;
          },
          [](Point p)
          {
            const double s = std::sin(pi * p.x), t = std::sin(pi * p.y);
            return Point{2 * s * s * t * std::cos(pi * p.y),
                         -2 * t * t * s * std::cos(pi * p.x)};
          },
          [period](double t) { return std::cos(pi * t / period); }};
}

/// Rigid rotation about a centre, counter-clockwise, one turn in a unit of
/// time.
inline Flow rotation(Point centre)
{
  constexpr double turn = 2 * std::numbers::pi;
  return {[=](Point p)
          {
            const Point d = p - centre;
            return -turn / 2 * (d.x * d.x + d.y * d.y);
          },
          [=](Point p)
          { return Point{-turn * (p.y - centre.y), turn * (p.x - centre.x)}; },
          [](double) { return 1.0; }};
}

inline Flow translation(Point v)
{
  return {[=](Point p) { return v.x * p.y - v.y * p.x; },
          [=](Point) { return v; }, [](double) { return 1.0; }};
}

/// ∫ pace dt by Gauss's rule of three points.
inline double elapsed(const Flow& flow, double t, double dt)
{
  const double s = std::sqrt(0.6) / 2;
  return dt / 18
         * (5 * flow.pace(t + (0.5 - s) * dt) + 8 * flow.pace(t + 0.5 * dt)
            + 5 * flow.pace(t + (0.5 + s) * dt));
}

/// Where a point was a time dt (or will be, dt < 0) ago, by Runge and Kutta's
/// rule of order 4.
inline Point traced_back(const Flow& flow, Point p, double t, double dt)
{
  const auto v = [&](Point q, double at)
  { return flow.pace(at) * flow.velocity(q); };
  const Point a = v(p, t), b = v(p - dt / 2 * a, t - dt / 2),
              c = v(p - dt / 2 * b, t - dt / 2), d = v(p - dt * c, t - dt);
  return p - dt / 6 * (a + 2 * b + 2 * c + d);
}

/// Seconds of the steps' parts, of the processor.
struct Seconds
{
  double flow = 0, reconstruct = 0, carry = 0, move = 0;

  /// Without the flow, which is the host's.
  [[nodiscard]] double all() const { return reconstruct + carry + move; }
};

struct Options
{
  remap::InterfaceOptions interfaces = {};
  remap::VolumeOptions volumes = {};
  bool bend = true; ///< facets, to the volumes of the stream function
};

/// A run.
class Run
{
public:
  Run(const remap::Mesh& mesh, std::span<const double> x,
      remap::Materials start, Options options, const remap::Host& host = {})
      : materials(std::move(start)), mesh(&mesh), host(&host),
        options(std::move(options)), interfaces(mesh, this->options.interfaces),
        transport(mesh, this->options.volumes), home(x.begin(), x.end()),
        before(home), swept(mesh.num_facets())
  {
  }

  /// Carry from t to t + dt; by the same flow in all calls.
  remap::Outcome step(const Flow& flow, double t, double dt)
  {
    const double begin = now();
    for (std::int32_t i = 0; i < mesh->num_nodes(); ++i)
    {
      const Point p = traced_back(flow, remap::point(home, i), t + dt, dt);
      before[2 * i] = p.x;
      before[2 * i + 1] = p.y;
    }
    const double time = elapsed(flow, t, dt);
    if (stream.empty())
      for (std::int32_t i = 0; i < mesh->num_nodes(); ++i)
        stream.push_back(flow.stream(remap::point(home, i)));
    for (std::int32_t f = 0; f < mesh->num_facets(); ++f)
      swept[f] = time * (stream[mesh->facet(f)[1]] - stream[mesh->facet(f)[0]]);
    const double flown = now();
    interfaces.reconstruct(home, materials, *host);
    const double made = now();
    const auto outcome =
        transport.carry(home, before,
                        options.bend ? std::span<const double>(swept)
                                     : std::span<const double>(),
                        interfaces.partitions(), materials, *host, ledger);
    const double carried = now();
    remap::move(*mesh, options.interfaces.geometry, before, home, materials);
    seconds.flow += flown - begin;
    seconds.reconstruct += made - flown;
    seconds.carry += carried - made;
    seconds.move += now() - carried;
    return outcome;
  }

  /// Carry from 0 to a time in equal steps.
  remap::Outcome run(const Flow& flow, double time, int steps, double from = 0)
  {
    for (int k = 0; k < steps; ++k)
      if (const auto out = step(flow, from + k * time / steps, time / steps);
          out != remap::Outcome::ok)
        return out;
    return remap::Outcome::ok;
  }

  remap::Materials materials;
  Seconds seconds;
  remap::MaterialLedger ledger;
  const remap::Mesh* mesh;
  const remap::Host* host;
  Options options;
  remap::Interfaces interfaces;
  remap::VolumeTransport transport;
  std::vector<double> home, before, swept, stream;

private:
  static double now()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }
};

/// Volume of a material.
inline double volume(const remap::Mesh& mesh, remap::Geometry geometry,
                     std::span<const double> x,
                     const remap::Materials& materials, int material)
{
  std::vector<double> v(mesh.num_cells());
  remap::cell_volumes(mesh, geometry, x, v);
  double sum = 0;
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
    sum += v[c] * materials.fraction(c, material);
  return sum;
}

/// Σ |f − f_exact| V of a material.
inline double error(const remap::Mesh& mesh, std::span<const double> x,
                    const remap::Materials& a, const remap::Materials& b,
                    int material)
{
  std::vector<double> v(mesh.num_cells());
  remap::cell_volumes(mesh, remap::Geometry::plane, x, v);
  double sum = 0;
  for (std::int32_t c = 0; c < mesh.owned_cells(); ++c)
    sum += v[c] * std::abs(a.fraction(c, material) - b.fraction(c, material));
  return sum;
}
} // namespace eulerian
