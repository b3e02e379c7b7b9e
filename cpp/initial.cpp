// SPDX-License-Identifier: LGPL-3.0-or-later
#include "initial.h"

#include "bridge/paint.h"
#include "effective.h"
#include "mixture.h"

#include "lagrangian/kernel.h"
#include "simulation.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <format>
#include <stdexcept>

namespace mmale
{
namespace
{
double top_of(const mesh::Domain& domain)
{
  double top = -scene::infinity;
  for (std::size_t i = 1; i < domain.initial_x.size(); i += 2)
    top = std::max(top, domain.initial_x[i]);
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, domain.comm);
  return top;
}

/// Shares of the three vertices in point q of `points` of a cell.
std::array<double, 3> shares(int points, int q)
{
  if (points == 3)
    return lagrangian::points<3>()[q];
  if (points == 6)
    return lagrangian::points<6>()[q];
  return {1. / 3, 1. / 3, 1. / 3};
}

/// The ground at a height, at rest under its weight.
struct Layer
{
  double pressure;      ///< total [Pa]
  double excess;        ///< of the vertical stress over the pressure [Pa]
  double pore_pressure; ///< 0 without water [Pa]
  double void_ratio;    ///< NaN where the scene leaves it to the law
};

class Ground
{
public:
  /// Collective.
  Ground(const scene::Scene& scene, const mesh::Domain& domain,
         const lagrangian::Element& element)
      : _scene(scene), _element(element),
        _surface(scene.initial.surface.value_or(top_of(domain)))
  {
    if (not scene.stage.empty() and scene.stage.front().gravity)
      _gravity = -(*scene.stage.front().gravity)[1](0);
  }

  Layer at(double y) const
  {
    const auto& initial = _scene.initial;
    const double e = void_ratio(y), p_w = pore_pressure(y);
    if (not initial.K0)
      return {initial.pressure.value_or(0), 0, p_w, e};
    // horizontal is K0 times vertical, of the effective stresses
    const double vertical = vertical_stress(y);
    const double excess = (vertical - p_w) * 2 * (1 - *initial.K0) / 3;
    return {vertical - excess, excess, p_w, e};
  }

private:
  double void_ratio(double y) const;
  double density(double y) const; ///< of all, water too [kg/m3]
  double pore_pressure(double y) const;
  double vertical_stress(double y) const; ///< total, compression positive [Pa]

  const scene::Scene& _scene;
  const lagrangian::Element& _element;
  double _surface;     ///< [m]
  double _gravity = 0; ///< downward [m/s2]
};

double Ground::void_ratio(double y) const
{
  const auto& at = _scene.initial.void_ratio;
  if (at.empty())
    return scene::required;
  const double depth = _surface - y;
  const auto below = std::ranges::find_if(at, [depth](const scene::AtDepth& a)
                                          { return a.depth >= depth; });
  if (below == at.begin())
    return at.front().value;
  if (below == at.end())
    return at.back().value;
  const auto& [d0, e0] = *(below - 1);
  const auto& [d1, e1] = *below;
  return e0 + (e1 - e0) * (depth - d0) / (d1 - d0);
}

double Ground::density(double y) const
{
  std::vector<double> q(_element.num_history());
  return _element.begin({.void_ratio = void_ratio(y)}, 0, q);
}

double Ground::pore_pressure(double y) const
{
  const auto& initial = _scene.initial;
  if (not _scene.water or not initial.K0)
    return 0;
  return _scene.water->density * _gravity
         * (initial.water_table.value_or(_surface) - y);
}

double Ground::vertical_stress(double y) const
{
  // rho may bend where the void ratio does, and is smooth in between: Simpson
  // between these depths
  const double depth = _surface - y;
  std::vector<double> bends{0};
  for (const auto& a : _scene.initial.void_ratio)
    if (a.depth > 0 and a.depth < depth)
      bends.push_back(a.depth);
  bends.push_back(depth);
  double mass = 0;
  const auto rho = [this](double d) { return density(_surface - d); };
  for (std::size_t i = 1; i < bends.size(); ++i)
  {
    const double a = bends[i - 1], h = bends[i] - a;
    mass += h / 6 * (rho(a) + 4 * rho(a + 0.5 * h) + rho(a + h));
  }
  // with a table above it, water stands on the surface
  return _scene.initial.surcharge + std::max(0.0, pore_pressure(_surface))
         + _gravity * mass;
}

} // namespace

