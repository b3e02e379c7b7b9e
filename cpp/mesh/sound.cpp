// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sound.h"

#include "scene/check.h"
#include <algorithm>
#include <cmath>
#include <format>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>

namespace mmale::mesh
{
namespace
{
/// Lengths below this share of the body's are round-off of gmsh's.
constexpr double round_off = 1e-9;
/// Twice the area over the square of the longest edge: less is flat.
constexpr double flat = 1e-10;

using Pair = std::array<std::int64_t, 2>;

/// One way round an edge of a cell.
struct Half
{
  std::int64_t low, high; ///< nodes
  bool upwards;           ///< from low to high, the cell on the left
  std::int64_t cell;
  auto key() const { return Pair{low, high}; }
};

/// The first of a kind of mistake, and how many more there are.
struct Mistake
{
  std::int64_t count = 0;
  std::string what;
  int line = 0;

  void note(int where, const std::string& text)
  {
    if (count++ == 0)
      what = text, line = where;
  }
};

class Builder
{
public:
  Builder(const Msh& msh, const std::string& file, bool axisymmetric,
          std::vector<scene::Complaint>& out)
      : _msh(msh), _file(file), _axisymmetric(axisymmetric), _out(out),
        _before(out.size())
  {
  }

  Grid build()
  {
    check_types();
    choose_cells();
    if (not find_nodes() or not sound())
      return {};
    check_places();
    turn_cells();
    if (sound())
      name_edges();
    if (sound())
    {
      check_parts();
      check_near_nodes();
    }
    return sound() ? std::move(_grid) : Grid();
  }

private:
  bool sound() const { return _out.size() == _before; }

  void complain(const std::string& what, int line = 0)
  {
    _out.push_back({"", what, {_file, line}});
  }

  void complain(const Mistake& mistake)
  {
    if (mistake.count > 0)
      complain(mistake.what
                   + (mistake.count > 1
                          ? std::format(" (and {} more)", mistake.count - 1)
                          : ""),
               mistake.line);
  }

  std::string place(std::int64_t node) const
  {
    return std::format("({:.6g}, {:.6g})", _grid.x[2 * node],
                       _grid.x[2 * node + 1]);
  }

  std::string centre(std::int64_t cell) const
  {
    double sum[2] = {0, 0};
    for (int v = 0; v < 3; ++v)
      for (int d = 0; d < 2; ++d)
        sum[d] += _grid.x[2 * _grid.cells[3 * cell + v] + d] / 3;
    return std::format("({:.6g}, {:.6g})", sum[0], sum[1]);
  }

  double along(std::int64_t node, int d) const { return _grid.x[2 * node + d]; }

  double distance(std::int64_t a, std::int64_t b) const
  {
    return std::hypot(along(b, 0) - along(a, 0), along(b, 1) - along(a, 1));
  }

  /// Twice the area of the triangle a, b, c.
  double turn(std::int64_t a, std::int64_t b, std::int64_t c) const
  {
    return (along(b, 0) - along(a, 0)) * (along(c, 1) - along(a, 1))
           - (along(b, 1) - along(a, 1)) * (along(c, 0) - along(a, 0));
  }

  void check_types();
  void choose_cells();
  bool find_nodes();
  void check_places();
  void turn_cells();
  void name_edges();
  std::map<Pair, std::string> curves(std::span<const Half> halves);
  void check_parts();
  void check_near_nodes();
  void check_hanging(std::span<const std::int64_t> nodes);

