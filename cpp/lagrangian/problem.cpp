// SPDX-License-Identifier: LGPL-3.0-or-later
#include "problem.h"

#include "mesh/corners.h"
#include "output/archive.h"
#include <algorithm>
#include <cmath>
#include <dolfinx/common/MPI.h>
#include <limits>

namespace mmale::lagrangian
{
namespace
{
double mean_edge(const mesh::Domain& domain)
{
  double sum[2] = {0, static_cast<double>(domain.num_owned_cells)};
  for (int c = 0; c < domain.num_owned_cells; ++c)
    sum[0] += mesh::cell_volume(domain, domain.initial_x, c, false);
  MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, domain.comm);
  return std::sqrt(sum[0] / sum[1]);
}

std::shared_ptr<const dolfinx::common::IndexMap>
node_map(const mesh::Domain& domain)
{
  return domain.space->dofmap()->index_map;
}
} // namespace

Problem::Problem(const mesh::Domain& domain,
                 std::span<const material::AnyLaw> laws,
                 scene::Symmetry symmetry, const scene::Solver& options,
                 const std::optional<scene::Water>& water, output::Clock& clock)
    : _domain(domain), _symmetry(symmetry), _options(options), _clock(clock),
      _element(make_element(domain, laws, symmetry, options, water)),
      _loads(domain, symmetry), _length(mean_edge(domain)),
      _increment(3 * domain.num_nodes(), 0), _z(node_map(domain), 3),
      _force(node_map(domain), 3)
{
  if (not water or not water->seepage())
    return;
  _block = 4;
  _pore_pressure = std::make_unique<PorePressure>(domain, symmetry, *water);
  _element->set_pore_pressure(_pore_pressure.get());
}

Problem::~Problem()
{
  SNESDestroy(&_snes);
  MatDestroy(&_J);
  VecDestroy(&_x);
  VecDestroy(&_r);
  VecDestroy(&_unlifted);
}

void Problem::set_scales(const State& state, double dt)
{
  const auto [G, K] = moduli(state, dt);
  _stress = G;
  _bulk = K;
  if (not _newmark or not _element->fluid())
    return;
  // what resists in a fluid is its mass; G alone would be a unit so small that
  // the matrix is singular to the last digit
  double sum[2] = {0, static_cast<double>(_domain.num_owned_cells)};
  for (int c = 0; c < _domain.num_owned_cells; ++c)
    sum[0] += state.density[c];
  MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, _domain.comm);
  _stress += sum[0] / sum[1] * _length * _length / (dt * dt);
}

void Problem::set_stage(const scene::Stage& stage, const State& state)
{
  _conditions.emplace(_domain, stage);
  _contact.emplace(_domain, *_conditions);
  _holder.assign(_conditions->holder().begin(), _conditions->holder().end());
  _guess_dt = 0;
  _newmark.reset();
  if (stage.dynamics)
    _newmark.emplace(_domain, _symmetry, stage.dynamics->resolved());
  set_scales(state, stage.step);
  _element->set_newmark(_newmark ? &*_newmark : nullptr);
  if (_pore_pressure)
    _pore_pressure->set_stage(stage);
  choose_solver();
}

void Problem::unpack(Vec x)
{
  const PetscScalar* from = nullptr;
  VecGetArrayRead(x, &from);
  auto z = _z.mutable_array();
  const double pressure = _stress / _length;
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
  {
    const PetscScalar* of_node = from + _block * static_cast<std::ptrdiff_t>(n);
    std::copy_n(of_node, 2, z.begin() + 3 * n);
    z[3 * n + 2] = of_node[2] * pressure;
    if (_pore_pressure)
      _pore_pressure->trial()[n] = of_node[3] * pressure;
  }
  VecRestoreArrayRead(x, &from);
  _z.scatter_fwd();
  if (_pore_pressure)
    _pore_pressure->send_trial();
}

void Problem::agree_on_failure(int cell, const std::string& why)
{
  // The lowest rank that failed tells the others.
  int rank = dolfinx::MPI::rank(_domain.comm);
  int first = cell >= 0 ? rank : std::numeric_limits<int>::max();
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, _domain.comm);
  _failed = first != std::numeric_limits<int>::max();
  if (not _failed)
    return;
  struct
  {
    std::int64_t cell = -1;
    double place[2] = {0, 0};
    char cause[64] = {};
  } told;
  if (rank == first)
  {
    told.cell = _domain.cell_id[cell];
    for (int n : _domain.cells[cell])
      for (int d = 0; d < 2; ++d)
        told.place[d] += _state->x[2 * n + d] / 3;
    why.copy(told.cause, sizeof(told.cause) - 1);
  }
  MPI_Bcast(&told, sizeof(told), MPI_BYTE, first, _domain.comm);
  _failure = {told.cause, told.cell, {told.place[0], told.place[1]}};
}

