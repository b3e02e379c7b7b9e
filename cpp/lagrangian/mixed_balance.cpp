// SPDX-License-Identifier: LGPL-3.0-or-later
// What mixed cells give to the balance, and their parts at the end of a step.
#include "mixed_element.h"

#include "mesh/corners.h"
#include "mixture.h"
#include <algorithm>
#include <cmath>

namespace mmale::lagrangian
{
namespace
{
using bridge::Materials;
using bridge::Part;

/// What an open gap keeps of its volume equation, lest a node without any
/// other cell has none. Larger: it takes part in its neighbours' equations.
constexpr double open_fill = 1e-6;
/// Void that is left of a gap that has closed; the remap sweeps it up.
constexpr double closed_fill = 1e-13;
/// Part of the ersatz stiffness that holds nodes to where they were, lest
/// crumbs that touch nothing float about in statics.
constexpr double grounded = 1e-4;
} // namespace

void MixedElement::gather(const State& state, int c, std::span<const double> z,
                          CellInput& in, double* x) const
{
  MeanElement::gather(state, c, z, in, x);
  if (_of_cell[c] < 0)
  {
    const Medium& medium = _media[state.materials->pure(c)];
    in.memory = medium.fluid() ? 0 : 1;
    return;
  }
  const Mixture& m = _mixture[_of_cell[c]];
  bool fluid = true;
  for (const Part& part : state.materials->parts(m.row))
    fluid = fluid and (is_void(part.material) or _media[part.material].fluid());
  in.mean_rho = in.rho;
  in.rho /= m.fill;
  in.memory = fluid ? 0 : 1;
  in.rho_b = in.rho;
  in.fill = m.fill;
  in.kept = 1;
  for (int d = 0; d < 2; ++d)
  {
    in.offset[d] = in.mass_offset[d] = 0;
    for (int v = 0; v < 3; ++v)
    {
      in.offset[d] += (m.centre[v] - 1. / 3) * x[3 * v + d];
      in.mass_offset[d] += (m.mass_centre[v] - 1. / 3) * x[3 * v + d];
    }
  }
  if (not m.open)
    return;
  in.fill = m.spray ? 0 : open_fill;
  in.kept = 0; // no bubble
  in.ln_J = 0;
  in.theta = 0;
  for (int v = 0; v < 3; ++v)
    in.theta -= z[3 * _domain.cells[c][v] + 2] / (3 * _K_open);
}

void MixedElement::add_tangent(int c, CellInput& in) const
{
  MeanElement::add_tangent(c, in);
  if (_of_cell[c] < 0 or not _mixture[_of_cell[c]].open)
    return;
  std::ranges::fill(in.ds_dp, 0.0);
  std::ranges::fill(in.dtheta_dh, 0.0);
  in.dtheta_dp = -1 / _K_open;
}

const MeanElement::Balance& MixedElement::balance(int c) const
{
  return _of_cell[c] < 0 ? MeanElement::balance(c) : _shared;
}

void MixedElement::residual(const State& state, int c,
                            std::span<const double> z,
                            const Constants& constants, double* R)
{
  if (_empty[c])
    std::fill_n(R, 9, 0.0);
  else
    MeanElement::residual(state, c, z, constants, R);
  if (const double k = ersatz(state, c); k > 0)
    for (int v = 0; v < 3; ++v)
      for (int d = 0; d < 2; ++d)
      {
        const auto u = [&](int i)
        { return z[3 * _domain.cells[c][(v + i) % 3] + d]; };
        R[3 * v + d] += k * ((2 + grounded) * u(0) - u(1) - u(2));
      }
}

/// Stiffness of the springs between the nodes of a cell that is in part void:
/// they hold nodes that have next to nothing of a body [N/m2 or N/(m rad)].
double MixedElement::ersatz(const State& state, int c) const
{
  if (_of_cell[c] < 0)
    return 0;
  const Mixture& m = _mixture[_of_cell[c]];
  if (m.bodies == 1)
    return 0;
  const double rho = state.density[c] / m.bodies;
  const double V = mesh::cell_volume(_domain, state.x, c, _axisymmetric);
  const double A =
      _axisymmetric ? mesh::cell_volume(_domain, state.x, c, false) : V;
  const double inertia = _newmark ? rho * _newmark->c_a * V : 0;
  return (1 - m.bodies) * _options.ersatz_stiffness * (_G[c] * V / A + inertia);
}

void MixedElement::jacobian(const State& state, int c,
                            std::span<const double> z,
                            const Constants& constants, double* J)
{
  if (_empty[c])
    std::fill_n(J, 81, 0.0);
  else
    MeanElement::jacobian(state, c, z, constants, J);
  if (const double k = ersatz(state, c); k > 0)
    for (int i = 0; i < 9; ++i)
      for (int j = i % 3; i % 3 != 2 and j < 9; j += 3)
        J[9 * i + j] += i == j ? (2 + grounded) * k : -k;
}

std::array<double, 6> MixedElement::forces(const State& state, int c,
                                           std::span<const double> z,
                                           const Constants& constants) const
{
  return _empty[c] ? std::array<double, 6>{}
                   : MeanElement::forces(state, c, z, constants);
}

/// Parts of the owned mixed cells at the end of the step. Their masses stay.
void MixedElement::accept_parts(State& state, std::span<const double> z) const
{
  Materials& materials = *state.materials;
  const std::size_t h = _num_history, cells = materials.num_cells();
  for (std::size_t i = 0; i < _mixed.size(); ++i)
  {
    const int c = _mixed[i];
    const Mixture& m = _mixture[i];
    const double J = std::exp(_cell[c].motion.ln_J);
    const auto parts = materials.parts(m.row);
    const std::size_t first = materials.first_slot(m.row);
    double filled = 0; // of the old volume, by what bears load at the end
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (not is_void(parts[k].material))
        filled += parts[k].fraction * std::exp(_part[first + k - cells].theta);
    // its fraction at the end
    const double fill = m.open ? filled / J : m.gap ? 1 - closed_fill : m.fill;
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
      Part& part = parts[k];
      const std::size_t slot = first + k;
      const PartEnd& end = _part[slot - cells];
      const auto at = shares_at(state, c, part);
      for (int v = 0; v < 3; ++v)
      {
        const int n = _domain.cells[c][v];
        part.centroid.x += at[v] * z[3 * n];
        part.centroid.y += at[v] * z[3 * n + 1];
      }
      const double before = part.fraction;
      part.fraction = is_void(part.material)
                          ? 1 - fill
                          : fill * before * std::exp(end.theta) / filled;
      state.density[slot] *=
          is_void(part.material) ? 1 : before / (part.fraction * J);
      Voigt::Map(state.s.data() + 4 * slot) = end.s;
      state.P[slot] = end.p;
      std::copy_n(_part_history.begin() + h * (slot - cells), h,
                  state.history.begin() + h * slot);
    }
  }
}

