// SPDX-License-Identifier: LGPL-3.0-or-later
#include "samples.h"

#include <Eigen/Dense>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <limits>
#include <numbers>
#include <set>

using namespace mmale;
using namespace mmale::material;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using mmale::test::Random;
using mmale::test::Sample;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

/// A point of a material: its state at the start of a step.
struct Point
{
  Voigt s = Voigt::Zero();
  double p = 0;
  std::vector<double> q;
};

std::size_t num_history(const AnyLaw& law)
{
  return std::visit([](const auto& l) { return l.history.size(); }, law);
}

double shear_modulus(const AnyLaw& law)
{
  return std::visit([](const auto& l) { return l.shear_modulus(); }, law);
}

double bulk_modulus(const AnyLaw& law)
{
  return std::visit([](const auto& l) { return l.bulk_modulus(); }, law);
}

double admit(const AnyLaw& law, Voigt& s, const std::vector<double>& q)
{
  return std::visit([&](const auto& l) { return l.admit(s, q); }, law);
}

Response update(const AnyLaw& law, const Point& start, const Voigt& de,
                double p, std::vector<double>& q)
{
  Response answer;
  q = start.q;
  const Outcome outcome = std::visit(
      [&](const auto& l)
      {
        return l.update({start.s, de, start.p, p}, TangentKind::consistent, q,
                        answer);
      },
      law);
  REQUIRE(outcome == Outcome::ok);
  return answer;
}

Response update(const AnyLaw& law, const Point& start, const Voigt& de,
                double p)
{
  std::vector<double> q;
  return update(law, start, de, p, q);
}

void advance(const AnyLaw& law, Point& point, const Voigt& de, double p)
{
  std::vector<double> q;
  point.s = update(law, point, de, p, q).s;
  point.p = p;
  point.q = q;
}

/// A state that a random path of a few steps has led to.
Point random_point(const AnyLaw& law, const Sample& sample, Random& random)
{
  Point point{.q = std::vector<double>(num_history(law), 0.0)};
  for (int k = 0; k < 4; ++k)
    advance(law, point, random.deviator(0.7 * sample.strain, 2),
            sample.pressure * random.unit());
  return point;
}

/// All numbers of an answer whose derivatives it also brings: s, theta, flow,
/// each over its size.
Eigen::Vector<double, 6> scaled(const Response& a, const Sample& sample,
                                double G, double K)
{
  Eigen::Vector<double, 6> out;
  out << a.s / (2 * G * sample.strain), a.theta * K / sample.pressure, a.flow;
  return out;
}

Eigen::Matrix2d matrix(const Voigt& s, double shear)
{
  return Eigen::Matrix2d{{s[0], s[3] * shear}, {s[3] * shear, s[1]}};
}

/// R t R^T; `shear` is 1 for a stress, 1/2 for a strain with 2 eps_xy.
Voigt turned(const Voigt& t, double angle, double shear)
{
  const Eigen::Rotation2Dd R(angle);
  const Eigen::Matrix2d m = R.toRotationMatrix() * matrix(t, shear)
                            * R.toRotationMatrix().transpose();
  return {m(0, 0), m(1, 1), t[2], m(0, 1) / shear};
}

auto any_sample()
{
  return GENERATE_REF(from_range(test::samples));
}
} // namespace

TEST_CASE("every law of the list has a sample in these tests",
          "[conformance][material]")
{
  std::set<std::string> sampled;
  for (const Sample& s : test::samples)
    sampled.insert(s.law);
  for (const auto& info : law_infos())
  {
    INFO("add a set of parameters of '" << info.name << "' to samples.h");
    CHECK(sampled.contains(info.name));
  }
}