bool Problem::evaluate()
{
  std::string why;
  const int failed = _element->evaluate(*_state, _z.array(), _constants, why);
  agree_on_failure(failed, why);
  return not _failed;
}

void Problem::assemble_residual(double* r)
{
  const auto z = _z.array();
  auto force = _force.mutable_array();
  std::ranges::fill(force, 0.0);
  // squares: cell forces, strains, held increments, flows
  double size[4] = {0, 0, 0, 0};
  // what last digits come to, as large as they may weigh: strains of the
  // pressure at rest, by which the bubble moves too, and of the displacement in
  // flight
  const double last_digits =
      4 * std::numeric_limits<double>::epsilon() / _options.tolerance;
  const double of_p = last_digits / std::min(_bulk, _stress);
  const double of_u = _newmark ? last_digits / _length : 0;
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    double R[9];
    _element->residual(*_state, c, z, _constants, R);
    const auto& nodes = _domain.cells[c];
    for (int i = 0; i < 9; ++i)
    {
      force[3 * nodes[i / 3] + i % 3] += R[i];
      if (i % 3 != 2)
        size[0] += R[i] * R[i];
    }
    // and what the cell brought along: a step may end without stress
    size[0] += _element->force_squared(*_state, c);
    const double V = _element->volume(c) / 3;
    double lost = 0;
    for (int n : nodes)
      lost += (of_p * std::abs(z[3 * n + 2])
               + of_u * std::hypot(z[3 * n], z[3 * n + 1]))
              / 3;
    size[1] += 3 * V * V * (1e-32 + lost * lost + _element->strain_squared(c));
  }
  _loads.add_residual(*_state, z, force);
  _force.scatter_rev(std::plus<double>());
  if (_newmark)
    add_inertia(force, size[0]);
  if (_pore_pressure)
    assemble_flow(size);
  if (not _contact->empty() and _contact_changes < max_contact_changes
      and _contact->update(_state->x, z, force, _stress))
  {
    ++_contact_changes;
    hold();
  }

  double norm[4] = {0, 0, 0, 0};
  const double weight = _newmark ? _newmark->weight() : 1;
  for (int i = 0; i < 3 * _domain.num_owned_nodes; ++i)
  {
    const bool pressure = i % 3 == 2;
    double& row = r[_block * (i / 3) + i % 3];
    row = pressure ? weight * force[i] / _length : force[i] / _stress;
    if (_holder[i] >= 0)
    {
      row = (z[i] - _increment[i]) * (pressure ? _length / _stress : 1);
      norm[2] += row * row;
      size[2] += _increment[i] * _increment[i];
    }
    else
      norm[pressure ? 1 : 0] += force[i] * force[i];
  }
  for (int n = 0; _pore_pressure and n < _domain.num_owned_nodes; ++n)
  {
    const PorePressure& water = *_pore_pressure;
    double& row = r[4 * n + 3];
    row = water.residual()[n] / _length;
    if (water.holder()[n] >= 0)
    {
      const double unit = _length / _stress;
      row = unit * (water.trial()[n] - water.prescribed(n));
      norm[2] += row * row;
      size[2] += std::pow(unit * water.prescribed(n), 2);
    }
    else
      norm[3] += std::pow(water.residual()[n], 2);
  }
  std::array<double, 8> all;
  std::copy_n(norm, 4, all.begin());
  std::copy_n(size, 4, all.begin() + 4);
  MPI_Allreduce(MPI_IN_PLACE, all.data(), 8, MPI_DOUBLE, MPI_SUM, _domain.comm);
  const double tiny = 1e-16 * _length * _stress;
  _norm_u = std::sqrt(all[0] / (all[4] + tiny * tiny));
  _norm_p = std::sqrt(all[1] / all[5]);
  _norm_bc =
      all[2] > 0 ? std::sqrt(all[2] / (all[6] + 1e-32 * _length * _length)) : 0;
  _norm_w = _pore_pressure ? std::sqrt(all[3] / (all[5] + all[7])) : 0;
}

