// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/curves.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <unistd.h>
#include <utility>

namespace mmale::output
{
namespace
{
[[noreturn]] void fail(const std::filesystem::path& file, int error)
{
  throw std::runtime_error("cannot write " + file.string() + ": "
                           + std::strerror(error));
}

void append(std::string& line, double value)
{
  // The shortest text that reads back as the same number.
  std::array<char, 32> text;
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value);
  assert(error == std::errc());
  line.append(text.data(), end);
}

std::vector<std::string> split(const std::string& line)
{
  std::vector<std::string> out(1);
  for (char c : line)
    if (c == ',')
      out.emplace_back();
    else if (c != ' ')
      out.back() += c;
  return out;
}
} // namespace

Curves::Curves(std::vector<std::string> names)
    : _names(std::move(names)), _columns(_names.size())
{
  for (auto it = _names.begin(); it != _names.end(); ++it)
  {
    if (it->empty() or it->find_first_of(",\n\r") != std::string::npos)
      throw std::runtime_error("\"" + *it + "\" cannot name a curve");
    if (std::find(_names.begin(), it, *it) != it)
      throw std::runtime_error("two curves are named \"" + *it + "\"");
  }
}

Curves::Curves(std::filesystem::path file, std::vector<std::string> names)
    : Curves(std::move(names))
{
  _file = std::move(file);
  _fd = ::open(_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (_fd < 0)
    fail(_file, errno);
  std::string line;
  for (const std::string& name : _names)
    line += (line.empty() ? "" : ",") + name;
  write(line + '\n');
}

Curves::~Curves()
{
  if (_fd >= 0)
    ::close(_fd);
}

Curves::Curves(Curves&& other) noexcept
    : _names(std::move(other._names)), _columns(std::move(other._columns)),
      _rows(std::exchange(other._rows, 0)), _file(std::move(other._file)),
      _fd(std::exchange(other._fd, -1))
{
}

Curves& Curves::operator=(Curves&& other) noexcept
{
  std::swap(_names, other._names);
  std::swap(_columns, other._columns);
  std::swap(_rows, other._rows);
  std::swap(_file, other._file);
  std::swap(_fd, other._fd);
  return *this;
}

void Curves::write(std::string_view line)
{
  const off_t start = ::lseek(_fd, 0, SEEK_CUR);
  ssize_t written = -1;
  do
    written = ::write(_fd, line.data(), line.size());
  while (written < 0 and errno == EINTR);
  if (written == static_cast<ssize_t>(line.size()))
    return;
  // A nearly full disk takes a part of the row: say so, and take it back.
  const int error = written < 0 ? errno : ENOSPC;
  if (written > 0 and start >= 0 and ::ftruncate(_fd, start) == 0)
    ::lseek(_fd, start, SEEK_SET);
  fail(_file, error);
}

void Curves::add(std::span<const double> row)
{
  if (row.size() != _columns.size())
    throw std::runtime_error("a row of curves has " + std::to_string(row.size())
                             + " numbers for " + std::to_string(_columns.size())
                             + " columns");
  if (_fd >= 0)
  {
    std::string line;
    for (double value : row)
    {
      if (not line.empty())
        line += ',';
      append(line, value);
    }
    write(line + '\n');
  }
  for (std::size_t i = 0; i < row.size(); ++i)
    _columns[i].push_back(row[i]);
  ++_rows;
}

bool Curves::has(std::string_view name) const
{
  return std::ranges::find(_names, name) != _names.end();
}

std::span<const double> Curves::column(std::string_view name) const
{
  const auto it = std::ranges::find(_names, name);
  if (it == _names.end())
    throw std::out_of_range("no curve is named \"" + std::string(name) + "\"");
  return _columns[static_cast<std::size_t>(it - _names.begin())];
}

Curves read_curves(const std::filesystem::path& file)
{
  std::ifstream in(file);
  std::string line;
  int number = 0;
  // People's own tables have remarks, blank lines and Windows' line ends.
  const auto next = [&]
  {
    while (std::getline(in, line))
    {
      ++number;
      while (not line.empty() and (line.back() == '\r' or line.back() == ' '))
        line.pop_back();
      if (not line.empty() and line.front() != '#')
        return true;
    }
    return false;
  };
  if (not in or not next())
    throw std::runtime_error("cannot read " + file.string());
  Curves out(split(line));
  std::vector<double> row;
  while (next())
  {
    row.clear();
    for (const std::string& cell : split(line))
    {
      double value = 0;
      const char* end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(cell.data(), end, value);
      if (error != std::errc() or stop != end)
        throw std::runtime_error(file.string() + ":" + std::to_string(number)
                                 + ": \"" + cell + "\" is no number");
      row.push_back(value);
    }
    if (row.size() != out.names().size())
      throw std::runtime_error(
          file.string() + ":" + std::to_string(number) + ": "
          + std::to_string(row.size()) + " numbers for "
          + std::to_string(out.names().size()) + " columns");
    out.add(row);
  }
  return out;
}
} // namespace mmale::output
