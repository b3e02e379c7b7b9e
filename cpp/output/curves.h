// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// `curves.csv`: numbers over the steps of a run, and the same in memory.
///
/// In: one row a step. Out: a file with a header of names, each row written at
/// once by one call, so that a run killed at any time leaves whole rows only.
namespace mmale::output
{
/// A table of named columns.
class Curves
{
public:
  /// A table in memory alone, as on all ranks but the first.
  /// @param[in] names columns, all different, without comma or line break
  explicit Curves(std::vector<std::string> names);

  /// A table in memory and in a file, which is made anew.
  /// @throws std::runtime_error naming the file and the cause
  Curves(std::filesystem::path file, std::vector<std::string> names);

  ~Curves();
  Curves(Curves&& other) noexcept;
  Curves& operator=(Curves&& other) noexcept;

  /// Add a row; NaN is written as "nan".
  ///
  /// A row that the disk does not take whole is taken back from the file.
  ///
  /// @param[in] row one number a column, shape (columns,)
  /// @throws std::runtime_error naming the file and the cause
  void add(std::span<const double> row);

  std::span<const std::string> names() const { return _names; }
  std::size_t rows() const { return _rows; }
  bool has(std::string_view name) const;

  /// All rows of a column, shape (rows,).
  /// @throws std::out_of_range if there is no such column
  std::span<const double> column(std::string_view name) const;

private:
  void write(std::string_view line);

  std::vector<std::string> _names;
  std::vector<std::vector<double>> _columns;
  std::size_t _rows = 0;
  std::filesystem::path _file;
  int _fd = -1; // open file, -1 for none
};

/// Read a table that `Curves` wrote, e.g. of another run.
/// @throws std::runtime_error naming file and line
Curves read_curves(const std::filesystem::path& file);
} // namespace mmale::output