/// Rows of the pore pressure; `size` has its fourth number from them.
void Problem::assemble_flow(double* size)
{
  auto rows = _pore_pressure->residual();
  std::ranges::fill(rows, 0.0);
  const double last_digits =
      4 * std::numeric_limits<double>::epsilon() / _options.tolerance;
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const FlowRow row = _element->flow(*_state, c, _z.array(), _constants);
    for (int v = 0; v < 3; ++v)
      rows[_domain.cells[c][v]] += row.R[v];
    size[3] +=
        row.size_squared + last_digits * last_digits * row.digits_squared;
  }
  _pore_pressure->gather_residual();
}

/// Newton again and again while nodes of seepage faces are held or let go, from
/// where the last one ended. (In its midst, as contact does it, a row that
/// changes from a flow to a pressure stalls the line search.)
bool Problem::settle_faces(NewtonLog& log)
{
  for (int round = 0; _pore_pressure->update(); ++round)
  {
    if (round == max_contact_changes)
    {
      const int node = _pore_pressure->unsettled();
      agree_on_failure(node < 0 ? -1 : cell_at(node),
                       "a seepage face did not settle");
      log.failure = _failure;
      return false;
    }
    hold();
    if (not newton(log))
      return false;
  }
  return true;
}

/// A local cell at a local node.
int Problem::cell_at(int node) const
{
  const auto at = std::ranges::find_if(
      _domain.cells, [node](const auto& cell)
      { return std::ranges::find(cell, node) != cell.end(); });
  return static_cast<int>(at - _domain.cells.begin());
}

