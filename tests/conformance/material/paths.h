// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "samples.h"

#include <Eigen/Dense>
#include <catch2/catch_test_macros.hpp>

/// Points of a material on their way through strains and stresses.
namespace mmale::test
{
using material::Response;
using material::Voigt2;

/// A point and the whole stress at it, tension positive.
struct Body
{
  Voigt s = Voigt::Zero();
  double p = 0;
  std::vector<double> q = {};

  Voigt sigma() const { return s - p * Voigt(1, 1, 1, 0); }
};

inline Body body(const Voigt& sigma)
{
  const double p = -sigma.head<3>().sum() / 3;
  return {sigma + p * Voigt(1, 1, 1, 0), p};
}

/// Answer to a strain increment with engineering shear.
template <class L>
Response answer(const L& law, const Body& from, const Voigt& strain,
                std::vector<double>& q, double dt = 1,
                material::TangentKind kind = material::TangentKind::consistent)
{
  const double theta = strain.head<3>().sum();
  const Voigt de = strain - theta / 3 * Voigt(1, 1, 1, 0);
  Response r;
  q = from.q;
  // not a REQUIRE: there are a million of these
  if (law.update({from.s, from.p, from.q}, {de, theta, dt}, kind, q, r)
      != material::Outcome::ok)
    FAIL("the law asks for a smaller step");
  return r;
}

template <class L>
Response answer(const L& law, const Body& from, const Voigt& strain,
                double dt = 1)
{
  std::vector<double> q;
  return answer(law, from, strain, q, dt);
}

template <class L>
Response advance(const L& law, Body& body, const Voigt& strain, double dt = 1)
{
  std::vector<double> q;
  const Response r = answer(law, body, strain, q, dt);
  body = {r.s, r.p, q};
  return r;
}

/// Derivative of the whole stress by the strain.
inline Voigt2 stiffness(const Response& r)
{
  const Voigt one(1, 1, 1, 0);
  const Voigt2 deviator =
      Voigt2::Identity() - one * one.transpose() / 3; // of a strain
  return (r.ds_de - one * r.dp_de.transpose()) * deviator
         + (r.ds_dtheta - r.dp_dtheta * one) * one.transpose();
}

/// A step in which some strains are given and the other stresses are held.
///
/// @param[in,out] strain increment; entries in `held` are found
/// @param[in]     held   components whose stress stays at `target`
template <class L>
void mixed_step(const L& law, Body& body, Voigt strain,
                const std::vector<int>& held, const Voigt& target,
                Voigt* found = nullptr)
{
  const int n = static_cast<int>(held.size());
  double left = 0;
  for (int i = 0; i < 60; ++i)
  {
    const Response r = answer(law, body, strain);
    const Voigt sigma = r.s - r.p * Voigt(1, 1, 1, 0);
    const Voigt2 C = stiffness(r);
    Eigen::VectorXd gap(n);
    Eigen::MatrixXd A(n, n);
    for (int a = 0; a < n; ++a)
    {
      gap[a] = sigma[held[a]] - target[held[a]];
      for (int b = 0; b < n; ++b)
        A(a, b) = C(held[a], held[b]);
    }
    left = gap.norm();
    if (left < 1e-12 * (sigma.norm() + target.norm()))
      break;
    const Eigen::VectorXd step = A.colPivHouseholderQr().solve(gap);
    for (int a = 0; a < n; ++a)
      strain[held[a]] -= step[a];
  }
  INFO("stress left " << left);
  REQUIRE(left < 1e-8 * (target.norm() + body.sigma().norm() + 1));
  advance(law, body, strain);
  if (found)
    *found = strain;
}

/// A step of a triaxial test: axial strain given, lateral pressure held.
/// (Its two lateral strains are tied: on an edge of a surface a stress does
/// not say how they differ.)
/// @return the lateral strain
template <class L>
double triaxial_step(const L& law, Body& body, double axial, double lateral)
{
  double low = -1, high = 1;
  for (int i = 0; i < 200; ++i)
  {
    const double mid = (low + high) / 2;
    const Response r = answer(law, body, Voigt(mid, axial, mid, 0));
    (r.s[0] - r.p > -lateral ? high : low) = mid;
  }
  advance(law, body, Voigt(low, axial, low, 0));
  return low;
}

/// Principal stresses, the largest first, by another way than the law's.
inline Eigen::Vector3d principal(const Voigt& t)
{
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 0) = t[0];
  m(1, 1) = t[1];
  m(2, 2) = t[2];
  m(0, 1) = m(1, 0) = t[3];
  const Eigen::Vector3d v =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues();
  return v.reverse();
}

/// R t R^T; `shear` is 1 for a stress, 1/2 for a strain with 2 eps_xy.
inline Voigt turned(const Voigt& t, double angle, double shear)
{
  const double c = std::cos(angle), s = std::sin(angle);
  const double xy = shear * t[3];
  return {c * c * t[0] + s * s * t[1] - 2 * c * s * xy,
          s * s * t[0] + c * c * t[1] + 2 * c * s * xy, t[2],
          (c * s * (t[0] - t[1]) + (c * c - s * s) * xy) / shear};
}

/// Product of a stress and a strain with engineering shear.
inline double work(const Voigt& stress, const Voigt& strain)
{
  return stress.dot(strain);
}

/// Strain that goes elastically with a stress.
inline Voigt compliance(double E, double nu, const Voigt& t)
{
  return Voigt(t[0] - nu * (t[1] + t[2]), t[1] - nu * (t[2] + t[0]),
               t[2] - nu * (t[0] + t[1]), 2 * (1 + nu) * t[3])
         / E;
}
} // namespace mmale::test
