// SPDX-License-Identifier: LGPL-3.0-or-later
#include "balance.h"
#include "damped.h"
#include "lagrangian/kernel.h"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

using namespace mmale::lagrangian;
using Catch::Approx;

namespace
{
constexpr double c = 30; // change.py [1/s]

/// A cell with no number left out.
struct Cell
{
  CellInput input;
  Constants constants;
  std::array<double, 9> x{0.4, 0.1, 0, 1.3, 0.2, 0, 0.6, 0.9, 0};

  Cell()
  {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(0.5, 1.5);
    auto* numbers = reinterpret_cast<double*>(&input);
    for (std::size_t i = 0; i < sizeof(input) / sizeof(double); ++i)
      numbers[i] = uniform(random);
    constants = {.g = {0.3, -9.8}, .g_n = {0.1, -9}, .dt = 0.02};
  }
  double area() const
  {
    return 0.5
           * ((x[3] - x[0]) * (x[7] - x[1]) - (x[6] - x[0]) * (x[4] - x[1]));
  }
  double radius() const { return (x[0] + x[3] + x[6]) / 3; }

  /// What a form has more than another.
  std::vector<double> difference(const ufcx_form& with,
                                 const ufcx_form& without,
                                 std::size_t size) const
  {
    std::vector<double> a(size, 0.0), b(size, 0.0);
    Kernel(with, IntegralKind::cell)(a, input, constants, x.data());
    Kernel(without, IntegralKind::cell)(b, input, constants, x.data());
    for (std::size_t i = 0; i < size; ++i)
      a[i] -= b[i];
    return a;
  }
};

/// Mass-proportional damping of the cell, one point: every pair of its nodes
/// has a ninth of its mass, in each direction.
void check(const ufcx_form& R, const ufcx_form& R_0, const ufcx_form& J,
           const ufcx_form& J_0, double volume)
{
  const Cell cell;
  const double ninth = c * cell.input.rho * volume / cell.constants.dt / 9;
  const auto dR = cell.difference(R, R_0, 11);
  const auto dJ = cell.difference(J, J_0, 121);
  for (int i = 0; i < 11; ++i)
  {
    double force = 0;
    for (int j = 0; j < 11; ++j)
    {
      const bool coupled = i < 9 and j < 9 and i % 3 < 2 and i % 3 == j % 3;
      INFO("row " << i << ", column " << j);
      // differences of numbers up to some hundreds times larger
      CHECK(dJ[11 * i + j]
            == Approx(coupled ? ninth : 0).margin(1e-12 * ninth));
      if (coupled)
        force += ninth * cell.input.w[j];
    }
    CHECK(dR[i] == Approx(force).margin(1e-12 * ninth));
  }
}
} // namespace

TEST_CASE("one line of damping in the residual arrives in residual and tangent",
          "[verification][forms]")
{
  const Cell cell;
  SECTION("plane strain")
  {
    check(*form_damped_R_plane, *form_balance_R_plane, *form_damped_J_plane,
          *form_balance_J_plane, cell.area());
  }
  SECTION("axisymmetric")
  {
    check(*form_damped_R_axi, *form_balance_R_axi, *form_damped_J_axi,
          *form_balance_J_axi, cell.area() * cell.radius());
  }
}

TEST_CASE("the bubble's columns are left alone by it", "[verification][forms]")
{
  const auto dB =
      Cell().difference(*form_damped_B_plane, *form_balance_B_plane, 22);
  for (double v : dB)
    CHECK(std::abs(v) < 1e-13); // another order of sums, no more
}
