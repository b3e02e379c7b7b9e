// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/blocks.h"
#include "output/checkpoint_file.h"
#include "state.h"
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace mmale::mesh
{
struct Domain;
}

namespace mmale::output
{
/// What a part of a run gives to a checkpoint and takes from it.
///
/// A part has one function for both ways, `keep(Archive&)`, which names each
/// thing that steers it: saving takes the values, loading replaces them. So
/// nothing can be saved and not loaded.
///
/// Names have a '/' between groups. All calls are collective, in the same order
/// on all ranks.
class Archive
{
public:
  /// To save.
  explicit Archive(const mesh::Domain& domain);

  /// To load: the whole file is read at once, whoever wrote it.
  /// @throws std::runtime_error if it cannot be read, or is of another mesh
  Archive(const mesh::Domain& domain, const std::filesystem::path& file);

  bool loading() const { return _loading; }

  /// Numbers and texts, the same on all ranks.
  void operator()(const std::string& name, double& x);
  void operator()(const std::string& name, std::int64_t& n);
  void operator()(const std::string& name, int& n);
  void operator()(const std::string& name, std::string& text);

  /// Any number of numbers, the same on all ranks.
  void operator()(const std::string& name, std::vector<double>& values,
                  int width = 1);

  template <std::size_t N>
  void operator()(const std::string& name,
                  std::vector<std::array<double, N>>& rows)
  {
    std::vector<double> flat;
    for (const auto& row : rows)
      flat.insert(flat.end(), row.begin(), row.end());
    (*this)(name, flat, static_cast<int>(N));
    rows.resize(flat.size() / N);
    for (std::size_t i = 0; i < flat.size(); ++i)
      rows[i / N][i % N] = flat[i];
  }

  template <std::size_t N>
  void operator()(const std::string& name, std::array<double, N>& values)
  {
    std::vector<std::array<double, N>> one{values};
    (*this)(name, one);
    values = one.at(0);
  }

  /// A row for each node or cell of the mesh.
  ///
  /// @param[in,out] values owned entities, then ghosts, which are not saved,
  ///                       but filled when loaded. Empty: left out.
  void operator()(const std::string& name, Entity entity,
                  std::vector<double>& values);

  /// Write what was saved; see write_datasets. Collective.
  void write(const std::filesystem::path& file) const;

private:
  /// A dataset of the file, and whose rows it has.
  struct Item
  {
    std::string name;
    std::string kind; ///< "numbers", "count", "text", "node" or "cell" rows
    int width = 1;
    Content content = std::string();
  };
  const Blocks& blocks(const std::string& kind) const;
  Dataset dataset(const Item& item) const;
  Content read(const DatasetReader& reader, const Item& item) const;
  void check_mesh();
  void save(Item item) { _items.push_back(std::move(item)); }
  const Item& find(const std::string& name, const std::string& kind) const;

  const mesh::Domain& _domain;
  bool _loading;
  std::filesystem::path _file;
  Blocks _nodes, _cells;
  std::vector<Item> _items;
};
} // namespace mmale::output
