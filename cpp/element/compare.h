// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/test.h"
#include "output/curves.h"
#include "output/summary.h"
#include <optional>
#include <span>
#include <string>
#include <vector>

/// A test against measured points.
namespace mmale::element
{
/// A data file as read.
struct DataTable
{
  std::optional<output::Curves> curves; ///< none: see the complaints
  std::string x;                        ///< its abscissa
  std::vector<std::string> complaints;
};

/// Read a data file; lines that begin with # are left out.
DataTable read_data(const Data& data);

/// Columns that a test of this file can be held against must be columns of
/// the test: those that are not, in words.
std::vector<std::string> strangers(const DataTable& data,
                                   std::span<const std::string> columns);

/// Stretches of a curve between the turns of its abscissa, as first and last
/// row. A way back of less than 1 % of the whole range is noise and no turn.
std::vector<std::pair<std::size_t, std::size_t>>
branches(std::span<const double> x);

/// Root mean square of test less data, a number for each column of the data
/// but the abscissa.
///
/// The curve is read at the abscissa of each point, stretch by stretch between
/// the turns of the abscissa, so loading is held against loading.
std::vector<output::Deviation> deviations(const DataTable& data,
                                          const output::Curves& curves);
} // namespace mmale::element
