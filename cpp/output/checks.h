// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/curves.h"
#include "output/ledger.h"
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A run against what is known of it: `reference.toml` beside the scene.
///
/// In: the reference file, the curves, the ledger. Out: for each entry whether
/// it holds. A place that no curve reaches is a check that does not hold.
namespace mmale::output
{
/// One entry of reference.toml, as data.
///
///     [p_sy_at_0.05]
///     curve = "p_sy"            # or: ledger = "mass.relative_change"
///     at = { z_B = 0.05 }       # or: take = "first" | "last" | "min" | "max"
///     value = 2.9685            # or: at_least = ... | at_most = ...
///     rtol = 0.015              # or: atol = ...
///     source = "(2+pi)/sqrt(3), Prandtl"
///
/// `at` interpolates linearly where the other curve first passes the value.
struct Reference
{
  enum class Take
  {
    at,
    first,
    last,
    min,
    max
  };
  enum class Relation
  {
    near,     ///< |value - reference| <= tolerance
    at_least, ///< value >= reference
    at_most   ///< value <= reference; a ledger's number by magnitude
  };

  std::string name = {};
  std::string curve = {};  ///< name in curves.csv, or
  std::string ledger = {}; ///< "entry.number", number as in summary.json
  Take take = Take::last;
  std::pair<std::string, double> at = {}; ///< other curve and its value
  Relation relation = Relation::near;
  double reference = 0;
  double tolerance = 0;    ///< absolute
  std::string source = {}; ///< where the reference comes from
  std::string unit = {};
};

/// References of a file, and what is wrong with it.
struct References
{
  std::vector<Reference> entries;
  std::vector<std::string> complaints; ///< "file:line: [entry] ..."
};

/// A reference and what the run has made of it.
struct Check
{
  Reference reference = {};
  std::optional<double> value = {}; ///< none: the run did not get there
  bool holds = false;
};

/// Numbers of a ledger's entry that a reference may ask for.
inline constexpr const char* ledger_numbers[] = {
    "start", "end", "through_surface", "booked", "relative_change"};

/// Read and judge a reference file, before the run.
///
/// @param[in] file    reference.toml
/// @param[in] curves  columns that the run will write
/// @param[in] ledger  entries that the run will book
References read_references(const std::filesystem::path& file,
                           std::span<const std::string> curves,
                           std::span<const std::string> ledger);

/// Value of curve y where curve x first passes a value; linear in between.
///
/// @param[in] x  shape (n,)
/// @param[in] y  shape (n,)
/// @return none if x never gets there, or y is no number there
std::optional<double> interpolate(std::span<const double> x,
                                  std::span<const double> y, double at);

/// Hold the run against its references.
std::vector<Check> evaluate(std::span<const Reference> references,
                            const Curves& curves, const Ledger& ledger);

/// True if every check holds.
bool all_hold(std::span<const Check> checks);

/// One line a check, for the screen.
std::string table(std::span<const Check> checks);
} // namespace mmale::output
