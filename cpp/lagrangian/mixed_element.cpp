// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mixed_element.h"

#include "mesh/corners.h"
#include "mixed.h"
#include "mixture.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace mmale::lagrangian
{
namespace
{
using ::remap::Materials;
using ::remap::Part;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What an open gap keeps of its volume equation, lest a node without any
/// other cell has no pressure. Doubled: twice as much of nothing.
constexpr double open_fill = 1e-6;
/// Void that is left of a gap that has closed; the remap sweeps it up.
constexpr double closed_fill = 1e-13;

/// Part of the ersatz stiffness that holds nodes to where they were, lest
/// crumbs that touch nothing float about in statics.
constexpr double grounded = 1e-4;

/// Shares of the vertices of a cell in a point.
std::array<double, 3> shares_at(const mesh::Domain& domain,
                                std::span<const double> x, int c,
                                ::remap::Point at)
{
  const auto& n = domain.cells[c];
  const auto cross = [&](int i, int j)
  {
    return (x[2 * n[i]] - at.x) * (x[2 * n[j] + 1] - at.y)
           - (x[2 * n[j]] - at.x) * (x[2 * n[i] + 1] - at.y);
  };
  const std::array<double, 3> a{cross(1, 2), cross(2, 0), cross(0, 1)};
  const double sum = a[0] + a[1] + a[2];
  return {a[0] / sum, a[1] / sum, a[2] / sum};
}
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

/// How a mixed cell is made up at the start of the step.
void MixedElement::find_mixture(const State& state, int c, Mixture& m) const
{
  const Materials& materials = *state.materials;
  m.row = materials.row(c);
  std::size_t slot = materials.first_slot(m.row);
  int bodies = 0;
  double fill = 0, mass = 0;
  std::array<double, 3> middle{0, 0, 0}; // about an axis not the third parts
  for (const Part& part : materials.parts(m.row))
  {
    const auto at = shares_at(_domain, state.x, c, part.centroid);
    for (int v = 0; v < 3; ++v)
      middle[v] += part.fraction * at[v] - part.fraction / 3;
    if (const double rho = state.density[slot++]; not is_void(part.material))
    {
      ++bodies;
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
      static_cast<std::size_t>(bodies) < materials.parts(m.row).size();
  m.gap = with_void
          and (_rule == scene::VoidRule::closing
               or (_rule == scene::VoidRule::by_bodies and bodies > 1));
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
  // any stiffness of the scene's: it only sets p of nodes that bear nothing
  _K_open = 0;
  for (int c : _mixed)
    _K_open = std::max(_K_open, moduli(state, c, dt).K);
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
      const auto at = shares_at(_domain, state.x, c, part.centroid);
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
