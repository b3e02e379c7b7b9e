// SPDX-License-Identifier: LGPL-3.0-or-later
#include "states.h"

#include "material/drive.h"
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
using mmale::test::advance;
using mmale::test::begin;
using mmale::test::moduli;
using mmale::test::Random;
using mmale::test::random_state;
using mmale::test::Sample;
using mmale::test::State;
using mmale::test::update;

namespace
{
constexpr double eps = std::numeric_limits<double>::epsilon();

bool is_fluid(const AnyLaw& law)
{
  return std::visit([](const auto& l) { return l.fluid; }, law);
}

double admit(const AnyLaw& law, State& state)
{
  return std::visit([&](const auto& l)
                    { return l.admit(state.s, state.p, state.q); }, law);
}

/// All numbers of an answer whose derivatives it also brings: s, p, flow, each
/// over its size.
Eigen::Vector<double, 6> scaled(const Response& a, const Sample& sample,
                                const Moduli& m)
{
  Eigen::Vector<double, 6> out;
  out << a.s / (2 * m.G * sample.strain), a.p / (m.K * sample.theta), a.flow;
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

/// R q R^T for the tensors of a history.
std::vector<double> turned_history(const AnyLaw& law, std::vector<double> q,
                                   double angle)
{
  std::size_t at = 0;
  for (const HistoryField& field :
       std::visit([](const auto& l) { return l.history(); }, law))
  {
    if (field.size == 4)
    {
      Eigen::Map<Voigt> t(q.data() + at);
      t = turned(Voigt(t), angle, 1);
    }
    at += field.size;
  }
  return q;
}

/// Size of a stress that the law answers with.
double stress_size(const AnyLaw& law, const Sample& sample, const State& start)
{
  const auto [G, K] = moduli(law, start, sample);
  return 2 * G * sample.strain + norm(start.s) + std::abs(start.p);
}

auto any_sample()
{
  return GENERATE_REF(from_range(test::samples));
}
} // namespace

TEST_CASE("the tangent is the derivative of the update",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  Random random(3);
  // Central differences at h = 1e-4 of the scale: truncation 1e-8 of the
  // scaled value, round-off eps / 1e-4; 1e-6 leaves room for large steps.
  constexpr double h = 1e-4, tolerance = 1e-6;
  int kinks = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial)
  {
    const State start = random_state(law, sample, random);
    const Moduli m = moduli(law, start, sample);
    const Voigt de = random.deviator(2 * sample.strain, 2);
    const double theta = sample.theta * random.unit();
    const Response a = update(law, sample, start, de, theta);
    const Voigt d = random.deviator(1, 2);

    const auto at = [&](double x, double y)
    {
      return scaled(update(law, sample, start, de + x * sample.strain * d,
                           theta + y * sample.theta),
                    sample, m);
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
    Response by_e, by_theta;
    by_e.s = a.ds_de * d * sample.strain;
    by_e.p = a.dp_de.dot(d) * sample.strain;
    by_e.flow = a.dflow_de.dot(d) * sample.strain;
    by_theta.s = a.ds_dtheta * sample.theta;
    by_theta.p = a.dp_dtheta * sample.theta;
    by_theta.flow = a.dflow_dtheta * sample.theta;
    CHECK(a.dp_dtheta < 0);
    CHECK((slope(h, 0) - scaled(by_e, sample, m)).norm() < tolerance);
    CHECK((slope(0, h) - scaled(by_theta, sample, m)).norm() < tolerance);
  }
  CHECK(kinks < trials / 50);
}

TEST_CASE("driven by pressure, a law has this pressure, and derivatives of its "
          "own",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  Random random(7);
  constexpr double h = 1e-4;
  int kinks = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial)
  {
    const State start = random_state(law, sample, random);
    const Moduli m = moduli(law, start, sample);
    const double range = m.K * sample.theta;
    const Voigt de = random.deviator(sample.strain, 2);
    const Voigt d = random.deviator(1, 2);
    // any pressure, tension too
    const double p = start.p + 2 * range * random.unit();
    const auto at = [&](double x, double y, std::vector<double>& q)
    {
      Driven out;
      q = start.q;
      const Outcome outcome = std::visit(
          [&](const auto& l)
          {
            return drive(l, start.point(), de + x * sample.strain * d,
                         p + y * range, sample.dt, std::nan(""),
                         TangentKind::consistent, q, out);
          },
          law);
      REQUIRE(outcome == Outcome::ok);
      return out;
    };
    std::vector<double> q;
    const Driven a = at(0, 0, q);
    const Response r = update(law, sample, start, de, a.theta);
    const double size = std::abs(p) + std::abs(start.p) + norm(start.s);
    CHECK(std::abs(r.p - p) <= 1e-12 * (size + range));
    CHECK((r.s - a.s).norm() <= 1e-12 * (size + norm(a.s)));
    const auto all = [&](const Driven& v)
    {
      Eigen::Vector<double, 6> out;
      out << v.s / (2 * m.G * sample.strain), v.theta / sample.theta, v.flow;
      return out;
    };
    const auto slope = [&](double dx, double dy)
    {
      const auto right = all(at(dx, dy, q)), left = all(at(-dx, -dy, q));
      const double bend = ((right - 2 * all(a) + left) / h).norm();
      return std::pair(Eigen::Vector<double, 6>((right - left) / (2 * h)),
                       bend);
    };
    Driven by_e, by_p;
    by_e.s = a.ds_de * d * sample.strain;
    by_e.theta = a.dtheta_de.dot(d) * sample.strain;
    by_e.flow = a.dflow_de.dot(d) * sample.strain;
    by_p.s = a.ds_dp * range;
    by_p.theta = a.dtheta_dp * range;
    by_p.flow = a.dflow_dp * range;
    const auto [along_e, bend_e] = slope(h, 0);
    const auto [along_p, bend_p] = slope(0, h);
    if (bend_e > 1e-2 or bend_p > 1e-2)
    {
      ++kinks;
      continue;
    }
    CHECK((along_e - all(by_e)).norm() < 1e-5 * (1 + along_e.norm()));
    CHECK((along_p - all(by_p)).norm() < 1e-5 * (1 + along_p.norm()));
  }
  CHECK(kinks < trials / 10);
}

