// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
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
/// What dynamics offers to the forms, by the names in forms/inertia.py.
struct NewmarkInput
{
  double a_0[6], a_n[6], v_0[6], r_0[3];
};

/// What a cell offers to the forms, by the names in forms/balance.py.
struct CellInput
{
  double w[11];   ///< u, p of three vertices, bubble; end of the step
  double w_n[11]; ///< at its start
  double s[5];
  double theta, ln_J, mu, memory, lam, rho;
  double mu_b, rho_b, to_end; ///< of the bubble
  double u_n[2], grad_p[2];
  double ds_dh[25];
  double ds_dp[5];
  double dtheta_dh[5];
  double dtheta_dp;
  double dlam_dh[5];
  double dlam_dp;
  NewmarkInput newmark;
};

/// What a cell with seepage offers, by the names in forms/seepage.py, besides
/// those of CellInput.
struct SeepageInput
{
  CellInput cell;
  double p_w[3], p_w_n[3]; ///< end and start of the step
  double stored[3], dstored_dp[3];
  double compliance, mobility, share, radius;
  double size[4];
};

/// What a cell of n points offers, by the names in forms/points.py.
template <int n>
struct PointInput
{
  double w[11];
  double mu, rho;
  double s[5 * n];
  double excess[n];
  double ds_dh[25 * n];
  double ds_dp[5 * n];
  double dtheta_dh[5 * n];
  double dtheta_dp[n];
  NewmarkInput newmark;
};

/// The constants of the forms.
struct Constants
{
  double g[2] = {0, 0};
  double g_n[2] = {0, 0};
  double dt = 0;
  double t[2] = {0, 0};
  double p_a = 0;
  double z_p = 0, z_s = 0;
  double c_a = 0, c_v = 0, c_r = 0;
  double b = 0;
  double spring = 0;
  double rho_f = 0;
  double end = 1;
};

enum class IntegralKind
{
  cell,
  facet
};

/// One compiled form with its packing.
template <class Input>
class BasicKernel
{
public:
  /// @throws std::runtime_error when the form uses a name that is not offered,
  /// naming it and what there is.
  BasicKernel(const ufcx_form& form, IntegralKind kind);

  /// Add the element tensor to `A`.
  ///
  /// @param[in,out] A     row-major element tensor
  /// @param[in]     input the cell's numbers
  /// @param[in]     c     constants
  /// @param[in]     x     vertices, shape (3, 3) [m]
  /// @param[in]     facet local facet, for facet integrals
  void operator()(std::span<double> A, const Input& input, const Constants& c,
                  const double* x, int facet = 0) const;

private:
  struct Part
  {
    std::size_t offset; ///< bytes from the start of the struct
    int size;           ///< doubles
  };
  std::vector<decltype(ufcx_integral::tabulate_tensor_float64)> _functions;
  std::vector<Part> _coefficients, _constants;
};
using Kernel = BasicKernel<CellInput>;

/// The gradients of forms/strain.py: in the middle of a cell, or at n points.
///
/// @tparam     n 1 for the middle, 3 or 6 for the points
/// @param[in]  axisymmetric which of the two expressions
/// @param[in]  w displacement increment in MINI order, shape (11)
/// @param[in]  x vertices of the mid-step geometry, shape (3, 3) [m]
/// @param[out] G xx, xy, yx, yy, zz, shape (n, 5)
template <int n>
void mid_gradient(bool axisymmetric, const double* w, const double* x,
                  double* G);

/// Shares of the three vertices in a point of layout `quadrature`, as in
/// forms/mini.py.
template <int n>
const std::array<std::array<double, 3>, n>& points();
} // namespace mmale::lagrangian
