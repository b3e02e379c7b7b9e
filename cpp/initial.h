// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "lagrangian/element.h"
#include "mesh/domain.h"
#include "scene/scene.h"
#include "state.h"

/// The body at the start of a run (METHOD.md, Initial state).
namespace mmale
{
struct Simulation;

/// Stress, nodal pressures, density and history of every cell, ghosts too.
/// Collective.
void fill_initial(const scene::Scene& scene, const mesh::Domain& domain,
                  const lagrangian::Element& element, State& state);

/// The same with several materials, painted into the cells as the scene says;
/// unstressed, or with the scene's pressure.
/// @param[in] laws of the materials, in the scene's order of names
void fill_initial(const scene::Scene& scene, const mesh::Domain& domain,
                  std::span<const material::AnyLaw> laws, State& state);

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
