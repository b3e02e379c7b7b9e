// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include "mesh/domain.h"
#include "output/clock.h"
#include "scene/scene.h"
#include "state.h"
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Steps 2 to 4 of METHOD.md: the solver's state through the remap library.
///
/// The only place that knows both: halos, constraints on nodes, which array
/// travels how. Conserved: the integral of every field, but for what passes
/// the boundary, which the ledger holds.
namespace mmale::output
{
class Archive;
}

namespace mmale::bridge
{
/// What a remap did.
struct RemapLog
{
  bool done = false;
  std::string trouble;        ///< why it was left out; the mesh then stays
  int cycles = 0;             ///< sub-cycles of the transport
  double quality = 1;         ///< worst cell after smoothing
  std::int64_t clipped = 0;   ///< cells brought back to the yield surface
  double clipped_largest = 0; ///< by this part of their stress
};

/// What passed the boundary since the start, inward positive; per radian
/// about an axis.
struct Passed
{
  double through = 0;  ///< free surfaces and open boundaries
  double at_walls = 0; ///< closed boundaries: round-off, else nodes slid
                       ///< along a wall that is not straight
};

struct Exchange
{
  Passed volume;                                 ///< [m3/m]
  Passed mass;                                   ///< [kg/m]
  std::map<std::string, Passed> tracer;          ///< integral of each
  std::map<std::string, Passed> material_volume; ///< of each of several
  std::map<std::string, Passed> material_mass;
};

/// Smoother and transport schemes by name, as the scene may choose them.
std::vector<std::string> smoothers();
std::vector<std::string> transports();
std::vector<std::string> interfaces();

/// Worst radius ratio of all cells. Collective.
double worst_quality(const mesh::Domain& domain, const State& state);

class RemapStep
{
public:
  /// Collective.
  RemapStep(const mesh::Domain& domain, const scene::Scene& scene,
            std::span<const material::AnyLaw> laws, output::Clock& clock);
  ~RemapStep();

  /// Is it time? Collective.
  /// @param[in] number of the step in the run, from 1
  bool due(const State& state, int number);

  /// Move the mesh and carry the state. Collective.
  /// @param[in] at_wall 1 for nodes that a wall holds, shape (nodes); empty
  ///                    without walls
  void run(State& state, std::span<const std::uint8_t> at_wall, RemapLog& log);

  Exchange exchange() const;

  /// What steers the remaps to come, besides the state, and the ledger.
  void keep(output::Archive& archive);

private:
  struct Impl;
  std::unique_ptr<Impl> _impl;
};
} // namespace mmale::bridge
