// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// Nothing, beside other materials (METHOD.md, Mixed cells): it has a place and
/// a volume, and never answers for a cell of the solver. By itself, as laws are
/// tested: no deviator, and a pressure that falls with its volume at a
/// stiffness too small to matter.
struct Void
{
  static constexpr std::string_view name = "void";
  static constexpr bool symmetric = true, yields = false, fluid = true;
  static constexpr bool linear_pressure = true;

  double stiffness = 1;  ///< [Pa]; doubled, a void of twice its volume pulls
                         ///< with 1.4 Pa for 0.7
  double density = 1e-3; ///< [kg/m3]; a trace, that where void flows in
                         ///< momentum has something to be carried by

  static inline const std::array<Parameter<Void>, 2> parameters{{
      {"stiffness", "Pa", &Void::stiffness, scene::above(0),
       "fall of its pressure over its logarithmic volume strain"},
      {"density", "kg/m3", &Void::density, scene::above(0),
       "mass density, a trace that carries momentum"},
  }};

  std::vector<HistoryField> history() const { return {}; }
  void begin(const Start&, std::span<double>) const {}
  std::vector<std::string> complaints() const { return {}; }
  double admit(Eigen::Ref<Voigt> s, double&, std::span<double>) const
  {
    const bool any = norm(s) > 0;
    s.setZero();
    return any ? 1 : 0;
  }

  Moduli moduli(const Point&, double) const { return {stiffness, stiffness}; }

  Outcome update(const Point& start, const Strain& step, TangentKind,
                 std::span<double>, Response& answer) const
  {
    answer = {};
    answer.p = start.p - stiffness * step.theta;
    answer.dp_dtheta = -stiffness;
    return Outcome::ok;
  }
};

static_assert(MaterialLaw<Void>);
} // namespace mmale::material
