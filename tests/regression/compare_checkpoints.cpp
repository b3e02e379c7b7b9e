// SPDX-License-Identifier: LGPL-3.0-or-later
// compare_checkpoints A B [TOLERANCE]: do two checkpoints hold the same? Bit by
// bit, or each array to a part of its largest number. What tells of the way
// there is left out: timers, how often it was resumed, who wrote which fields.
// Exit code 0 or 1; what differs goes to standard output.
#include "output/checkpoint_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <mpi.h>
#include <sstream>

namespace
{
using mmale::output::DatasetReader;

/// Largest difference, in parts of the largest number.
double apart(const std::vector<double>& a, const std::vector<double>& b)
{
  double gap = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    if (std::isnan(a[i]) and std::isnan(b[i]))
      continue;
    gap = std::max(gap, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(a[i]));
  }
  return size > 0 ? gap / size : gap;
}

/// In words, or empty.
std::string difference(const std::string& kind, const std::string& name,
                       const DatasetReader& a, const DatasetReader& b,
                       double tolerance)
{
  if (not b.has(name))
    return "is missing";
  if (kind == "text")
    return a.text(name) == b.text(name) ? "" : "is another text";
  if (kind == "count")
    return a.counts(name) == b.counts(name) ? "" : "is another number";
  const auto x = a.numbers(name), y = b.numbers(name);
  if (x.size() != y.size())
    return "has another size";
  if (tolerance > 0)
  {
    const double gap = apart(x, y);
    return gap <= tolerance ? "" : "is apart by " + std::to_string(gap);
  }
  return std::memcmp(x.data(), y.data(), 8 * x.size()) == 0
             ? ""
             : "differs in some bit";
}

int compare(const char* first, const char* second, double tolerance)
{
  const DatasetReader a(first), b(second);
  std::istringstream list(a.text("contents"));
  std::string kind, name;
  int width = 0, compared = 0, different = 0;
  while (list >> kind >> width and std::getline(list >> std::ws, name))
  {
    if (name.starts_with("timers/") or name == "summary/resumed"
        or name == "fields" or name == "scene")
      continue;
    // iterations, residuals and gaps are the solver's tolerance itself
    if (tolerance > 0
        and (name.starts_with("summary/") or name == "curves/rows"))
      continue;
    ++compared;
    const auto words = difference(kind, name, a, b, tolerance);
    if (words.empty())
      continue;
    std::cout << name << " " << words << "\n";
    ++different;
  }
  std::cout << compared << " datasets compared, " << different << " differ\n";
  return different > 0 or compared == 0;
}
} // namespace

int main(int argc, char* argv[])
{
  if (argc < 3)
    return 2;
  MPI_Init(&argc, &argv);
  int out = 2;
  try
  {
    out = compare(argv[1], argv[2], argc > 3 ? std::stod(argv[3]) : 0);
  }
  catch (const std::exception& error)
  {
    std::cout << error.what() << "\n";
  }
  MPI_Finalize();
  return out;
}
