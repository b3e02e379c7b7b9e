// SPDX-License-Identifier: LGPL-3.0-or-later
// What PETSc is told of the problem, and what it calls back.
#include "problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mmale::lagrangian
{
/// A factorisation that suits the stage; made anew only where that changes.
void Problem::choose_solver()
{
  using enum scene::Factorisation;
  const bool symmetric =
      _options.factorisation == ldlt
      or (_options.factorisation == automatic and _element->symmetric());
  if (_snes and symmetric == _symmetric)
    return;
  _symmetric = symmetric;
  SNESDestroy(&_snes);
  MatDestroy(&_J);
  for (Vec* v : {&_x, &_r, &_unlifted})
    VecDestroy(v);
  create_matrix();
  create_solver();
}

void Problem::create_matrix()
{
  const auto& map = _domain.nodes();
  const int b = _block, unknowns = 3 * b; // of a node, of a cell
  const PetscInt rows = b * _domain.num_owned_nodes;
  MatCreate(_domain.comm, &_J);
  MatSetSizes(_J, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE);
  MatSetType(_J, MATAIJ);
  MatSetBlockSize(_J, b);

  std::vector<std::int64_t> global(_domain.num_nodes());
  std::vector<std::int32_t> local(_domain.num_nodes());
  for (int n = 0; n < _domain.num_nodes(); ++n)
    local[n] = n;
  map.local_to_global(local, global);
  std::vector<PetscInt> row, column;
  const std::size_t entries =
      static_cast<std::size_t>(unknowns) * unknowns * _domain.num_owned_cells
      + rows;
  row.reserve(entries);
  column.reserve(entries);
  for (int c = 0; c < _domain.num_owned_cells; ++c)
    for (int i = 0; i < unknowns; ++i)
      for (int j = 0; j < unknowns; ++j)
      {
        const auto& nodes = _domain.cells[c];
        row.push_back(static_cast<PetscInt>(b * global[nodes[i / b]] + i % b));
        column.push_back(
            static_cast<PetscInt>(b * global[nodes[j / b]] + j % b));
      }
  for (PetscInt i = 0; i < rows; ++i)
  {
    row.push_back(static_cast<PetscInt>(b * global[i / b] + i % b));
    column.push_back(row.back());
  }
  MatSetPreallocationCOO(_J, static_cast<PetscCount>(row.size()), row.data(),
                         column.data());
  _coo.resize(row.size());
  MatCreateVecs(_J, &_x, &_r);
  if (_symmetric)
  {
    MatSetOption(_J, MAT_SYMMETRIC, PETSC_TRUE);
    MatSetOption(_J, MAT_SYMMETRY_ETERNAL, PETSC_TRUE);
    VecDuplicate(_r, &_unlifted);
  }
}

void Problem::create_solver()
{
  SNESCreate(_domain.comm, &_snes);
  SNESSetOptionsPrefix(_snes, "lagrangian_");
  SNESSetType(_snes, SNESNEWTONLS);
  SNESSetFunction(_snes, _r, function, this);
  SNESSetJacobian(_snes, _J, _J, jacobian, this);
  SNESSetTolerances(_snes, 0, 0, 0, _options.max_iterations, 10000);
  SNESSetUpdate(_snes, before_iteration);
  SNESSetConvergenceTest(_snes, converged, this, nullptr);
  if (_options.lag_jacobian > 1)
  {
    SNESSetLagJacobian(_snes, _options.lag_jacobian);
    SNESSetLagPreconditioner(_snes, 1);
  }
  SNESLineSearch search;
  SNESGetLineSearch(_snes, &search);
  SNESLineSearchSetType(search, _options.line_search ? SNESLINESEARCHBT
                                                     : SNESLINESEARCHBASIC);
  SNESLineSearchSetPreCheck(search, precheck, this);
  KSP ksp;
  PC pc;
  SNESGetKSP(_snes, &ksp);
  KSPSetType(ksp, KSPPREONLY);
  KSPGetPC(ksp, &pc);
  KSPSetPreSolve(ksp, before_solve, this);
  KSPSetPostSolve(ksp, after_solve, this);
  PCSetType(pc, _symmetric ? PCCHOLESKY : PCLU);
  PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
  // The system is scaled by its units already: MUMPS's own scaling and its
  // search for a large diagonal cost more than they give. But viscosities may
  // differ by many decades from cell to cell, and then it takes pivots for
  // zeros (Bingham with a plug 1e5 times as viscous as what flows).
  static bool ours = false; // what an earlier solver has set, not the user
  PetscBool given = PETSC_FALSE;
  PetscOptionsHasName(nullptr, nullptr, "-lagrangian_mat_mumps_icntl_8",
                      &given);
  if (ours or not given)
    PetscOptionsSetValue(nullptr, "-lagrangian_mat_mumps_icntl_8",
                         _element->fluid() ? "77" : "0");
  ours = ours or not given;
  PetscOptionsHasName(nullptr, nullptr, "-lagrangian_mat_mumps_icntl_6",
                      &given);
  if (not given)
    PetscOptionsSetValue(nullptr, "-lagrangian_mat_mumps_icntl_6", "0");
  if (not _options.petsc.empty())
    PetscOptionsInsertString(nullptr, _options.petsc.c_str());
  SNESSetFromOptions(_snes);
}

/// A factorisation that failed would be asked again.
void Problem::forget_factor()
{
  KSP ksp;
  PC pc;
  SNESGetKSP(_snes, &ksp);
  KSPGetPC(ksp, &pc);
  PCReset(pc);
}

PetscErrorCode Problem::function(SNES, Vec x, Vec r, void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  const auto scope = self._clock.scope("1a law and assembly");
  self.unpack(x);
  PetscScalar* out = nullptr;
  PetscCall(VecGetArray(r, &out));
  if (self.evaluate())
    self.assemble_residual(out);
  else // a norm that no line search accepts
    std::fill_n(out, self._block * self._domain.num_owned_nodes,
                std::numeric_limits<double>::quiet_NaN());
  PetscCall(VecRestoreArray(r, &out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Units of the unknowns and equations, held ones out.
void Problem::scale(int cell, double* A)
{
  // displacement rows in units of G, volume rows of l; pressures G / l: what
  // is symmetric stays so
  const double weight = _newmark ? _newmark->weight() : 1;
  const double row[2] = {weight / _stress, weight / _length};
  const double column[2] = {1, _stress / _length};
  std::array<int, 9> unknown;
  for (int i = 0; i < 9; ++i)
    unknown[i] = 3 * _domain.cells[cell][i / 3] + i % 3;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      A[9 * i + j] *= row[i % 3 == 2] * column[j % 3 == 2];
  if (_symmetric)
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < i; ++j)
        A[9 * i + j] = A[9 * j + i] = 0.5 * (A[9 * i + j] + A[9 * j + i]);
  for (int i = 0; i < 9; ++i)
  {
    if (_holder[unknown[i]] < 0)
      continue;
    std::fill_n(A + 9 * i, 9, 0.0);
    for (int j = 0; _symmetric and j < 9; ++j)
    {
      double& a = A[9 * j + i];
      if (a != 0 and _holder[unknown[j]] < 0)
        _lift.push_back({unknown[j], unknown[i], a});
      a = 0;
    }
  }
}

/// The cell's tangent with seepage: what is scaled already, and the blocks of
/// the pore pressure.
///
/// @param[in]  A9  of u and p, scaled, shape (9, 9)
/// @param[out] A12 shape (12, 12)
void Problem::add_flow(int c, const double* A9, double* A12)
{
  const FlowTangent flow =
      _element->flow_tangent(*_state, c, _z.array(), _constants);
  const auto& nodes = _domain.cells[c];
  const double weight = _newmark ? _newmark->weight() : 1;
  const double row[2] = {weight / _stress, weight / _length};
  const double column[2] = {1, _stress / _length};
  const auto at = [](int i) { return 4 * (i / 3) + i % 3; };
  for (int i = 0; i < 9; ++i)
  {
    const bool held = _holder[3 * nodes[i / 3] + i % 3] >= 0;
    for (int j = 0; j < 9; ++j)
      A12[12 * at(i) + at(j)] = A9[9 * i + j];
    for (int j = 0; j < 3; ++j)
      A12[12 * at(i) + 4 * j + 3] =
          held ? 0 : flow.momentum[3 * i + j] * row[i % 3 == 2] * column[1];
  }
  for (int i = 0; i < 3; ++i)
  {
    const double unit =
        _pore_pressure->holder()[nodes[i]] >= 0 ? 0 : 1 / _length;
    double* to = A12 + 12 * (4 * i + 3);
    for (int j = 0; j < 9; ++j)
      to[at(j)] = unit * flow.by_nodes[9 * i + j] * column[j % 3 == 2];
    for (int j = 0; j < 3; ++j)
      to[4 * j + 3] = unit * flow.by_pore_pressure[3 * i + j] * column[1];
  }
}

/// Take what held unknowns still have to move to the right-hand side.
void Problem::lift(Vec b)
{
  dolfinx::la::Vector<double> moved(_domain.space->dofmap()->index_map, 3);
  moved.set(0);
  const auto z = _z.array();
  for (const auto& [row, column, value] : _lift)
    moved.mutable_array()[row] += value * (z[column] - _increment[column]);
  moved.scatter_rev(std::plus<double>());
  PetscScalar* to = nullptr;
  VecGetArray(b, &to);
  for (int i = 0; i < 3 * _domain.num_owned_nodes; ++i)
    to[i] -= moved.array()[i];
  VecRestoreArray(b, &to);
}

PetscErrorCode Problem::jacobian(SNES, Vec, Mat J, Mat, void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  const auto scope = self._clock.scope("1a law and assembly");
  const auto& d = self._domain;
  self._held_anew = false;
  self._lift.clear();
  const int b = self._block;
  const std::size_t entries = 9 * static_cast<std::size_t>(b) * b;
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    double alone[81]; // with seepage a block of the cell's
    double* block = self._coo.data() + entries * c;
    double* A = self._pore_pressure ? alone : block;
    self._element->jacobian(*self._state, c, self._z.array(), self._constants,
                            A);
    self._loads.add_jacobian(*self._state, c, self._z.array(), A);
    self.scale(c, A);
    if (self._pore_pressure)
      self.add_flow(c, A, block);
  }
  double* diagonal = self._coo.data() + entries * d.num_owned_cells;
  for (int n = 0; n < d.num_owned_nodes; ++n)
  {
    for (int i = 0; i < 3; ++i)
      diagonal[b * n + i] = self._holder[3 * n + i] >= 0 ? 1 : 0;
    if (self._pore_pressure)
      diagonal[b * n + 3] = self._pore_pressure->holder()[n] >= 0 ? 1 : 0;
  }
  for (int n = 0; self._newmark and n < d.num_owned_nodes; ++n)
    for (int i = 0; i < 2; ++i)
      if (self._holder[3 * n + i] < 0)
      {
        const Newmark& m = *self._newmark;
        const double weight = m.weight();
        diagonal[b * n + i] =
            m.mass(n) / self._stress
            * (m.c_a + weight * m.scheme().damping_mass * m.c_v);
      }
  PetscCall(MatSetValuesCOO(J, self._coo.data(), INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Whether the last factor still serves in this iteration. It never serves in
/// the next step: a run that is resumed there would not have it.
bool Problem::factor_serves(int it) const
{
  const auto& r = _log->residuals;
  return it > 0 and not _held_anew
         and r[it] * (r[it] / r[it - 1]) <= _options.tolerance;
}

PetscErrorCode Problem::before_iteration(SNES snes, PetscInt it)
{
  PetscFunctionBeginUser;
  void* context = nullptr;
  PetscCall(SNESGetFunction(snes, nullptr, nullptr, &context));
  auto& self = *static_cast<Problem*>(context);
  self._element->begin_iteration(self._z.array());
  if (self._options.lag_jacobian == 0)
    PetscCall(SNESSetLagJacobian(snes, self.factor_serves(it) ? -1 : 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Problem::before_solve(KSP, Vec b, Vec, void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  self._solving.reset(
      new output::Clock::Scope(self._clock.scope("1b factorise and solve")));
  if (self._symmetric)
  {
    PetscCall(VecCopy(b, self._unlifted));
    if (self._norm_bc > 0)
      self.lift(b);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Problem::after_solve(KSP, Vec b, Vec, void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  if (self._symmetric) // SNES goes on with it
    PetscCall(VecCopy(self._unlifted, b));
  self._solving.reset();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Shorten a Newton step that would invert a cell.
PetscErrorCode Problem::precheck(SNESLineSearch, Vec, Vec y, PetscBool* changed,
                                 void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  const auto& d = self._domain;
  dolfinx::la::Vector<double> step(d.space->dofmap()->index_map, 3);
  const PetscScalar* from = nullptr;
  PetscCall(VecGetArrayRead(y, &from));
  for (int n = 0; n < d.num_owned_nodes; ++n)
    std::copy_n(from + self._block * static_cast<std::ptrdiff_t>(n), 3,
                step.mutable_array().begin() + 3 * n);
  PetscCall(VecRestoreArrayRead(y, &from));
  step.scatter_fwd();
  const auto z = self._z.array();
  double share = 1;
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    std::array<std::array<double, 2>, 3> x, v;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 2; ++i)
      {
        const int n = d.cells[c][k];
        x[k][i] = self._state->x[2 * n + i] + z[3 * n + i];
        v[k][i] = -step.array()[3 * n + i];
      }
    const auto cross = [](const auto& a, const auto& b)
    {
      return (a[1][0] - a[0][0]) * (b[2][1] - b[0][1])
             - (a[1][1] - a[0][1]) * (b[2][0] - b[0][0]);
    };
    // twice the area along the step: a + b t + c t^2, kept above a tenth of a
    const double a = 0.9 * cross(x, x), b = cross(x, v) + cross(v, x),
                 q = cross(v, v);
    const double root = b * b - 4 * a * q;
    if (root < 0 or (b >= 0 and q >= 0))
      continue;
    const double t = 2 * a / (-b + std::sqrt(root));
    if (t > 0)
      share = std::min(share, t);
  }
  MPI_Allreduce(MPI_IN_PLACE, &share, 1, MPI_DOUBLE, MPI_MIN, d.comm);
  *changed = share < 1 ? PETSC_TRUE : PETSC_FALSE;
  if (share < 1)
    PetscCall(VecScale(y, 0.9 * share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Problem::converged(SNES, PetscInt it, PetscReal, PetscReal,
                                  PetscReal fnorm, SNESConvergedReason* reason,
                                  void* context)
{
  PetscFunctionBeginUser;
  auto& self = *static_cast<Problem*>(context);
  const double tol = self._options.tolerance;
  *reason = SNES_CONVERGED_ITERATING;
  if (not std::isfinite(fnorm))
    *reason = SNES_DIVERGED_FNORM_NAN;
  else if (self._norm_u <= tol and self._norm_p <= tol and self._norm_bc <= tol
           and self._norm_w <= tol)
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  self._log->residuals.push_back(
      std::max({self._norm_u, self._norm_p, self._norm_bc, self._norm_w}));
  (void)it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

} // namespace mmale::lagrangian
