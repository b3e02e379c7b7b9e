// SPDX-License-Identifier: LGPL-3.0-or-later
#include "lagrangian/kernel.h"

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <ufcx.h>

using namespace mmale::lagrangian;
using Catch::Matchers::ContainsSubstring;

namespace
{
/// Hands on the packed coefficients, then the constants. `Rest` is what the
/// DOLFINx at hand has besides.
template <class... Rest>
void show(double* A, const double* w, const double* c, const double* x,
          const int* facet, Rest...)
{
  for (int i = 0; i < 6; ++i)
    A[i] += w[i];
  A[6] += c[0];
  A[7] += c[1];
  A[8] += c[2];
  A[9] += x[0] + *facet;
}

/// A form as FFCx would write it, over cells or boundary facets.
struct Form
{
  std::vector<const char*> coefficients, constants;
  bool over_facets = false;
  ufcx_integral integral{};
  ufcx_integral* integrals[1] = {&integral};
  int offsets[4] = {};
  ufcx_form form{};

  Form(std::vector<const char*> w, std::vector<const char*> c,
       bool facets = false)
      : coefficients(std::move(w)), constants(std::move(c))
  {
    integral.tabulate_tensor_float64 = show;
    form.num_coefficients = static_cast<int>(coefficients.size());
    form.num_constants = static_cast<int>(constants.size());
    form.coefficient_name_map = coefficients.data();
    form.constant_name_map = constants.data();
    form.form_integrals = integrals;
    form.form_integral_offsets = offsets;
    for (int i = (facets ? exterior_facet : cell) + 1; i < 4; ++i)
      offsets[i] = 1;
  }
};
} // namespace

TEST_CASE("a form gets its coefficients and constants by name, in its order",
          "[unit][kernel]")
{
  CellInput input{};
  input.rho = 7;
  for (int i = 0; i < 5; ++i)
    input.s[i] = 10 + i;
  Constants c;
  c.dt = 0.5;
  c.g[0] = 3;
  c.g[1] = 4;
  const double x[9] = {100};
  for (const bool facets : {false, true})
  {
    Form form({"rho", "s"}, {"dt", "g"}, facets);
    const Kernel kernel(form.form,
                        facets ? IntegralKind::facet : IntegralKind::cell);
    std::array<double, 10> A{1}; // added to, not overwritten
    kernel(A, input, c, x, 2);
    CHECK(A == std::array<double, 10>{8, 10, 11, 12, 13, 14, 0.5, 3, 4, 102});
    Form other({"s", "rho"}, {"g", "dt"}, facets);
    A = {};
    Kernel(other.form,
           facets ? IntegralKind::facet : IntegralKind::cell)(A, input, c, x);
    CHECK(A == std::array<double, 10>{10, 11, 12, 13, 14, 7, 3, 4, 0.5, 100});
  }
}

TEST_CASE("a form that asks for an unknown coefficient is told which there are",
          "[unit][kernel]")
{
  Form form({"w", "temperature"}, {"dt"});
  CHECK_THROWS_WITH(
      Kernel(form.form, IntegralKind::cell),
      ContainsSubstring("coefficient") and ContainsSubstring("'temperature'")
          and ContainsSubstring("theta") and ContainsSubstring("rho"));
}

TEST_CASE("a form that asks for an unknown constant is told which there are",
          "[unit][kernel]")
{
  Form form({"w"}, {"damping"});
  CHECK_THROWS_WITH(Kernel(form.form, IntegralKind::cell),
                    ContainsSubstring("constant")
                        and ContainsSubstring("'damping'")
                        and ContainsSubstring("dt"));
}

TEST_CASE("a form without the integrals that the solver calls is refused",
          "[unit][kernel]")
{
  Form over_cells({"w"}, {});
  CHECK_THROWS_WITH(Kernel(over_cells.form, IntegralKind::facet),
                    ContainsSubstring("no integral"));
}
