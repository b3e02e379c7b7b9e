// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <algorithm>
#include <concepts>
#include <initializer_list>
#include <string>
#include <vector>

/// The words that a scene may choose among.
namespace mmale::scene
{
template <class T, class... U>
concept OneOf = (std::same_as<T, U> or ...);

template <class T>
concept Enumeration = OneOf<T, Symmetry, Diagonal, Element, Layout, Tangent,
                            Factorisation, VoidRule, RemapMode>;

/// Names of an enumeration, in the order of its values.
template <Enumeration E>
const std::vector<std::string>& names()
{
  using Names = std::vector<std::string>;
  if constexpr (std::same_as<E, Symmetry>)
  {
    static const Names list = {"plane_strain", "axisymmetric"};
    return list;
  }
  else if constexpr (std::same_as<E, Diagonal>)
  {
    static const Names list = {"right", "left", "alternating"};
    return list;
  }
  else if constexpr (std::same_as<E, Element>)
  {
    static const Names list = {"mini", "equal_order", "constant_strain"};
    return list;
  }
  else if constexpr (std::same_as<E, Layout>)
  {
    static const Names list = {"mean", "quadrature"};
    return list;
  }
  else if constexpr (std::same_as<E, Tangent>)
  {
    static const Names list = {"consistent", "continuum", "robust"};
    return list;
  }
  else if constexpr (std::same_as<E, Factorisation>)
  {
    static const Names list = {"automatic", "lu", "ldlt"};
    return list;
  }
  else if constexpr (std::same_as<E, VoidRule>)
  {
    static const Names list = {"surface", "by_bodies", "closing"};
    return list;
  }
  else
  {
    static const Names list = {"lagrangian", "ale", "eulerian"};
    return list;
  }
}

inline const std::vector<std::string> sides = {"left", "right", "bottom",
                                               "top"};
inline const std::vector<std::string> mesh_shapes = {"rectangle",
                                                     "quadrilateral", "gmsh"};
inline const std::vector<std::string> region_shapes = {
    "rectangle", "polygon", "circle", "half_plane", "file", "everywhere"};
inline const std::vector<std::string> quantities = {"displacement_x",
                                                    "displacement_y",
                                                    "velocity_x",
                                                    "velocity_y",
                                                    "reaction_x",
                                                    "reaction_y",
                                                    "pressure",
                                                    "stress_xx",
                                                    "stress_yy",
                                                    "stress_zz",
                                                    "stress_xy",
                                                    "pore_pressure",
                                                    "effective_stress_xx",
                                                    "effective_stress_yy",
                                                    "effective_stress_zz",
                                                    "effective_stress_xy",
                                                    "discharge",
                                                    "covered_length",
                                                    "x_max",
                                                    "y_max",
                                                    "kinetic_energy",
                                                    "internal_work",
                                                    "external_work",
                                                    "total_energy",
                                                    "tracer_max",
                                                    "tracer_min",
                                                    "tracer_total"};

/// Is the text among the wanted ones of the choices?
inline bool is_one_of(const std::string& text,
                      const std::vector<std::string>& choices,
                      std::initializer_list<std::size_t> wanted)
{
  return std::ranges::any_of(wanted,
                             [&](std::size_t i) { return text == choices[i]; });
}

/// "\"a\" or \"b\"", the wanted ones of the choices.
inline std::string alternatives(const std::vector<std::string>& choices,
                                std::initializer_list<std::size_t> wanted)
{
  std::string text;
  for (std::size_t i : wanted)
    text += (text.empty() ? "\"" : " or \"") + choices[i] + "\"";
  return text;
}
} // namespace mmale::scene
