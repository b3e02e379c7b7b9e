// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel.h"

#include "compat.h"
#include "strain.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <ufcx.h>

namespace mmale::lagrangian
{
namespace
{
struct Offer
{
  std::string_view name;
  std::size_t offset;
  int size;
};

constexpr std::array coefficients{
    Offer{"w", offsetof(CellInput, w), 11},
    Offer{"w_n", offsetof(CellInput, w_n), 11},
    Offer{"s", offsetof(CellInput, s), 5},
    Offer{"theta", offsetof(CellInput, theta), 1},
    Offer{"ln_J", offsetof(CellInput, ln_J), 1},
    Offer{"mu", offsetof(CellInput, mu), 1},
    Offer{"lam", offsetof(CellInput, lam), 1},
    Offer{"rho", offsetof(CellInput, rho), 1},
    Offer{"ds_dh", offsetof(CellInput, ds_dh), 25},
    Offer{"ds_dp", offsetof(CellInput, ds_dp), 5},
    Offer{"dtheta_dh", offsetof(CellInput, dtheta_dh), 5},
    Offer{"dtheta_dp", offsetof(CellInput, dtheta_dp), 1},
    Offer{"dlam_dh", offsetof(CellInput, dlam_dh), 5},
    Offer{"dlam_dp", offsetof(CellInput, dlam_dp), 1},
};

constexpr std::array constants{
    Offer{"g", offsetof(Constants, g), 2},
    Offer{"g_n", offsetof(Constants, g_n), 2},
    Offer{"dt", offsetof(Constants, dt), 1},
    Offer{"t", offsetof(Constants, t), 2},
    Offer{"p_a", offsetof(Constants, p_a), 1},
};

const Offer& find(std::span<const Offer> offers, std::string_view name,
                  std::string_view what)
{
  const auto it = std::ranges::find(offers, name, &Offer::name);
  if (it != offers.end())
    return *it;
  std::string message = "forms: no " + std::string(what) + " is called '"
                        + std::string(name) + "'; there are";
  for (const Offer& o : offers)
    message += " " + std::string(o.name);
  throw std::runtime_error(message);
}

template <class Struct>
double* pack(double* to, const Struct& from, const auto& parts)
{
  const char* base = reinterpret_cast<const char*>(&from);
  for (const auto& [offset, size] : parts)
    to = std::copy_n(reinterpret_cast<const double*>(base + offset), size, to);
  return to;
}
} // namespace

Kernel::Kernel(const ufcx_form& form, IntegralKind kind)
{
  for (int i = 0; i < form.num_coefficients; ++i)
  {
    const Offer& o =
        find(coefficients, form.coefficient_name_map[i], "coefficient");
    _coefficients.push_back({o.offset, o.size});
    _w_size += o.size;
  }
  for (int i = 0; i < form.num_constants; ++i)
  {
    const Offer& o = find(constants, form.constant_name_map[i], "constant");
    _constants.push_back({o.offset, o.size});
    _c_size += o.size;
  }
  const auto type = kind == IntegralKind::cell ? cell : exterior_facet;
  for (int i = form.form_integral_offsets[type];
       i < form.form_integral_offsets[type + 1]; ++i)
    _functions.push_back(form.form_integrals[i]->tabulate_tensor_float64);
  if (_functions.empty())
    throw std::runtime_error("forms: a form has no integral over its cells or "
                             "boundary facets");
}

void Kernel::operator()(std::span<double> A, const CellInput& input,
                        const Constants& c, const double* x, int facet) const
{
  std::array<double, sizeof(CellInput) / sizeof(double)> w_packed;
  std::array<double, sizeof(Constants) / sizeof(double)> c_packed;
  pack(w_packed.data(), input, _coefficients);
  pack(c_packed.data(), c, _constants);
  for (const auto f : _functions)
    compat::call(f, A.data(), w_packed.data(), c_packed.data(), x, &facet);
}

void mid_gradient(bool axisymmetric, const double* w, const double* x,
                  double* G)
{
  std::fill_n(G, 5, 0.0);
  const ufcx_expression* e =
      axisymmetric ? expression_strain_1 : expression_strain_0;
  compat::call(e->tabulate_tensor_float64, G, w, nullptr, x, nullptr);
}
} // namespace mmale::lagrangian
