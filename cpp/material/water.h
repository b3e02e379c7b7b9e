// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "drive.h"
#include <algorithm>
#include <array>
#include <cmath>

/// Water in the pores of a material (METHOD.md, Water).
///
/// The law keeps the effective stress; the pressure of the medium is
/// p = p' + p_w. History of the medium: the law's, then pore_pressure and
/// porosity. Pressures of the water count from the atmosphere's.
namespace mmale::material
{
/// What the water carries at a point.
struct Pores
{
  double p_w = 0; ///< pore pressure, compression positive [Pa]
  double n = 0;   ///< porosity [-]
};

/// Water and grains, both compressible and at the pressure of the water.
///
/// A volume of them changes as its parts do:
///
///     exp(theta) = n exp(-dp / K_f) + (1 - n) exp(-dp / K_s),
///
/// so the volume of the grains is kept but for their own compression, closed
/// paths close, and for small steps 1/K_w = n/K_f + (1 - n)/K_s. Below the
/// pressure of cavitation the water's own modulus is next to nothing; the
/// pressure stays a function of the volume, falling everywhere.
struct Water
{
  static constexpr int num_history = 2; ///< pore_pressure, porosity

  double K_f = scene::required; ///< bulk modulus of the water [Pa]
  double K_s = scene::required; ///< of the grains [Pa]
  double p_c = scene::required; ///< cavitation, from the atmosphere's [Pa]
  /// Of cavitating water [Pa]. Doubled: pressure falls below p_c twice as far,
  /// by K_c times the volume strain of the water. Nothing fails if it is less.
  static constexpr double K_c = 1e4;

  double modulus(double p_w) const { return p_w < p_c ? K_c : K_f; }

  /// Logarithm of the water's volume ratio from one pressure to another [-].
  double swelling_of_water(double from, double to) const
  {
    if ((from < p_c) == (to < p_c))
      return (from - to) / modulus(to);
    return (from - p_c) / modulus(from) + (p_c - to) / modulus(to);
  }

  /// Compressibility of water and grains at a pressure [1/Pa].
  double compressibility(const Pores& at) const
  {
    return at.n / modulus(at.p_w) + (1 - at.n) / K_s;
  }

  /// Logarithmic volume strain of water and grains from one pressure to another
  /// [-], and its slope [1/Pa].
  struct Swelling
  {
    double theta, slope;
    double n; ///< porosity at the end
  };
  Swelling swelling(const Pores& start, double p_w) const
  {
    const double water = swelling_of_water(start.p_w, p_w);
    const double grains = (start.p_w - p_w) / K_s;
    const double theta = std::log1p(start.n * std::expm1(water)
                                    + (1 - start.n) * std::expm1(grains));
    const double n = start.n * std::exp(water - theta);
    return {theta, -compressibility({p_w, n}), n};
  }

  /// Pores at the end of a step without flow, by the volume strain of water and
  /// grains.
  /// @param[out] slope dp_w / dtheta [Pa]
  Pores undrained(const Pores& start, double theta, double& slope) const
  {
    // A smooth convex function on either side of cavitation: Newton on the
    // side of the answer, from the corner if the start lies on the other one
    const bool cavitates = theta > swelling(start, p_c).theta;
    const double K = cavitates ? K_c : K_f;
    double p = cavitates == (start.p_w < p_c) ? start.p_w : p_c;
    Swelling at = swelling(start, p);
    const double enough = 1e-15 * std::abs(theta);
    for (int i = 0; i < 100 and std::abs(at.theta - theta) > enough; ++i)
    {
      const double last = p;
      p += (at.theta - theta) / (at.n / K + (1 - at.n) / K_s);
      p = cavitates ? std::min(p, p_c) : std::max(p, p_c);
      if (p == last)
        break; // last digits
      at = swelling(start, p);
    }
    slope = 1 / at.slope;
    return {p, at.n};
  }

  /// Porosity at the end of a step with flow: the grains stay.
  /// @param[in] theta of the skeleton [-]
  double porosity(const Pores& start, double p_w, double theta) const
  {
    return 1 - (1 - start.n) * std::exp((start.p_w - p_w) / K_s - theta);
  }

  /// Volume that water and grains give way by when the pressure rises, of a
  /// volume of the medium [-], and its slope [1/Pa]: storage.
  std::array<double, 2> stored(const Pores& start, double p_w) const
  {
    const double water = -swelling_of_water(start.p_w, p_w);
    return {start.n * water + (1 - start.n) * (p_w - start.p_w) / K_s,
            compressibility({p_w, start.n})};
  }
};

/// The numbers of the water in the history of a medium, its last two.
inline Pores pores(std::span<const double> q)
{
  return {q[q.size() - 2], q[q.size() - 1]};
}
inline void set_pores(const Pores& pores, std::span<double> q)
{
  q[q.size() - 2] = pores.p_w;
  q[q.size() - 1] = pores.n;
}

/// A law with water in its pores that cannot flow: to `drive` a law like any
/// other, in total stress.
template <class L>
struct Undrained
{
  const L& law;
  const Water& water;

  /// The law's part of a point of the medium.
  static Point skeleton(const Point& start)
  {
    return {start.s, start.p - pores(start.q).p_w,
            start.q.first(start.q.size() - Water::num_history)};
  }

  Moduli moduli(const Point& start, double dt) const
  {
    const auto [G, K] = law.moduli(skeleton(start), dt);
    return {G, K + 1 / water.compressibility(pores(start.q))};
  }

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const
  {
    const Outcome outcome =
        law.update(skeleton(start), step, kind,
                   q.first(q.size() - Water::num_history), answer);
    if (outcome != Outcome::ok)
      return outcome;
    double slope = 0;
    const Pores end = water.undrained(pores(start.q), step.theta, slope);
    set_pores(end, q);
    answer.p += end.p_w;
    answer.dp_dtheta += slope;
    return Outcome::ok;
  }
};

/// A law with water that flows: to `drive` a law like any other, in effective
/// stress, as the nodes know the pressure of the water.
template <class L>
struct Seeping
{
  static constexpr bool linear_pressure = LinearPressure<L>;

  const L& law;
  const Water& water;
  double p_w; ///< at the end of the step [Pa]

  /// The law's part of a point whose pressure is the effective one.
  static Point skeleton(const Point& start)
  {
    return {start.s, start.p,
            start.q.first(start.q.size() - Water::num_history)};
  }

  Moduli moduli(const Point& start, double dt) const
  {
    return law.moduli(skeleton(start), dt);
  }

  Outcome update(const Point& start, const Strain& step, TangentKind kind,
                 std::span<double> q, Response& answer) const
  {
    const Outcome outcome =
        law.update(skeleton(start), step, kind,
                   q.first(q.size() - Water::num_history), answer);
    if (outcome == Outcome::ok)
      set_pores({p_w, water.porosity(pores(start.q), p_w, step.theta)}, q);
    return outcome;
  }
};
} // namespace mmale::material