void fill_initial(const scene::Scene& scene, const mesh::Domain& domain,
                  const lagrangian::Element& element, State& state)
{
  const Ground ground(scene, domain, element);
  const std::size_t nodes = domain.num_nodes(), cells = domain.num_cells();
  const int points = state.points;
  const std::size_t h = element.num_history();
  state.p.resize(nodes);
  state.p_w.resize(scene.water and scene.water->seepage() ? nodes : 0);
  for (std::size_t n = 0; n < nodes; ++n)
  {
    const Layer layer = ground.at(domain.initial_x[2 * n + 1]);
    state.p[n] = layer.pressure;
    if (not state.p_w.empty())
      state.p_w[n] = layer.pore_pressure;
  }
  state.s.assign(4 * cells * points, 0);
  state.P.resize(cells * points);
  state.density.assign(cells, 0);
  state.history.assign(h * cells * points, 0);
  state.apex.assign(element.has_floor() ? cells : 0, 0);
  for (std::size_t q = 0; q < cells * points; ++q)
  {
    const std::size_t c = q / points;
    const auto share = shares(points, static_cast<int>(q % points));
    double y = 0;
    for (int v = 0; v < 3; ++v)
      y += share[v] * domain.initial_x[2 * domain.cells[c][v] + 1];
    const auto [p, excess, p_w, e] = ground.at(y);
    const double half = 0.5 * excess;
    state.P[q] = p;
    material::Voigt::Map(state.s.data() + 4 * q) << half, -2 * half, half, 0;
    state.density[c] +=
        element.begin({p - p_w, e}, p_w,
                      std::span(state.history).subspan(h * q, h))
        / points;
  }
}

void fill_initial(const scene::Scene& scene, const mesh::Domain& domain,
                  std::span<const material::AnyLaw> laws, State& state)
{
  state.materials = bridge::paint(scene, domain);
  const bridge::Materials& materials = *state.materials;
  const auto slots = static_cast<std::size_t>(materials.num_slots());
  std::size_t h = 0;
  bool floor = false;
  std::vector<lagrangian::Medium> media;
  for (const material::AnyLaw& law : laws)
  {
    const auto& medium = media.emplace_back(law, std::nullopt);
    h = std::max(h, static_cast<std::size_t>(medium.num_history()));
    floor = floor or medium.has_floor();
  }
  const double p = scene.initial.pressure.value_or(0);
  state.p.assign(domain.num_nodes(), p);
  state.s.assign(4 * slots, 0);
  state.P.assign(slots, 0);
  state.density.assign(slots, 0);
  state.history.assign(h * slots, 0);
  state.apex.assign(floor ? domain.num_cells() : 0, 0);
  for (std::size_t slot = 0; slot < slots; ++slot)
  {
    const std::int32_t k = materials.material(static_cast<std::int32_t>(slot));
    if (k < 0)
      continue;
    state.P[slot] = media[k].is_void() ? 0 : p;
    state.density[slot] = media[k].begin(
        {.p = p}, 0, std::span(state.history).subspan(h * slot, h));
  }
  mixture::fill(state);
}

