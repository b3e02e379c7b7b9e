// SPDX-License-Identifier: LGPL-3.0-or-later
// The piercing block in small strain as a DOLFINx user would write it: mixed
// MINI, stress and tangent at quadrature points, fem::Form assembly, Newton,
// MUMPS. What the study lagrangian_step holds the solver against.
#include "mixed.h"

#include <Eigen/Core>
#include <array>
#include <basix/finite-element.h>
#include <basix/quadrature.h>
#include <cmath>
#include <ctime>
#include <dolfinx.h>
#include <dolfinx/fem/petsc.h>
#include <dolfinx/la/petsc.h>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <petscksp.h>
#include <string>

namespace
{
using namespace dolfinx;
using Element = std::shared_ptr<const fem::FiniteElement<double>>;
using Space = std::shared_ptr<const fem::FunctionSpace<double>>;
using Function = std::shared_ptr<fem::Function<double>>;
using Condition = std::shared_ptr<const fem::DirichletBC<double>>;
using Form = std::shared_ptr<const fem::Form<double>>;
using Voigt = Eigen::Vector4d;
using Voigt2 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// Seconds of the processor by the part of the work.
class Parts
{
public:
  double& operator[](const std::string& name) { return _seconds[name]; }
  static double now()
  {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec)
           + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  template <class F>
  void time(const std::string& name, F&& f)
  {
    const double begin = now();
    f();
    _seconds[name] += now() - begin;
  }
  const auto& all() const { return _seconds; }

private:
  std::map<std::string, double> _seconds;
};

/// What is to be computed.
struct Problem
{
  int nx = 110, ny = 164, steps = 10;
  double step = 1e-3; ///< punch displacement [m]
  double E = 2.6e6, nu = 0.3, yield_stress = 20e3, tolerance = 1e-8;
  bool symmetric = false; ///< LDLT in the place of LU
  bool rest = false;      ///< Newton starts without motion, not with the last

  double G() const { return E / (2 * (1 + nu)); }
  double K() const { return E / (3 * (1 - 2 * nu)); }
};

Space make_space(std::shared_ptr<mesh::Mesh<double>> mesh, Element e,
                 std::vector<std::size_t> shape)
{
  const auto layout = fem::create_element_dof_layout(*e);
  auto dofs = std::make_shared<const fem::DofMap>(fem::create_dofmap(
      mesh->comm(), layout, *mesh->topology_mutable(), nullptr, nullptr));
  return std::make_shared<const fem::FunctionSpace<double>>(mesh, e, dofs,
                                                            shape);
}

Element mixed_element()
{
  using basix::element::dpc_variant;
  using basix::element::lagrange_variant;
  const auto triangle = basix::cell::type::triangle;
  const auto p1 = basix::create_element<double>(
      basix::element::family::P, triangle, 1, lagrange_variant::gll_warped,
      dpc_variant::unset, false);
  const auto bubble = basix::create_element<double>(
      basix::element::family::bubble, triangle, 3, lagrange_variant::unset,
      dpc_variant::unset, false);
  using E = const fem::FiniteElement<double>;
  return std::make_shared<E>(std::vector<Element>{
      std::make_shared<E>(p1, 2), std::make_shared<E>(bubble, 2),
      std::make_shared<E>(p1, 1)});
}

/// The program's parts that stay.
class Solver
{
public:
  explicit Solver(const Problem& problem);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// One load step. @return Newton iterations, or -1
  int step();
  double reaction() const { return _reaction; }
  Parts parts;

private:
  void hold();
  void stress();
  double residual();
  void tangent();
  void solve(bool lift);
  std::vector<std::int32_t> nodes(int direction, auto&& where) const;

