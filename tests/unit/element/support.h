// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/driver.h"
#include "element/reader.h"
#include <catch2/catch_test_macros.hpp>
#include <format>
#include <string>
#include <vector>

/// Element tests as text, and where they lead.
namespace mmale::element::test
{
inline scene::Libraries libraries()
{
  return {.laws = material::law_infos()};
}

inline Test make(const std::string& text)
{
  Reading reading = read(text, "test.toml", {}, libraries());
  for (const auto& complaint : reading.complaints)
    UNSCOPED_INFO(to_string(complaint));
  REQUIRE(reading.complaints.empty());
  return reading.test;
}

/// G = 4 MPa, K = 20/3 MPa.
inline const std::string elastic = R"(
[material]
law = "elastic"
E = 1e7
nu = 0.25
density = 0.0
)";

inline std::string hochstetten(const std::string& grains, double void_ratio,
                               double tolerance)
{
  return "[material]\nlaw = \"hypoplastic\"\nsand = \"hochstetten\"\n"
         "grain_density = 2650\nintergranular_strain = \""
         + grains + "\"\nvoid_ratio = " + std::format("{}", void_ratio)
         + "\ntolerance = " + std::format("{}", tolerance)
         + "\nmax_substeps = 1000000\n";
}

inline const std::string isotropic_start = "[initial]\npressure = 100e3\n";

/// Where a test ends, and what it took.
struct End
{
  State state;
  StepLog log = {};
  bool completed = true;

  double sigma_a() const { return -state.stress[1]; }
  double sigma_r() const { return -state.stress[0]; }
  double sigma_t() const { return -state.stress[2]; }
  double tau() const { return state.stress[3]; }
  double p() const { return -state.stress.head<3>().sum() / 3; }
  double q() const { return sigma_a() - sigma_r(); }
  double eps_a() const { return -state.strain[1]; }
  double eps_r() const { return -state.strain[0]; }
  double eps_v() const { return -state.strain.head<3>().sum(); }
  double gamma() const { return state.strain[3]; }
};

/// Run all paths; what each step leads to goes to `see`.
template <class See>
End run(const Test& test, See see)
{
  const material::AnyLaw law = material::make_law(test.material);
  End end{.state = initial_state(test, law)};
  for (const Path& path : test.path)
  {
    Driver driver(law, path, test.solver, end.state);
    for (int i = 0; i < driver.steps() and end.completed; ++i)
    {
      end.completed = driver.advance(end.log) == material::Outcome::ok;
      see(end, i + 1);
    }
  }
  return end;
}

inline End run(const std::string& text)
{
  return run(make(text), [](const End&, int) {});
}
} // namespace mmale::element::test
