// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/drive.h"
#include <Eigen/Core>
#include <cmath>

/// Time-centred kinematics of a step (METHOD.md, step 1a).
///
/// In: G, the gradient of the displacement increment on the mid-step geometry.
/// Out: deviatoric strain increment, rotation over half a step, volume strain;
/// and the chain rule from the laws' derivatives to those by the gradient on
/// the end geometry, which is what the forms take.
/// @source Hughes & Winget, Int. J. Numer. Meth. Engng 15 (1980) 1862
namespace mmale::lagrangian
{
using material::Driven;
using material::Voigt;
using material::Voigt2;

/// Components xx, xy, yx, yy, zz, as in the forms.
using Gradient = Eigen::Matrix<double, 5, 1>;
using Gradient2 = Eigen::Matrix<double, 5, 5>;

/// Strain, rotation and volume ratio of a cell over a step.
struct Motion
{
  Voigt de;      ///< deviator of sym G, engineering shear [-]
  double spin;   ///< (G_yx - G_xy) / 2 [-]
  double cosine; ///< of the rotation over half the step
  double sine;
  double ln_J; ///< logarithm of the volume ratio; NaN when inverted
};

/// Motion from the mid-step gradient; ln J has full relative precision however
/// small the step is.
inline Motion motion(const Gradient& G)
{
  const double mean = (G[0] + G[3] + G[4]) / 3;
  const double spin = 0.5 * (G[2] - G[1]);
  const double hyp = std::sqrt(1 + 0.25 * spin * spin);
  // f = (I - G/2)^-1 (I + G/2), so J is a ratio of two determinants
  const double trace = G[0] + G[3];
  const double det = G[0] * G[3] - G[1] * G[2];
  const double ln_J = std::log1p(0.5 * trace + 0.25 * det)
                      - std::log1p(-0.5 * trace + 0.25 * det)
                      + std::log1p(0.5 * G[4]) - std::log1p(-0.5 * G[4]);
  return {Voigt(G[0] - mean, G[3] - mean, G[4] - mean, G[1] + G[2]), spin,
          1 / hyp, 0.5 * spin / hyp, ln_J};
}

/// R s R^T for the rotation (cosine, sine) about z.
inline Voigt rotate(const Voigt& s, double c, double t)
{
  return {c * c * s[0] + t * t * s[1] - 2 * c * t * s[3],
          t * t * s[0] + c * c * s[1] + 2 * c * t * s[3], s[2],
          c * t * (s[0] - s[1]) + (c * c - t * t) * s[3]};
}

/// Rate of R s R^T with the angle, at angle zero.
inline Voigt spun(const Voigt& s)
{
  return {-2 * s[3], 2 * s[3], 0, s[0] - s[1]};
}

/// The same for a strain with engineering shear.
inline Voigt spun_strain(const Voigt& e)
{
  return {-e[3], e[3], 0, 2 * (e[0] - e[1])};
}

/// A symmetric tensor in the forms' components.
inline Gradient expand(const Voigt& s)
{
  return (Gradient() << s[0], s[3], s[3], s[1], s[2]).finished();
}

/// What the forms take of a cell.
struct CellTangent
{
  Gradient2 ds_dh;
  Gradient ds_dp;
  Gradient dtheta_dh;
  Gradient dflow_dh;
};

/// Chain rule from the law's frame to the end geometry.
///
/// @param[in] G         mid-step gradient
/// @param[in] m         motion(G)
/// @param[in] law       the law's answer, in the mid-step frame
/// @param[in] s         deviator at the end, law.s rotated by half a step [Pa]
/// @param[in] p         pressure at the end [Pa]
/// @param[in] geometric with the change of the integration domain
CellTangent tangent(const Gradient& G, const Motion& m, const Driven& law,
                    const Voigt& s, double p, bool geometric);
} // namespace mmale::lagrangian
