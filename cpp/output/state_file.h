// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/domain.h"
#include "state.h"
#include <filesystem>

namespace mmale::output
{
/// Write the whole state to an HDF5 file, whole or not at all. Collective.
///
/// Owned entries, rank after rank, with their numbers in the grid beside
/// them, so that any number of ranks can read it: /node_id, /x, /p, /v,
/// /cell_id, /s, /P, /density, /history, /tracer_<name>; /time. What the scene
/// does not have is left out.
///
/// @throws std::runtime_error on all ranks, naming the file
void write_state(const std::filesystem::path& file, const mesh::Domain& domain,
                 const State& state);
} // namespace mmale::output
