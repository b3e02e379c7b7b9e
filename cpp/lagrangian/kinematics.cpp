// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kinematics.h"

namespace mmale::lagrangian
{
namespace
{
/// dG/dh: G = du,mid and h is a gradient on the end geometry, so that
/// dG = (I - G/2) h (I + G/2), hoop likewise.
Gradient2 mid_from_end(const Gradient& G)
{
  Eigen::Matrix2d left, right;
  left << 1 - G[0] / 2, -G[1] / 2, -G[2] / 2, 1 - G[3] / 2;
  right << 1 + G[0] / 2, G[1] / 2, G[2] / 2, 1 + G[3] / 2;
  Gradient2 Q = Gradient2::Zero();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l)
          Q(2 * i + j, 2 * k + l) = left(i, k) * right(l, j);
  Q(4, 4) = (1 - G[4] / 2) * (1 + G[4] / 2);
  return Q;
}

/// sigma tr(h) - sigma h^T: the integrand's change with the geometry.
Gradient2 geometric_stiffness(const Voigt& s, double p)
{
  const double xx = s[0] - p, yy = s[1] - p, zz = s[2] - p, xy = s[3];
  const Gradient sigma = (Gradient() << xx, xy, xy, yy, zz).finished();
  Gradient2 K = Gradient2::Zero();
  for (int i : {0, 3, 4})
    K.col(i) += sigma;
  // (sigma h^T)_ij = sigma_ik h_jk
  const Eigen::Matrix2d S{{xx, xy}, {xy, yy}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k)
        K(2 * i + j, 2 * j + k) -= S(i, k);
  K(4, 4) -= zz;
  return K;
}
} // namespace

CellTangent tangent(const Gradient& G, const Motion& m, const Driven& law,
                    const Voigt& s, double p, bool geometric)
{
  const Gradient2 Q = mid_from_end(G);
  Eigen::Matrix<double, 4, 5> deviator;       // of the strain, by G
  deviator << 2. / 3, 0, 0, -1. / 3, -1. / 3, //
      -1. / 3, 0, 0, 2. / 3, -1. / 3,         //
      -1. / 3, 0, 0, -1. / 3, 2. / 3,         //
      0, 1, 1, 0, 0;
  const Eigen::RowVector<double, 5> spin{0, -0.5, 0.5, 0, 0};

  // half a step's rotation, by G
  const Eigen::RowVector<double, 5> angle =
      spin * (0.5 / (1 + 0.25 * m.spin * m.spin)) * Q;
  // An isotropic law turns with its input; so turning the start stress alone
  // is turning the answer, and the strain back.
  const Eigen::Matrix<double, 4, 5> de =
      deviator * Q - spun_strain(m.de) * angle;
  const Eigen::Matrix<double, 4, 5> ds_mid = law.ds_de * de;

  CellTangent t;
  Eigen::Matrix<double, 4, 5> ds;
  for (int k = 0; k < 5; ++k)
    ds.col(k) = rotate(ds_mid.col(k), m.cosine, m.sine);
  ds += 2 * spun(s) * angle;
  for (int k = 0; k < 5; ++k)
    t.ds_dh.col(k) = expand(ds.col(k));
  if (geometric)
    t.ds_dh += geometric_stiffness(s, p);
  t.ds_dp = expand(rotate(law.ds_dp, m.cosine, m.sine));

  t.dtheta_dh = de.transpose() * law.dtheta_de;
  t.dflow_dh = de.transpose() * law.dflow_de;
  for (int i : {0, 3, 4}) // of theta - ln J, and of the volume it fills
    t.dtheta_dh[i] += -1 + (geometric ? law.theta - m.ln_J : 0);
  return t;
}
} // namespace mmale::lagrangian
