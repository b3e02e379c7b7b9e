// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <string_view>

/// Embedded pairs of explicit Runge–Kutta formulas, and the size of the next
/// sub-step from the error of the last (METHOD.md, step 1a).
///
/// A scheme lists the times of its stages, their weights `a` row by row
/// (without the first, which is empty), those of the result, which is the
/// pair's better one, and of the error, the difference of the two. `carries`:
/// the last stage is the first of the next sub-step.
namespace mmale::material::runge_kutta
{
/// Heun's method; error from Euler's.
struct Heun
{
  static constexpr std::string_view name = "heun";
  static constexpr int stages = 2, order = 2;
  static constexpr bool carries = false;
  static constexpr double c[] = {0, 1};
  static constexpr double a[][1] = {{1}};
  static constexpr double b[] = {0.5, 0.5};
  static constexpr double error[] = {-0.5, 0.5};
};

/// Kutta's method of order 3; error from the mid-point rule. In soil mechanics
/// it goes by the name of RKF23.
/// @source Sloan (1987), Int. J. Numer. Meth. Eng. 24, 893-911
struct Kutta
{
  static constexpr std::string_view name = "rkf23";
  static constexpr int stages = 3, order = 3;
  static constexpr bool carries = false;
  static constexpr double c[] = {0, 0.5, 1};
  static constexpr double a[][2] = {{0.5}, {-1, 2}};
  static constexpr double b[] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
  static constexpr double error[] = {1.0 / 6, -1.0 / 3, 1.0 / 6};
};

/// @source Bogacki & Shampine (1989), Appl. Math. Lett. 2, 321-325
struct BogackiShampine
{
  static constexpr std::string_view name = "bs32";
  static constexpr int stages = 4, order = 3;
  static constexpr bool carries = true;
  static constexpr double c[] = {0, 0.5, 0.75, 1};
  static constexpr double a[][3] = {
      {0.5}, {0, 0.75}, {2.0 / 9, 1.0 / 3, 4.0 / 9}};
  static constexpr double b[] = {2.0 / 9, 1.0 / 3, 4.0 / 9, 0};
  static constexpr double error[] = {-5.0 / 72, 1.0 / 12, 1.0 / 9, -1.0 / 8};
};

/// @source Dormand & Prince (1980), J. Comput. Appl. Math. 6, 19-26
struct DormandPrince
{
  static constexpr std::string_view name = "dp54";
  static constexpr int stages = 7, order = 5;
  static constexpr bool carries = true;
  static constexpr double c[] = {0, 0.2, 0.3, 0.8, 8.0 / 9, 1, 1};
  static constexpr double a[][6] = {
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double b[] = {
      35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84, 0};
  static constexpr double error[] = {
      71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
      -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
};

inline constexpr std::array names{Heun::name, Kutta::name,
                                  BogackiShampine::name, DormandPrince::name};

/// By how much to change the size of a sub-step.
///
/// Smooth in the error but at its ends, so that a sequence of sub-steps without
/// a rejection, the last cut to the end of the step, is a continuous function
/// of the strain: a jump in the answer would stall the Newton iteration around.
///
/// @param[in] error estimated over allowed; the pair's lower order makes it
/// @param[in] order of the pair's better formula
inline double resize(double error, int order)
{
  const double factor = 0.85 * std::pow(error, -1.0 / order);
  return factor < 0.2 ? 0.2 : factor < 5 ? factor : 5; // NaN: 5, see callers
}
} // namespace mmale::material::runge_kutta
