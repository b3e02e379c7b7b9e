// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

/// What a run must conserve, booked from its start to its end.
namespace mmale::output
{
/// A conserved quantity: what was there, what is there, what came in.
///
/// The balance closes when end = start + through_surface + booked.
struct LedgerEntry
{
  std::string name = {}; ///< e.g. "mass"
  std::string unit = {}; ///< e.g. "kg/m"
  double start = 0;
  double end = 0;
  double through_surface = 0; ///< net, inward is +
  double booked = 0; ///< at walls, and what is not conserved: the volume's
                     ///< change by the material's own motion
  /// What the gap is measured by; 0: |start|. Give it where a quantity
  /// starts from nothing (momentum).
  double scale = 0;

  /// end - start - through_surface - booked, in parts of the scale [-]; NaN
  /// where there is neither a start nor a scale.
  double relative_change() const
  {
    const double by = scale > 0 ? scale : std::abs(start);
    const double gap = end - start - through_surface - booked;
    return by > 0 ? gap / by : std::numeric_limits<double>::quiet_NaN();
  }
};

using Ledger = std::vector<LedgerEntry>;
} // namespace mmale::output