  Problem _problem;
  std::shared_ptr<mesh::Mesh<double>> _mesh;
  Space _W;
  Function _w, _s, _D;
  std::shared_ptr<fem::Constant<double>> _punch;
  std::vector<Condition> _held;
  std::vector<std::int32_t> _punch_dofs;
  Form _F, _J;
  std::unique_ptr<fem::Expression<double>> _strain;
  std::vector<std::int32_t> _cells;
  std::vector<double> _e, _e_n, _s_n, _w_n, _last;
  int _points = 0;
  double _depth = 0, _reaction = 0, _force = 0;
  Mat _A = nullptr;
  KSP _ksp = nullptr;
  std::unique_ptr<la::Vector<double>> _b, _dx;
  Vec _petsc_b = nullptr, _petsc_dx = nullptr;
};

std::vector<std::int32_t> Solver::nodes(int direction, auto&& where) const
{
  const auto sub = _W->sub({0}).sub({direction});
  const auto facets = mesh::locate_entities_boundary(*_mesh, 1, where);
  return fem::locate_dofs_topological(*_mesh->topology_mutable(), *sub.dofmap(),
                                      1, facets);
}

void Solver::hold()
{
  const auto boundary = [](int axis, double value, double to)
  {
    return [axis, value, to](auto x)
    {
      std::vector<std::int8_t> on(x.extent(1));
      for (std::size_t i = 0; i < on.size(); ++i)
        on[i] = std::abs(x(axis, i) - value) < 1e-9 and x(1 - axis, i) <= to;
      return on;
    };
  };
  const auto add = [&](int direction, auto&& where, auto value)
  {
    auto sub = std::make_shared<const fem::FunctionSpace<double>>(
        _W->sub({0}).sub({direction}));
    _held.push_back(std::make_shared<const fem::DirichletBC<double>>(
        value, nodes(direction, where), sub));
  };
  const auto zero = std::make_shared<fem::Constant<double>>(0.0);
  _punch = std::make_shared<fem::Constant<double>>(0.0);
  const auto punch = boundary(1, 1.5, 0.5 + 1e-9);
  add(0, boundary(0, 0, 2), zero);
  add(0, boundary(0, 1, 2), zero);
  add(1, boundary(1, 0, 2), zero);
  add(0, punch, zero);
  add(1, punch, _punch);
  _punch_dofs = nodes(1, punch);
}

Solver::Solver(const Problem& problem) : _problem(problem)
{
  const auto& p = _problem;
  _mesh = std::make_shared<mesh::Mesh<double>>(mesh::create_rectangle<double>(
      MPI_COMM_WORLD, {{{0, 0}, {1, 1.5}}}, {p.nx, p.ny},
      mesh::CellType::triangle, mesh::DiagonalType::right));
  _mesh->topology_mutable()->create_connectivity(1, 2);
  _W = make_space(_mesh, mixed_element(), {5});
  const auto [X, weights] = basix::quadrature::make_quadrature<double>(
      basix::quadrature::type::Default, basix::cell::type::triangle,
      basix::polyset::type::standard, 4);
  _points = static_cast<int>(weights.size());
  const auto at_points = [&](std::vector<std::size_t> shape, std::size_t size)
  {
    auto e = std::make_shared<const fem::FiniteElement<double>>(
        mesh::CellType::triangle, X,
        std::array<std::size_t, 2>{weights.size(), 2}, size);
    return std::make_shared<fem::Function<double>>(make_space(_mesh, e, shape));
  };
  _w = std::make_shared<fem::Function<double>>(_W);
  _s = at_points({4}, 4);
  _D = at_points({4, 4}, 16);
  const auto K = std::make_shared<fem::Constant<double>>(p.K());
  _F = std::make_shared<const fem::Form<double>>(fem::create_form<double>(
      *form_mixed_F, {_W}, {{"w", _w}, {"s", _s}}, {{"K", K}}, {}, {}));
  _J = std::make_shared<const fem::Form<double>>(fem::create_form<double>(
      *form_mixed_J, {_W, _W}, {{"D", _D}}, {{"K", K}}, {}, {}));
  _strain = std::make_unique<fem::Expression<double>>(
      fem::create_expression<double>(*expression_mixed_0, {{"w", _w}}, {}));
  hold();

  const auto cells = _mesh->topology()->index_map(2);
  _cells.resize(cells->size_local() + cells->num_ghosts());
  for (std::size_t c = 0; c < _cells.size(); ++c)
    _cells[c] = static_cast<std::int32_t>(c);
  _e.resize(_cells.size() * _points * 4);
  _e_n = _s_n = _e;
  _w_n.assign(_w->x()->array().size(), 0);
  _last = _w_n;

  _A = fem::petsc::create_matrix(*_J);
  const auto map = _W->dofmap()->index_map;
  _b = std::make_unique<la::Vector<double>>(map, 1);
  _dx = std::make_unique<la::Vector<double>>(map, 1);
  _petsc_b = la::petsc::create_vector_wrap(*_b);
  _petsc_dx = la::petsc::create_vector_wrap(*_dx);
  KSPCreate(MPI_COMM_WORLD, &_ksp);
  KSPSetType(_ksp, KSPPREONLY);
  KSPSetOperators(_ksp, _A, _A);
  if (p.symmetric)
    MatSetOption(_A, MAT_SYMMETRIC, PETSC_TRUE);
  PC pc;
  KSPGetPC(_ksp, &pc);
  PCSetType(pc, p.symmetric ? PCCHOLESKY : PCLU);
  PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
  KSPSetFromOptions(_ksp);
}

Solver::~Solver()
{
  VecDestroy(&_petsc_b);
  VecDestroy(&_petsc_dx);
  KSPDestroy(&_ksp);
  MatDestroy(&_A);
}

/// Strain, radial return and consistent tangent at all points.
void Solver::stress()
{
  const std::size_t values = 4 * static_cast<std::size_t>(_points);
  _strain->eval(*_mesh, _cells, _e, {_cells.size(), values});
  const double G = _problem.G();
  const double radius = std::sqrt(2.0 / 3.0) * _problem.yield_stress;
  Voigt2 elastic;
  elastic << 4, -2, -2, 0, -2, 4, -2, 0, -2, -2, 4, 0, 0, 0, 0, 3;
  elastic *= G / 3;
  auto s_out = _s->x()->mutable_array();
  auto D_out = _D->x()->mutable_array();
  const auto s_dofs = _s->function_space()->dofmap()->map();
  const auto D_dofs = _D->function_space()->dofmap()->map();
  double size = 0;
  for (std::size_t c = 0; c < _cells.size(); ++c)
    for (int q = 0; q < _points; ++q)
    {
      const std::size_t at = c * values + 4 * q;
      const Voigt de = Voigt(_e.data() + at) - Voigt(_e_n.data() + at);
      Voigt s = Voigt(_s_n.data() + at) + elastic * de;
      Voigt2 D = elastic;
      const double trial = std::sqrt(s.squaredNorm() + s[3] * s[3]);
      if (trial > radius)
      {
        const Voigt n = s / trial;
        const double keep = radius / trial;
        s = radius * n;
        D = keep * (elastic - 2 * G * n * n.transpose());
      }
      Voigt::Map(s_out.data() + 4 * s_dofs(c, q)) = s;
      Voigt2::Map(D_out.data() + 16 * D_dofs(c, q)) = D;
      size += s.squaredNorm() + s[3] * s[3];
    }
  // what the cells' own forces come to: stress times edge
  const double area = 1.5 / static_cast<double>(_cells.size());
  _force = std::sqrt(2 * size / _points * area);
}

/// Out-of-balance force on the free unknowns, relative.
double Solver::residual()
{
  auto b = _b->mutable_array();
  std::ranges::fill(b, 0);
  fem::assemble_vector<double>(b, *_F);
  _b->scatter_rev(std::plus<double>());
  _reaction = 0;
  for (auto dof : _punch_dofs)
    _reaction -= b[dof];
  for (const auto& bc : _held)
    bc->set(b, _w->x()->array(), -1);
  double norm = 0;
  for (auto value : b)
    norm += value * value;
  return std::sqrt(norm) / _force;
}

void Solver::tangent()
{
  MatZeroEntries(_A);
  fem::assemble_matrix(la::petsc::Matrix::set_fn(_A, ADD_VALUES), *_J, _held);
  MatAssemblyBegin(_A, MAT_FLUSH_ASSEMBLY);
  MatAssemblyEnd(_A, MAT_FLUSH_ASSEMBLY);
  fem::set_diagonal<double>(la::petsc::Matrix::set_fn(_A, INSERT_VALUES), *_W,
                            _held);
  MatAssemblyBegin(_A, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(_A, MAT_FINAL_ASSEMBLY);
}

void Solver::solve(bool lift)
{
  if (lift)
    parts.time("residual",
               [&]
               {
                 auto b = _b->mutable_array();
                 fem::apply_lifting<double, double>(b, {_J}, {_held},
                                                    {_w->x()->array()}, -1);
                 for (const auto& bc : _held)
                   bc->set(b, _w->x()->array(), -1);
               });
  parts.time("factorise and solve",
             [&] { KSPSolve(_ksp, _petsc_b, _petsc_dx); });
  auto w = _w->x()->mutable_array();
  for (std::size_t i = 0; i < w.size(); ++i)
    w[i] -= _dx->array()[i];
}

int Solver::step()
{
  _depth += _problem.step;
  _punch->value = {-_depth};
  auto w = _w->x()->mutable_array();
  const bool first = _problem.rest or _depth == _problem.step;
  for (std::size_t i = 0; i < w.size() and not _problem.rest; ++i)
    w[i] += _last[i]; // the motion goes on
  for (int it = 0; it < 30; ++it)
  {
    parts.time("strain and law", [&] { stress(); });
    double norm = 0;
    parts.time("residual", [&] { norm = residual(); });

    if (norm < _problem.tolerance and (it > 0 or not first))
    {
      for (std::size_t i = 0; i < w.size(); ++i)
      {
        _last[i] = w[i] - _w_n[i];
        _w_n[i] = w[i];
      }
      _e_n = _e;
      const auto s = _s->x()->array();
      const auto dofs = _s->function_space()->dofmap()->map();
      for (std::size_t c = 0; c < _cells.size(); ++c)
        for (int q = 0; q < _points; ++q)
          std::copy_n(s.data() + 4 * dofs(c, q), 4,
                      _s_n.data() + 4 * (c * _points + q));
      return it;
    }
    parts.time("tangent", [&] { tangent(); });
    solve(first and it == 0);
  }
  return -1;
}

/// name=value words from the command line.
Problem read(int argc, char** argv)
{
  Problem p;
  const std::map<std::string, int*> whole{
      {"nx", &p.nx}, {"ny", &p.ny}, {"steps", &p.steps}};
  const std::map<std::string, double*> real{{"step", &p.step},
                                            {"E", &p.E},
                                            {"nu", &p.nu},
                                            {"yield_stress", &p.yield_stress},
                                            {"tolerance", &p.tolerance}};
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const auto at = word.find('=');
    const std::string name = word.substr(0, at);
    if (name == "ldlt")
      p.symmetric = true;
    else if (name == "rest")
      p.rest = true;
    else if (at != std::string::npos and whole.contains(name))
      *whole.at(name) = std::stoi(word.substr(at + 1));
    else if (at != std::string::npos and real.contains(name))
      *real.at(name) = std::stod(word.substr(at + 1));
    else
      throw std::runtime_error("unknown word " + word);
  }
  return p;
}
} // namespace

int main(int argc, char** argv)
{
  const Problem problem = read(argc, argv);
  PetscInitialize(nullptr, nullptr, nullptr, nullptr);
  {
    nlohmann::json out = {{"steps", nlohmann::json::array()}};
    const double begin = Parts::now();
    Solver solver(problem);
    out["setup"] = Parts::now() - begin;
    for (int i = 0; i < problem.steps; ++i)
    {
      solver.parts = {};
      const double start = Parts::now();
      const int iterations = solver.step();
      out["steps"].push_back({{"iterations", iterations},
                              {"depth", (i + 1) * problem.step},
                              {"reaction", solver.reaction()},
                              {"seconds", Parts::now() - start},
                              {"parts", solver.parts.all()}});
      if (iterations < 0)
        break;
    }
    std::cout << out.dump(1) << std::endl;
  }
  PetscFinalize();
  return 0;
}
