// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "hypoplastic_rate.h"
#include "law.h"

/// Hypoplastic sand along a line of strain, in sub-steps (METHOD.md, step 1a).
///
/// Time runs to 1 over the step, so that a strain rate is the step's strain.
namespace mmale::material::hypoplasticity
{
/// What the integration is to do.
struct Task
{
  Tensor<4> D;         ///< strain of the step
  double theta = 0;    ///< its trace
  double e = 0;        ///< void ratio at time 0
  double begin = 0;    ///< time to begin at
  double begin_D = 0;  ///< its derivative by theta
  bool grains = false; ///< with intergranular strain
  TangentKind kind = TangentKind::consistent;
  double tolerance = 0;
  double max_substeps = 0;
  std::string_view scheme; ///< a name of runge_kutta.h
};

/// State along the way, and its derivatives by the step's strain: true ones, M
/// at the end for `continuum`, or m_R L at the beginning for `robust`.
struct Track
{
  Tensor<4> T;       ///< stress, counted from the apex [Pa]
  Tensor<4> h;       ///< intergranular strain
  double opened = 0; ///< volume strain that the floor has let go
  Tensor2<4> T_D = Tensor2<4>::Zero();
  Tensor2<4> h_D = Tensor2<4>::Zero(); ///< only true ones
  Tensor<4> opened_D = Tensor<4>::Zero();
  Effort effort = {};
};

/// Void ratio at a time of the step: exact.
inline double void_ratio(const Task& task, double t)
{
  return (1 + task.e) * std::exp(task.theta * t) - 1;
}

/// From `task.begin` to 1.
/// @return reduce_step if it took too many sub-steps
Outcome integrate(const Sand& sand, const Task& task, Track& track);

/// Share of its deviator that keeps a stress within a Matsuoka-Nakai cone.
///
/// @param[in] I     I1 I2/I3 on the cone
/// @param[in] q     Td . Td of the deviator over the trace
/// @param[in] cubic tr Td^3
/// @return 1 inside
double share_in_cone(double I, double q, double cubic);

/// I1 I2/I3 on the cone of a friction angle.
inline double cone(double angle)
{
  const double s2 = std::sin(angle) * std::sin(angle);
  return (9 - s2) / (1 - s2);
}
} // namespace mmale::material::hypoplasticity
