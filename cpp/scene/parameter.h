// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/range.h"
#include <cmath>
#include <functional>
#include <map>
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
  double standard = required; ///< value when not given; NaN: must be given,
                              ///< infinite: the law does without
  std::string sentence;       ///< what it is, one sentence

  /// True when a scene must give it.
  [[nodiscard]] bool is_required() const { return std::isnan(standard); }
};

/// A text of a material law.
struct TextInfo
{
  std::string name;
  bool needed = false;
  std::string sentence;
};

/// A list of numbers of a material law; may be left out.
struct ListInfo
{
  std::string name;
  std::string sentence;
};

/// Numbers of a known material.
struct SetInfo
{
  std::string name;
  std::string source;
  std::map<std::string, double> values;
};

/// A material law, its numbers, texts and lists, and known materials.
struct LawInfo
{
  std::string name;
  std::vector<ParameterInfo> parameters = {};
  std::vector<TextInfo> texts = {};
  std::vector<ListInfo> lists = {};
  std::string set_key = {}; ///< key that names a set; "" without sets
  std::vector<SetInfo> sets = {};
  bool void_ratio = false; ///< its history knows the void ratio

  /// What is wrong with values that are each in range; empty is good.
  std::function<std::vector<std::string>(const Material&)> complaints = {};
};

/// Names that scenes may use.
struct Libraries
{
  std::vector<LawInfo> laws = {};
  std::vector<std::string> smoothers = {};
  std::vector<std::string> transports = {};
  std::vector<std::string> closures = {};
  std::vector<std::string> interfaces = {};

  /// Fields that pictures can show, tracers aside; empty: not checked.
  std::vector<std::string> fields = {};
};
} // namespace mmale::scene
