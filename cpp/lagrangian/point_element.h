// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element.h"

namespace mmale::lagrangian
{
/// Layout `quadrature`: one stress state at each of n points of a cell, whose
/// strain includes the bubble (METHOD.md, 1 Lagrangian step).
///
/// The bubble is an increment, zero when a step begins. Each trial finds it
/// anew: from the blocks of the last tangent,
///
///     b = b_k - K_bb^-1 (r_b + K_bn (z - z_k)),
///
/// which is all in an elastic cell, and then by Newton on the cell's own two
/// equations, so that residual and line search see a function of the nodal
/// unknowns alone. (With the first alone, the residual along a line does not
/// return to its start, and line searches stall in plastic flow.)
template <int n>
class PointElement final : public Element
{
public:
  PointElement(const mesh::Domain& domain,
               std::span<const material::AnyLaw> laws, scene::Symmetry symmetry,
               const scene::Solver& options,
               const std::optional<scene::Water>& water);

  void begin_step(const State& state, double dt) override;
  void begin_iteration(std::span<const double> z) override;
  int evaluate(const State& state, std::span<const double> z,
               const Constants& c, std::string& why) override;
  void residual(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* R) override;
  void jacobian(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* J) override;
  std::array<double, 6> forces(const State& state, int cell,
                               std::span<const double> z,
                               const Constants& c) const override;
  void full(const State& state, int cell, std::span<const double> z,
            const Constants& c, std::span<double> R11,
            std::span<double> J121) const override;
  double ln_J(int cell) const override { return _cell[cell].ln_J; }
  std::array<double, 2> mismatch_squared(const State& state,
                                         int cell) const override;
  double strain_squared(int cell) const override;
  material::Effort effort(int cell) const override;

private:
  /// Of a bubble's equation; elastic cells take one. Doubled: nothing.
  static constexpr int max_bubble_iterations = 25;
  /// Force left on a bubble, in parts of the cell's. Doubled: less digits.
  static constexpr double bubble_tolerance = 1e-11;
  using Numbers9 = std::array<double, 9>;
  struct Point
  {
    Gradient G;
    Motion motion;
    material::Driven answer;
    double guess; ///< of the volume strain, or NaN
    Voigt s;      ///< deviator at the end, turned
    double p;     ///< pressure at the end
  };
  struct Cell
  {
    std::array<Point, n> point;
    double ln_J = 0;         ///< of the nodes' motion
    double bubble[2] = {};   ///< now
    double bubble_k[2] = {}; ///< at the last iteration
    double force[2] = {};    ///< r_b now
    double force_k[2] = {};  ///< and at the last iteration
    Numbers9 z_k{};          ///< unknowns at the last iteration
    bool has_blocks = false;
    Condensation K_bb; ///< of the last tangent
    Numbers9 K_bn[2];  ///< likewise
  };
  void accept_stress(State& state) const override;
  Numbers9 nodal(int cell, std::span<const double> z) const;
  void foresee_bubble(Cell& cell, const Numbers9& z) const;
  const char* answer(const State& state, int c, std::span<const double> z,
                     double dt);
  const char* balance_bubble(const State& state, int c,
                             std::span<const double> z,
                             const Constants& constants);
  double size_squared(int c) const;
  const char* strain_cell(const State& state, int c, std::span<const double> z);
  void gather(const State& state, int cell, std::span<const double> z,
              PointInput<n>& in, double* x) const;
  void add_tangent(int cell, PointInput<n>& in) const;
  std::array<double, 11> residual_of(const State& state, int c,
                                     std::span<const double> z,
                                     const Constants& constants) const;
  void tangent_of(const State& state, int c, std::span<const double> z,
                  const Constants& constants, double* A) const;
  void keep_blocks(Cell& cell, const double* A);

  using KernelN = BasicKernel<PointInput<n>>;
  KernelN _R, _J, _R_damping, _J_damping;
  std::vector<Cell> _cell;
};

extern template class PointElement<3>;
extern template class PointElement<6>;
} // namespace mmale::lagrangian
