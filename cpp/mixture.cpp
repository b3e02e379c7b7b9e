// SPDX-License-Identifier: LGPL-3.0-or-later
#include "mixture.h"

#include <algorithm>

namespace mmale::mixture
{
void clear(State& state)
{
  const auto slots = static_cast<std::size_t>(state.materials->num_slots());
  for (const std::int32_t c : state.materials->mixed())
    for (std::vector<double>* field :
         {&state.s, &state.P, &state.density, &state.history})
    {
      const std::size_t width = field->size() / slots;
      std::fill_n(field->begin() + width * c, width, 0.0);
    }
}

void fill(State& state)
{
  clear(state);
  const ::remap::Materials& materials = *state.materials;
  const auto mixed = materials.mixed();
  for (std::size_t row = 0; row < mixed.size(); ++row)
  {
    const auto c = static_cast<std::size_t>(mixed[row]);
    auto slot = static_cast<std::size_t>(
        materials.first_slot(static_cast<std::int32_t>(row)));
    for (const ::remap::Part& part :
         materials.parts(static_cast<std::int32_t>(row)))
    {
      for (int i = 0; i < 4; ++i)
        state.s[4 * c + i] += part.fraction * state.s[4 * slot + i];
      state.P[c] += part.fraction * state.P[slot];
      state.density[c] += part.fraction * state.density[slot];
      ++slot;
    }
  }
}
} // namespace mmale::mixture
