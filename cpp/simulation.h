// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "bridge/remap_step.h"
#include "lagrangian/problem.h"
#include "material/library.h"
#include "mesh/domain.h"
#include "output/clock.h"
#include "state.h"
#include <memory>
#include <vector>

namespace mmale
{
/// The parts of a run, each made only if the scene asks for it.
struct Simulation
{
  /// Collective. The scene must outlive this.
  /// @param[in] grid the scene's mesh, if it was read already: on all ranks
  ///                 null or on none; only rank 0's is looked at
  Simulation(MPI_Comm comm, const scene::Scene& scene,
             const mesh::Grid* grid = nullptr);

  const scene::Scene& scene;
  output::Clock clock;
  mesh::Domain domain;
  State state;
  std::vector<material::AnyLaw> laws; ///< of the materials, in the scene's
                                      ///< order of names
  std::unique_ptr<lagrangian::Problem> problem; ///< unless motion is prescribed
  std::unique_ptr<bridge::RemapStep> remap;     ///< unless Lagrangian
};

/// What one cycle did.
struct StepLog
{
  lagrangian::NewtonLog newton;
  bridge::RemapLog remap;
};

/// One cycle, METHOD.md steps 1 to 4. The state is advanced only on success;
/// otherwise `log` tells why. Collective.
///
/// @param[in] t0,t1  the step, counted from the start of the stage [s]
/// @param[in] number of the step in the run, from 1
[[nodiscard]] bool step(Simulation& sim, const scene::Stage& stage, double t0,
                        double t1, int number, StepLog& log);
} // namespace mmale
