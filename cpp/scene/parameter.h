// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/range.h"
#include <cmath>
#include <string>
#include <vector>

/// What the libraries (laws, smoothers, schemes) tell the scene reader.
///
/// The lists come from the libraries themselves, so a new law or smoother is
/// known to the reader without a line here.
namespace mmale::scene
{
/// One number of a material law, as a scene gives it.
struct ParameterInfo
{
  std::string name; ///< key in the scene, also says a unit like `_deg`
  std::string unit; ///< "Pa"; "-" without dimension
  Range range;      ///< allowed values
  double standard = required; ///< value when not given; NaN: must be given
  std::string sentence;       ///< what it is, one sentence

  /// True when a scene must give it.
  [[nodiscard]] bool is_required() const { return std::isnan(standard); }
};

/// A material law and its numbers.
struct LawInfo
{
  std::string name;
  std::vector<ParameterInfo> parameters;
};

/// Names that scenes may use.
struct Libraries
{
  std::vector<LawInfo> laws;
  std::vector<std::string> smoothers;
  std::vector<std::string> transports;

  /// Fields that pictures can show, tracers aside; empty: not checked.
  std::vector<std::string> fields;
};
} // namespace mmale::scene