void Problem::name_worst(NewtonLog& log)
{
  log.failure = _failure;
  if (_failed)
    return;
  // Newton stalled: the cell of the node with the largest force left over
  struct
  {
    double force;
    int rank;
  } worst{-1, dolfinx::MPI::rank(_domain.comm)};
  int node = 0;
  const auto force = _force.array();
  for (int n = 0; n < _domain.num_owned_nodes; ++n)
  {
    const double f =
        std::hypot(_holder[3 * n] < 0 ? force[3 * n] : 0.0,
                   _holder[3 * n + 1] < 0 ? force[3 * n + 1] : 0.0);
    if (f > worst.force)
    {
      worst.force = f;
      node = n;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC,
                _domain.comm);
  const bool here = worst.rank == dolfinx::MPI::rank(_domain.comm);
  agree_on_failure(here ? cell_at(node) : -1, "Newton did not converge");
  log.failure = _failure;
}

/// Conditions, loads and constants of the step to solve.
void Problem::prepare(const State& state, double t0, double t1)
{
  _state = &state;
  _t0 = t0;
  _t1 = t1;
  find_void(state);
  const auto g = _conditions->gravity(t1);
  _constants = {};
  _constants.dt = t1 - t0;
  _constants.spring = _options.bubble_spring;
  if (_pore_pressure)
  {
    _constants.rho_f = _pore_pressure->water().density;
    _constants.end = _pore_pressure->water().time_weight;
  }
  std::ranges::copy(g, _constants.g);
  std::ranges::copy(t0 > 0 ? _conditions->gravity(t0) : _gravity,
                    _constants.g_n);
  if (_newmark)
    begin_newmark(state);
  _loads.begin_step(_conditions->loads(t1), _newmark ? &*_newmark : nullptr,
                    [this](int cell) { return impedance(cell); });
}

/// What is held in this step: the stage's conditions, and contact.
void Problem::hold()
{
  _held_anew = true;
  _conditions->increments(_t0, _t1, _increment);
  std::ranges::copy(_conditions->holder(), _holder.begin());
  _contact->apply(_state->x, _holder, _increment);
  hold_void();
  if (not _newmark)
    return;
  _newmark->set_lines(*_state);
  _newmark->hold(*_state, _holder, _increment);
  for (int i = 0; _newmark->is_explicit() and i < 3 * _domain.num_nodes(); ++i)
    if (i % 3 != 2 and _holder[i] < 0)
    {
      _holder[i] = by_scheme();
      _increment[i] = _newmark->foreseen(*_state, 2 * (i / 3) + i % 3);
    }
}

/// Which nodes have only void around them, and which nothing that bears a
/// pressure. Collective.
void Problem::find_void(const State& state)
{
  _around.clear();
  if (not state.materials)
    return;
  _around.assign(2 * static_cast<std::size_t>(_domain.num_nodes()), 0);
  for (int c = 0; c < _domain.num_cells(); ++c)
    for (int n : _domain.cells[c])
    {
      if (_element->present(state, c))
        _around[2 * n] = 1;
      if (_element->bears(state, c))
        _around[2 * n + 1] = 1;
    }
  _domain.node_halo->update(_around, 2); // a ghost's cells are not all here
}

/// These nodes leave the system: they stay, or have no pressure.
void Problem::hold_void()
{
  for (int i = 0; i < 3 * _domain.num_nodes(); ++i)
    if (not bears(i / 3, i % 3) and _holder[i] < 0)
    {
      _holder[i] = by_void();
      _increment[i] = 0;
    }
}

/// First iterate of Newton.
void Problem::start(Start from)
{
  const double dt = _t1 - _t0;
  PetscScalar* x = nullptr;
  VecGetArray(_x, &x);
  for (int i = 0; i < 3 * _domain.num_owned_nodes; ++i)
  {
    PetscScalar& value = x[_block * (i / 3) + i % 3];
    if (i % 3 == 2)
      value = _state->p[i / 3] * _length / _stress;
    else if (from == Start::rest)
      value = 0;
    else if (_holder[i] >= 0)
      value = _increment[i];
    else
      value = _newmark ? _newmark->foreseen(*_state, 2 * (i / 3) + i % 3)
                       : _motion[2 * (i / 3) + i % 3] * dt / _guess_dt;
  }
  for (int n = 0; _pore_pressure and n < _domain.num_owned_nodes; ++n)
    x[4 * n + 3] =
        (_pore_pressure->holder()[n] >= 0 ? _pore_pressure->prescribed(n)
                                          : _state->p_w[n])
        * _length / _stress;
  VecRestoreArray(_x, &x);
}

bool Problem::newton(NewtonLog& log)
{
  log.residuals.clear();
  log.failure = {};
  _log = &log;
  _failed = false;
  _element->begin_step(*_state, _constants.dt);
  SNESSolve(_snes, nullptr, _x);
  PetscInt iterations = 0;
  SNESGetIterationNumber(_snes, &iterations);
  log.iterations += static_cast<int>(iterations);
  SNESConvergedReason reason;
  SNESGetConvergedReason(_snes, &reason);
  if (reason <= 0)
    name_worst(log);
  if (reason == SNES_DIVERGED_LINEAR_SOLVE)
    forget_factor();
  return reason > 0;
}

/// Newton; the set of nodes in contact settles on the way. A set that goes on
/// changing is frozen, and has to prove itself afterwards.
bool Problem::equilibrium(Start from, NewtonLog& log)
{
  _contact->begin_step(_state->x, _t0, _t1);
  _contact_changes = 0;
  if (_pore_pressure)
    _pore_pressure->begin(_state->p_w, _t1, _t1 - _t0, _length);
  hold();
  start(from);
  if (not newton(log))
    return false;
  if (_pore_pressure and _pore_pressure->has_face() and not settle_faces(log))
    return false;
  if (_contact->empty()
      or not _contact->update(_state->x, _z.array(), _force.array(), _stress))
    return true;
  const int node = _contact->unsettled();
  agree_on_failure(node < 0 ? -1 : cell_at(node),
                   "contact with a wall did not settle");
  log.failure = _failure;
  return false;
}

bool Problem::solve(State& state, double t0, double t1, NewtonLog& log)
{
  const auto scope = _clock.scope("1 lagrangian");
  prepare(state, t0, t1);
  const bool guessed = _guess_dt > 0 or _newmark;
  const bool solved = (guessed and equilibrium(Start::guess, log))
                      or equilibrium(Start::rest, log);
  _guess_dt = 0;
  if (not solved)
    return false;
  if (_newmark)
    book_work(state, inner_forces());
  _element->accept(state, _z.array(), t1 - t0);
  if (_pore_pressure)
    std::ranges::copy(_pore_pressure->trial(), state.p_w.begin());
  if (_newmark)
    finish_newmark(state);
  _reactions = sum_reactions();
  _motion.resize(2 * static_cast<std::size_t>(_domain.num_nodes()));
  for (std::size_t i = 0; i < _motion.size(); ++i)
    _motion[i] = _z.array()[3 * (i / 2) + i % 2];
  _guess_dt = t1 - t0;
  std::copy_n(_constants.g, 2, _gravity.begin());
  return true;
}

void Problem::keep(output::Archive& archive)
{
  archive("lagrangian/stress", _stress);
  archive("lagrangian/bulk", _bulk);
  archive("lagrangian/guess_dt", _guess_dt);
  archive("lagrangian/gravity", _gravity);
  if (_guess_dt > 0)
    archive("lagrangian/motion", Entity::node, _motion);
}

} // namespace mmale::lagrangian
