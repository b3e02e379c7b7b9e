// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include "mesh/domain.h"
#include "scene/scene.h"
#include "state.h"

/// The body at the start of a run (METHOD.md, Initial state).
namespace mmale
{
struct Simulation;

/// What the ground is like at a height, at rest under its weight.
class Ground
{
public:
  /// Collective.
  Ground(const scene::Scene& scene, const mesh::Domain& domain,
         const material::AnyLaw& law);

  /// Void ratio, or NaN where the scene leaves it to the law.
  double void_ratio(double y) const;
  double density(double y) const;         ///< [kg/m3]
  double vertical_stress(double y) const; ///< compression positive [Pa]
  double horizontal_stress(double y) const;
  double pressure(double y) const;

private:
  const scene::Initial& _initial;
  const material::AnyLaw& _law;
  double _surface;     ///< [m]
  double _gravity = 0; ///< downward [m/s2]
};

/// Stress, nodal pressure, density and history of every cell, ghosts too.
/// Collective.
void fill_initial(const scene::Scene& scene, const mesh::Domain& domain,
                  const material::AnyLaw& law, State& state);

/// How far from balance the body begins.
struct Balance
{
  double as_laid = 0; ///< largest force on a free node over the weight [-]
  double settled = 0; ///< the same when the run begins
};

/// Bring an initial stress that is in balance but for the mesh's error into
/// balance with the first stage's loads and weight, by an elastic solution
/// whose motion is not taken. Collective.
///
/// @throws std::runtime_error if the balance is not reached
Balance settle(Simulation& sim);
} // namespace mmale
