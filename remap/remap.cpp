// SPDX-License-Identifier: LGPL-3.0-or-later

#include "remap/remap.h"

#include "remap/dual/dual.h"
#include "remap/transport/kernel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace remap;

namespace
{
template <Geometry G>
Moments cell_moments(const Mesh& mesh, std::int32_t c,
                     std::span<const double> x)
{
  const Triple& n = mesh.cell(c);
  return triangle<G>(point(x, n[0]), point(x, n[1]), point(x, n[2]));
}

/// Call with the scheme and the number of components as constants.
template <class F>
void with_components(int n, F&& call)
{
  switch (n)
  {
  case 1:
    return call(std::integral_constant<int, 1>{});
  case 2:
    return call(std::integral_constant<int, 2>{});
  case 3:
    return call(std::integral_constant<int, 3>{});
  case 4:
    return call(std::integral_constant<int, 4>{});
  default:
    return call(std::integral_constant<int, 0>{});
  }
}
} // namespace

std::vector<std::string> Options::complaints() const
{
  std::vector<std::string> out;
  if (not(max_loss > 0))
    out.push_back("max_loss: must be positive");
  if (max_cycles < 1)
    out.push_back("max_cycles: must be at least 1");
  if (cell_components < 0 or nodal_components < 0)
    out.push_back("cell_components, nodal_components: must not be negative");
  return out;
}

Remapper::Remapper(const Mesh& mesh, Options options)
    : _mesh(&mesh), _options(std::move(options))
{
  if (const auto all = _options.complaints(); not all.empty())
  {
    std::string text;
    for (const std::string& line : all)
      text += line + "\n";
    throw std::invalid_argument(text);
  }
  const auto facets = static_cast<std::size_t>(mesh.num_facets());
  const auto cells = static_cast<std::size_t>(mesh.num_cells());
  _cells.reserve(mesh.cell_cells(), mesh.owned_cells(), 2 * facets,
                 _options.cell_components);
  if (_options.nodal_components > 0)
  {
    std::size_t boundary = 0;
    for (std::int32_t f = 0; f < mesh.num_facets(); ++f)
      boundary += mesh.facet_cells(f)[1] < 0 ? 1 : 0;
    _nodes.reserve(mesh.node_nodes(), mesh.owned_nodes(),
                   6 * cells + 4 * boundary, _options.nodal_components);
    _flags.resize(mesh.num_nodes());
  }
  _x.resize(std::size_t(2) * mesh.num_nodes());
  _y.resize(std::size_t(2) * mesh.num_nodes());
  _moved.assign(mesh.num_nodes(), 0);
  _moved_nodes.reserve(mesh.num_nodes());
}

bool Remapper::fits(const Field& field, std::int32_t num, int components) const
{
  const int n = field.components;
  const bool any_open = std::find(_options.boundaries.begin(),
                                  _options.boundaries.end(), Boundary::open)
                        != _options.boundaries.end();
  return n >= 1 and n <= components and field.group >= 1
         and n % field.group == 0
         and field.values.size() == std::size_t(n) * num
         and (not any_open
              or field.inflow.size() == n * _options.boundaries.size());
}

bool Remapper::sizes_fit(std::span<const double> x_old,
                         std::span<const double> x_new,
                         std::span<const Field> cells,
                         std::span<const Field> nodes) const
{
  const auto cell_fits = [this](const Field& f)
  { return fits(f, _mesh->num_cells(), _options.cell_components); };
  const auto node_fits = [this](const Field& f)
  { return fits(f, _mesh->num_nodes(), _options.nodal_components); };
  return x_old.size() == _x.size() and x_new.size() == _x.size()
         and std::all_of(cells.begin(), cells.end(), cell_fits)
         and std::all_of(nodes.begin(), nodes.end(), node_fits);
}

