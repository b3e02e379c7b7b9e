// SPDX-License-Identifier: LGPL-3.0-or-later
#include "archive.h"

#include "mesh/domain.h"
#include "on_root.h"
#include <algorithm>
#include <bit>
#include <sstream>
#include <stdexcept>

namespace mmale::output
{
namespace
{
/// Name of the dataset that lists the others: kind, width and name a line.
constexpr const char* contents = "contents";

/// Mixes a number into a sum whose bits all depend on all of its.
std::uint64_t mix(std::uint64_t sum, std::uint64_t x)
{
  // the finaliser of splitmix64
  x += sum + 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// A number for the mesh as first laid: nodes with their places, cells with
/// their nodes, on however many ranks.
std::int64_t fingerprint(const mesh::Domain& d)
{
  std::uint64_t sum = 0;
  for (int n = 0; n < d.num_owned_nodes; ++n)
  {
    std::uint64_t h = mix(1, static_cast<std::uint64_t>(d.node_id[n]));
    for (int i = 0; i < 2; ++i)
      h = mix(h, std::bit_cast<std::uint64_t>(d.initial_x[2 * n + i]));
    sum += h;
  }
  for (int c = 0; c < d.num_owned_cells; ++c)
  {
    std::array<std::int64_t, 3> nodes;
    for (int v = 0; v < 3; ++v)
      nodes[v] = d.node_id[d.cells[c][v]];
    std::ranges::sort(nodes);
    std::uint64_t h = mix(2, static_cast<std::uint64_t>(d.cell_id[c]));
    for (std::int64_t n : nodes)
      h = mix(h, static_cast<std::uint64_t>(n));
    sum += h;
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, d.comm);
  return std::bit_cast<std::int64_t>(sum);
}

std::span<const std::int64_t> first(const std::vector<std::int64_t>& id, int n)
{
  return std::span(id).first(static_cast<std::size_t>(n));
}
} // namespace

Archive::Archive(const mesh::Domain& domain)
    : _domain(domain), _loading(false),
      _nodes(domain.comm, first(domain.node_id, domain.num_owned_nodes)),
      _cells(domain.comm, first(domain.cell_id, domain.num_owned_cells))
{
  check_mesh();
}

Archive::Archive(const mesh::Domain& domain, const std::filesystem::path& file)
    : _domain(domain), _loading(true), _file(file),
      _nodes(domain.comm, first(domain.node_id, domain.num_owned_nodes)),
      _cells(domain.comm, first(domain.cell_id, domain.num_owned_cells))
{
  const DatasetReader reader(file);
  std::istringstream list(reader.text(contents));
  for (Item item; list >> item.kind >> item.width
                  and std::getline(list >> std::ws, item.name);)
  {
    item.content = read(reader, item);
    _items.push_back(item);
  }
  check_mesh();
}

/// Rows of a checkpoint have a place on its own mesh only.
void Archive::check_mesh()
{
  const std::int64_t here = fingerprint(_domain);
  std::int64_t there = here;
  (*this)("mesh", there);
  if (there != here)
    throw std::runtime_error(_file.string() + " is of another mesh");
}

const Blocks& Archive::blocks(const std::string& kind) const
{
  return kind == "node" ? _nodes : _cells;
}

Content Archive::read(const DatasetReader& reader, const Item& item) const
{
  if (item.kind == "text")
    return reader.text(item.name);
  if (item.kind == "count")
    return reader.counts(item.name);
  if (item.kind == "numbers")
    return reader.numbers(item.name);
  const Blocks& b = blocks(item.kind);
  const auto [rows, width] = reader.shape(item.name);
  if (rows != b.rows() or width != item.width)
    throw std::runtime_error(_file.string() + " is of another mesh: "
                             + item.name + " has " + std::to_string(rows)
                             + " rows, not " + std::to_string(b.rows()));
  return reader.numbers(item.name, b.begin(), b.count());
}

const Archive::Item& Archive::find(const std::string& name,
                                   const std::string& kind) const
{
  const auto at = std::ranges::find(_items, name, &Item::name);
  if (at == _items.end() or at->kind != kind)
    throw std::runtime_error(_file.string() + " has no '" + name + "' (" + kind
                             + ")");
  return *at;
}

void Archive::operator()(const std::string& name, double& x)
{
  std::vector<double> one{x};
  (*this)(name, one);
  x = one.at(0);
}

void Archive::operator()(const std::string& name, std::int64_t& n)
{
  using Counts = std::vector<std::int64_t>;
  if (_loading)
    n = std::get<Counts>(find(name, "count").content).at(0);
  else
    save({name, "count", 1, Counts{n}});
}

void Archive::operator()(const std::string& name, int& n)
{
  std::int64_t wide = n;
  (*this)(name, wide);
  n = static_cast<int>(wide);
}

void Archive::operator()(const std::string& name, std::string& text)
{
  if (_loading)
    text = std::get<std::string>(find(name, "text").content);
  else
    save({name, "text", 1, text});
}

void Archive::operator()(const std::string& name, std::vector<double>& values,
                         int width)
{
  if (not _loading)
  {
    save({name, "numbers", width, values});
    return;
  }
  const Item& item = find(name, "numbers");
  if (item.width != width)
    throw std::runtime_error(_file.string() + ": '" + name + "' has "
                             + std::to_string(item.width)
                             + " numbers a row, not " + std::to_string(width));
  values = std::get<std::vector<double>>(item.content);
}

void Archive::operator()(const std::string& name, Entity entity,
                         std::vector<double>& values)
{
  const bool node = entity == Entity::node;
  const std::string kind = node ? "node" : "cell";
  const int local = node ? _domain.num_nodes() : _domain.num_cells();
  if (not _loading)
  {
    // a rank without entities does not know the width
    int width = local > 0 ? static_cast<int>(values.size()) / local : 0;
    MPI_Allreduce(MPI_IN_PLACE, &width, 1, MPI_INT, MPI_MAX, _domain.comm);
    if (width > 0)
      save({name, kind, width, blocks(kind).sorted(values, width)});
    return;
  }
  if (std::ranges::find(_items, name, &Item::name) == _items.end())
  {
    values.clear();
    return;
  }
  const Item& item = find(name, kind);
  values = blocks(kind).owned(std::get<std::vector<double>>(item.content),
                              item.width);
  values.resize(static_cast<std::size_t>(local) * item.width);
  (node ? _domain.node_halo : _domain.cell_halo)->update(values, item.width);
}

Dataset Archive::dataset(const Item& item) const
{
  Dataset out{.name = item.name, .width = item.width, .content = item.content};
  if (item.kind == "node" or item.kind == "cell")
  {
    const Blocks& b = blocks(item.kind);
    out.rows = b.rows();
    out.begin = b.begin();
    return out;
  }
  if (item.kind == "text")
    return out;
  // the same on all ranks: the first writes it
  int rank = 0;
  MPI_Comm_rank(_domain.comm, &rank);
  std::visit(
      [&](auto& values)
      {
        out.rows = static_cast<std::int64_t>(values.size()) / item.width;
        if (rank > 0)
          values.clear();
      },
      out.content);
  return out;
}

void Archive::write(const std::filesystem::path& file) const
{
  std::string list;
  for (const Item& item : _items)
    list +=
        item.kind + " " + std::to_string(item.width) + " " + item.name + "\n";
  std::vector<Dataset> datasets;
  for (const Item& item : _items)
    datasets.push_back(dataset(item));
  datasets.push_back({.name = contents, .content = list});
  write_datasets(_domain.comm, file, datasets);
}
} // namespace mmale::output
