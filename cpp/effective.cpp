// SPDX-License-Identifier: LGPL-3.0-or-later
#include "effective.h"

#include "material/water.h"
#include <algorithm>
#include <span>

namespace mmale
{
namespace
{
/// History of a point of a state, const or not.
auto history(auto& state, std::size_t q)
{
  const std::size_t h = state.history.size() / state.P.size();
  return std::span(state.history).subspan(h * q, h);
}

double pore_pressure(const State& state, std::size_t q)
{
  return material::pores(history(state, q)).p_w;
}
} // namespace

double effective_pressure(const State& state, std::size_t q)
{
  return state.P[q] - pore_pressure(state, q);
}

void to_effective(State& state)
{
  for (std::size_t q = 0; q < state.P.size(); ++q)
    state.P[q] -= pore_pressure(state, q);
  for (std::size_t n = 0; n < state.p_w.size(); ++n)
    state.p[n] -= state.p_w[n];
}

void to_total(State& state)
{
  for (std::size_t q = 0; q < state.P.size(); ++q)
    state.P[q] += pore_pressure(state, q);
  for (std::size_t n = 0; n < state.p_w.size(); ++n)
    state.p[n] += state.p_w[n];
}

Cut admit(std::span<const material::AnyLaw> laws, State& state, int owned_cells)
{
  Cut cut;
  const auto owned = static_cast<std::size_t>(state.points) * owned_cells;
  const auto point = [&](const auto& law, std::size_t own, std::size_t q)
  {
    const double share =
        law.admit(Eigen::Map<material::Voigt>(state.s.data() + 4 * q),
                  state.P[q], history(state, q).first(own));
    cut.points += q < owned and share > 0;
    cut.largest = std::max(cut.largest, share);
  };
  for (std::size_t k = 0; k < laws.size(); ++k)
  {
    const auto own = static_cast<std::size_t>(material::num_history(laws[k]));
    std::visit(
        [&](const auto& law)
        {
          for (std::size_t q = 0; q < state.P.size(); ++q)
            if (not state.materials
                or state.materials->material(static_cast<std::int32_t>(q))
                       == static_cast<std::int32_t>(k))
              point(law, own, q);
        },
        laws[k]);
  }
  return cut;
}
} // namespace mmale