TEST_CASE("the continuum tangent is that of an ever smaller step",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  if (is_fluid(law))
    SUCCEED("a fluid has no rate equation for its stress");
  else
  {
    Random random(4);
    const State start = random_state(law, sample, random);
    const Voigt direction = random.deviator(sample.strain, 2);
    const double G = moduli(law, start, sample).G;
    const auto gap = [&](double share)
    {
      std::vector<double> q;
      const auto stiffness = [&](TangentKind kind)
      {
        return update(law, sample, start, share * direction, 0, q, kind).ds_de;
      };
      return (stiffness(TangentKind::consistent)
              - stiffness(TangentKind::continuum))
                 .norm()
             / (2 * G);
    };
    const double coarse = gap(1e-2), fine = gap(1e-3);
    CHECK(fine <= 0.12 * coarse + 8 * eps); // first order in the step
    CHECK(fine < 1e-2);
  }
}

TEST_CASE("rotating the input rotates the output", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  Random random(5);
  for (int trial = 0; trial < 200; ++trial)
  {
    const double angle = std::numbers::pi * random.unit();
    const State start = random_state(law, sample, random);
    const Voigt de = random.deviator(2 * sample.strain, 2);
    const double theta = sample.theta * random.unit();
    std::vector<double> q, q_turned;
    const Response a = update(law, sample, start, de, theta, q);
    State other = start;
    other.s = turned(start.s, angle, 1);
    other.q = turned_history(law, start.q, angle);
    const Response b =
        update(law, sample, other, turned(de, angle, 0.5), theta, q_turned);
    const double size = stress_size(law, sample, start);
    // a few dozen operations on numbers of this size; a law of many sub-steps
    // takes as many times more
    const double steps = 1.0 + static_cast<double>(a.effort.substeps);
    CHECK((b.s - turned(a.s, angle, 1)).norm() < 200 * steps * eps * size);
    CHECK(b.p == Approx(a.p).margin(200 * steps * eps * size));
    CHECK(b.flow == Approx(a.flow).margin(1e-12));
    q = turned_history(law, q, angle);
    for (std::size_t i = 0; i < q.size(); ++i)
      CHECK(
          q_turned[i]
          == Approx(q[i]).epsilon(1e-12).margin(1e-12 * steps * sample.strain));
  }
}

