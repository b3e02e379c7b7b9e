// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <optional>
#include <string>
#include <vector>

/// An element test as the user asked for it, as plain data.
///
/// Signs of soil mechanics throughout: stresses and normal strains are
/// positive in compression. Axial (a) is y, radial (r) is x, tangential (t)
/// is z, as in an axisymmetric scene; tau and gamma belong to xy. Strains are
/// logarithmic: integrals of the stretching.
namespace mmale::element
{
using scene::required;

/// The sample before the first path.
struct Initial
{
  std::optional<double> pressure;   ///< effective, isotropic [Pa]; or
  std::optional<double> sigma_a;    ///< axial effective stress [Pa], with
  std::optional<double> k0;         ///< sigma_r / sigma_a [-]
  std::optional<double> void_ratio; ///< [-]; none: by the material's own keys
};

/// Measured points that the test is held against.
struct Data
{
  std::string file = {};   ///< columns named as in curves.csv
  std::string folder = {}; ///< where a relative `file` starts; no key: the
                           ///< reader puts the test's own folder
  std::string x = {};      ///< abscissa; "": the file's first column
};

/// One loading. Strains count from its start; stresses are those at its end,
/// effective ones, but total ones where it is undrained.
struct Path
{
  std::string name;
  std::string kind; ///< isotropic | oedometric | triaxial | simple_shear | free
  std::string drainage = "drained"; ///< "undrained": the volume is constant
  std::string hold = "sigma_r";     ///< or "p", of a triaxial path
  std::optional<double> pressure, q;
  std::optional<double> eps_v;
  std::optional<double> eps_a, eps_r, eps_t, gamma;
  std::optional<double> sigma_a, sigma_r, sigma_t, tau;
  double cycles = 0;   ///< in quarters; the target is then an amplitude about
                       ///< the value at the start; 0: one way
  int steps = 100;     ///< of the path, or of each cycle
  double duration = 1; ///< of the path [s]
};

/// Knobs of the driver.
struct Solver
{
  double tolerance = 1e-9; ///< doubled: stresses that are prescribed are met
                           ///< half as well
  scene::Tangent tangent = scene::Tangent::consistent;
};

struct Test
{
  std::string title;
  scene::Material material;
  Initial initial;
  std::vector<Path> path;
  std::optional<Data> data;
  Solver solver;
};
} // namespace mmale::element
