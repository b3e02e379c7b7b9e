// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel.h"

#include "compat.h"
#include "strain.h"
#include <algorithm>
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
  std::string name;
  std::size_t offset;
  int size;
};

std::vector<Offer> offers(const CellInput*)
{
  return {{"w", offsetof(CellInput, w), 11},
          {"w_n", offsetof(CellInput, w_n), 11},
          {"s", offsetof(CellInput, s), 5},
          {"theta", offsetof(CellInput, theta), 1},
          {"ln_J", offsetof(CellInput, ln_J), 1},
          {"mu", offsetof(CellInput, mu), 1},
          {"memory", offsetof(CellInput, memory), 1},
          {"mu_b", offsetof(CellInput, mu_b), 1},
          {"rho_b", offsetof(CellInput, rho_b), 1},
          {"to_end", offsetof(CellInput, to_end), 1},
          {"u_n", offsetof(CellInput, u_n), 2},
          {"grad_p", offsetof(CellInput, grad_p), 2},
          {"lam", offsetof(CellInput, lam), 1},
          {"rho", offsetof(CellInput, rho), 1},
          {"ds_dh", offsetof(CellInput, ds_dh), 25},
          {"ds_dp", offsetof(CellInput, ds_dp), 5},
          {"dtheta_dh", offsetof(CellInput, dtheta_dh), 5},
          {"dtheta_dp", offsetof(CellInput, dtheta_dp), 1},
          {"dlam_dh", offsetof(CellInput, dlam_dh), 5},
          {"dlam_dp", offsetof(CellInput, dlam_dp), 1}};
}

template <int n>
std::vector<Offer> offers(const PointInput<n>*)
{
  using Input = PointInput<n>;
  const std::string of = "_" + std::to_string(n);
  return {{"w", offsetof(Input, w), 11},
          {"mu", offsetof(Input, mu), 1},
          {"rho", offsetof(Input, rho), 1},
          {"s" + of, offsetof(Input, s), 5 * n},
          {"excess" + of, offsetof(Input, excess), n},
          {"ds_dh" + of, offsetof(Input, ds_dh), 25 * n},
          {"ds_dp" + of, offsetof(Input, ds_dp), 5 * n},
          {"dtheta_dh" + of, offsetof(Input, dtheta_dh), 5 * n},
          {"dtheta_dp" + of, offsetof(Input, dtheta_dp), n}};
}

std::vector<Offer> offers(const SeepageInput*)
{
  using Input = SeepageInput;
  auto out = offers(static_cast<const CellInput*>(nullptr));
  for (Offer& o : out)
    o.offset += offsetof(Input, cell);
  out.insert(out.end(), {{"p_w", offsetof(Input, p_w), 3},
                         {"p_w_n", offsetof(Input, p_w_n), 3},
                         {"stored", offsetof(Input, stored), 3},
                         {"dstored_dp", offsetof(Input, dstored_dp), 3},
                         {"compliance", offsetof(Input, compliance), 1},
                         {"mobility", offsetof(Input, mobility), 1},
                         {"share", offsetof(Input, share), 1},
                         {"size", offsetof(Input, size), 4},
                         {"radius", offsetof(Input, radius), 1}});
  return out;
}

template <class Input>
constexpr std::size_t newmark_at = offsetof(Input, newmark);
template <>
constexpr std::size_t newmark_at<SeepageInput> =
    offsetof(SeepageInput, cell) + offsetof(CellInput, newmark);

/// What every input has.
template <class Input>
std::vector<Offer> all_offers()
{
  auto out = offers(static_cast<const Input*>(nullptr));
  const std::size_t at = newmark_at<Input>;
  out.push_back({"a_0", at + offsetof(NewmarkInput, a_0), 6});
  out.push_back({"a_n", at + offsetof(NewmarkInput, a_n), 6});
  out.push_back({"v_0", at + offsetof(NewmarkInput, v_0), 6});
  out.push_back({"r_0", at + offsetof(NewmarkInput, r_0), 3});
  return out;
}

