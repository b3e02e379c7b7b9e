// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/range.h"
#include "scene/scene.h"
#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What a material law is (METHOD.md, step 1a).
///
/// Strain-driven, as in a textbook: the law is given the stress at the start
/// of a step and the strain increment, and answers with the stress at the end.
/// Stress is the effective one; pore water is not a law's business
/// (`water.h`), nor is the pressure that the solver brings (`drive.h`). Laws
/// work in the mid-step frame, so they know nothing of rotation.
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
  continuum,  ///< derivative of the rate equations
  robust      ///< the law's stiffest: slow Newton, hard to upset
};

/// A point of a material at one time.
struct Point
{
  Voigt s = Voigt::Zero();   ///< deviator of the stress [Pa]
  double p = 0;              ///< pressure, compression positive [Pa]
  std::span<const double> q; ///< the law's history
};

/// Strain over a step.
struct Strain
{
  Voigt de = Voigt::Zero(); ///< deviator, engineering shear [-]
  double theta = 0;         ///< logarithmic volume strain [-]
  double dt = 0;            ///< length of the step [s]
};

/// What an update took, to be counted and reported.
struct Effort
{
  long substeps = 0; ///< taken
  long rejected = 0; ///< and taken back
  long apex = 0;     ///< updates that met the zero-stress floor
  long clipped = 0;  ///< void ratio or intergranular strain cut to its range

  Effort& operator+=(const Effort& o)
  {
    substeps += o.substeps;
    rejected += o.rejected;
    apex += o.apex;
    clipped += o.clipped;
    return *this;
  }
};

/// The answer, with derivatives by `de` and by `theta`.
struct Response
{
  Voigt s = Voigt::Zero(); ///< deviator at the end [Pa]
  double p = 0;            ///< pressure at the end [Pa]
  double flow = 0; ///< 2 G dLambda with d eps_plastic = dLambda s; 0 if elastic
  Voigt2 ds_de = Voigt2::Zero();
  Voigt ds_dtheta = Voigt::Zero();
  Voigt dp_de = Voigt::Zero();
  double dp_dtheta = 0; ///< below 0 at any state, so that p can drive
  Voigt dflow_de = Voigt::Zero();
  double dflow_dtheta = 0;
  Effort effort;
};

/// Tangent moduli at the start of a step [Pa].
struct Moduli
{
  double G; ///< above 0: it also scales and stabilises
  double K; ///< above 0
};

/// What a remap keeps of a number of the history: its integral over the
/// volume, or that of the grains' share, 1 / (1 + e), of a void ratio e.
enum class Conserved
{
  value,
  grain_volume
};

/// Numbers of a point that the law carries from step to step.
struct HistoryField
{
  std::string name; ///< also of the output field; of a tensor with _xx ...
  int size = 1;     ///< 1, or 4: a symmetric tensor xx yy zz xy (xy is not
                    ///< doubled) that turns with the material
  Conserved conserved = Conserved::value;
};

/// How a point begins, where the scene says more than the law.
struct Start
{
  double p = 0;                        ///< effective pressure [Pa]
  double void_ratio = scene::required; ///< NaN: by the law's own parameters
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

/// The answer of a law that is written for whole tensors.
///
/// @param[in] sigma stress at the end, tension positive [Pa]
/// @param[in] C     its derivative by the strain with engineering shear [Pa]
inline void split(const Voigt& sigma, const Voigt2& C, Response& answer)
{
  const Voigt one(1, 1, 1, 0);
  answer.p = -sigma.head<3>().sum() / 3;
  answer.s = sigma + answer.p * one;
  // de is a deviator: what C does to its trace does not count
  const Voigt by_theta = C * one / 3;
  answer.dp_dtheta = -by_theta.head<3>().sum() / 3;
  answer.ds_dtheta = by_theta + answer.dp_dtheta * one;
  answer.dp_de = -C.topRows<3>().colwise().sum().transpose() / 3;
  answer.ds_de = C + one * answer.dp_de.transpose();
}

/// A number of law `L`, as written in scenes.
///
/// Its value in `L{}` is the default: `scene::required` if there is none,
/// `not_given` if it may be left out and the law then does without.
template <class L>
struct Parameter
{
  std::string_view name;
  std::string_view unit;
  double L::* value;
  scene::Range range;
  std::string_view meaning;
};
inline constexpr double not_given = scene::infinity;

/// Numbers of a known material, by the names of the law's parameters.
struct ParameterSet
{
  std::string_view name;
  std::string_view source;
  std::map<std::string_view, double> values;
};

/// A law may also have, and the library then offers in scenes:
///
///     static constexpr std::string_view set_key;        // "sand"
///     static std::span<const ParameterSet> sets();
///     static const std::array<TextParameter<L>, n> texts;
///     static const std::array<ListParameter<L>, n> lists;
template <class L>
struct TextParameter
{
  std::string_view name;
  std::string L::* value;
  bool needed;
  std::string_view meaning;
};

template <class L>
struct ListParameter
{
  std::string_view name;
  std::vector<double> L::* value;
  std::string_view meaning;
};

/// Mass density of a point at the start [kg/m3]: the law's `density`, or what
/// it makes of other numbers.
template <class L>
double initial_density(const L& law, const Start& at)
{
  if constexpr (requires { law.initial_density(at); })
    return law.initial_density(at);
  else
    return law.density;
}

template <class L>
concept MaterialLaw =
    std::is_aggregate_v<L>
    and requires(const L law, const Point& start, const Strain& step,
                 TangentKind kind, std::span<double> q, Response& answer,
                 Eigen::Ref<Voigt> s, double& p) {
          { L::name } -> std::convertible_to<std::string_view>;
          // ds_de is symmetric, and p and the deviator do not mix
          { L::symmetric } -> std::convertible_to<bool>;
          { L::yields } -> std::convertible_to<bool>; // flow may exceed 0
          // the deviator depends on the rate of strain alone
          { L::fluid } -> std::convertible_to<bool>;
          { L::parameters[0] } -> std::convertible_to<Parameter<L>>;
          { initial_density(law, Start{}) } -> std::same_as<double>;
          { law.history() } -> std::same_as<std::vector<HistoryField>>;
          // history of a point at the start of a run
          law.begin(Start{}, q);
          // advances q in place, which is a copy of start.q when called
          { law.update(start, step, kind, q, answer) } -> std::same_as<Outcome>;
          { law.moduli(start, step.dt) } -> std::same_as<Moduli>;
          // brings a remapped state back; the part of it that was cut off
          { law.admit(s, p, q) } -> std::same_as<double>;
          // beyond the ranges of single parameters; empty is good
          { law.complaints() } -> std::same_as<std::vector<std::string>>;
        };
} // namespace mmale::material
