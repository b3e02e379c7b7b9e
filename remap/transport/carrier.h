// SPDX-License-Identifier: LGPL-3.0-or-later
//
// One field over one sub-cycle, whatever its scheme, components and groups.
#pragma once

#include "remap/host.h"
#include "remap/transport/control_volumes.h"
#include "remap/transport/field.h"
#include "remap/transport/library.h"

namespace remap
{
/// Fills the ghosts of an array over volumes: halo(values, block).
using Halo = Host::Halo;

/// Does a limiter of the scheme look across facets?
[[nodiscard]] bool looks_at_sides(const Scheme& scheme);

/// Rings of volumes whose centroids a scheme needs around those that change.
[[nodiscard]] int rings_of(const Scheme& scheme);

/// Widest block of components that are carried at once.
[[nodiscard]] int widest_block(int components);

/// What each piece of this sub-cycle takes of a field of one component.
struct Amounts
{
  std::vector<double> inner, outer;
};

/// How a field travels.
struct Travel
{
  const Scheme& scheme;
  std::span<const Boundary> boundaries;
  const Halo& halo; ///< over the volumes
  const Host& host; ///< for agreement on numbers
  /// Where a field of one component notes what its pieces take, or null.
  Amounts* amounts = nullptr;
  /// Volumes are masses and values velocities: a vector that is limited as one
  /// must not gain kinetic energy.
  bool kinetic = false;
  /// Do ghosts get their new values?
  bool fill_ghosts = true;
};

/// Carry one field; ghosts are filled at the end.
///
/// @param[in,out] cv    volumes, pieces, matrices
/// @param[in,out] field means
/// @param[in,out] book  one entry a component
/// @return part of the limited correction that the kinetic energy let through
double carry_field(ControlVolumes& cv, const Field& field, const Travel& travel,
                   std::span<Exchange> book);
} // namespace remap