const std::vector<Offer> constants{{"g", offsetof(Constants, g), 2},
                                   {"g_n", offsetof(Constants, g_n), 2},
                                   {"dt", offsetof(Constants, dt), 1},
                                   {"t", offsetof(Constants, t), 2},
                                   {"p_a", offsetof(Constants, p_a), 1},
                                   {"z_p", offsetof(Constants, z_p), 1},
                                   {"z_s", offsetof(Constants, z_s), 1},
                                   {"c_a", offsetof(Constants, c_a), 1},
                                   {"c_v", offsetof(Constants, c_v), 1},
                                   {"c_r", offsetof(Constants, c_r), 1},
                                   {"b", offsetof(Constants, b), 1},
                                   {"spring", offsetof(Constants, spring), 1},
                                   {"rho_f", offsetof(Constants, rho_f), 1},
                                   {"end", offsetof(Constants, end), 1}};

const Offer& find(std::span<const Offer> offers, std::string_view name,
                  std::string_view what)
{
  const auto it = std::ranges::find(offers, name, &Offer::name);
  if (it != offers.end())
    return *it;
  std::string message = "forms: no " + std::string(what) + " is called '"
                        + std::string(name) + "'; there are";
  for (const Offer& o : offers)
    message += " " + o.name;
  throw std::runtime_error(message);
}

template <class Struct>
void pack(double* to, const Struct& from, const auto& parts)
{
  const char* base = reinterpret_cast<const char*>(&from);
  for (const auto& [offset, size] : parts)
    to = std::copy_n(reinterpret_cast<const double*>(base + offset), size, to);
}
} // namespace

template <class Input>
BasicKernel<Input>::BasicKernel(const ufcx_form& form, IntegralKind kind)
{
  const auto coefficients = all_offers<Input>();
  for (int i = 0; i < form.num_coefficients; ++i)
  {
    const Offer& o =
        find(coefficients, form.coefficient_name_map[i], "coefficient");
    _coefficients.push_back({o.offset, o.size});
  }
  for (int i = 0; i < form.num_constants; ++i)
  {
    const Offer& o = find(constants, form.constant_name_map[i], "constant");
    _constants.push_back({o.offset, o.size});
  }
  const auto type = kind == IntegralKind::cell ? cell : exterior_facet;
  for (int i = form.form_integral_offsets[type];
       i < form.form_integral_offsets[type + 1]; ++i)
    _functions.push_back(form.form_integrals[i]->tabulate_tensor_float64);
  if (_functions.empty())
    throw std::runtime_error("forms: a form has no integral over its cells or "
                             "boundary facets");
}

template <class Input>
void BasicKernel<Input>::operator()(std::span<double> A, const Input& input,
                                    const Constants& c, const double* x,
                                    int facet) const
{
  std::array<double, sizeof(Input) / sizeof(double)> w_packed;
  std::array<double, sizeof(Constants) / sizeof(double)> c_packed;
  pack(w_packed.data(), input, _coefficients);
  pack(c_packed.data(), c, _constants);
  for (const auto f : _functions)
    compat::call(f, A.data(), w_packed.data(), c_packed.data(), x, &facet);
}

template class BasicKernel<CellInput>;
template class BasicKernel<SeepageInput>;
template class BasicKernel<PointInput<3>>;
template class BasicKernel<PointInput<6>>;

namespace
{
template <int n>
const ufcx_expression& strain(bool axisymmetric)
{
  if constexpr (n == 1)
    return axisymmetric ? *expression_strain_1 : *expression_strain_0;
  else if constexpr (n == 3)
    return axisymmetric ? *expression_strain_3 : *expression_strain_2;
  else
    return axisymmetric ? *expression_strain_5 : *expression_strain_4;
}
} // namespace

template <int n>
void mid_gradient(bool axisymmetric, const double* w, const double* x,
                  double* G)
{
  std::fill_n(G, 5 * n, 0.0);
  compat::call(strain<n>(axisymmetric).tabulate_tensor_float64, G, w, nullptr,
               x, nullptr);
}

template <int n>
const std::array<std::array<double, 3>, n>& points()
{
  static const auto shares = []
  {
    const double* X = strain<n>(false).points;
    std::array<std::array<double, 3>, n> out;
    for (int q = 0; q < n; ++q)
      out[q] = {1 - X[2 * q] - X[2 * q + 1], X[2 * q], X[2 * q + 1]};
    return out;
  }();
  return shares;
}

template void mid_gradient<1>(bool, const double*, const double*, double*);
template void mid_gradient<3>(bool, const double*, const double*, double*);
template void mid_gradient<6>(bool, const double*, const double*, double*);
template const std::array<std::array<double, 3>, 3>& points<3>();
template const std::array<std::array<double, 3>, 6>& points<6>();
} // namespace mmale::lagrangian
