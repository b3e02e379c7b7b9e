// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"
#include <array>

namespace mmale::material
{
/// A law in a shared library with Abaqus's interface UMAT, symbol `umat_`.
///
/// Units are those of the scene (SI; `props` are handed over as they are).
/// Tension is positive, shear strains are engineering ones. Order of the four
/// components (NDI = 3, NSHR = 1): 11 22 33 12, which are xx yy zz xy; about an
/// axis rr zz θθ rz. Strains are logarithmic, in the frame of the middle of the
/// step, so DROT is the identity. The stress is the effective one.
///
/// Given: STRESS, STATEV, STRAN, DSTRAN, TIME (both of the run), DTIME, PROPS,
/// DFGRD0 = I, DFGRD1 = I + DSTRAN, KSTEP = 1, KINC = 1 in a point's first step
/// and then 2; TEMP, PREDEF, COORDS, energies are 0, CELENT, NOEL, NPT are 1.
/// Taken: STRESS, STATEV, DDSDDE, PNEWDT < 1 (a smaller step, please). Numbers
/// that are not finite ask for a smaller step too.
struct Umat
{
  static constexpr double required = scene::required;
  static constexpr std::string_view name = "umat";
  static constexpr bool symmetric = false, yields = false, fluid = false;

  std::string library;                ///< file, relative to the scene
  std::vector<double> props;          ///< PROPS
  std::vector<double> initial_states; ///< STATEV at the start; none: zeros
  double states = required;           ///< NSTATV
  double density = required;          ///< [kg/m3]
  std::string folder = {};            ///< the scene's, filled by the library
  void (*routine)() = nullptr;        ///< `umat_`, by `open`

  static const std::array<Parameter<Umat>, 2> parameters;
  static const std::array<TextParameter<Umat>, 1> texts;
  static const std::array<ListParameter<Umat>, 2> lists;

  /// Load the library, which stays loaded.
  /// @return empty, or why it cannot be had
  std::string open();

  std::vector<HistoryField> history() const;
  void begin(const Start&, std::span<double> q) const;
  std::vector<std::string> complaints() const;

  /// Of the tangent that the routine gives for no strain at all.
  Moduli moduli(const Point& start, double dt) const;

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const;

  /// What the routine makes of the state for no strain and no time.
  double admit(Eigen::Ref<Voigt> s, double& p, std::span<double> q) const;
};

static_assert(MaterialLaw<Umat>);
} // namespace mmale::material
