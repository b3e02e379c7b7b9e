// SPDX-License-Identifier: LGPL-3.0-or-later
// Routines with Abaqus's interface: the same answers as our own laws, what
// they are called with, and what becomes of those that misbehave.
#include "samples.h"

#include "material/drive.h"
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <limits>

using namespace mmale;
using namespace mmale::material;
using Catch::Matchers::ContainsSubstring;
using mmale::test::Random;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

struct State
{
  Voigt s = Voigt::Zero();
  double p = 0;
  std::vector<double> q = {};
};

State begin(const AnyLaw& law)
{
  State state{.q = std::vector<double>(std::size_t(num_history(law)), NAN)};
  std::visit([&](const auto& l) { l.begin({}, state.q); }, law);
  return state;
}

Outcome update(const AnyLaw& law, const State& start, const Strain& step,
               std::vector<double>& q, Response& answer)
{
  q = start.q;
  return std::visit(
      [&](const auto& l)
      {
        return l.update({start.s, start.p, start.q}, step,
                        TangentKind::consistent, q, answer);
      },
      law);
}

AnyLaw umat(const std::string& file, std::vector<double> props, double states)
{
  return make_law({"umat",
                   {{"states", states}, {"density", 1.0}},
                   {{"library", UMATS + file}},
                   {{"props", std::move(props)}}});
}

/// Both laws along one random path, each from its own answers.
void compare(const AnyLaw& ours, const AnyLaw& theirs, double strain,
             double stress, bool plastic)
{
  Random random(1);
  State a = begin(ours), b = begin(theirs);
  for (int k = 0; k < 300; ++k)
  {
    const Strain step{random.deviator(strain, 2), strain * random.unit(), 0.5};
    Response x, y;
    std::vector<double> qa, qb;
    REQUIRE(update(ours, a, step, qa, x) == Outcome::ok);
    REQUIRE(update(theirs, b, step, qb, y) == Outcome::ok);
    // a few dozen operations a step, which add up
    const double digits = 100 * eps * (k + 1) * (stress + std::abs(x.p));
    CHECK((x.s - y.s).norm() <= digits);
    CHECK(std::abs(x.p - y.p) <= digits);
    const double modulus = std::abs(x.dp_dtheta) + x.ds_de.norm();
    const auto by_trace = [](const Voigt2& m) // what counts of a deviator
    {
      Voigt2 out = m;
      out.leftCols<3>().colwise() -= m.leftCols<3>().rowwise().sum() / 3;
      return out;
    };
    CHECK((by_trace(x.ds_de) - by_trace(y.ds_de)).norm() <= 1e-11 * modulus);
    CHECK((x.ds_dtheta - y.ds_dtheta).norm() <= 1e-12 * modulus);
    CHECK(std::abs(x.dp_dtheta - y.dp_dtheta) <= 1e-12 * modulus);
    if (plastic)
      CHECK(std::abs(qa[0] - qb[5]) <= 100 * eps * (k + 1) * qa[0]);
    a = {x.s, x.p, qa};
    b = {y.s, y.p, qb};
  }
  if (plastic)
    CHECK(a.q[0] > 50 * strain); // the path yields in most of its steps
}
} // namespace

TEST_CASE("umat: Hooke's law in C is our elastic law to round-off",
          "[conformance][material][umat]")
{
  const AnyLaw ours =
      make_law({"elastic", {{"E", 2.6e6}, {"nu", 0.3}, {"density", 1.0}}});
  compare(ours, umat("elastic.so", {2.6e6, 0.3}, 0), 1e-2, 5e4, false);
}

TEST_CASE("umat: von Mises in C is our j2 to round-off",
          "[conformance][material][umat]")
{
  const AnyLaw ours = make_law({"j2",
                                {{"E", 2.1e11},
                                 {"nu", 0.29},
                                 {"yield_stress", 3e8},
                                 {"hardening", 4e9},
                                 {"density", 1.0}}});
  compare(ours, umat("mises.so", {2.1e11, 0.29, 3e8, 4e9}, 1), 4e-3, 4e8, true);
}

TEST_CASE("umat: moduli are those of the routine's tangent",
          "[conformance][material][umat]")
{
  const AnyLaw law = umat("elastic.so", {2.6e6, 0.3}, 0);
  const State start = begin(law);
  const auto moduli = [&](const AnyLaw& l, const State& s)
  {
    return std::visit([&](const auto& x)
                      { return x.moduli({s.s, s.p, s.q}, 1); }, l);
  };
  CHECK(moduli(law, start).G == Catch::Approx(1e6));
  CHECK(moduli(law, start).K == Catch::Approx(2.6e6 / 1.2));
  // one without any still scales what is around it
  const AnyLaw none = umat("capricious.so", {1e6, 5, 0}, 0);
  CHECK(moduli(none, begin(none)).G > 0);
  CHECK(moduli(none, begin(none)).K > 0);
}

TEST_CASE("umat: the routine is told strain, time and increments",
          "[conformance][material][umat]")
{
  const AnyLaw law = umat("capricious.so", {1e6, 0, 1}, 9);
  State state = begin(law);
  const Strain first{{1e-3, -1e-3, 0, 4e-3}, 3e-3, 0.25};
  const Strain second{{0, 2e-3, -2e-3, 2e-3}, 0, 0.5};
  Response r;
  std::vector<double> q;
  REQUIRE(update(law, state, first, q, r) == Outcome::ok);
  // STRAN, TIME(1), TIME(2), DTIME, KINC, DFGRD1(1,2) of the first step
  const std::vector<double> one = {0, 0, 0, 0, 0, 0, 0.25, 1, 2e-3};
  for (std::size_t i = 0; i < 9; ++i)
    CHECK(q[5 + i] == Catch::Approx(one[i]).margin(1e-18));
  state = {r.s, r.p, q};
  REQUIRE(update(law, state, second, q, r) == Outcome::ok);
  const std::vector<double> two = {2e-3, 0,   1e-3, 4e-3, 0.25,
                                   0.25, 0.5, 2,    1e-3};
  for (std::size_t i = 0; i < 9; ++i)
    CHECK(q[5 + i] == Catch::Approx(two[i]).margin(1e-18));
}

