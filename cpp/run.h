// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/grid.h"
#include "scene/scene.h"
#include <filesystem>
#include <map>
#include <memory>
#include <mpi.h>
#include <string>

namespace mmale
{
/// Where a run writes and what it is checked against.
struct RunOptions
{
  std::filesystem::path results;   ///< folder, made if missing
  std::filesystem::path reference; ///< reference.toml; empty: no checks
  std::string scene_as_understood; ///< JSON text, for summary.json
  bool quiet = false;
  /// The mesh, if it was read already: null on all ranks or on none, and only
  /// rank 0's is looked at.
  std::shared_ptr<const mesh::Grid> grid = nullptr;
};

/// How a run ended.
struct Result
{
  std::string outcome; ///< "completed", or why it stopped
  bool completed = false;
  bool interrupted = false; ///< by a signal: what follows is not wanted either
  bool checks_hold = true;
  std::map<std::string, double> last; ///< last row of curves.csv, by name
};

/// Run a scene from start to end and write its results.
///
/// Collective over `comm`. The scene has no complaints left.
Result run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options);
} // namespace mmale