namespace
{
/// The first stage at its beginning: everything stands still.
scene::Stage at_rest(scene::Stage stage)
{
  const auto now = [](std::optional<scene::TimeSeries>& series)
  {
    if (series)
      series = scene::TimeSeries{{}, {(*series)(0)}};
  };
  const auto stop = [](std::optional<scene::TimeSeries>& series)
  {
    if (series)
      series = scene::TimeSeries{{}, {0}};
  };
  stage.dynamics.reset();
  for (auto& g : *stage.gravity)
    g = scene::TimeSeries{{}, {g(0)}};
  for (auto& [name, condition] : stage.boundary)
  {
    for (auto* series : {&condition.velocity_x, &condition.velocity_y,
                         &condition.displacement_x, &condition.displacement_y})
      stop(*series);
    for (auto* series :
         {&condition.traction_x, &condition.traction_y, &condition.pressure})
      now(*series);
    if (condition.wall)
      for (auto* series :
           {&condition.wall->velocity_x, &condition.wall->velocity_y})
        stop(*series);
    if (condition.absorbing) // it carries what it carries at rest
      condition.fixed = true;
    condition.absorbing = false;
  }
  return stage;
}

/// Largest share of a stress that the law would cut off. Collective.
double beyond_the_law(const Simulation& sim)
{
  State copy = sim.state;
  if (sim.scene.water)
    to_effective(copy);
  double worst = admit(sim.laws, copy, sim.domain.num_owned_cells).largest;
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, sim.domain.comm);
  return worst;
}
} // namespace

Balance settle(Simulation& sim)
{
  // forces on free nodes over the weight; the steps of Newton's method reach
  // the solver's own tolerance
  constexpr double enough = 1e-8;
  constexpr int max_rounds = 4;
  const scene::Stage stage = at_rest(sim.scene.stage.front());
  State& state = sim.state;
  Balance balance;
  sim.problem->set_stage(stage, state);
  sim.problem->rest_under_gravity();
  balance.as_laid = balance.settled = sim.problem->imbalance(state, stage.step);
  if (balance.as_laid > 0.1 * enough)
  {
    // The water stays as it is, so what changes is effective stress, and the
    // skeleton's modulus has to tell how much: with the water's beside it sand
    // near a surface was taken beyond what it bears.
    const auto [G, K] =
        sim.problem->moduli(state, stage.step, lagrangian::Meets::skeleton);
    const material::AnyLaw elastic =
        material::Elastic{.E = 9 * K * G / (3 * K + G),
                          .nu = (3 * K - 2 * G) / (6 * K + 2 * G),
                          .density = 0};
    State trial = state;
    trial.history.clear(); // total stress: the water stays as it is
    trial.p_w.clear();
    trial.apex.clear();
    scene::Solver options = sim.scene.solver;
    options.bubble_spring = 0; // its force would be gone in the next round
    lagrangian::Problem problem(sim.domain, std::span(&elastic, 1),
                                sim.scene.symmetry, options, std::nullopt,
                                sim.clock);
    problem.set_stage(stage, trial);
    problem.rest_under_gravity();
    for (int i = 0; i < max_rounds and balance.settled > 0.1 * enough; ++i)
    {
      lagrangian::NewtonLog log;
      if (not problem.solve(trial, 0, stage.step, log))
        break;
      trial.x = state.x;
      trial.density = state.density;
      state.s = trial.s;
      state.P = trial.P;
      state.p = trial.p;
      balance.settled = sim.problem->imbalance(state, stage.step);
    }
  }
  // the mesh's error is a small part of a node's own weight
  const double nodes = static_cast<double>(sim.domain.nodes().size_global());
  if (balance.as_laid > 0.5 / nodes)
    throw std::runtime_error(std::format(
        "the initial stress does not fit the loads of stage '{}': a force of "
        "{:.1e} of the weight is left on a node; is the surcharge (and what "
        "water stands above the surface) a pressure there?",
        stage.name, balance.as_laid));
  if (not(balance.settled <= enough))
    throw std::runtime_error(std::format(
        "the initial stress is not in balance with the weight and the loads of "
        "stage '{}': a force of {:.1e} of the weight is left on a node; {:.1e} "
        "of a stress is beyond what the material bears",
        stage.name, balance.settled, beyond_the_law(sim)));
  if (const double cut = beyond_the_law(sim); cut > 1e-6)
    throw std::runtime_error(
        std::format("the initial stress is more than the material bears: {:.1e}"
                    " of it would be cut off; K0 = {}?",
                    cut, *sim.scene.initial.K0));
  return balance;
}
} // namespace mmale
