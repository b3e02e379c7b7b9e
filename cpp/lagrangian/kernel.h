// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>
#include <ufcx.h>
#include <vector>

/// FFCx kernels, called with their coefficients found by name.
///
/// A form in forms/ may use any of the names below and no other, in any order;
/// what it does not use is not copied.
namespace mmale::lagrangian
{
/// What a cell offers to the forms, by the names in forms/balance.py.
struct CellInput
{
  double w[11];   ///< u, p of three vertices, bubble; end of the step
  double w_n[11]; ///< at its start
  double s[5];
  double theta, ln_J, mu, lam, rho;
  double ds_dh[25];
  double ds_dp[5];
  double dtheta_dh[5];
  double dtheta_dp;
  double dlam_dh[5];
  double dlam_dp;
};

/// The constants of forms/balance.py and forms/load.py.
struct Constants
{
  double g[2] = {0, 0};
  double g_n[2] = {0, 0};
  double dt = 0;
  double t[2] = {0, 0};
  double p_a = 0;
};

enum class IntegralKind
{
  cell,
  facet
};

/// One compiled form with its packing.
class Kernel
{
public:
  /// @throws std::runtime_error when the form uses a name that is not offered,
  /// naming it and what there is.
  Kernel(const ufcx_form& form, IntegralKind kind);

  /// Add the element tensor to `A`.
  ///
  /// @param[in,out] A     row-major element tensor
  /// @param[in]     input the cell's numbers
  /// @param[in]     c     constants
  /// @param[in]     x     vertices, shape (3, 3) [m]
  /// @param[in]     facet local facet, for facet integrals
  void operator()(std::span<double> A, const CellInput& input,
                  const Constants& c, const double* x, int facet = 0) const;

private:
  struct Part
  {
    std::size_t offset; ///< bytes from the start of the struct
    int size;           ///< doubles
  };
  std::vector<decltype(ufcx_integral::tabulate_tensor_float64)> _functions;
  std::vector<Part> _coefficients, _constants;
  int _w_size = 0, _c_size = 0;
};

/// The mid-cell gradient of forms/strain.py.
///
/// @param[in]  axisymmetric which of the two expressions
/// @param[in]  w displacement increment in MINI order, shape (11)
/// @param[in]  x vertices of the mid-step geometry, shape (3, 3) [m]
/// @param[out] G xx, xy, yx, yy, zz
void mid_gradient(bool axisymmetric, const double* w, const double* x,
                  double* G);
} // namespace mmale::lagrangian
