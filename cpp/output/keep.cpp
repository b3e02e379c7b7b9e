// SPDX-License-Identifier: LGPL-3.0-or-later
#include "keep.h"

#include "checkpoint.h"

#include <array>
#include <span>
#include <stdexcept>
#include <string>

namespace mmale::output
{
void keep(Archive& archive, Clock& clock, std::vector<Timing> timings)
{
  std::vector<std::string> names;
  std::vector<std::array<double, 2>> times;
  for (const auto& t : timings)
  {
    names.push_back(t.name);
    times.push_back({t.seconds, static_cast<double>(t.calls)});
  }
  std::string text = lines(names);
  double wall = clock.wall();
  archive("timers/names", text);
  archive("timers/seconds_calls", times);
  archive("timers/wall", wall);
  if (not archive.loading())
    return;
  timings.clear();
  names = from_lines(text);
  for (std::size_t i = 0; i < names.size(); ++i)
    timings.push_back({.name = names[i],
                       .seconds = times.at(i)[0],
                       .calls = static_cast<std::int64_t>(times[i][1])});
  clock.add(timings, wall);
}

void keep(Archive& archive, Curves& curves)
{
  const std::size_t width = curves.names().size();
  std::string names = lines(curves.names());
  archive("curves/names", names);
  std::vector<double> rows;
  for (std::size_t r = 0; r < curves.rows(); ++r)
    for (const auto& name : curves.names())
      rows.push_back(curves.column(name)[r]);
  archive("curves/rows", rows, static_cast<int>(width));
  if (not archive.loading())
    return;
  if (names != lines(curves.names()))
    throw std::runtime_error("the checkpoint has other curves");
  for (std::size_t r = 0; r < rows.size(); r += width)
    curves.add(std::span(rows).subspan(r, width));
}

void keep(Archive& archive, std::vector<FieldOutput>& outputs)
{
  std::vector<std::array<double, 2>> rows;
  for (const auto& o : outputs)
    rows.push_back({o.time, static_cast<double>(o.begin)});
  archive("fields", rows);
  outputs.clear();
  for (const auto& [time, begin] : rows)
    outputs.push_back({time, static_cast<std::int64_t>(begin)});
}
} // namespace mmale::output
