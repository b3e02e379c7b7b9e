// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mixed_element.h"

#include "mixed.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace mmale::lagrangian
{
namespace
{
using bridge::Materials;
using bridge::Part;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

} // namespace

MixedElement::MixedElement(const mesh::Domain& domain,
                           std::span<const material::AnyLaw> laws,
                           scene::Symmetry symmetry,
                           const scene::Solver& options)
    : MeanElement(domain, laws, symmetry, options, std::nullopt),
      _shared{{_axisymmetric ? *form_mixed_R_axi : *form_mixed_R_plane,
               IntegralKind::cell},
              {_axisymmetric ? *form_mixed_J_axi : *form_mixed_J_plane,
               IntegralKind::cell},
              {_axisymmetric ? *form_mixed_B_axi : *form_mixed_B_plane,
               IntegralKind::cell}},
      _closure(material::make_closure(options.closure)),
      _rule(options.void_rule), _pure(laws.size()),
      _of_cell(domain.num_owned_cells), _empty(domain.num_owned_cells)
{
}

bool MixedElement::present(const State& state, int c) const
{
  const std::int32_t k = state.materials->pure(c);
  return k < 0 or not is_void(k);
}

bool MixedElement::bears(const State& state, int c) const
{
  const Materials& materials = *state.materials;
  if (const std::int32_t k = materials.pure(c); k >= 0)
    return not is_void(k);
  double fill = 0;
  bool with_void = false;
  for (const Part& part : materials.parts(materials.row(c)))
    if (is_void(part.material))
      with_void = true;
    else
      fill += part.fraction;
  return not with_void or fill >= _options.spray_below;
}

void MixedElement::find_cells(const State& state)
{
  const Materials& materials = *state.materials;
  for (auto& list : _pure)
    list.clear();
  _mixed.clear();
  _mixture.clear();
  std::ranges::fill(_of_cell, -1);
  for (int c = 0; c < _domain.num_owned_cells; ++c)
  {
    const std::int32_t k = materials.pure(c);
    _empty[c] = k >= 0 and is_void(k);
    if (k >= 0)
    {
      _pure[k].push_back(c);
      continue;
    }
    _of_cell[c] = static_cast<int>(_mixed.size());
    _mixed.push_back(c);
    find_mixture(state, c, _mixture.emplace_back());
  }
  const auto parts =
      static_cast<std::size_t>(materials.num_slots() - materials.num_cells());
  _part.assign(parts, {.guess = nan});
  _part_history.assign(parts * _num_history, 0);
}

/// Shares of the vertices of a cell in a part's middle.
std::array<double, 3> MixedElement::shares_at(const State& state, int c,
                                              const Part& part) const
{
  const auto& x = state.x;
  const auto& n = _domain.cells[c];
  const auto [px, py] = std::array{part.centroid.x, part.centroid.y};
  const auto cross = [&](int i, int j)
  {
    return (x[2 * n[i]] - px) * (x[2 * n[j] + 1] - py)
           - (x[2 * n[j]] - px) * (x[2 * n[i] + 1] - py);
  };
  const std::array<double, 3> a{cross(1, 2), cross(2, 0), cross(0, 1)};
  const double sum = a[0] + a[1] + a[2];
  return {a[0] / sum, a[1] / sum, a[2] / sum};
}

/// How a mixed cell is made up at the start of the step.
void MixedElement::find_mixture(const State& state, int c, Mixture& m) const
{
  const Materials& materials = *state.materials;
  m.row = materials.row(c);
  std::size_t slot = materials.first_slot(m.row);
  int number = 0; // of bodies
  double fill = 0, mass = 0;
  std::array<double, 3> middle{0, 0, 0}; // of the cell less 1/3: not 0 about
                                         // an axis
  for (const Part& part : materials.parts(m.row))
  {
    const auto at = shares_at(state, c, part);
    for (int v = 0; v < 3; ++v)
      middle[v] += part.fraction * at[v] - part.fraction / 3;
    if (const double rho = state.density[slot++]; not is_void(part.material))
    {
      ++number;
      fill += part.fraction;
      mass += part.fraction * rho;
      for (int v = 0; v < 3; ++v)
      {
        m.centre[v] += part.fraction * at[v];
        m.mass_centre[v] += part.fraction * rho * at[v];
      }
    }
  }
  const bool with_void =
      static_cast<std::size_t>(number) < materials.parts(m.row).size();
  m.gap = with_void
          and (_rule == scene::VoidRule::closing
               or (_rule == scene::VoidRule::by_bodies and number > 1));
  m.fill = with_void and not m.gap ? fill : 1;
  m.bodies = fill;
  m.spray = with_void and fill < _options.spray_below;
  for (int v = 0; v < 3; ++v)
  {
    m.mass_centre[v] = mass > 0 ? m.mass_centre[v] / mass - middle[v] : 1. / 3;
    m.centre[v] =
        with_void and not m.gap ? m.centre[v] / fill - middle[v] : 1. / 3;
  }
}

void MixedElement::begin_step(const State& state, double dt)
{
  find_cells(state);
  MeanElement::begin_step(state, dt);
  // sets p = 0 at nodes that bear nothing; the same on all ranks
  _K_open = 0;
  for (int c : _mixed)
    _K_open = std::max(_K_open, moduli(state, c, dt).K);
  MPI_Allreduce(MPI_IN_PLACE, &_K_open, 1, MPI_DOUBLE, MPI_MAX, _domain.comm);
}

material::Moduli MixedElement::moduli(const State& state, int c, double dt,
                                      Meets) const
{
  const Materials& materials = *state.materials;
  material::Moduli sum{0, 0};
  double fill = 0;
  const auto add = [&](std::int32_t k, std::size_t slot, double f)
  {
    const Medium& medium = _media[k];
    if (medium.is_void())
      return;
    const auto h = static_cast<std::size_t>(_num_history);
    const material::Point at{
        Voigt(state.s.data() + 4 * slot), state.P[slot],
        std::span(state.history).subspan(h * slot, medium.num_history())};
    const auto [G, K] = medium.with([&](const auto& answers)
                                    { return answers(0).moduli(at, dt); });
    sum.G += f * G;
    sum.K += f / K; // one pressure
    fill += f;
  };
  if (const std::int32_t k = materials.pure(c); k >= 0)
    add(k, c, 1);
  else
  {
    std::size_t slot = materials.first_slot(materials.row(c));
    for (const Part& part : materials.parts(materials.row(c)))
      add(part.material, slot++, part.fraction);
  }
  if (fill > 0)
    sum = {sum.G / fill, fill / sum.K};
  return sum;
}

int MixedElement::evaluate(const State& state, std::span<const double> z,
                           const Constants& constants, std::string& why)
{
  for (std::size_t k = 0; k < _media.size(); ++k)
  {
    if (_media[k].is_void())
    {
      for (int c : _pure[k])
        if (const char* trouble = strain_cell(state, c, z))
        {
          why = trouble;
          return c;
        }
    }
    else if (const int failed = evaluate_cells(_media[k], _pure[k], state, z,
                                               constants.dt, why);
             failed >= 0)
      return failed;
  }
  for (int c : _mixed)
  {
    const char* trouble = strain_cell(state, c, z);
    if (not trouble)
      trouble = answer_mixture(state, c, z, constants.dt);
    if (trouble)
    {
      why = trouble;
      return c;
    }
  }
  return -1;
}

/// The shares of a cell that bear load, as they are when the step begins.
void MixedElement::fill_shares(const State& state, const Mixture& m,
                               const Motion& motion)
{
  const Materials& materials = *state.materials;
  const auto h = static_cast<std::size_t>(_num_history);
  const auto parts = materials.parts(m.row);
  std::size_t slot = materials.first_slot(m.row);
  const std::size_t cells = materials.num_cells();
  _share.clear();
  _turned.resize(h * parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i, ++slot)
  {
    const Medium& medium = _media[parts[i].material];
    if (medium.is_void())
      continue;
    const auto numbers = static_cast<std::size_t>(medium.num_history());
    const auto turned = std::span(_turned).subspan(h * i, numbers);
    std::copy_n(state.history.begin() + h * slot, numbers, turned.begin());
    medium.turn(turned, motion.cosine, motion.sine);
    _share.push_back(
        {.law = &medium.law(),
         .fraction = parts[i].fraction,
         .start = {rotate(Voigt(state.s.data() + 4 * slot), motion.cosine,
                          motion.sine),
                   state.P[slot], turned},
         .q = std::span(_part_history).subspan(h * (slot - cells), numbers),
         .guess = _part[slot - cells].guess,
         .answer = {}});
  }
}

/// Between the largest share and the others, across the line through their
/// middles. Ties are broken by place: the numbers of materials mean nothing.
material::Interface MixedElement::find_interface(const State& state, int c,
                                                 const Mixture& m) const
{
  material::Interface out;
  if (std::holds_alternative<material::EqualPressure>(_closure))
    return out;
  const auto before = [](const Part& a, const Part& b)
  {
    return std::tuple(a.fraction, a.centroid.x, a.centroid.y)
           > std::tuple(b.fraction, b.centroid.x, b.centroid.y);
  };
  std::vector<std::pair<Part, int>> bodies;
  for (const Part& part : state.materials->parts(m.row))
    if (not is_void(part.material))
      bodies.emplace_back(part, static_cast<int>(bodies.size()));
  if (bodies.size() < 2)
    return out;
  std::ranges::sort(bodies, before, [](const auto& b) { return b.first; });
  out.first = bodies[0].second;
  out.second = bodies[1].second;
  const auto way = bodies[1].first.centroid - bodies[0].first.centroid;
  const double length = std::hypot(way.x, way.y);
  if (not(length > 0))
    return out;
  const Motion& motion = _cell[c].motion;
  out.normal = {(motion.cosine * way.x - motion.sine * way.y) / length,
                (motion.sine * way.x + motion.cosine * way.y) / length};
  out.area = 1; // there is one
  return out;
}

/// What the materials of a cell answer together; what is wrong, or null.
const char* MixedElement::answer_mixture(const State& state, int c,
                                         std::span<const double> z, double dt)
{
  Cell& cell = _cell[c];
  Mixture& m = _mixture[_of_cell[c]];
  double p = 0;
  for (int v = 0; v < 3; ++v)
    p += m.centre[v] * z[3 * _domain.cells[c][v] + 2];
  fill_shares(state, m, cell.motion);
  m.open = m.spray;
  if (m.gap and not m.spray)
  {
    material::Mixed unloaded;
    if (material::open_volume(_share, cell.motion.de, dt, tangent_kind(),
                              unloaded)
        != Outcome::ok)
      return "a law asks for a smaller step";
    m.open = unloaded.volume < std::exp(cell.motion.ln_J);
  }
  if (m.open)
  {
    bear_nothing(state, c);
    return nullptr;
  }
  material::Mixed mixed;
  const material::Interface interface = find_interface(state, c, m);
  const Outcome outcome = std::visit(
      [&](const auto& closure)
      {
        return closure(_share, cell.motion.de, p, dt, tangent_kind(), interface,
                       mixed);
      },
      _closure);
  if (outcome != Outcome::ok)
    return "a law asks for a smaller step";
  take_parts(state, c);
  cell.answer = mixed.mean;
  if (m.gap)
    cell.answer.theta += std::log(m.bodies);
  for (Voigt* mean : {&cell.answer.s, &cell.answer.ds_dp})
    *mean *= m.fill;
  cell.answer.ds_de *= m.fill;
  cell.p = m.fill * p;
  settle_answer(c);
  return nullptr;
}

/// What each material has answered.
void MixedElement::take_parts(const State& state, int c)
{
  const Motion& motion = _cell[c].motion;
  const Materials& materials = *state.materials;
  const int row = _mixture[_of_cell[c]].row;
  std::size_t slot = materials.first_slot(row) - materials.num_cells();
  auto share = _share.begin();
  for (const Part& part : materials.parts(row))
  {
    PartEnd& end = _part[slot++];
    end = {Voigt::Zero(), 0, 0, nan};
    if (is_void(part.material))
      continue;
    end = {rotate(share->answer.s, motion.cosine, motion.sine), share->p,
           share->answer.theta, share->guess};
    _media[part.material].turn(share->q, motion.cosine, motion.sine);
    ++share;
  }
}

/// Bodies with room about them take no part in the cell's strain: they are
/// unloaded, and fly on as they are.
void MixedElement::bear_nothing(const State& state, int c)
{
  Cell& cell = _cell[c];
  const Mixture& m = _mixture[_of_cell[c]];
  const Materials& materials = *state.materials;
  const std::size_t h = _num_history, cells = materials.num_cells();
  std::size_t slot = materials.first_slot(m.row);
  for (const Part& part : materials.parts(m.row))
  {
    const std::size_t i = slot - cells;
    _part[i] = {Voigt::Zero(), 0, 0, nan};
    const auto q = std::span(_part_history).subspan(h * i, h);
    std::copy_n(state.history.begin() + h * slot, h, q.begin());
    const Medium& medium = _media[part.material];
    for (int half = 0; half < 2 and not medium.is_void(); ++half)
      medium.turn(q, cell.motion.cosine, cell.motion.sine);
    ++slot;
  }
  cell.answer = {};
  cell.p = 0;
  settle_answer(c);
}
} // namespace mmale::lagrangian
