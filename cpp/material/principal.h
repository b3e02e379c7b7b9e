// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "law.h"

/// Principal values of a stress xx, yy, zz, xy and the way back.
///
/// zz is always one of them; a and b are those of the plane, a >= b.
namespace mmale::material
{
using Principal = Eigen::Vector3d;  ///< a, b, zz
using Principal2 = Eigen::Matrix3d; ///< derivatives of one by another

class PrincipalAxes
{
public:
  explicit PrincipalAxes(const Voigt& t)
  {
    const double half = 0.5 * (t[0] - t[1]);
    const double mean = 0.5 * (t[0] + t[1]);
    _radius = std::hypot(half, t[3]);
    if (_radius > 0)
    {
      _cos2 = half / _radius;
      _sin2 = t[3] / _radius;
    }
    _values = {mean + _radius, mean - _radius, t[2]};
  }

  const Principal& values() const { return _values; }

  /// Half the difference of a and b.
  double radius() const { return _radius; }

  /// A stress with these axes and values.
  Voigt assemble(const Principal& v) const
  {
    const double mean = 0.5 * (v[0] + v[1]), half = 0.5 * (v[0] - v[1]);
    return {mean + half * _cos2, mean - half * _cos2, v[2], half * _sin2};
  }

  /// Derivative of a stress by a strain with engineering shear.
  ///
  /// @param[in] C     derivative of the values by principal strains [Pa]
  /// @param[in] shear that of the shear stress in these axes by the
  ///                  engineering shear strain in them [Pa]
  Voigt2 assemble(const Principal2& C, double shear) const
  {
    // columns: how a, b, zz and the shear between a and b look in xx yy zz xy
    Voigt2 Q = Voigt2::Zero();
    Q.col(0) << 0.5 * (1 + _cos2), 0.5 * (1 - _cos2), 0, 0.5 * _sin2;
    Q.col(1) << 0.5 * (1 - _cos2), 0.5 * (1 + _cos2), 0, -0.5 * _sin2;
    Q(2, 2) = 1;
    Q.col(3) << -_sin2, _sin2, 0, _cos2;
    Voigt2 inner = Voigt2::Zero();
    inner.topLeftCorner<3, 3>() = C;
    inner(3, 3) = shear;
    return Q * inner * Q.transpose();
  }

private:
  Principal _values;
  double _radius, _cos2 = 1, _sin2 = 0;
};
} // namespace mmale::material