void Remapper::find_touched(std::span<const double> x_old,
                            std::span<const double> x_new)
{
  for (std::int32_t i : _moved_nodes)
    _moved[i] = 0;
  _moved_nodes.clear();
  for (std::int32_t i = 0; i < _mesh->num_nodes(); ++i)
    if (not(point(x_old, i) == point(x_new, i)))
    {
      _moved[i] = 1;
      _moved_nodes.push_back(i);
    }
  _cells.clear();
  _nodes.clear();
  for (std::int32_t i : _moved_nodes)
    for (std::int32_t c : _mesh->node_cells()[i])
      _cells.touch(c);
  // In the order of memory, whichever way they were found.
  std::sort(_cells.touched.begin(), _cells.touched.end());
  if (_dual)
  {
    for (std::int32_t c : _cells.touched)
      for (std::int32_t i : _mesh->cell(c))
        _nodes.touch(i);
    std::sort(_nodes.touched.begin(), _nodes.touched.end());
  }
  _report = {};
  _report.moved_nodes = static_cast<std::int32_t>(_moved_nodes.size());
  _report.touched_cells = static_cast<std::int32_t>(_cells.touched.size());
}

/// A ghost node may change because of a cell that we do not see; its owner must
/// know that we need the centroids around it, and we that it changes.
void Remapper::exchange_touched(const Host& host)
{
  if (_dual)
  {
    for (std::size_t i = 0; i < _flags.size(); ++i)
      _flags[i] = _nodes.mark[i];
    host.update_nodes(_flags, 1);
    for (std::int32_t i = _mesh->owned_nodes(); i < _mesh->num_nodes(); ++i)
      if (_flags[i] > 0)
        _nodes.touch(i);
    _nodes.close_ring();
  }
  _cells.close_ring();
}

template <Geometry G>
void Remapper::measure(bool with_ring, const Host& host)
{
  const auto cell = [this](std::int32_t c)
  {
    const Moments m = cell_moments<G>(*_mesh, c, _x);
    _cells.volume[c] = m.v;
    _cells.centroid[c] = m.centroid();
  };
  const auto node = [this](std::int32_t i)
  {
    const Moments m = dual::volume<G>(*_mesh, i, _x);
    _nodes.volume[i] = m.v;
    _nodes.centroid[i] = m.centroid();
  };
  std::for_each(_cells.touched.begin(), _cells.touched.end(), cell);
  std::for_each(_nodes.touched.begin(), _nodes.touched.end(), node);
  if (with_ring)
  {
    std::for_each(_cells.ring.begin(), _cells.ring.end(), cell);
    std::for_each(_nodes.ring.begin(), _nodes.ring.end(), node);
  }
  // The corners around a ghost node are not all here.
  if (_dual)
    host.update_nodes(
        std::span(&_nodes.centroid[0].x, std::size_t(2) * _nodes.num), 2);
}

/// Volumes at y.
template <Geometry G>
void Remapper::measure_next(std::span<const double> y)
{
  for (std::int32_t c : _cells.touched)
    _cells.next[c] = cell_moments<G>(*_mesh, c, y).v;
  for (std::int32_t i : _nodes.touched)
    _nodes.next[i] = dual::volume<G>(*_mesh, i, y).v;
}

/// Does a cell of any rank have no positive volume? Then the report names it.
bool Remapper::inverted(std::span<const double> volumes, const Host& host)
{
  double worst = -1;
  for (std::int32_t c : _cells.touched)
    if (c < _mesh->owned_cells() and not(volumes[c] > 0))
      worst = std::max(worst, static_cast<double>(_mesh->cell_ids()[c]));
  _report.worst_cell = static_cast<std::int64_t>(host.max(worst));
  return _report.worst_cell >= 0;
}

template <Geometry G>
void Remapper::sweep_dual(std::int32_t c)
{
  const Triple& n = _mesh->cell(c);
  const std::int32_t owned = _mesh->owned_nodes();
  const dual::Corners before = dual::corners(*_mesh, c, _x);
  const dual::Corners after = dual::corners(*_mesh, c, _y);
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    if (n[i] < owned or n[j] < owned)
      _nodes.sweep<G>(dual::facet(before, after, i), n[i], n[j], -1);
    const std::int32_t f = _mesh->cell_facets(c)[i];
    if (not _mesh->on_boundary(f) or not(_moved[n[i]] or _moved[n[j]]))
      continue;
    const Point m0 = middle(before.v[i], before.v[j]);
    const Point m1 = middle(after.v[i], after.v[j]);
    const std::int32_t marker = _mesh->marker(f);
    if (n[i] < owned)
      _nodes.sweep<G>({before.v[i], m0, after.v[i], m1}, n[i], -1, marker);
    if (n[j] < owned)
      _nodes.sweep<G>({m0, before.v[j], m1, after.v[j]}, n[j], -1, marker);
  }
}