TEST_CASE("umat: one that wants less or writes no number asks for a smaller "
          "step",
          "[conformance][material][umat]")
{
  const auto mode = GENERATE(1.0, 2.0, 3.0, 4.0);
  INFO("mode " << mode);
  const AnyLaw law = umat("capricious.so", {1e6, mode, 1e-3}, 9);
  const State start = begin(law);
  Response r;
  std::vector<double> q;
  const Voigt de(1, -1, 0, 0);
  CHECK(update(law, start, {2e-3 * de, 0, 1}, q, r) == Outcome::reduce_step);
  CHECK(update(law, start, {5e-4 * de, 0, 1}, q, r) == Outcome::ok);
  // and the way by pressure passes it on
  Driven driven;
  q = start.q;
  CHECK(std::visit(
            [&](const auto& l)
            {
              return drive(l, {start.s, start.p, start.q}, 2e-3 * de, 0, 1, NAN,
                           TangentKind::consistent, q, driven);
            },
            law)
        == Outcome::reduce_step);
}

TEST_CASE("umat: a routine without a tangent cannot be driven by pressure, and "
          "says so by the step",
          "[conformance][material][umat]")
{
  const AnyLaw law = umat("capricious.so", {1e6, 5, 0}, 0);
  const State start = begin(law);
  Driven driven;
  std::vector<double> q = start.q;
  const Voigt de(1e-3, -1e-3, 0, 0);
  CHECK(std::visit(
            [&](const auto& l)
            {
              return drive(l, {start.s, start.p, start.q}, de, 1e3, 1, NAN,
                           TangentKind::consistent, q, driven);
            },
            law)
        == Outcome::reduce_step);
}

TEST_CASE("umat: nearly incompressible, where deviators round off more than "
          "pressure has digits, it is driven by pressure",
          "[conformance][material][umat]")
{
  const AnyLaw law = umat("elastic.so", {1e9, 0.4999}, 0);
  const State start = begin(law);
  const double K = 1e9 / (3 * (1 - 2 * 0.4999));
  Random random(2);
  for (int trial = 0; trial < 100; ++trial)
  {
    const Voigt de = random.deviator(1e-3, 2);
    const double p = 10 * random.unit();
    Driven driven;
    std::vector<double> q = start.q;
    REQUIRE(std::visit(
                [&](const auto& l)
                {
                  return drive(l, {start.s, start.p, start.q}, de, p, 1, NAN,
                               TangentKind::consistent, q, driven);
                },
                law)
            == Outcome::ok);
    // three strains of 1e-3, summed
    CHECK(std::abs(driven.theta + p / K) <= 10 * eps * 1e-3);
  }
}

TEST_CASE("umat: what a routine writes into its input stays with it",
          "[conformance][material][umat]")
{
  const AnyLaw law = umat("capricious.so", {1e6, 6, 0}, 0);
  const State start = begin(law);
  Response r;
  std::vector<double> q;
  const Strain step{{1e-3, -1e-3, 0, 0}, 0, 1};
  for (int k = 0; k < 2; ++k) // the second call finds PROPS as they were
  {
    REQUIRE(update(law, start, step, q, r) == Outcome::ok);
    CHECK(r.s[0] == Catch::Approx(2e3));
    CHECK(q[0] == 1e-3);
  }
}

TEST_CASE("umat: what cannot be loaded is told, not run",
          "[conformance][material][umat]")
{
  const auto complaints = [](const scene::Material& material)
  {
    for (const auto& info : law_infos())
      if (info.name == "umat")
        return info.complaints(material);
    return std::vector<std::string>();
  };
  scene::Material material{
      "umat", {{"states", 1}, {"density", 1.0}}, {{"library", "nothing.so"}}};
  material.folder = "some/where";
  auto said = complaints(material);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], ContainsSubstring("no such file")
                          and ContainsSubstring("some/where/nothing.so"));
  CHECK_THROWS_WITH(make_law(material), ContainsSubstring("nothing.so"));

  material.folder = UMATS; // and relative to it
  material.texts["library"] = "none.so";
  said = complaints(material);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], ContainsSubstring("has no symbol umat_"));

  material.texts["library"] = "../CMakeFiles";
  CHECK_THAT(complaints(material).at(0), ContainsSubstring("cannot be loaded"));

  material.texts["library"] = "mises.so";
  CHECK(complaints(material).empty());
  material.parameters["states"] = 1.5;
  CHECK_THAT(complaints(material).at(0),
             ContainsSubstring("states: must be a whole number, is 1.5"));
  material.parameters["states"] = 2;
  material.lists["initial_states"] = {1, 2, 3};
  CHECK_THAT(complaints(material).at(0),
             ContainsSubstring("initial_states: has 3 numbers, states is 2"));
}

TEST_CASE("umat: STATEV begins as the scene says",
          "[conformance][material][umat]")
{
  scene::Material material{
      "umat",
      {{"states", 2}, {"density", 1.0}},
      {{"library", UMATS "mises.so"}},
      {{"props", {1, 0, 1, 0}}, {"initial_states", {0.7, -3}}}};
  const State start = begin(make_law(material));
  CHECK(start.q == std::vector<double>{0, 0, 0, 0, 0, 0.7, -3});
  material.lists.erase("initial_states");
  CHECK(begin(make_law(material)).q == std::vector<double>(7, 0.0));
}