TEST_CASE("the tangent is the derivative of the update",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  const double G = shear_modulus(law), K = bulk_modulus(law);
  Random random(3);
  // Central differences at h = 1e-4 of the scale: truncation 1e-8 of the
  // scaled value, round-off eps / 1e-4; 1e-6 leaves room for large steps.
  constexpr double h = 1e-4, tolerance = 1e-6;
  int kinks = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial)
  {
    const Point start = random_point(law, sample, random);
    const Voigt de = random.deviator(2 * sample.strain, 2);
    const double p = sample.pressure * random.unit();
    const Response a = update(law, start, de, p);
    const Voigt d = random.deviator(1, 2);

    const auto at = [&](double x, double y)
    {
      return scaled(update(law, start, de + x * sample.strain * d,
                           p + y * sample.pressure),
                    sample, G, K);
    };
    const auto slope = [&](double dx, double dy)
    { return Eigen::Vector<double, 6>((at(dx, dy) - at(-dx, -dy)) / (2 * h)); };
    const auto centre = at(0, 0);
    // a yield point within h: the two sides differ, nothing to compare with
    const auto bend = [&](double dx, double dy)
    { return ((at(dx, dy) - 2 * centre + at(-dx, -dy)) / h).norm(); };
    if (bend(h, 0) > 1e-2 or bend(0, h) > 1e-2)
    {
      ++kinks;
      continue;
    }
    Response by_e, by_p;
    by_e.s = a.ds_de * d * sample.strain;
    by_e.theta = a.dtheta_de.dot(d) * sample.strain;
    by_e.flow = a.dflow_de.dot(d) * sample.strain;
    by_p.s = a.ds_dp * sample.pressure;
    by_p.theta = a.dtheta_dp * sample.pressure;
    by_p.flow = a.dflow_dp * sample.pressure;
    CHECK((slope(h, 0) - scaled(by_e, sample, G, K)).norm() < tolerance);
    CHECK((slope(0, h) - scaled(by_p, sample, G, K)).norm() < tolerance);
  }
  CHECK(kinks < trials / 50);
}

TEST_CASE("the continuum tangent is that of an ever smaller step",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  Random random(4);
  const Point start = random_point(law, sample, random);
  const Voigt direction = random.deviator(sample.strain, 2);
  const auto gap = [&](double share)
  {
    Voigt2 D[2];
    for (const auto kind : {TangentKind::consistent, TangentKind::continuum})
    {
      std::vector<double> q = start.q;
      Response a;
      const auto outcome = std::visit(
          [&](const auto& l)
          {
            return l.update({start.s, share * direction, start.p, start.p},
                            kind, q, a);
          },
          law);
      REQUIRE(outcome == Outcome::ok);
      D[kind == TangentKind::continuum] = a.ds_de;
    }
    return (D[0] - D[1]).norm() / (2 * shear_modulus(law));
  };
  const double coarse = gap(1e-2), fine = gap(1e-3);
  CHECK(fine <= 0.12 * coarse + 8 * eps); // first order in the step
  CHECK(fine < 1e-2);
}

TEST_CASE("rotating the input rotates the output", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  Random random(5);
  for (int trial = 0; trial < 200; ++trial)
  {
    const double angle = std::numbers::pi * random.unit();
    const Point start = random_point(law, sample, random);
    const Voigt de = random.deviator(2 * sample.strain, 2);
    const double p = sample.pressure * random.unit();
    std::vector<double> q, q_turned;
    const Response a = update(law, start, de, p, q);
    Point other = start;
    other.s = turned(start.s, angle, 1);
    const Response b = update(law, other, turned(de, angle, 0.5), p, q_turned);
    const double size = 2 * shear_modulus(law) * sample.strain;
    // a few dozen operations on numbers of this size
    CHECK((b.s - turned(a.s, angle, 1)).norm() < 100 * eps * size);
    CHECK(b.theta == Approx(a.theta).margin(1e-14 * sample.strain));
    CHECK(b.flow == Approx(a.flow).margin(1e-12));
    for (std::size_t i = 0; i < q.size(); ++i)
      CHECK(q_turned[i] == Approx(q[i]).epsilon(1e-12));
  }
}

TEST_CASE("a zero increment changes nothing", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  Random random(6);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Point start = random_point(law, sample, random);
    std::vector<double> q;
    const Response a = update(law, start, Voigt::Zero(), start.p, q);
    // A state on the yield surface is there to round-off, no better.
    CHECK((a.s - start.s).norm() <= 4 * eps * norm(start.s));
    CHECK(a.theta == 0);
    CHECK(a.flow <= 4 * eps);
    for (std::size_t i = 0; i < q.size(); ++i)
      CHECK(std::abs(q[i] - start.q[i]) <= 8 * eps * sample.strain);
  }
}

