// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

/// What the verbs of the program have in common.
namespace mmale
{
/// How the program ends; `--help` says the same.
enum Exit
{
  good = 0,
  mistake = 1,
  failure = 2,
  stopped = 3,
  checks_fail = 4
};

/// How a run or a test ended.
Exit end_of(bool completed, bool checks_hold);

/// The one that the program tells of all that happened.
Exit worst(const std::set<Exit>& ends);

/// The words of the command line.
struct Arguments
{
  std::filesystem::path scene; ///< or test
  std::vector<std::string> overrides;
  std::filesystem::path results;
  bool quiet = false;
  bool keys = false;
  bool resume = false;
};

/// Print complaints, each once: members of a sweep share most of theirs.
void print(std::span<const scene::Complaint> complaints);

/// results/<name>: the folder of a file that is called as usual, else the
/// file's own stem; or where the user wants it.
/// @param usual "scene.toml"
std::filesystem::path results_folder(const Arguments& given,
                                     const std::string& usual);
} // namespace mmale
