// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "mesh/grid.h"
#include "scene/scene.h"
#include <filesystem>
#include <map>
#include <memory>
#include <mpi.h>
#include <string>
#include <vector>

namespace mmale
{
/// Where a run writes and what it is checked against.
struct RunOptions
{
  std::filesystem::path results;   ///< folder, made if missing
  std::filesystem::path reference; ///< reference.toml; empty: no checks
  std::string scene_as_understood; ///< JSON text, for summary.json
  bool quiet = false;
  bool resume = false; ///< go on from the checkpoint in the folder
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
/// Collective over `comm`. The scene has no complaints left; a run that resumes
/// has been looked for by `look_for_checkpoint`.
Result run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options);

/// What a call of the program does about a run.
struct Resumption
{
  enum class Way
  {
    start,    ///< there is no checkpoint
    resume,   ///< there is one, and the scene is its own
    completed ///< nothing is left to do
  };
  Way way = Way::start;
  std::vector<std::string> complaints = {}; ///< why it cannot go on
  Result result = {};                       ///< of a run that is completed
};

/// Look for the checkpoint of a run and hold it against the scene; on one rank.
Resumption look_for_checkpoint(const std::filesystem::path& results,
                               const scene::Scene& scene,
                               const std::string& scene_as_understood);
} // namespace mmale