/// Regions swept between _x and _y.
template <Geometry G>
void Remapper::sweep()
{
  _cells.drop_pieces();
  _nodes.drop_pieces();
  const std::int32_t owned = _mesh->owned_cells();
  for (std::int32_t c : _cells.touched)
  {
    for (std::int32_t f : _mesh->cell_facets(c))
    {
      const auto [left, right] = _mesh->facet_cells(f);
      const auto [p, q] = _mesh->facet(f);
      // A facet with a moved end has both its cells in the list: once is
      // enough.
      if (left != c or not(_moved[p] or _moved[q])
          or not(left < owned or (right >= 0 and right < owned)))
        continue;
      _cells.sweep<G>({point(_x, p), point(_x, q), point(_y, p), point(_y, q)},
                      left, right, right < 0 ? _mesh->marker(f) : -1);
    }
    if (_dual)
      sweep_dual<G>(c);
  }
}

/// Moved nodes at part `at` of their way, into _y; exact at the end.
void Remapper::place(double at)
{
  for (std::int32_t i : _moved_nodes)
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t k = 2 * static_cast<std::size_t>(i) + d;
      _y[k] = at < 1 ? _x_old[k] + at * (_x_new[k] - _x_old[k]) : _x_new[k];
    }
}

/// Divide what is left of the way until no volume loses too much in the next
/// sub-cycle.
///
/// @param[in]     at   part of the way done
/// @param[in,out] left equal sub-cycles for the rest
template <Geometry G>
Outcome Remapper::choose_cycle(double at, int& left, const Host& host)
{
  // Round-off of a loss must not decide on the number of sub-cycles: ranks cut
  // differently would disagree with themselves.
  constexpr double slack = 1e-9;
  while (true)
  {
    place(left == 1 ? 1 : at + (1 - at) / left);
    sweep<G>();
    const double loss =
        host.max(std::max(_cells.largest_loss(), _nodes.largest_loss()));
    if (_report.cycles == 0 and left == 1)
      _report.loss = loss;
    if (loss <= (1 + slack) * _options.max_loss)
      return Outcome::ok;
    const double needed = left * loss / _options.max_loss - slack;
    if (not(_report.cycles + needed <= _options.max_cycles))
      return Outcome::too_many_cycles;
    left = std::max(left + 1, static_cast<int>(std::ceil(needed)));
  }
}

/// One sub-cycle for all fields.
void Remapper::carry(std::span<const Field> cells, std::span<const Field> nodes,
                     const Host& host)
{
  const auto book_volume = [this](const ControlVolumes& cv, Exchange& book)
  {
    for (std::int32_t k : cv.outside)
    {
      const Piece& p = cv.pieces[k];
      const bool in = p.from < 0;
      const Boundary kind = kernel::kind_of(_options.boundaries, p.marker);
      if ((in ? p.to : p.from) < cv.owned)
        book[std::size_t(kernel::way(kind, in))] += in ? p.volume : -p.volume;
    }
  };
  std::size_t entry = 2;
  const auto all = [&](ControlVolumes& cv, std::span<const Field> fields,
                       const Scheme& scheme, const auto& halo)
  {
    const auto one = [&]<class S>(const S&, const Field& field)
    {
      const std::span book = std::span(_book).subspan(entry, field.components);
      with_components(field.components,
                      [&]<int NC>(std::integral_constant<int, NC>)
                      {
                        kernel::transport<S, NC>(cv, field, _options.boundaries,
                                                 book, halo);
                      });
      halo(field.values, field.components);
      entry += field.components;
    };
    std::visit(
        [&]<class S>(const S& s)
        {
          if constexpr (S::linear)
            for (std::int32_t i : cv.touched)
              if (i < cv.owned and cv.first[i] >= 0)
                kernel::fit(cv, i);
          for (const Field& field : fields)
            one(s, field);
        },
        scheme);
  };
  book_volume(_cells, _book[0]);
  book_volume(_nodes, _book[1]);
  all(_cells, cells, _options.scheme,
      [&host](std::span<double> v, int block) { host.update_cells(v, block); });
  all(_nodes, nodes, _options.nodal_scheme,
      [&host](std::span<double> v, int block) { host.update_nodes(v, block); });
}

