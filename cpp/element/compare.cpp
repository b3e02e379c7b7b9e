// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/compare.h"

#include "scene/complaint.h"
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace mmale::element
{
DataTable read_data(const Data& data)
{
  DataTable table;
  const std::filesystem::path file =
      std::filesystem::path(data.folder) / data.file;
  try
  {
    table.curves.emplace(output::read_curves(file));
  }
  catch (const std::runtime_error& error)
  {
    table.complaints.emplace_back(error.what());
    return table;
  }
  const auto names = table.curves->names();
  table.x = data.x.empty() ? names.front() : data.x;
  if (not table.curves->has(table.x))
    table.complaints.push_back("x: " + file.string() + " has no column '"
                               + table.x + "', "
                               + scene::suggestion(table.x, names));
  if (names.size() < 2)
    table.complaints.push_back(file.string()
                               + ": needs an abscissa and a column beside it");
  if (table.curves->rows() == 0)
    table.complaints.push_back(file.string() + ": has no row");
  return table;
}

std::vector<std::string> strangers(const DataTable& data,
                                   std::span<const std::string> columns)
{
  std::vector<std::string> out;
  for (const std::string& name : data.curves->names())
    if (std::ranges::find(columns, name) == columns.end())
      out.push_back("column '" + name + "' is none of the test, "
                    + scene::suggestion(name, columns));
  return out;
}

std::vector<std::pair<std::size_t, std::size_t>>
branches(std::span<const double> x)
{
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (x.empty())
    return out;
  const auto [low, high] = std::ranges::minmax(x);
  const double noise = 0.01 * (high - low);
  std::size_t first = 0, extreme = 0;
  int direction = 0; // not known yet
  for (std::size_t i = 1; i < x.size(); ++i)
  {
    const double ahead = x[i] - x[extreme];
    if (direction == 0)
    {
      if (std::abs(x[i] - x[first]) > noise)
      {
        direction = x[i] > x[first] ? 1 : -1;
        extreme = i;
      }
    }
    else if (direction * ahead >= 0)
      extreme = i;
    else if (-direction * ahead > noise)
    {
      out.emplace_back(first, extreme);
      first = extreme;
      extreme = i;
      direction = -direction;
    }
  }
  out.emplace_back(first, x.size() - 1);
  return out;
}

std::vector<output::Deviation> deviations(const DataTable& data,
                                          const output::Curves& curves)
{
  const auto x = data.curves->column(data.x), along = curves.column(data.x);
  const auto measured = branches(x), computed = branches(along);
  std::vector<output::Deviation> out;
  for (const std::string& name : data.curves->names())
  {
    if (name == data.x)
      continue;
    const auto y = data.curves->column(name), of = curves.column(name);
    output::Deviation d{.column = name, .abscissa = data.x};
    double squares = 0;
    for (std::size_t b = 0; b < measured.size(); ++b)
      // a turn belongs to the stretch that it ends
      for (std::size_t i = measured[b].first + (b > 0); i <= measured[b].second;
           ++i)
      {
        std::optional<double> value;
        if (b < computed.size())
        {
          const auto [from, to] = computed[b];
          const std::size_t n = to - from + 1;
          value = output::interpolate(along.subspan(from, n),
                                      of.subspan(from, n), x[i]);
        }
        if (not value or not std::isfinite(y[i]))
        {
          ++d.outside;
          continue;
        }
        ++d.points;
        squares += (*value - y[i]) * (*value - y[i]);
      }
    d.rms = d.points > 0 ? std::sqrt(squares / d.points) : NAN;
    out.push_back(d);
  }
  return out;
}
} // namespace mmale::element
