// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "state.h"

namespace mmale::output
{
class Archive;
}
namespace mmale::mesh
{
struct Domain;
}

/// Rows of mixed cells in a state with several materials: what a cell is as a
/// whole, for those who look at cells alone (mass, energy, pictures).
namespace mmale::mixture
{
/// Deviator, pressure and density: sums over the parts by their fractions. Of
/// the history, which means something else in each law, nothing.
void fill(State& state);

/// All zero, as the remap library wants them.
void clear(State& state);

/// Materials and the arrays over their slots, to a checkpoint or from it.
/// Collective.
void keep(output::Archive& archive, const mesh::Domain& domain, State& state);
} // namespace mmale::mixture