  const Msh& _msh;
  const std::string& _file;
  bool _axisymmetric;
  std::vector<scene::Complaint>& _out;
  std::size_t _before;
  double _size = 0; ///< diagonal of the box around the body [m]
  std::vector<const Msh::Element*> _cells;
  std::vector<const Msh::Node*> _nodes; ///< of the grid's nodes
  std::unordered_map<std::int64_t, std::int64_t> _number; ///< of node tags
  std::vector<Pair> _neighbours; ///< cells that share an edge
  Grid _grid;
};

/// What gmsh writes besides nodes, edges and triangles.
void Builder::check_types()
{
  static const std::map<int, const char*> second_order = {
      {8, "edges"},           {9, "triangles"},      {10, "quadrilaterals"},
      {11, "tetrahedra"},     {12, "hexahedra"},     {16, "quadrilaterals"},
      {17, "hexahedra"},      {18, "prisms"},        {20, "triangles"},
      {21, "triangles"},      {26, "edges"},         {27, "edges"},
      {36, "quadrilaterals"}, {37, "quadrilaterals"}};
  static const std::map<int, const char*> solids = {
      {4, "tetrahedra"}, {5, "hexahedra"}, {6, "prisms"}, {7, "pyramids"}};
  for (const auto& [type, other] : _msh.others)
  {
    const std::string first =
        other.count > 1
            ? std::format("{}, the first of them {}", other.count, other.first)
            : std::format("element {}", other.first);
    if (type == 3)
      complain("quadrilaterals cannot be used (" + first
                   + "); leave Recombine out of the .geo",
               other.line);
    else if (const auto it = solids.find(type); it != solids.end())
      complain(std::format("is a 3D mesh: it has {} ({}); mesh the plane z = 0 "
                           "with gmsh -2",
                           it->second, first),
               other.line);
    else if (const auto at = second_order.find(type); at != second_order.end())
      complain(std::format("{} of higher order cannot be used ({}); set "
                           "Mesh.ElementOrder = 1",
                           at->second, first),
               other.line);
    else
      complain(std::format("elements of gmsh's type {} cannot be used ({})",
                           type, first),
               other.line);
  }
}

void Builder::choose_cells()
{
  const bool grouped = std::ranges::any_of(_msh.triangles, [](const auto& t)
                                           { return not t.groups.empty(); });
  Mistake twice;
  std::set<std::array<std::int64_t, 3>> seen;
  for (const Msh::Element& t : _msh.triangles)
  {
    if (grouped and t.groups.empty())
      continue;
    auto nodes = t.nodes;
    std::ranges::sort(nodes);
    // MSH 2.2 has a triangle once for each of its groups.
    if (seen.insert(nodes).second)
      _cells.push_back(&t);
    else if (t.groups.empty())
      twice.note(t.line, std::format("triangle {} is there twice", t.tag));
  }
  complain(twice);
  if (_cells.empty() and _msh.others.empty())
    complain("has no triangles; give the body as a Physical Surface");
}

/// The nodes of the cells, in the order of the file.
bool Builder::find_nodes()
{
  std::unordered_map<std::int64_t, const Msh::Node*> known;
  Mistake twice, unknown;
  for (const Msh::Node& node : _msh.nodes)
    if (not known.emplace(node.tag, &node).second)
      twice.note(node.line, std::format("node {} is there twice", node.tag));
  std::set<std::int64_t> used;
  for (const Msh::Element* t : _cells)
    for (std::int64_t tag : t->nodes)
    {
      used.insert(tag);
      if (not known.contains(tag))
        unknown.note(t->line, std::format("triangle {} has node {}, which is "
                                          "not there",
                                          t->tag, tag));
    }
  complain(twice);
  complain(unknown);
  if (twice.count + unknown.count > 0)
    return false;
  for (const Msh::Node& node : _msh.nodes)
    if (used.contains(node.tag))
    {
      _number[node.tag] = static_cast<std::int64_t>(_nodes.size());
      _nodes.push_back(&node);
      _grid.x.insert(_grid.x.end(), {node.x[0], node.x[1]});
    }
  for (const Msh::Element* t : _cells)
    for (std::int64_t tag : t->nodes)
      _grid.cells.push_back(_number[tag]);
  double box[4] = {scene::infinity, scene::infinity, -scene::infinity,
                   -scene::infinity};
  for (std::size_t i = 0; i < _grid.x.size(); ++i)
  {
    box[i % 2] = std::min(box[i % 2], _grid.x[i]);
    box[2 + i % 2] = std::max(box[2 + i % 2], _grid.x[i]);
  }
  _size = std::hypot(box[2] - box[0], box[3] - box[1]);
  return true;
}

void Builder::check_places()
{
  Mistake off_plane, beyond;
  for (std::size_t n = 0; n < _nodes.size(); ++n)
  {
    const auto& [tag, x, line] = *_nodes[n];
    if (std::abs(x[2]) > round_off * _size)
      off_plane.note(line, std::format("is a 3D mesh: node {} at ({:.6g}, "
                                       "{:.6g}, {:.6g}) is off the plane z = 0",
                                       tag, x[0], x[1], x[2]));
    if (not _axisymmetric)
      continue;
    if (x[0] < -round_off * _size)
      beyond.note(line, std::format("the radius x must not be negative in "
                                    "axisymmetry: node {} at ({:.6g}, {:.6g})",
                                    tag, x[0], x[1]));
    else if (std::abs(x[0]) <= round_off * _size)
      _grid.x[2 * n] = 0; // gmsh's round-off on the axis
  }
  complain(off_plane);
  complain(beyond);
}

/// All cells counter-clockwise, a surface turned as a whole.
void Builder::turn_cells()
{
  Mistake no_area, inverted;
  std::map<std::int64_t, std::array<std::int64_t, 2>> ways; // of each surface
  std::vector<int> way(_cells.size());
  for (std::size_t c = 0; c < _cells.size(); ++c)
  {
    const auto* v = &_grid.cells[3 * c];
    const double area = turn(v[0], v[1], v[2]);
    const double edge = std::max(
        {distance(v[0], v[1]), distance(v[1], v[2]), distance(v[2], v[0])});
    if (not(std::abs(area) > flat * edge * edge))
      no_area.note(_cells[c]->line,
                   std::format("triangle {} at {} has no area", _cells[c]->tag,
                               centre(static_cast<std::int64_t>(c))));
    else
      ++ways[_cells[c]->entity][way[c] = area > 0];
  }
  for (std::size_t c = 0; c < _cells.size(); ++c)
  {
    const auto& [clockwise, counter] = ways[_cells[c]->entity];
    if (way[c] != (counter >= clockwise))
      inverted.note(_cells[c]->line,
                    std::format("triangle {} at {} is inverted: it turns "
                                "against the others of surface {}",
                                _cells[c]->tag,
                                centre(static_cast<std::int64_t>(c)),
                                _cells[c]->entity));
    else if (way[c] == 0)
      std::swap(_grid.cells[3 * c + 1], _grid.cells[3 * c + 2]);
  }
  complain(no_area);
  if (no_area.count == 0)
    complain(inverted);
}

/// The named curves by their edges, each on the boundary and with one name.
std::map<Pair, std::string> Builder::curves(std::span<const Half> halves)
{
  std::map<Pair, std::string> out;
  std::map<std::string, Mistake> inside, nowhere;
  Mistake two_names;
  std::set<std::string> bad_names;
  for (const Msh::Element& edge : _msh.edges)
    for (std::int64_t group : edge.groups)
    {
      const auto named = _msh.curve_names.find(group);
      if (named == _msh.curve_names.end())
        continue;
      const auto& name = named->second;
      if (not scene::is_name(name) and bad_names.insert(name).second)
        complain("physical curve '" + name
                 + "': a name is made of letters, digits, _ and -, and starts "
                   "with a letter or _");
      const auto a = _number.find(edge.nodes[0]),
                 b = _number.find(edge.nodes[1]);
      const auto known = a != _number.end() and b != _number.end();
      const Pair key = known ? Pair{std::min(a->second, b->second),
                                    std::max(a->second, b->second)}
                             : Pair{-1, -1};
      const auto sides =
          std::ranges::equal_range(halves, key, {}, &Half::key).size();
      if (sides == 0)
        nowhere[name].note(
            edge.line, std::format("physical curve '{}': edge {} of curve {} "
                                   "is no side of a cell",
                                   name, edge.tag, edge.entity));
      else if (sides > 1)
        inside[name].note(
            edge.line,
            std::format("physical curve '{}' lies inside the body: edge {} of "
                        "curve {} from {} to {} has cells on both sides",
                        name, edge.tag, edge.entity, place(a->second),
                        place(b->second)));
      else if (const auto [at, is_new] = out.emplace(key, name);
               not is_new and at->second != name)
        two_names.note(edge.line,
                       std::format("edge {} of curve {} from {} to {} is of "
                                   "two physical curves, '{}' and '{}'",
                                   edge.tag, edge.entity, place(a->second),
                                   place(b->second), at->second, name));
    }
  for (const auto* list : {&inside, &nowhere})
    for (const auto& [name, mistake] : *list)
      complain(mistake);
  complain(two_names);
  return out;
}

void Builder::name_edges()
{
  std::vector<Half> halves;
  for (std::size_t i = 0; i < _grid.cells.size(); ++i)
  {
    const auto c = static_cast<std::int64_t>(i / 3);
    const std::int64_t a = _grid.cells[i],
                       b = _grid.cells[3 * c + (i % 3 + 1) % 3];
    halves.push_back({std::min(a, b), std::max(a, b), a < b, c});
  }
  std::ranges::stable_sort(halves, {}, &Half::key);
  const auto named = curves(halves);
  std::set<std::string> names;
  for (const auto& [edge, name] : named)
    names.insert(name);
  _grid.names.assign(names.begin(), names.end());
  const auto unnamed = static_cast<std::int64_t>(_grid.names.size());

  Mistake overlap;
  for (std::size_t i = 0; i < halves.size();)
  {
    std::size_t end = i + 1;
    while (end < halves.size() and halves[end].key() == halves[i].key())
      ++end;
    const auto& [low, high, upwards, cell] = halves[i];
    if (end - i > 2 or (end - i == 2 and upwards == halves[i + 1].upwards))
      overlap.note(_cells[cell]->line,
                   std::format("triangles {} and {} overlap at the edge from "
                               "{} to {}",
                               _cells[cell]->tag,
                               _cells[halves[i + 1].cell]->tag, place(low),
                               place(high)));
    else if (end - i == 2)
      _neighbours.push_back({cell, halves[i + 1].cell});
    else
    {
      const auto at = named.find({low, high});
      const auto name = at == named.end()
                            ? unnamed
                            : std::ranges::lower_bound(_grid.names, at->second)
                                  - _grid.names.begin();
      _grid.edges.push_back({upwards ? low : high, upwards ? high : low, name});
    }
    i = end;
  }
  complain(overlap);
  if (std::ranges::any_of(_grid.edges,
                          [&](const auto& e) { return e[2] == unnamed; }))
    _grid.names.emplace_back();
}

/// One body: every cell is reached from the first across edges.
void Builder::check_parts()
{
  std::vector<std::int64_t> root(_cells.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int64_t c)
  {
    while (root[c] != c)
      c = root[c] = root[root[c]];
    return c;
  };
  for (const auto& [a, b] : _neighbours)
    root[find(a)] = find(b);
  std::map<std::int64_t, std::int64_t> first; // cell of each part
  for (std::size_t c = 0; c < _cells.size(); ++c)
    first.emplace(find(static_cast<std::int64_t>(c)), c);
  if (first.size() > 1)
  {
    std::string places;
    for (auto it = first.begin(); it != first.end() and places.size() < 60;
         ++it)
      places += (places.empty() ? "" : ", ") + centre(it->second);
    complain(std::format("the body falls into {} parts that share no edge, "
                         "with cells at {}; let surfaces share their curves "
                         "(Coherence, or BooleanFragments)",
                         first.size(), places));
    return;
  }
  std::map<std::int64_t, int> ends;
  for (const auto& [a, b, name] : _grid.edges)
    ++ends[a];
  Mistake touching;
  for (const auto& [node, count] : ends)
    if (count > 1)
      touching.note(_nodes[node]->line,
                    std::format("the body touches itself in node {} at {}",
                                _nodes[node]->tag, place(node)));
  complain(touching);
}

/// No boundary node lies on another, or on an edge that it is no end of.
void Builder::check_near_nodes()
{
  std::vector<std::int64_t> nodes;
  for (const auto& [a, b, name] : _grid.edges)
    nodes.push_back(a);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

  const double room = round_off * _size;
  std::ranges::sort(nodes, {}, [&](auto n) { return along(n, 0); });
  Mistake same;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = i + 1;
         j < nodes.size() and along(nodes[j], 0) - along(nodes[i], 0) <= room;
         ++j)
      if (distance(nodes[i], nodes[j]) <= room)
        same.note(_nodes[nodes[j]]->line,
                  std::format("nodes {} and {} lie on each other at {}; the "
                              "cells around them are not connected",
                              _nodes[nodes[i]]->tag, _nodes[nodes[j]]->tag,
                              place(nodes[i])));
  complain(same);
  if (same.count == 0)
    check_hanging(nodes);
}

void Builder::check_hanging(std::span<const std::int64_t> nodes)
{
  std::vector<std::int64_t> sorted[2];
  for (int d = 0; d < 2; ++d)
  {
    sorted[d].assign(nodes.begin(), nodes.end());
    std::ranges::sort(sorted[d], {}, [&](auto n) { return along(n, d); });
  }
  Mistake hanging;
  for (const auto& [a, b, name] : _grid.edges)
  {
    // Along its longer extent few nodes lie beside an edge.
    const int d = std::abs(along(b, 0) - along(a, 0))
                          >= std::abs(along(b, 1) - along(a, 1))
                      ? 0
                      : 1;
    const double low = std::min(along(a, d), along(b, d)),
                 high = std::max(along(a, d), along(b, d));
    const auto at = [&](auto n) { return along(n, d); };
    const double length = distance(a, b);
    for (auto it = std::ranges::lower_bound(sorted[d], low, {}, at);
         it != sorted[d].end() and at(*it) <= high; ++it)
      if (*it != a and *it != b
          and std::abs(turn(a, b, *it)) <= round_off * length * length)
        hanging.note(_nodes[*it]->line,
                     std::format("node {} at {} hangs on the edge from {} to "
                                 "{}: the cells beside it are not connected",
                                 _nodes[*it]->tag, place(*it), place(a),
                                 place(b)));
  }
  complain(hanging);
}
} // namespace

Grid make_sound_grid(const Msh& msh, const std::string& file, bool axisymmetric,
                     std::vector<scene::Complaint>& complaints)
{
  return Builder(msh, file, axisymmetric, complaints).build();
}
} // namespace mmale::mesh