TEST_CASE("random paths stay finite, deviatoric and within the law's range",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("law " << sample.law << ", seed " << seed);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  Random random(seed);
  Point point{.q = std::vector<double>(num_history(law), 0.0)};
  double worst_trace = 0, worst_cut = 0, largest = 0;
  bool finite = true;
  for (int k = 0; k < 3000; ++k)
  {
    // from steps of a millionth of the yield strain to a thousand times it
    const double size = sample.strain * std::pow(10, 4.5 * random.unit() - 1.5);
    advance(law, point, random.deviator(size, 2),
            sample.pressure * 10 * random.unit());
    finite = finite and point.s.allFinite()
             and std::ranges::all_of(point.q,
                                     [](double v) { return std::isfinite(v); });
    largest = std::max(largest, norm(point.s));
    worst_trace =
        std::max(worst_trace, std::abs(point.s.head<3>().sum()) / largest);
    Voigt s = point.s;
    worst_cut = std::max(worst_cut, admit(law, s, point.q));
  }
  CHECK(finite);
  CHECK(largest > 0);
  CHECK(worst_trace < 3000 * 4 * eps); // each step adds its round-off
  CHECK(worst_cut <= 4 * eps);
}

TEST_CASE("admit brings any stress back, once", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  const AnyLaw law = make_law(sample.law, sample.parameters);
  Random random(8);
  for (int trial = 0; trial < 500; ++trial)
  {
    const Point start = random_point(law, sample, random);
    Voigt s = start.s;
    CHECK(admit(law, s, start.q) <= 4 * eps); // a path leads to no stress
    CHECK((s - start.s).norm() <= 4 * eps * norm(start.s)); // outside

    const double size = 2 * shear_modulus(law) * sample.strain
                        * std::pow(10, 3 * random.unit());
    const Voigt wild = random.deviator(size);
    s = wild;
    const double cut = admit(law, s, start.q);
    CHECK(cut >= 0);
    CHECK(cut < 1);
    // what is left is the share that it says, and a law accepts it as it is
    CHECK(norm(s) <= (1 + 4 * eps) * norm(wild));
    CHECK(norm(wild - s) == Approx(cut * norm(wild)).margin(8 * eps * size));
    const Voigt once = s;
    CHECK(admit(law, s, start.q) <= 4 * eps);
    CHECK((s - once).norm() <= 4 * eps * norm(once));
    const Response a =
        update(law, {once, start.p, start.q}, Voigt::Zero(), start.p);
    CHECK((a.s - once).norm() <= 8 * eps * norm(once));
  }
}

TEST_CASE("no parameter of a law has a silent default, none passes as NaN",
          "[conformance][material]")
{
  for (const auto& info : law_infos())
    for (const auto& parameter : info.parameters)
    {
      INFO(info.name << "." << parameter.name);
      CHECK(parameter.is_required());
      CHECK_FALSE(parameter.range.holds(std::nan("")));
      CHECK_FALSE(parameter.range.holds(scene::infinity));
      CHECK_FALSE(parameter.unit.empty());
      CHECK_FALSE(parameter.sentence.empty());
    }
}

TEST_CASE("the samples' parameters are complete, in range and without "
          "complaints",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law);
  for (const auto& info : law_infos())
    if (info.name == sample.law)
      for (const auto& parameter : info.parameters)
      {
        INFO(parameter.name);
        REQUIRE(sample.parameters.contains(parameter.name));
        CHECK(parameter.range.holds(sample.parameters.at(parameter.name)));
      }
  const AnyLaw law = make_law(sample.law, sample.parameters);
  CHECK(std::visit([](const auto& l) { return l.complaints(); }, law).empty());
}

TEST_CASE("an unknown law or parameter is named", "[conformance][material]")
{
  CHECK_THROWS_WITH(make_law("jelly", {}), ContainsSubstring("jelly"));
  for (const auto& info : law_infos())
    CHECK_THROWS_WITH(make_law(info.name, {{"sweetness", 1.0}}),
                      ContainsSubstring("sweetness")
                          and ContainsSubstring(info.name));
}
