// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include "state.h"
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>

/// The solver's own parts on a small body, for tests, on one process.
namespace mmale::test
{
/// What a step said.
struct Taken
{
  bool ok = false;
  int iterations = 0;
  std::vector<double> residuals; ///< relative, one an iteration
  std::string cause;             ///< when it failed
  std::int64_t cell = -1;
  std::array<double, 2> place = {0, 0};
  explicit operator bool() const { return ok; }
};

/// A body that is made from a scene and taken through steps, either by the
/// solver (`step`) or cell by cell with unknowns that the test chooses.
class Body
{
public:
  explicit Body(scene::Scene scene);
  ~Body();
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  State& state();
  int num_nodes() const;
  int num_cells() const;
  std::array<int, 3> cell(int c) const;
  std::vector<int> nodes(const std::string& boundary) const;
  int node(double x, double y) const; ///< nearest at the start

  /// Ground at rest under its weight, in the scene's first stage; the largest
  /// force on a free node over the weight, as laid and as settled.
  std::array<double, 2> settle();

  /// The solver: Newton on the conditions of a stage.
  void set_stage(const scene::Stage& stage);
  [[nodiscard]] Taken step(double t0, double t1);
  std::array<double, 2> reaction(const std::string& boundary) const;
  double discharge(const std::string& boundary) const; ///< [m3/s/m]
  std::array<double, 2> mismatch() const; ///< RMS of P - p, theta - ln J
  double kinetic_energy();                ///< of a dynamic stage [J/m]
  void rebalance(double t);               ///< as after a remap

  /// Cell by cell, at unknowns z = (ux, uy, p) a node.
  [[nodiscard]] bool evaluate(std::span<const double> z);
  void begin_iteration(std::span<const double> z);
  /// Constants of the forms, and inertia over a step of `dt`.
  void set_gravity(std::array<double, 2> start, std::array<double, 2> end);
  void set_dynamics(const scene::Dynamics& scheme, double dt);
  std::array<double, 9> residual(int c, std::span<const double> z) const;
  std::array<double, 81> jacobian(int c, std::span<const double> z) const;
  /// Before condensation: 11 and 11 x 11 numbers, the bubble's two last.
  void full(int c, std::span<const double> z, std::span<double> R,
            std::span<double> J) const;
  void accept(std::span<const double> z);
  double volume(int c) const;

private:
  struct Parts;
  std::unique_ptr<Parts> _parts;
};

/// A rectangle of nx x ny quadrilaterals cut in two, of one material.
scene::Scene rectangle(double width, double height, int nx, int ny,
                       std::string law,
                       std::map<std::string, double> parameters);

/// Layout `mean` for 1 point a cell, else `quadrature`.
void use_points(scene::Scene& scene, int points);

/// A constant over the stage.
inline scene::TimeSeries constant(double value)
{
  return {{}, {value}};
}

/// From 0 to `value` over `duration`.
inline scene::TimeSeries ramp(double value, double duration = 1)
{
  return {{0, duration}, {0, value}};
}

/// A stage without conditions.
scene::Stage stage(double duration = 1, double step = 1);

/// Newton on the element itself, with the displacement of every boundary node
/// prescribed by a function of the place at the start of the step. The body is
/// advanced to the end of the step.
///
/// @return relative size of the last update, NaN if a cell failed
double solve_prescribed(
    Body& body,
    const std::function<std::array<double, 2>(double x, double y)>& u);

/// Largest of |v|.
double largest(std::span<const double> v);
} // namespace mmale::test
