// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/driver.h"
#include "output/pictures.h"
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// A whole element test: curves.csv, pictures, summary.json.
namespace mmale::element
{
/// Columns of curves.csv: a row at the start and one a step. Signs of soil
/// mechanics, but for the law's own history, which has its own.
std::vector<std::string> columns(const Test& test, const material::AnyLaw& law);

struct Options
{
  std::filesystem::path results;   ///< folder, made if missing
  std::filesystem::path reference; ///< reference.toml; empty: no checks
  std::string test_as_understood;  ///< JSON text, for summary.json
  bool quiet = false;
};

/// How a test ended.
struct Result
{
  std::string outcome; ///< "completed", or why it stopped
  bool completed = false;
  bool checks_hold = true;
  std::map<std::string, double> last = {}; ///< last row of curves.csv, by name,
                                           ///< and rms_NAME of the data
};

/// Run a test that has no complaints left and write its results.
/// @throws std::runtime_error where files cannot be written, or a reference is
///         wrong
Result run(const Test& test, const Options& options);

/// The panels that suit a test, by the kind of its last path.
output::Sheet sheet(const Test& test, std::span<const std::string> columns,
                    std::span<const output::Reference> references);
} // namespace mmale::element
