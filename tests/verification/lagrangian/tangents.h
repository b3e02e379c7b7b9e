// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "body.h"
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>
#include <vector>

/// Tangents of cells against differences of their residuals.
namespace mmale::test
{
/// Random displacements and pressures.
inline std::vector<double> trial(const Body& body, double displacement,
                                 double pressure, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> z(3 * body.num_nodes());
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] = (i % 3 == 2 ? pressure : displacement) * uniform(random);
  return z;
}
/// Largest difference of the cells' tangents from central differences of their
/// residuals along a random direction, relative to a row's terms.
///
/// @param[in] step displacements of the direction; pressures 100 times that
/// @param[in] least row that counts; 0: any
inline double tangent_error(Body& body, const std::vector<double>& z,
                            double step, double least = 0)
{
  REQUIRE(body.evaluate(z));
  std::vector<std::array<double, 81>> J;
  for (int c = 0; c < body.num_cells(); ++c)
    J.push_back(body.jacobian(c, z));
  body.begin_iteration(z);
  const auto d = trial(body, step, 100 * step, 9);
  std::vector<std::array<double, 9>> slope(body.num_cells());
  for (const double side : {1.0, -1.0})
  {
    auto y = z;
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] += side * d[i];
    REQUIRE(body.evaluate(y));
    for (int c = 0; c < body.num_cells(); ++c)
    {
      const auto R = body.residual(c, y);
      for (int i = 0; i < 9; ++i)
        slope[c][i] += 0.5 * side * R[i];
    }
  }
  double error = 0;
  for (int c = 0; c < body.num_cells(); ++c)
    for (int i = 0; i < 9; ++i)
    {
      double expected = 0, size = least;
      for (int j = 0; j < 9; ++j)
      {
        const double term =
            J[c][9 * i + j] * d[3 * body.cell(c)[j / 3] + j % 3];
        expected += term;
        size += std::abs(term);
      }
      error = std::max(error, std::abs(slope[c][i] - expected) / size);
    }
  return error;
}
} // namespace mmale::test
