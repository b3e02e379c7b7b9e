// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "drive.h"
#include "library.h"
#include "water.h"
#include <array>
#include <string>
#include <variant>

/// What a cell with several materials answers as a whole (METHOD.md, Closure
/// of mixed cells).
///
/// Form P: the solver gives the pressure at the end of the step and the
/// deviatoric strain that the cell's materials have in common; a closure says
/// what each of them makes of it, and answers for all like one material.
/// Void has no part in this: whether a cell with void is full or open, the
/// solver finds by `open_volume`.
namespace mmale::material
{
/// A material in a mixed cell at the start of a step, and its answer.
struct Share
{
  const AnyLaw* law;   ///< never void
  double fraction;     ///< of the cell's volume at the start; what all of them
                       ///< leave of 1 is void
  Point start;         ///< turned to mid-step, in total stress
  std::span<double> q; ///< out: history at the end, of the size of start.q; of
                       ///< no meaning if the closure asks for a smaller step
  const Water* water = nullptr;   ///< in its pores, which cannot flow; or none
  double guess = scene::required; ///< in: of theta, or NaN; out: theta

  // out
  Driven answer;     ///< of this material alone, its derivatives by its own
                     ///< strain and pressure
  double p = 0;      ///< its pressure at the end [Pa]
  double weight = 0; ///< its part of the volume of all shares at the end
};

/// Between the two largest parts of a cell.
struct Interface
{
  /// Of unit length, turned to mid-step like the tensors of a start: by half
  /// the rotation of the step. Its sign does not matter.
  std::array<double, 2> normal{1, 0};
  double area = 0;           ///< in the cell, or 0: none known
  int first = 0, second = 1; ///< of the shares; chosen by geometry, not by
                             ///< index, or the order of materials would matter
};

/// What the cell is as a whole.
struct Mixed
{
  /// Means over the volumes of the shares at the end, f0_k exp(theta_k) (of
  /// a laminate's stresses at the start);
  /// theta = ln(sum of f0_k exp(theta_k) / sum of f0_k). The derivatives are
  /// by the common `de` and `p`, exact for consistent tangents of the laws.
  Driven mean;
  double volume = 0; ///< sum of f0_k exp(theta_k): of the shares at the end, in
                     ///< the cell's volume at the start [-]
  int refused = -1;  ///< which share asked for a smaller step; -1: none, or all
                     ///< together
};

/// @param[in,out] shares at least one; the sum of fractions above 0
/// @param[in]     de     deviator of the common strain, engineering shear
/// @param[in]     p      at the end, of the mixture [Pa]
/// @return reduce_step if a law asks for it, or no such state is found
template <class C>
concept Closure =
    requires(const C closure, std::span<Share> shares, const Voigt& de,
             double p, double dt, TangentKind kind, const Interface& interface,
             Mixed& mixed) {
      { C::name } -> std::convertible_to<std::string_view>;
      {
        closure(shares, de, p, dt, kind, interface, mixed)
      } -> std::same_as<Outcome>;
    };

/// One pressure and one deviatoric strain for all: each share takes the volume
/// strain that goes with p. Never allocates.
///
/// Exact for a mixture of fluids, and what a stiff material beside a soft one
/// is worst at: its deviator takes part in the whole strain.
struct EqualPressure
{
  static constexpr std::string_view name = "equal_pressure";
  Outcome operator()(std::span<Share> shares, const Voigt& de, double p,
                     double dt, TangentKind kind, const Interface& interface,
                     Mixed& mixed) const;
};

/// One strain for all; the mean of their pressures is p. The stiffest answer.
struct EqualStrain
{
  static constexpr std::string_view name = "equal_strain";
  Outcome operator()(std::span<Share> shares, const Voigt& de, double p,
                     double dt, TangentKind kind, const Interface& interface,
                     Mixed& mixed) const;
};

/// Two layers, bonded: one traction on their interface, and strains that
/// differ by sym(a x n) with the common strain as their mean.
///
/// The means of strain and stress, p with it, are weighted by the fractions at
/// the start. Exact for two shares and a plane interface. With more, `first` is
/// one layer and all others, which then have one strain, are the other. Without
/// an interface: EqualPressure.
struct Laminate
{
  static constexpr std::string_view name = "laminate";
  Outcome operator()(std::span<Share> shares, const Voigt& de, double p,
                     double dt, TangentKind kind, const Interface& interface,
                     Mixed& mixed) const;
};

/// Every closure. A new one is its name here; tests walk this list.
using AnyClosure = std::variant<EqualPressure, EqualStrain, Laminate>;

static_assert(Closure<EqualPressure> and Closure<EqualStrain>
              and Closure<Laminate>);

/// By its name in scenes.
/// @throws std::invalid_argument for an unknown one
AnyClosure make_closure(std::string_view name);

/// All names, the default first.
std::vector<std::string> closure_names();

/// The volume that the shares fill, each unloaded to `p`: `mixed.volume`.
///
/// Where it is less than J, volume of the cell at the end over that at the
/// start, the cell is open: void has the rest, and the answers left in
/// `shares` and `mixed` are those of the step. Otherwise void has closed, and
/// the shares answer to a pressure, together filling J.
///
/// @param[in] p that counts as none [Pa]. Hypoplastic sand falls from p_min to
///              0 over a volume strain of 0.1 (its `apex_stiffness`): at 0 it
///              would keep a cell closed by that much, at 2 p_min it does not
Outcome open_volume(std::span<Share> shares, const Voigt& de, double dt,
                    TangentKind kind, Mixed& mixed, double p = 0);

/// Moduli at the start of a step: G as all shear alike, K as all are under one
/// pressure.
Moduli moduli(std::span<const Share> shares, double dt);
} // namespace mmale::material
