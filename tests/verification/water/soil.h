// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "body.h"
#include <cmath>

namespace mmale::test
{
/// An elastic skeleton with water, and what follows from its numbers.
struct Soil
{
  double E = 1e7, nu = 0.25, density = 0; ///< of the skeleton, dry
  double n = 0.4, k = 1e-5;
  double K_f = 2.2e9, K_s = 36e9, rho_f = 1000;

  double G() const { return E / (2 * (1 + nu)); }
  double K() const { return E / (3 * (1 - 2 * nu)); }
  double M() const { return K() + 4 * G() / 3; }
  double K_w() const { return 1 / (n / K_f + (1 - n) / K_s); }
  double mobility() const { return k / (rho_f * 9.81); }
  double c_v() const { return mobility() / (1 / M() + 1 / K_w()); }
  /// Undrained: Skempton's B, and Poisson's ratio.
  double B() const { return K_w() / (K() + K_w()); }
  double nu_u() const
  {
    const double K_u = K() + K_w();
    return (3 * K_u - 2 * G()) / (2 * (3 * K_u + G()));
  }

  void put_into(scene::Scene& scene) const
  {
    scene.material["body"] = {"elastic",
                              {{"E", E}, {"nu", nu}, {"density", density}}};
    scene::Water& water = scene.water.emplace();
    water.drainage = "seepage";
    water.bulk_modulus = K_f;
    water.grain_bulk_modulus = K_s;
    water.density = rho_f;
    water.porosity = n;
    water.permeability = k;
  }

  scene::Scene rectangle(double width, double height, int nx, int ny) const
  {
    auto scene = test::rectangle(width, height, nx, ny, "", {});
    put_into(scene);
    return scene;
  }
};

/// Smooth walls on three sides.
inline scene::Stage trough()
{
  auto s = stage(1e9);
  for (const char* side : {"left", "right", "bottom"})
    s.boundary[side].roller = true;
  return s;
}
} // namespace mmale::test