void MixedElement::accept(State& state, std::span<const double> z, double dt)
{
  accept_parts(state, z);
  MeanElement::accept(state, z, dt);
  send_parts(state);
  mixture::fill(state);
}

/// Parts of ghost cells from their owners; which there are has not changed.
void MixedElement::send_parts(State& state) const
{
  int ranks = 1;
  MPI_Comm_size(_domain.comm, &ranks);
  if (ranks == 1)
    return;
  Materials& materials = *state.materials;
  const std::size_t h = _num_history, width = 9 + h; // of a part
  int most = 0;
  for (std::size_t r = 0; r < materials.mixed().size(); ++r)
    most = std::max(
        most,
        static_cast<int>(materials.parts(static_cast<std::int32_t>(r)).size()));
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_INT, MPI_MAX, _domain.comm);
  if (most == 0)
    return;
  const std::size_t row = most * width;
  std::vector<double> all(row * _domain.num_cells(), 0);
  const auto each = [&](auto&& visit)
  {
    for (const std::int32_t c : materials.mixed())
    {
      double* at = all.data() + row * c;
      std::size_t slot = materials.first_slot(materials.row(c));
      for (Part& part : materials.parts(materials.row(c)))
      {
        double* to = at;
        visit(c, part.fraction, *to++);
        visit(c, part.centroid.x, *to++);
        visit(c, part.centroid.y, *to++);
        visit(c, state.P[slot], *to++);
        visit(c, state.density[slot], *to++);
        for (int i = 0; i < 4; ++i)
          visit(c, state.s[4 * slot + i], *to++);
        for (std::size_t i = 0; i < h; ++i)
          visit(c, state.history[h * slot + i], *to++);
        at += width;
        ++slot;
      }
    }
  };
  each([](std::int32_t, double& value, double& sent) { sent = value; });
  _domain.cell_halo->update(all, static_cast<int>(row));
  each(
      [this](std::int32_t c, double& value, const double& sent)
      {
        if (c >= _domain.num_owned_cells)
          value = sent;
      });
}
} // namespace mmale::lagrangian
