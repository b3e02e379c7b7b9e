// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mpi.h>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Named datasets in an HDF5 file that is there whole or not at all.
///
/// In: datasets, of which each rank has a run of rows. Out: the file; an older
/// one stays as it was until the new one is on the disk.
namespace mmale::output
{
/// Numbers, whole numbers, or text.
using Content =
    std::variant<std::vector<double>, std::vector<std::int64_t>, std::string>;

/// A dataset and this rank's part of it. A text is the first rank's.
struct Dataset
{
  std::string name;                ///< with '/' between groups
  std::int64_t rows = 1;           ///< of all ranks
  std::int64_t width = 1;          ///< numbers a row
  std::int64_t begin = 0;          ///< first row of this rank
  Content content = std::string(); ///< this rank's rows, shape (n, width)
};

/// Write a file by all ranks together, by way of a neighbour `.part`, brought
/// to the disk and renamed. Collective; names and order agree.
///
/// @throws std::runtime_error naming file and cause: on all ranks when there is
/// no room or the place cannot be written; when the disk fails in the midst,
/// perhaps on one rank alone. The neighbour is removed.
void write_datasets(MPI_Comm comm, const std::filesystem::path& file,
                    std::span<const Dataset> datasets);

/// What a file is.
enum class FileKind
{
  missing,
  foreign, ///< no HDF5 file
  damaged, ///< HDF5, but cut off
  whole
};
FileKind file_kind(const std::filesystem::path& file);

/// Reads datasets by name, each rank for itself.
class DatasetReader
{
public:
  /// @throws std::runtime_error naming the file, if it is not `whole`
  explicit DatasetReader(std::filesystem::path file);
  ~DatasetReader();
  DatasetReader(const DatasetReader&) = delete;
  DatasetReader& operator=(const DatasetReader&) = delete;

  bool has(const std::string& name) const;

  /// Rows and width of a dataset.
  std::array<std::int64_t, 2> shape(const std::string& name) const;

  /// Some rows, shape (count, width); throws naming the dataset, as all below.
  std::vector<double> numbers(const std::string& name, std::int64_t begin,
                              std::int64_t count) const;
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::int64_t> counts(const std::string& name) const;
  std::string text(const std::string& name) const;

private:
  [[noreturn]] void damaged(const std::string& name) const;
  void read(const std::string& name, std::int64_t type, std::int64_t begin,
            std::int64_t count, void* to) const;

  std::filesystem::path _file;
  std::int64_t _id = -1;
};
} // namespace mmale::output
