// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/library.h"
#include <array>
#include <random>
#include <vector>

/// Parameters and scales for the conformance tests of the laws, and random
/// tensors in the components xx, yy, zz, xy.
namespace mmale::test
{
using material::Voigt;

/// One set of parameters of a law, with the sizes that its curves have.
struct Sample
{
  scene::Material material;
  double strain; ///< deviatoric, over which its answer bends [-]
  double theta;  ///< volume strain, likewise [-]
  double p = 0;  ///< pressure where paths begin [Pa]
  double dt = 1; ///< steps [s]

  const std::string& law() const { return material.law; }
};

/// A law without a sample here fails the tests. Moduli over many decades: a
/// law must not hide an absolute size.
inline const std::vector<Sample> samples{
    {{"elastic", {{"E", 2.6e6}, {"nu", 0.3}, {"density", 1e3}}}, 1e-2, 1e-2},
    {{"elastic", {{"E", 2e11}, {"nu", 0.4999}, {"density", 7.8e3}}},
     1e-3,
     1e-6},
    {{"j2",
      {{"E", 2.6e6},
       {"nu", 0.3},
       {"yield_stress", 2e4},
       {"hardening", 0},
       {"density", 1e3}}},
     1e-2,
     1e-2},
    {{"j2",
      {{"E", 2.1e11},
       {"nu", 0.29},
       {"yield_stress", 3e8},
       {"hardening", 4e9},
       {"density", 7.8e3}}},
     1.9e-3,
     2e-3},
    {{"j2",
      {{"E", 1.0},
       {"nu", 0.4999},
       {"yield_stress", 1e-3},
       {"hardening", 0.1},
       {"density", 1.0}}},
     1.5e-3,
     6e-7},
    {{"drucker_prager",
      {{"E", 2e7},
       {"nu", 0.27},
       {"cohesion", 4e3},
       {"friction_deg", 31},
       {"dilation_deg", 9},
       {"density", 1.6e3}},
      {{"cone", "compression"}}},
     1e-3,
     1e-3,
     1e4},
    {{"drucker_prager", // dry sand, cohesionless
      {{"E", 5e7},
       {"nu", 0.2},
       {"cohesion", 0},
       {"friction_deg", 38},
       {"dilation_deg", 0},
       {"density", 1.6e3}},
      {{"cone", "plane_strain"}}},
     2e-3,
     1e-3,
     1e5},
    {{"drucker_prager", // clay, undrained
      {{"E", 3e6},
       {"nu", 0.49},
       {"cohesion", 1e4},
       {"friction_deg", 0},
       {"dilation_deg", 0},
       {"density", 1.8e3},
       {"tensile_strength", 3e3}},
      {{"cone", "inscribed"}}},
     1e-2,
     2e-4,
     5e3},
    {{"mohr_coulomb",
      {{"E", 2e7},
       {"nu", 0.27},
       {"cohesion", 4e3},
       {"friction_deg", 31},
       {"dilation_deg", 9},
       {"density", 1.6e3},
       {"tensile_strength", 2e3}}},
     1e-3,
     1e-3,
     1e4},
    {{"mohr_coulomb", // dry sand, cohesionless
      {{"E", 5e7},
       {"nu", 0.2},
       {"cohesion", 0},
       {"friction_deg", 38},
       {"dilation_deg", 0},
       {"density", 1.6e3}}},
     2e-3,
     1e-3,
     1e5},
    {{"mohr_coulomb", // clay, undrained: Tresca
      {{"E", 3e6},
       {"nu", 0.49},
       {"cohesion", 1e4},
       {"friction_deg", 0},
       {"dilation_deg", 0},
       {"density", 1.8e3}}},
     1e-2,
     2e-4,
     5e3},
    {{"newtonian",
      {{"viscosity", 1e-3}, {"bulk_modulus", 2.2e9}, {"density", 1e3}}},
     1e-2,
     1e-9,
     1e3,
     1e-3},
    {{"herschel_bulkley", // bentonite
      {{"yield_stress", 12},
       {"consistency", 0.3},
       {"exponent", 0.8},
       {"regularisation", 1e-2},
       {"bulk_modulus", 2e6},
       {"density", 1.05e3}}},
     2e-2,
     1e-5,
     1e2,
     0.5},
    {{"herschel_bulkley", // Bingham
      {{"yield_stress", 1},
       {"consistency", 2},
       {"exponent", 1},
       {"regularisation", 1e-1},
       {"bulk_modulus", 1e3},
       {"density", 1}}},
     1,
     1e-2,
     0,
     1},
    {{"rigid", {{"stiffness", 1e12}, {"density", 7.8e3}}}, 1e-6, 1e-6},
    {{"void", {}}, 0.1, 0.1},
    // tight: what the sequence of sub-steps adds to differences is of the size
    // of the tolerance
    {{"hypoplastic",
      {{"grain_density", 2650}, {"void_ratio", 0.7}, {"tolerance", 1e-10}},
      {{"sand", "hochstetten"},
       {"intergranular_strain", "off"},
       {"integrator", "dp54"}}},
     1e-3,
     2e-4,
     1e5},
    {{"hypoplastic",
      {{"grain_density", 2650},
       {"relative_density", 0.3},
       {"tolerance", 1e-10}},
      {{"sand", "karlsruhe_fine"},
       {"intergranular_strain", "on"},
       {"integrator", "dp54"}}},
     1e-4,
     2e-5,
     3e4},
    {{"umat",
      {{"states", 0}, {"density", 1e3}},
      {{"library", UMATS "elastic.so"}},
      {{"props", {2.6e6, 0.3}}}},
     1e-2,
     1e-2},
    {{"umat",
      {{"states", 1}, {"density", 7.8e3}},
      {{"library", UMATS "mises.so"}},
      {{"props", {2.1e11, 0.29, 3e8, 4e9}}}},
     1.9e-3,
     2e-3},
};

/// Random numbers that any machine draws alike.
class Random
{
public:
  explicit Random(unsigned seed) : _engine(seed) {}

  /// In (-1, 1).
  double unit() { return 2.0 * (_engine() >> 11) / (1ull << 53) - 1.0; }

  /// A deviator; `shear` is the factor of the xy component.
  Voigt deviator(double size, double shear = 1)
  {
    const double x = unit(), y = unit(), z = unit();
    const double mean = (x + y + z) / 3;
    return size * Voigt(x - mean, y - mean, z - mean, shear * unit());
  }

private:
  std::mt19937_64 _engine;
};
} // namespace mmale::test
