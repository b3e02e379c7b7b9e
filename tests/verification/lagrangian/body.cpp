// SPDX-License-Identifier: LGPL-3.0-or-later
#include "body.h"

#include "environment.h"
#include "initial.h"
#include "simulation.h"
#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <catch2/catch_session.hpp>
#include <limits>
#include <set>

namespace mmale::test
{
struct Body::Parts
{
  explicit Parts(scene::Scene s)
      : scene(std::move(s)), sim(MPI_COMM_SELF, scene),
        element(lagrangian::make_element(sim.domain, sim.laws, scene.symmetry,
                                         scene.solver, scene.water))
  {
    constants.spring = scene.solver.bubble_spring;
    element->begin_step(sim.state, 1);
  }
  scene::Scene scene;
  Simulation sim;
  std::unique_ptr<lagrangian::Element> element;
  lagrangian::Constants constants;
  std::optional<lagrangian::Newmark> newmark;
};

Body::Body(scene::Scene scene)
    : _parts(std::make_unique<Parts>(std::move(scene)))
{
}
Body::~Body() = default;

State& Body::state()
{
  return _parts->sim.state;
}
int Body::num_nodes() const
{
  return _parts->sim.domain.num_nodes();
}
int Body::num_cells() const
{
  return _parts->sim.domain.num_cells();
}
std::array<int, 3> Body::cell(int c) const
{
  return _parts->sim.domain.cells[c];
}

std::vector<int> Body::nodes(const std::string& boundary) const
{
  const auto& d = _parts->sim.domain;
  return d.boundary_nodes(d.boundary(boundary));
}

int Body::node(double x, double y) const
{
  const auto& X = _parts->sim.domain.initial_x;
  int best = 0;
  for (int n = 1; n < num_nodes(); ++n)
    if (std::hypot(X[2 * n] - x, X[2 * n + 1] - y)
        < std::hypot(X[2 * best] - x, X[2 * best + 1] - y))
      best = n;
  return best;
}

std::array<double, 2> Body::settle()
{
  const Balance balance = mmale::settle(_parts->sim);
  set_stage(_parts->scene.stage.front());
  _parts->sim.problem->rest_under_gravity();
  return {balance.as_laid, balance.settled};
}

void Body::set_stage(const scene::Stage& stage)
{
  _parts->sim.problem->set_stage(stage, state());
  _parts->sim.problem->begin_stage(state());
}

Taken Body::step(double t0, double t1)
{
  lagrangian::NewtonLog log;
  const bool ok = _parts->sim.problem->solve(state(), t0, t1, log);
  return {ok,
          log.iterations,
          log.residuals,
          log.failure.cause,
          log.failure.cell,
          log.failure.place};
}

std::array<double, 2> Body::reaction(const std::string& boundary) const
{
  return _parts->sim.problem
      ->reactions()[_parts->sim.domain.boundary(boundary)];
}

double Body::discharge(const std::string& boundary) const
{
  return _parts->sim.problem
      ->discharge()[_parts->sim.domain.boundary(boundary)];
}

std::array<double, 2> Body::mismatch() const
{
  return _parts->sim.problem->mismatch(_parts->sim.state);
}

double Body::kinetic_energy()
{
  return _parts->sim.problem->kinetic_energy(state());
}

void Body::rebalance(double t)
{
  _parts->sim.problem->rebalance(state(), t);
}

void Body::set_gravity(std::array<double, 2> start, std::array<double, 2> end)
{
  std::ranges::copy(start, _parts->constants.g_n);
  std::ranges::copy(end, _parts->constants.g);
}

void Body::set_dynamics(const scene::Dynamics& scheme, double dt)
{
  Parts& p = *_parts;
  const auto size = static_cast<std::size_t>(2 * num_nodes());
  state().a.resize(size);
  state().p_rate.resize(num_nodes());
  p.newmark.emplace(p.sim.domain, p.scene.symmetry, scheme.resolved());
  p.newmark->begin_step(state(), dt);
  p.element->set_newmark(&*p.newmark);
  p.constants.dt = dt;
  p.constants.c_a = p.newmark->c_a;
  p.constants.c_v = p.newmark->c_v;
  p.constants.c_r = p.newmark->c_r;
  p.constants.b = scheme.damping_stiffness;
}

void Body::begin_iteration(std::span<const double> z)
{
  _parts->element->begin_iteration(z);
}

bool Body::evaluate(std::span<const double> z)
{
  std::string why;
  return _parts->element->evaluate(state(), z, _parts->constants, why) < 0;
}

std::array<double, 9> Body::residual(int c, std::span<const double> z) const
{
  std::array<double, 9> R;
  _parts->element->residual(_parts->sim.state, c, z, _parts->constants,
                            R.data());
  return R;
}

std::array<double, 81> Body::jacobian(int c, std::span<const double> z) const
{
  std::array<double, 81> J;
  _parts->element->jacobian(_parts->sim.state, c, z, _parts->constants,
                            J.data());
  return J;
}

void Body::full(int c, std::span<const double> z, std::span<double> R,
                std::span<double> J) const
{
  _parts->element->full(_parts->sim.state, c, z, _parts->constants, R, J);
}

void Body::accept(std::span<const double> z)
{
  _parts->element->accept(state(), z, 1);
  _parts->element->begin_step(state(), 1);
}

double Body::volume(int c) const
{
  return _parts->element->volume(c);
}

scene::Scene rectangle(double width, double height, int nx, int ny,
                       std::string law,
                       std::map<std::string, double> parameters)
{
  scene::Scene scene;
  scene.mesh.shape = "rectangle";
  scene.mesh.width = width;
  scene.mesh.height = height;
  scene.mesh.cells = {nx, ny};
  scene.material["body"] = {std::move(law), std::move(parameters)};
  return scene;
}

void use_points(scene::Scene& scene, int points)
{
  scene.solver.layout =
      points == 1 ? scene::Layout::mean : scene::Layout::quadrature;
  if (points != 1)
    scene.solver.points = points;
}

scene::Stage stage(double duration, double step)
{
  scene::Stage s;
  s.duration = duration;
  s.step = step;
  return s;
}

double solve_prescribed(
    Body& body,
    const std::function<std::array<double, 2>(double x, double y)>& u)
{
  const int n = 3 * body.num_nodes();
  const State& state = body.state();
  std::vector<double> z(n, 0);
  std::vector<bool> held(n, false);
  for (int i = 0; i < body.num_nodes(); ++i)
    z[3 * i + 2] = state.p[i];
  for (const char* side : {"left", "right", "bottom", "top"})
    for (int i : body.nodes(side))
      held[3 * i] = held[3 * i + 1] = true;
  // The start: every node moves so, lest a large rotation inverts a cell; the
  // inner ones are then put off, so that there is something to find.
  for (int i = 0; i < body.num_nodes(); ++i)
  {
    const auto [ux, uy] = u(state.x[2 * i], state.x[2 * i + 1]);
    z[3 * i] = ux + (held[3 * i] ? 0 : 1e-5 * std::sin(7.0 * i));
    z[3 * i + 1] = uy + (held[3 * i] ? 0 : 1e-5 * std::cos(5.0 * i));
  }
  double size = 0;
  for (int it = 0; it < 12; ++it)
  {
    if (not body.evaluate(z))
      return std::numeric_limits<double>::quiet_NaN();
    body.begin_iteration(z);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd r = Eigen::VectorXd::Zero(n);
    for (int c = 0; c < body.num_cells(); ++c)
    {
      const auto R = body.residual(c, z);
      const auto J = body.jacobian(c, z);
      const auto nodes = body.cell(c);
      for (int i = 0; i < 9; ++i)
      {
        const int row = 3 * nodes[i / 3] + i % 3;
        if (held[row])
          continue;
        r[row] += R[i];
        for (int j = 0; j < 9; ++j)
          if (const int column = 3 * nodes[j / 3] + j % 3; not held[column])
            entries.emplace_back(row, column, J[9 * i + j]);
      }
    }
    for (int i = 0; i < n; ++i)
      if (held[i])
        entries.emplace_back(i, i, 1.0);
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(A);
    const Eigen::VectorXd dz = lu.solve(r);
    size = 0;
    for (int i = 0; i < n; ++i)
    {
      z[i] -= dz[i];
      if (i % 3 != 2)
        size = std::max(size, std::abs(dz[i]));
    }
    if (size <= 1e-15 * std::max(1.0, largest(state.x)))
      break;
  }
  if (not body.evaluate(z))
    return std::numeric_limits<double>::quiet_NaN();
  body.accept(z);
  return size / largest(state.x);
}

double largest(std::span<const double> v)
{
  double out = 0;
  for (double x : v)
    out = std::max(out, std::abs(x));
  return out;
}
} // namespace mmale::test

int main(int argc, char** argv)
{
  const mmale::Environment environment(argv[0], {});
  return Catch::Session().run(argc, argv);
}
