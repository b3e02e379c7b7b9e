// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include "remap/materials/materials.h"
#include "remap/transport/field.h"
#include <span>
#include <vector>

namespace mmale::bridge
{
/// The history of laws on its way through a remap: taken apart, so that each
/// tensor is limited as one, and in the quantities whose integrals are kept (a
/// void ratio e as the grains' share of the volume, 1 / (1 + e)).
///
/// With several materials each has arrays of its own, over the slots of
/// `remap::Materials`, of which only its own count.
class HistoryFields
{
public:
  /// @param[in] water are the last numbers those of `material::Water`?
  /// @param[in] inflow material that comes in over each boundary, or -1; as at
  ///                   the start of a run
  HistoryFields(std::span<const material::AnyLaw> laws, bool water,
                std::span<const int> inflow = {});

  /// Numbers of a point: the most of any law.
  int numbers() const { return static_cast<int>(_numbers); }

  /// Into the arrays that travel.
  /// @param[in] history shape (points, numbers)
  /// @param[in] materials whose points these are; null: one material
  void take(std::span<const double> history,
            const ::remap::Materials* materials = nullptr);

  /// Fields on these arrays.
  void add_to(std::vector<::remap::Field>& fields);
  void add_to(std::vector<::remap::MaterialField>& fields);

  /// And back. What has not changed on the way stays to the last digit.
  /// @param[in,out] history as it was taken
  void give(std::span<double> history) const;

  /// With several materials: all of it anew, for the slots that there are now.
  void give(std::vector<double>& history,
            const ::remap::Materials& materials) const;

private:
  struct Part
  {
    int at;   ///< of its first component in the history
    int size; ///< components of one point
    material::Conserved conserved = material::Conserved::value;
    int material = 0;
    std::vector<std::uint8_t> carriers = {}; ///< this material alone
    std::vector<double> inflow = {};         ///< shape (boundaries, size)
    std::vector<double> values = {};         ///< shape (points, size)
  };
  std::vector<Part> _parts;
  std::size_t _numbers = 0;
};
} // namespace mmale::bridge
