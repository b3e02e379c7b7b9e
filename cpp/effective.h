// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include "state.h"
#include <cstddef>
#include <cstdint>
#include <span>

/// Total pressures, and the effective ones that laws know of materials with
/// water in their pores (METHOD.md, Water).
namespace mmale
{
/// Pressure of a point less that of the water in its pores [Pa].
/// @param q all points counted through
double effective_pressure(const State& state, std::size_t q);

/// Pressures of points and, with seepage, of nodes become effective ones; for
/// states with water alone.
void to_effective(State& state);

/// The inverse of `to_effective`, by the pore pressures that the state has.
void to_total(State& state);

/// What a law has cut off from stresses that it does not bear.
struct Cut
{
  std::int64_t points = 0; ///< of owned cells
  double largest = 0;      ///< share of a stress, ghosts too [-]
};

/// Bring the stress of every point back to what the law bears; pressures are
/// the effective ones. With several materials `laws` are in their order, and of
/// the slots only pure cells are counted.
Cut admit(std::span<const material::AnyLaw> laws, State& state,
          int owned_cells);
} // namespace mmale