/// Add this call's book to the ledger, summed over ranks.
void Remapper::settle(std::span<const Field> cells,
                      std::span<const Field> nodes, const Host& host,
                      Ledger& ledger)
{
  host.sum(std::span(_book[0].data(), _book.size() * num_ways));
  const auto add = [](Exchange& to, const Exchange& from)
  {
    for (std::size_t k = 0; k < num_ways; ++k)
      to[k] += from[k];
  };
  add(ledger.cell_volume, _book[0]);
  add(ledger.node_volume, _book[1]);
  std::size_t entry = 2;
  const auto all = [&](std::span<const Field> fields, std::vector<Exchange>& to)
  {
    std::size_t n = 0;
    for (const Field& field : fields)
      n += field.components;
    to.resize(n);
    for (Exchange& e : to)
      add(e, _book[entry++]);
  };
  all(cells, ledger.cells);
  all(nodes, ledger.nodes);
}

template <Geometry G>
Outcome Remapper::run(std::span<const Field> cells,
                      std::span<const Field> nodes, const Host& host,
                      Ledger& ledger)
{
  exchange_touched(host);
  std::copy(_x_old.begin(), _x_old.end(), _x.begin());
  std::copy(_x_old.begin(), _x_old.end(), _y.begin());
  measure<G>(true, host);
  if (inverted(_cells.volume, host))
    return Outcome::inverted_start;
  measure_next<G>(_x_new);
  if (inverted(_cells.next, host))
    return Outcome::inverted_target;

  double at = 0;
  int left = 1;
  while (at < 1)
  {
    if (_report.cycles > 0)
      measure<G>(false, host);
    if (const Outcome o = choose_cycle<G>(at, left, host); o != Outcome::ok)
      return o;
    // In one cycle the volumes at the end are known and good.
    if (_report.cycles > 0 or left > 1)
    {
      measure_next<G>(_y);
      if (inverted(_cells.next, host))
        return Outcome::inverted_path;
    }
    at = left == 1 ? 1 : at + (1 - at) / left;
    --left;
    carry(cells, nodes, host);
    ++_report.cycles;
    for (std::int32_t i : _moved_nodes)
    {
      _x[2 * i] = _y[2 * i];
      _x[2 * i + 1] = _y[2 * i + 1];
    }
  }
  settle(cells, nodes, host, ledger);
  return Outcome::ok;
}

Outcome Remapper::remap(std::span<const double> x_old,
                        std::span<const double> x_new,
                        std::span<const Field> cells,
                        std::span<const Field> nodes, const Host& host,
                        Ledger& ledger)
{
  const auto finite = [](std::span<const double> x)
  {
    return std::all_of(x.begin(), x.end(),
                       [](double v) { return std::isfinite(v); });
  };
  // All ranks learn of the worst trouble of any, and that some node moved.
  const bool fit = sizes_fit(x_old, x_new, cells, nodes);
  const bool good = fit and finite(x_old) and finite(x_new);
  _dual = not nodes.empty();
  if (good)
    find_touched(x_old, x_new);
  double state[3] = {fit ? 0.0 : 1.0, good ? 0.0 : 1.0,
                     good and not _moved_nodes.empty() ? 1.0 : 0.0};
  host.max(std::span(state, 3));
  if (state[0] > 0)
    return Outcome::wrong_size;
  if (state[1] > 0)
    return Outcome::not_finite;
  std::size_t entries = 2;
  for (const auto& fields : {cells, nodes})
    for (const Field& field : fields)
      entries += field.components;
  _book.assign(entries, {});
  if (not(state[2] > 0))
  {
    settle(cells, nodes, {}, ledger);
    return Outcome::ok;
  }
  _x_old = x_old;
  _x_new = x_new;
  return _options.geometry == Geometry::plane
             ? run<Geometry::plane>(cells, nodes, host, ledger)
             : run<Geometry::axisymmetric>(cells, nodes, host, ledger);
}
