// SPDX-License-Identifier: LGPL-3.0-or-later
#include "blocks.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace mmale::output
{
namespace
{
std::vector<int> times(std::span<const int> counts, int width)
{
  std::vector<int> out(counts.begin(), counts.end());
  for (int& n : out)
    n *= width;
  return out;
}

std::vector<int> starts(std::span<const int> counts)
{
  std::vector<int> out(counts.size(), 0);
  std::exclusive_scan(counts.begin(), counts.end(), out.begin(), 0);
  return out;
}

template <class T>
std::vector<T> exchange(MPI_Comm comm, MPI_Datatype type,
                        std::span<const T> from, std::span<const int> send,
                        std::span<const int> receive, int width)
{
  const auto out_counts = times(send, width), in_counts = times(receive, width);
  const auto out_at = starts(out_counts), in_at = starts(in_counts);
  std::vector<T> to(static_cast<std::size_t>(in_at.back() + in_counts.back()));
  MPI_Alltoallv(from.data(), out_counts.data(), out_at.data(), type, to.data(),
                in_counts.data(), in_at.data(), type, comm);
  return to;
}
} // namespace

Blocks::Blocks(MPI_Comm comm, std::span<const std::int64_t> id) : _comm(comm)
{
  int size = 1, rank = 0;
  MPI_Comm_size(comm, &size);
  MPI_Comm_rank(comm, &rank);
  _rows = static_cast<std::int64_t>(id.size());
  MPI_Allreduce(MPI_IN_PLACE, &_rows, 1, MPI_INT64_T, MPI_SUM, comm);
  const std::int64_t each = (_rows + size - 1) / size;
  _begin = std::min(_rows, rank * each);
  _count = std::min(_rows, _begin + each) - _begin;

  int bad = 0;
  _send.assign(size, 0);
  _receive.assign(size, 0);
  for (std::int64_t i : id)
    if (i < 0 or i >= _rows)
      bad = 1;
    else
      ++_send[i / each];
  MPI_Alltoall(_send.data(), 1, MPI_INT, _receive.data(), 1, MPI_INT, comm);
  std::vector<char> seen(static_cast<std::size_t>(_count), 0);
  if (bad == 0)
  {
    _order.resize(id.size());
    std::iota(_order.begin(), _order.end(), 0);
    std::ranges::stable_sort(_order, {}, [&](int i) { return id[i] / each; });
  }
  std::vector<std::int64_t> numbers;
  for (int i : _order)
    numbers.push_back(id[i]);
  MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_MAX, comm);
  if (bad == 0)
  {
    _place =
        exchange<std::int64_t>(comm, MPI_INT64_T, numbers, _send, _receive, 1);
    for (std::int64_t& p : _place)
    {
      p -= _begin;
      if (std::exchange(seen[p], 1))
        bad = 1;
    }
    MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_MAX, comm);
  }
  if (bad)
    throw std::runtime_error("entities are not numbered from 0 on");
}

std::vector<double> Blocks::sorted(std::span<const double> owned,
                                   int width) const
{
  std::vector<double> out;
  out.reserve(_order.size() * width);
  for (int i : _order)
    for (int k = 0; k < width; ++k)
      out.push_back(owned[static_cast<std::size_t>(i) * width + k]);
  const auto come =
      exchange<double>(_comm, MPI_DOUBLE, out, _send, _receive, width);
  std::vector<double> rows(static_cast<std::size_t>(_count) * width);
  for (std::size_t i = 0; i < _place.size(); ++i)
    std::copy_n(come.begin() + i * width, width,
                rows.begin() + _place[i] * width);
  return rows;
}

std::vector<double> Blocks::owned(std::span<const double> sorted,
                                  int width) const
{
  std::vector<double> out;
  out.reserve(_place.size() * width);
  for (std::int64_t p : _place)
    for (int k = 0; k < width; ++k)
      out.push_back(sorted[static_cast<std::size_t>(p) * width + k]);
  const auto come =
      exchange<double>(_comm, MPI_DOUBLE, out, _receive, _send, width);
  std::vector<double> rows(_order.size() * width);
  for (std::size_t i = 0; i < _order.size(); ++i)
    std::copy_n(come.begin() + i * width, width,
                rows.begin() + static_cast<std::size_t>(_order[i]) * width);
  return rows;
}
} // namespace mmale::output
