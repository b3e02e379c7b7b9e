// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/checks.h"
#include "output/clock.h"
#include "output/ledger.h"
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// `summary.json`: what a run was, how far it came, what it can be held to.
///
/// Written at the start with outcome "running", so that a killed run is seen
/// as such, and again at the end; each time whole or not at all.
namespace mmale::output
{
/// A column of a test against measured points.
struct Deviation
{
  std::string column, abscissa;
  int points = 0;  ///< compared
  int outside = 0; ///< where the test does not come
  double rms = 0;  ///< root mean square of test less data
};

struct Summary
{
  std::string title;
  std::string outcome = "running"; ///< "completed", or why it stopped
  std::vector<Check> checks;
  double time = 0;             ///< last time reached [s]
  std::int64_t steps = 0;      ///< accepted
  std::int64_t rejected = 0;   ///< steps taken back
  std::int64_t iterations = 0; ///< Newton, rejected steps included
  std::int64_t remaps = 0;
  std::int64_t remaps_left_out = 0;             ///< asked for, but not possible
  std::string remap_trouble;                    ///< why, the last time
  std::map<std::string, std::int64_t> law = {}; ///< what its updates took
  double initial_imbalance = 0; ///< of ground, over its weight [-]
  std::int64_t resumed = 0;     ///< times that it went on from a checkpoint
  std::int64_t cells = 0, nodes = 0; ///< of the whole mesh
  double wall_seconds = 0;           ///< [s]
  std::map<std::string, std::string> versions = library_versions();
  std::string commit = commit_from_environment();
  int ranks = 1;
  std::string scene;                   ///< as understood, JSON text
  std::map<std::string, double> water; ///< numbers of the drainage; or none
  std::string water_recommended;       ///< and the model that they ask for
  Ledger ledger;
  std::vector<Timing> timers;
  std::vector<Deviation> data; ///< left out when empty

  /// Compiler and MMALE; the caller adds what else it is linked with.
  static std::map<std::string, std::string> library_versions();

  /// MMALE_COMMIT, or "unknown".
  static std::string commit_from_environment();
};

/// The text of summary.json. Numbers that are not finite become null.
std::string to_json(const Summary& summary);

/// Replace a file by a text, whole or not at all: a neighbour is written,
/// brought to the disk, and renamed.
/// @throws std::runtime_error naming the file and the cause; an older file
/// stays as it was
void write_atomically(const std::filesystem::path& file, std::string_view text);

/// Write summary.json.
/// @throws as write_atomically
inline void write(const std::filesystem::path& file, const Summary& summary)
{
  write_atomically(file, to_json(summary));
}
} // namespace mmale::output
