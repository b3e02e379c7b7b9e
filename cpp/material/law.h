// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/range.h"
#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What a material law is (METHOD.md, step 1a).
///
/// Pressure-driven: the solver brings the deviatoric strain increment and the
/// total pressure at the end of the step; the law answers with the deviator
/// and the volume strain that it needs to carry this pressure. Laws work in
/// the mid-step frame, so they know nothing of rotation.
namespace mmale::material
{
/// Components xx, yy, zz, xy. Strains have the engineering shear 2 eps_xy.
using Voigt = Eigen::Vector4d;
using Voigt2 = Eigen::Matrix4d;

/// What the solver must do next.
enum class [[nodiscard]] Outcome
{
  ok,
  reduce_step ///< the law wants a smaller step
};

enum class TangentKind
{
  consistent, ///< derivative of the update
  continuum   ///< derivative of the rate equations
};

/// A step as seen by a point.
struct Increment
{
  Voigt s;    ///< deviator at the start [Pa]
  Voigt de;   ///< deviatoric strain increment [-]
  double p_n; ///< pressure at the start [Pa], compression positive
  double p;   ///< pressure at the end [Pa]
};

/// The answer, with derivatives by `de` and by `p`.
struct Response
{
  Voigt s = Voigt::Zero(); ///< deviator at the end [Pa]
  double theta = 0;        ///< volume strain that goes with `p` [-]
  double flow = 0; ///< 2 G dLambda with d eps_plastic = dLambda s; 0 if elastic
  Voigt2 ds_de = Voigt2::Zero();
  Voigt ds_dp = Voigt::Zero();
  Voigt dtheta_de = Voigt::Zero();
  double dtheta_dp = 0;
  Voigt dflow_de = Voigt::Zero();
  double dflow_dp = 0;
};

/// Frobenius norm of a stress in components xx, yy, zz, xy.
inline double norm(const Voigt& s)
{
  return std::sqrt(s.squaredNorm() + s[3] * s[3]);
}

/// Derivative of `2 G de` by `de` for deviatoric `de` with engineering shear.
inline Voigt2 shear_stiffness(double G)
{
  return Voigt(2 * G, 2 * G, 2 * G, G).asDiagonal();
}

/// A parameter of law `L`, as written in scenes.
template <class L>
struct Parameter
{
  std::string_view name;
  std::string_view unit;
  double L::* value;
  scene::Range range;
  std::string_view meaning;
};

template <class L>
concept MaterialLaw =
    std::is_aggregate_v<L>
    and requires(const L law, const Increment& step, std::span<double> q,
                 Response& answer, Eigen::Ref<Voigt> stress,
                 std::span<const double> history) {
          { L::name } -> std::convertible_to<std::string_view>;
          // ds_de is symmetric, and p and the deviator do not mix
          { L::symmetric } -> std::convertible_to<bool>;
          { L::yields } -> std::convertible_to<bool>; // flow may exceed 0
          // names of the history numbers of a point; also output fields
          { L::history[0] } -> std::convertible_to<std::string_view>;
          { L::parameters[0] } -> std::convertible_to<Parameter<L>>;
          // advances q in place
          {
            law.update(step, TangentKind{}, q, answer)
          } -> std::same_as<Outcome>;
          { law.shear_modulus() } -> std::same_as<double>; // at the start
          { law.bulk_modulus() } -> std::same_as<double>;
          { law.density } -> std::convertible_to<double>;
          // brings a remapped state back; the part of it that was cut off
          { law.admit(stress, history) } -> std::same_as<double>;
          // beyond the ranges of single parameters; empty is good
          { law.complaints() } -> std::same_as<std::vector<std::string>>;
        };
} // namespace mmale::material
