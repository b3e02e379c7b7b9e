// SPDX-License-Identifier: LGPL-3.0-or-later
#include "history_fields.h"

#include "material/water.h"
#include <algorithm>

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

HistoryFields::HistoryFields(std::span<const material::AnyLaw> laws, bool water,
                             std::span<const int> inflow)
{
  for (std::size_t k = 0; k < laws.size(); ++k)
  {
    std::vector<std::uint8_t> alone(laws.size(), 0);
    alone[k] = 1;
    std::vector<double> start(material::num_history(laws[k], water));
    std::visit([&](const auto& l) { l.begin({}, start); }, laws[k]);
    const auto add = [&](int at, int size, Conserved what)
    {
      Part& part = _parts.emplace_back(at, size, what, static_cast<int>(k));
      part.carriers = alone;
      for (const int material : inflow)
        for (int i = 0; i < size; ++i)
          part.inflow.push_back(material == static_cast<int>(k)
                                    ? conserved(what, start[at + i])
                                    : 0);
    };
    int at = 0;
    for (const material::HistoryField& field :
         std::visit([](const auto& l) { return l.history(); }, laws[k]))
    {
      add(at, field.size, field.conserved);
      at += field.size;
    }
    for (int i = 0; water and i < material::Water::num_history; ++i)
      add(at++, 1, Conserved::value);
    _numbers = std::max(_numbers, static_cast<std::size_t>(at));
  }
}

void HistoryFields::take(std::span<const double> history,
                         const ::remap::Materials* materials)
{
  const std::size_t points = _numbers > 0 ? history.size() / _numbers : 0;
  for (Part& part : _parts)
  {
    part.values.assign(points * part.size, 0);
    for (std::size_t i = 0; i < part.values.size(); ++i)
      if (not materials
          or materials->material(static_cast<std::int32_t>(i / part.size))
                 == part.material)
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

void HistoryFields::add_to(std::vector<::remap::MaterialField>& fields)
{
  static constexpr double metric[] = {1, 1, 1, 2}; // xx, yy, zz, xy
  for (Part& part : _parts)
  {
    ::remap::MaterialField field{.values = part.values,
                                 .components = part.size,
                                 .inflow = part.inflow,
                                 .carriers = part.carriers};
    if (part.size == 4)
    {
      field.group = 4;
      field.bound = ::remap::Bound::ball;
      field.weights = metric;
    }
    fields.push_back(field);
  }
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

void HistoryFields::give(std::vector<double>& history,
                         const ::remap::Materials& materials) const
{
  const std::int32_t slots = materials.num_slots();
  history.assign(_numbers * static_cast<std::size_t>(slots), 0);
  for (const Part& part : _parts)
    for (std::int32_t slot = 0; slot < slots; ++slot)
      if (materials.material(slot) == part.material)
        for (int i = 0; i < part.size; ++i)
          history[slot * _numbers + part.at + i] =
              value(part.conserved, part.values[slot * part.size + i]);
}
} // namespace mmale::bridge
