// SPDX-License-Identifier: LGPL-3.0-or-later
#include "history_fields.h"

#include "material/water.h"

namespace mmale::bridge
{
namespace
{
using material::Conserved;

double conserved(Conserved what, double x)
{
  return what == Conserved::grain_volume ? 1 / (1 + x) : x;
}
double value(Conserved what, double kept)
{
  return what == Conserved::grain_volume ? 1 / kept - 1 : kept;
}
} // namespace

HistoryFields::HistoryFields(const std::optional<material::AnyLaw>& law,
                             bool water)
{
  if (not law)
    return;
  int at = 0;
  for (const material::HistoryField& field :
       std::visit([](const auto& l) { return l.history(); }, *law))
  {
    _parts.push_back({at, field.size, field.conserved});
    at += field.size;
  }
  for (int i = 0; water and i < material::Water::num_history; ++i)
    _parts.push_back({at++, 1});
  _numbers = at;
}

void HistoryFields::take(std::span<const double> history)
{
  const std::size_t points = _numbers > 0 ? history.size() / _numbers : 0;
  for (Part& part : _parts)
  {
    part.values.resize(points * part.size);
    for (std::size_t i = 0; i < part.values.size(); ++i)
      part.values[i] = conserved(
          part.conserved,
          history[i / part.size * _numbers + part.at + i % part.size]);
  }
}

void HistoryFields::add_to(std::vector<::remap::Field>& fields)
{
  static constexpr double metric[] = {1, 1, 1, 2}; // xx, yy, zz, xy
  for (Part& part : _parts)
    if (part.size == 4)
      fields.push_back({.values = part.values,
                        .components = 4,
                        .group = 4,
                        .bound = ::remap::Bound::ball,
                        .weights = metric});
    else
      fields.push_back({.values = part.values, .components = part.size});
}

void HistoryFields::give(std::span<double> history) const
{
  for (const Part& part : _parts)
    for (std::size_t i = 0; i < part.values.size(); ++i)
    {
      double& x = history[i / part.size * _numbers + part.at + i % part.size];
      if (part.values[i] != conserved(part.conserved, x))
        x = value(part.conserved, part.values[i]);
    }
}
} // namespace mmale::bridge
