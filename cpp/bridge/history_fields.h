// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include "remap/transport/field.h"
#include <optional>
#include <span>
#include <vector>

namespace mmale::bridge
{
/// The history of a law on its way through a remap: taken apart, so that each
/// tensor is limited as one, and in the quantities whose integrals are kept (a
/// void ratio e as the grains' share of the volume, 1 / (1 + e)).
class HistoryFields
{
public:
  /// @param[in] water are the last numbers those of `material::Water`?
  HistoryFields(const std::optional<material::AnyLaw>& law, bool water);

  /// Into the arrays that travel.
  /// @param[in] history shape (points, numbers)
  void take(std::span<const double> history);

  /// Fields on these arrays.
  void add_to(std::vector<::remap::Field>& fields);

  /// And back. What has not changed on the way stays to the last digit.
  /// @param[in,out] history as it was taken
  void give(std::span<double> history) const;

private:
  struct Part
  {
    int at;   ///< of its first component in the history
    int size; ///< components of one point
    material::Conserved conserved = material::Conserved::value;
    std::vector<double> values = {}; ///< shape (points, size)
  };
  std::vector<Part> _parts;
  std::size_t _numbers = 0;
};
} // namespace mmale::bridge
