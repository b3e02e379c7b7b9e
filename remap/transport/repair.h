// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 3: put values back into a range that they may not leave, without
// changing their integral. In: new means and volumes; out: means in range, or
// the amount that found no room. Bounded schemes do not need it.
#pragma once

#include "remap/host.h"
#include "remap/transport/control_volumes.h"
#include "remap/transport/field.h"

#include <cstdint>

namespace remap
{
/// Conserving repair; makes room when it is first needed.
class Repair
{
public:
  /// Repair component k of a field. What is beyond the range goes to the
  /// neighbours that have room, a share of each by its room; what they cannot
  /// take goes to all volumes that changed, in the same way. Collective.
  ///
  /// @param[in,out] field  means, ghosts up to date in and out
  /// @param[in]     cv     volumes (`next`) that changed and their neighbours
  /// @param[in]     halo   fills ghosts of an array over these volumes
  /// @param[out]    number of our values that were out of range, by more than
  ///                       round-off
  /// @return amount that found no room, the same on all ranks: 0 if all is well
  double run(const Field& field, int k, const ControlVolumes& cv,
             const Host::Halo& halo, const Host& host, std::int64_t& number);

private:
  using Halo = Host::Halo;
  /// What is known of a volume, its neighbours included.
  struct Work
  {
    double excess;   ///< beyond the range, as content
    double up, down; ///< content it can take, and give
    double around;   ///< content that its neighbours can take of the excess
    double part_up, part_down; ///< part of what it is offered that it takes
    double rest; ///< of the excess, after the neighbours took theirs
  };
  void find_room(const Field& field, int k, const ControlVolumes& cv);
  void update(const ControlVolumes& cv, const Halo& halo);
  void pass_on(const Field& field, int k, const ControlVolumes& cv,
               const Halo& halo);
  double spread(const Field& field, int k, const ControlVolumes& cv,
                const Host& host);

  std::vector<Work> _work;
};
} // namespace remap
