// SPDX-License-Identifier: LGPL-3.0-or-later
#include "hypoplastic.h"

namespace mmale::material
{
namespace
{
/// One row of the usual table; h_s in Pa.
ParameterSet row(std::string_view name, std::string_view source,
                 std::array<double, 13> v)
{
  return {name,
          source,
          {{"phi_c_deg", v[0]},
           {"h_s", v[1]},
           {"n", v[2]},
           {"e_d0", v[3]},
           {"e_c0", v[4]},
           {"e_i0", v[5]},
           {"alpha", v[6]},
           {"beta", v[7]},
           {"m_R", v[8]},
           {"m_T", v[9]},
           {"R", v[10]},
           {"beta_R", v[11]},
           {"chi", v[12]}}};
}
} // namespace

std::span<const ParameterSet> Hypoplastic::sets()
{
  static const std::array known{
      row("hochstetten",
          "Herle & Gudehus (1999), Niemunis & Herle (1997), as quoted in the "
          "documentation of OpenSees",
          {33, 1.0e9, 0.25, 0.55, 0.95, 1.05, 0.25, 1.50, 5, 2, 1e-4, 0.5, 6}),
      row("hostun",
          "Herle & Gudehus (1999), as in the tests of Kratos' material point "
          "method (phi_c = 31 degrees in the table, by memory)",
          {34, 1.0e9, 0.29, 0.61, 0.96, 1.09, 0.13, 2.0, 5, 2, 1e-4, 0.5, 6}),
      row("hostun_rf", "examples of the xMat library (TU Hamburg)",
          {33, 1.0e9, 0.29, 0.63, 1.00, 1.15, 0.13, 2.0, 5, 2, 1e-4, 0.5, 6}),
      row("toyoura",
          "Herle & Gudehus (1999), as in the tester of the xMat library (TU "
          "Hamburg)",
          {30, 2.6e9, 0.27, 0.61, 0.98, 1.10, 0.18, 1.0, 5, 2, 1e-4, 0.5, 6}),
      row("karlsruhe_fine", "tests of the xMat library (TU Hamburg)",
          {33.1, 4.0e9, 0.27, 0.677, 1.054, 1.212, 0.14, 2.5, 2.2, 1.1, 1e-4,
           0.1, 5.5}),
      row("karlsruhe_fine_alt",
          "example input of P. Staubach's abaqus-implicit (there with nu = "
          "0.37, which this law has not)",
          {33.1, 4.0e9, 0.27, 0.677, 1.054, 1.212, 0.14, 2.5, 2.4, 1.2, 1e-4,
           0.1, 6}),
      row("karlsruhe",
          "NOT VERIFIED: Herle & Gudehus (1999) by memory; intergranular "
          "strain: usual values",
          {30, 5.8e9, 0.28, 0.53, 0.84, 1.00, 0.13, 1.05, 5, 2, 1e-4, 0.5, 6}),
      row("zbraslav",
          "NOT VERIFIED: Herle & Gudehus (1999) by memory; intergranular "
          "strain: usual values",
          {31, 5.7e9, 0.25, 0.52, 0.82, 0.95, 0.13, 1.0, 5, 2, 1e-4, 0.5, 6}),
  };
  return known;
}
} // namespace mmale::material
