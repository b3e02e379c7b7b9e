// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/complaint.h"
#include "scene/document.h"
#include <map>
#include <span>
#include <string>
#include <vector>

/// Overrides from the command line, and sweeps over several values of a key.
namespace mmale::scene
{
/// One run of a sweep.
struct Member
{
  std::vector<Override> overrides; ///< all of them, in the order given
  std::vector<Override> swept;     ///< those that differ between members
  std::string folder;              ///< "mesh.size=0.05"; empty without sweep
};

/// All runs that a command line asks for.
struct Sweep
{
  std::vector<Member> members; ///< one without overrides when none is given
  std::vector<Complaint> complaints;
};

/// Read `key=value` words; commas outside of brackets, braces and quotes make
/// a sweep, several sweeps their product, the last key running fastest.
Sweep expand(std::span<const std::string> arguments);

/// How a member ended, a row of sweep.csv.
struct Row
{
  std::vector<Override> swept;
  std::string outcome;
  std::map<std::string, double> last; ///< last value of every curve
  bool interrupted = false;           ///< by a signal: no member follows
};

/// The table as CSV: swept keys, outcome, every curve that any row has. Cells
/// that a row lacks are empty.
std::string to_csv(std::span<const Row> rows);
} // namespace mmale::scene
