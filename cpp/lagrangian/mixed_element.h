// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "material/closure.h"
#include "mean_element.h"

namespace mmale::lagrangian
{
/// Layout `mean` with several materials, which may share cells (METHOD.md,
/// Mixed cells).
///
/// A pure cell is that of its material. In a mixed one the closure answers for
/// all materials together. Void bears nothing: a cell that it shares with one
/// body is integrated over the body's part alone, at its centroid, so that the
/// free surface lies where it is within the cell; between two bodies it is a
/// gap, which closes before they press on each other, and bears no tension.
class MixedElement final : public MeanElement
{
public:
  MixedElement(const mesh::Domain& domain,
               std::span<const material::AnyLaw> laws, scene::Symmetry symmetry,
               const scene::Solver& options);

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
  void accept(State& state, std::span<const double> z, double dt) override;
  material::Moduli moduli(const State& state, int cell, double dt,
                          Meets what = Meets::slow_step) const override;
  bool present(const State& state, int cell) const override;
  bool bears(const State& state, int cell) const override;

private:
  /// A cell that several materials share, the void among them.
  struct Mixture
  {
    int row = 0;                ///< of the state's materials
    double fill = 1;            ///< of the cell's volume, by what bears load
    double bodies = 1;          ///< of it, by all that is not void
    bool spray = false;         ///< too little of bodies to bear anything
    bool gap = false;           ///< void between two bodies
    bool open = false;          ///< in this trial state
    double centre[3] = {};      ///< of what bears load: shares of the vertices
    double mass_centre[3] = {}; ///< of the mass
  };
  /// A material's part in the trial state.
  struct PartEnd
  {
    Voigt s;      ///< turned [Pa]
    double p;     ///< [Pa]
    double theta; ///< [-]
    double guess; ///< of theta, or NaN
  };
  void find_cells(const State& state);
  std::array<double, 3> shares_at(const State& state, int cell,
                                  const bridge::Part& part) const;
  void find_mixture(const State& state, int cell, Mixture& m) const;
  const char* answer_mixture(const State& state, int cell,
                             std::span<const double> z, double dt);
  material::Interface find_interface(const State& state, int cell,
                                     const Mixture& m) const;
  double ersatz(const State& state, int cell) const;
  void take_parts(const State& state, int cell);
  void bear_nothing(const State& state, int cell);
  void fill_shares(const State& state, const Mixture& m, const Motion& motion);
  bool is_void(int material) const { return _media[material].is_void(); }
  void add_tangent(int cell, CellInput& in) const override;
  void gather(const State& state, int cell, std::span<const double> z,
              CellInput& in, double* x) const override;
  const Balance& balance(int cell) const override;
  bool has_bubble(int cell) const override
  {
    return MeanElement::has_bubble(cell)
           and (_of_cell[cell] < 0 or not _mixture[_of_cell[cell]].open);
  }
  /// Cells change hands: a fluid's bubble only follows the total forces.
  bool bubble_remembers() const override { return false; }
  void accept_parts(State& state, std::span<const double> z) const;
  void send_parts(State& state) const;

  Balance _shared; ///< kernels of mixed cells
  material::AnyClosure _closure;
  scene::VoidRule _rule;
  double _K_open = 1;                  ///< of open gaps, for `open_fill` [Pa]
  std::vector<std::vector<int>> _pure; ///< owned cells of each material
  std::vector<int> _mixed;             ///< owned mixed cells
  std::vector<Mixture> _mixture;       ///< of them
  std::vector<int> _of_cell;           ///< index into `_mixed`, or -1
  std::vector<std::uint8_t> _empty;    ///< owned cells of void alone
  std::vector<PartEnd> _part;          ///< of the parts of all rows
  std::vector<double> _part_history;   ///< likewise
  std::vector<material::Share> _share; ///< of the cell at work
  std::vector<double> _turned;         ///< history of its shares
};
} // namespace mmale::lagrangian
