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
              scene::Symmetry symmetry, const scene::Solver& options,
              const std::optional<scene::Water>& water);

  void begin_step(const State& state, double dt) override;
  int evaluate(const State& state, std::span<const double> z,
               const Constants& c, std::string& why) override;
  void residual(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* R) override;
  void jacobian(const State& state, int cell, std::span<const double> z,
                const Constants& c, double* J) override;
  FlowRow flow(const State& state, int cell, std::span<const double> z,
               const Constants& c) override;
  FlowTangent flow_tangent(const State& state, int cell,
                           std::span<const double> z,
                           const Constants& c) override;
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
  material::Effort effort(int cell) const override;

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
  /// What seepage adds.
  struct Flow
  {
    BasicKernel<SeepageInput> R, by_pore_pressure, by_nodes, of_momentum,
        of_bubble, R_consistent, by_pore_pressure_consistent;
    bool consistent;                ///< storage, not lumped
    double mobility;                ///< [m2/(Pa s)]
    std::vector<double> compliance; ///< of the cells in this step [1/Pa]
    double carried[18];             ///< K_nb K_bb^-1 of the last jacobian
  };
  /// The kernels that dynamics adds.
  struct Inertia
  {
    Kernel R, J, B, R_damping, J_damping;
  };
  /// A fluid's bubble in this step.
  struct Bubble
  {
    double mu;                  ///< shear modulus that holds it [Pa]
    double rho;                 ///< density [kg/m3]
    std::array<double, 2> u_n;  ///< its place at the start, as remembered [m]
    std::array<double, 2> grad; ///< of p at the start [Pa/m]
  };
  void accept_stress(State& state) const override;
  void begin_bubbles(const State& state);
  void place_bubbles(const State& state, const Constants& c);
  void hold_bubble(int cell, CellInput& in) const;
  const char* strain_cell(const State& state, int cell,
                          std::span<const double> z);
  void gather(const State& state, int cell, std::span<const double> z,
              CellInput& in, double* x) const;
  void gather_bubble(const State& state, int cell, CellInput& in) const;
  void add_tangent(int cell, CellInput& in) const;
  void use_cell_pressure(int cell, CellInput& in) const;
  void project_pressure(int cell, const CellInput& in, double* R,
                        double* J) const;
  double cell_pressure(int cell) const;
  void make_flow(const scene::Water& water);
  void gather_flow(const State& state, int cell, std::span<const double> z,
                   SeepageInput& in, double* x) const;
  void measure_flow(int cell, const SeepageInput& in, const double* x,
                    const Constants& c, FlowRow& row) const;

  Kernel _R, _J, _B;
  Inertia _inertia;
  std::unique_ptr<Flow> _flow; ///< with seepage
  std::vector<Cell> _cell;
  std::vector<Bubble> _bubble; ///< of a fluid
  bool _placed = false;        ///< bubbles at the start of this step
};
} // namespace mmale::lagrangian
