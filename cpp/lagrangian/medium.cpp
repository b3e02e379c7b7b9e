// SPDX-License-Identifier: LGPL-3.0-or-later
#include "medium.h"

namespace mmale::lagrangian
{
Medium::Medium(const material::AnyLaw& law,
               const std::optional<scene::Water>& water)
    : _law(&law),
      _fluid(std::visit([](const auto& l) { return l.fluid; }, law)),
      _num_history(material::num_history(law, water.has_value())),
      _void_ratio(material::void_ratio_index(law))
{
  if (water)
  {
    _water = {water->bulk_modulus, water->grain_bulk_modulus,
              water->cavitation_pressure};
    _flows = water->seepage();
    _rho_f = water->density;
    _porosity = water->porosity;
  }
  int at = 0;
  for (const material::HistoryField& field :
       std::visit([](const auto& l) { return l.history(); }, law))
  {
    if (field.size == 4)
      _tensors.push_back(at);
    at += field.size;
  }
}

bool Medium::has_floor() const
{
  return std::visit([]<class L>(const L&)
                    { return not material::LinearPressure<L>; }, *_law);
}

double Medium::begin(const material::Start& start, double p_w,
                     std::span<double> q) const
{
  const int own = _num_history - (_water ? material::Water::num_history : 0);
  return std::visit(
      [&](const auto& law)
      {
        law.begin(start, q.first(own));
        const double rho = material::initial_density(law, start);
        if (not _water)
          return rho;
        const double n = material::porosity(*_law, q, _porosity);
        material::set_pores({p_w, n}, q.first(_num_history));
        return rho + n * _rho_f;
      },
      *_law);
}
} // namespace mmale::lagrangian