TEST_CASE("a zero increment changes nothing", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  Random random(6);
  for (int trial = 0; trial < 200; ++trial)
  {
    const State start = random_state(law, sample, random);
    std::vector<double> q;
    const Response a = update(law, sample, start, Voigt::Zero(), 0, q);
    const double size = norm(start.s) + std::abs(start.p);
    // A state on the yield surface is there to round-off, no better.
    if (is_fluid(law)) // at rest
      CHECK(norm(a.s) <= stress_size(law, sample, start));
    else
      CHECK((a.s - start.s).norm() <= 4 * eps * size);
    CHECK(std::abs(a.p - start.p) <= 4 * eps * size);
    CHECK(a.flow <= 4 * eps);
    const auto names = history_names(law);
    for (std::size_t i = 0; i < q.size() and not is_fluid(law); ++i)
      if (names[i] == "total_time") // runs on
        CHECK(q[i] == start.q[i] + sample.dt);
      else
        CHECK(std::abs(q[i] - start.q[i])
              <= 8 * eps * (sample.strain + std::abs(start.q[i])));
  }
}

TEST_CASE("random paths stay finite, deviatoric and within the law's range",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  const auto seed = GENERATE(1u, 2u, 3u);
  INFO("law " << sample.law() << ", seed " << seed);
  const AnyLaw law = make_law(sample.material);
  Random random(seed);
  State state = begin(law, sample);
  double worst_trace = 0, worst_cut = 0, largest = 0;
  bool finite = true;
  for (int k = 0; k < 1000; ++k)
  {
    // from steps of a millionth of the yield strain to a thousand times it
    const double size = sample.strain * std::pow(10, 4.5 * random.unit() - 1.5);
    std::vector<double> q = state.q;
    Response a;
    const Strain step{random.deviator(size, 2),
                      sample.theta * 10 * random.unit(), sample.dt};
    const Outcome outcome = std::visit(
        [&](const auto& l)
        {
          return l.update(state.point(), step, TangentKind::consistent, q, a);
        },
        law);
    if (outcome != Outcome::ok)
      continue; // it may ask for less, and keeps its state then
    state = {a.s, a.p, q};
    finite = finite and state.s.allFinite() and std::isfinite(state.p)
             and a.dp_dtheta < 0
             and std::ranges::all_of(
                 state.q, [](double v) { return std::isfinite(v); });
    largest = std::max(largest, norm(state.s) + std::abs(state.p));
    worst_trace =
        std::max(worst_trace, std::abs(state.s.head<3>().sum()) / largest);
    State cut = state;
    worst_cut = std::max(worst_cut, admit(law, cut));
  }
  CHECK(finite);
  CHECK(largest > 0);
  CHECK(worst_trace < 1000 * 16 * eps); // each step adds its round-off
  CHECK(worst_cut <= 1e-6);             // tolerance of an integrated path
}

TEST_CASE("admit brings any stress back, once", "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  const AnyLaw law = make_law(sample.material);
  Random random(8);
  for (int trial = 0; trial < 500; ++trial)
  {
    const State start = random_state(law, sample, random);
    State same = start;
    CHECK(admit(law, same) <= 1e-6); // a path leads to no stress outside

    const double size = 2 * moduli(law, start, sample).G * sample.strain
                        * std::pow(10, 3 * random.unit());
    State wild = start;
    wild.s = random.deviator(size);
    const double cut = admit(law, wild);
    CHECK(cut >= 0);
    CHECK(cut < 1 + eps);
    CHECK(wild.s.allFinite());
    const State once = wild;
    CHECK(admit(law, wild) <= 64 * eps);
    const double left = norm(once.s) + std::abs(once.p);
    CHECK((wild.s - once.s).norm() <= 64 * eps * left);
    if (is_fluid(law))
      continue;
    const Response a = update(law, sample, once, Voigt::Zero(), 0);
    CHECK((a.s - once.s).norm() <= 1e-10 * left);
  }
}
