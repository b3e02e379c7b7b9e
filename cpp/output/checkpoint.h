// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/archive.h"
#include "scene/compare.h"
#include <map>
#include <optional>

/// `checkpoint.h5`: what a checkpoint says of itself, before anything is made.
namespace mmale::output
{
inline constexpr const char* checkpoint_name = "checkpoint.h5";

/// Grows when a checkpoint of old cannot be gone on with.
inline constexpr int checkpoint_format = 1;

struct CheckpointHeader
{
  std::int64_t format = checkpoint_format;
  std::string version; ///< of the program that wrote it
  std::string scene;   ///< as understood, JSON text
  scene::Standing standing;
  double time = 0;     ///< of the run [s]
  int completed = 0;   ///< there was nothing left to do
  int checks_hold = 1; ///< of a completed run

  void keep(Archive& archive);
};

/// A checkpoint as found in the folder of a run.
struct FoundCheckpoint
{
  bool there = false;
  std::string trouble; ///< empty, or why it cannot be read: "file: words"
  CheckpointHeader header;
  std::map<std::string, double> last; ///< last row of its curves, by name
};

/// Look into a folder; on one rank.
FoundCheckpoint find_checkpoint(const std::filesystem::path& folder);

/// Checkpoints take this part of a run at most, unless they are wanted more
/// often than each second. Doubled: twice the share.
inline constexpr double checkpoint_share = 0.02;

/// When the next checkpoint is due.
///
/// @param[in] every as the scene wants it [s]
/// @param[in] cost  of the last one [s]
/// @return seconds from now
inline double checkpoint_wait(double every, double cost)
{
  return every < 1 ? every : std::max(every, cost / checkpoint_share);
}

/// Names on lines, as one text.
std::string lines(std::span<const std::string> names);
std::vector<std::string> from_lines(const std::string& text);
} // namespace mmale::output
