// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element.h"

namespace mmale::lagrangian
{
/// Layout `mean`: one stress state a cell, from its mean strain.
///
/// The bubble only stabilises the pressure. It is linear in the residual, so
/// it is eliminated exactly and has no state: for a residual the two bubble
/// columns are enough.
class MeanElement final : public Element
{
public:
  MeanElement(const mesh::Domain& domain, const material::AnyLaw& law,
              scene::Symmetry symmetry, const scene::Solver& options);

  void begin_step(const State& state, double dt) override;
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
  double ln_J(int cell) const override { return _cell[cell].motion.ln_J; }
  std::array<double, 2> mismatch_squared(const State& state,
                                         int cell) const override;
  double strain_squared(int cell) const override;
  material::Effort effort() const override;

private:
  struct Cell
  {
    Gradient G;
    Motion motion;
    material::Driven answer;
    double guess; ///< of the volume strain, or NaN
    Voigt s;      ///< deviator at the end, turned
    double p;     ///< mean pressure at the end
  };
  /// The kernels that dynamics adds.
  struct Inertia
  {
    Kernel R, J, B, R_damping, J_damping;
  };
  void accept_stress(State& state) const override;
  const char* strain_cell(const State& state, int cell,
                          std::span<const double> z);
  void gather(const State& state, int cell, std::span<const double> z,
              CellInput& in, double* x) const;
  void add_tangent(int cell, CellInput& in) const;
  void use_cell_pressure(int cell, CellInput& in) const;
  void project_pressure(int cell, const CellInput& in, double* R,
                        double* J) const;
  double cell_pressure(int cell) const;

  Kernel _R, _J, _B;
  Inertia _inertia;
  std::vector<Cell> _cell;
};
} // namespace mmale::lagrangian
