// SPDX-License-Identifier: LGPL-3.0-or-later
#include "samples.h"

#include "material/drive.h"
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>

using namespace mmale;
using namespace mmale::material;
using mmale::test::Random;
using mmale::test::Sample;

namespace
{
struct Tally
{
  long steps = 0, refused = 0, not_finite = 0, not_falling = 0, lost = 0;
};

/// A path of random steps, from a billionth of the yield strain to a thousand
/// times it; compression and tension, and some steps driven by pressure.
template <class L>
void walk(const L& law, const Sample& sample, Random& random, Tally& tally)
{
  std::vector<double> q(num_history(AnyLaw(law)), 0.0);
  law.begin({.p = sample.p}, q);
  Voigt s = Voigt::Zero();
  double p = sample.p;
  const auto finite = [](const auto& values)
  {
    return std::ranges::all_of(values,
                               [](double v) { return std::isfinite(v); });
  };
  for (int k = 0; k < 8; ++k)
  {
    const std::vector<double> start_q = q;
    const Point start{s, p, start_q};
    const double size = std::pow(10, 6 * random.unit() - 3);
    const Strain step{random.deviator(size * sample.strain, 2),
                      size * sample.theta * random.unit(),
                      k == 5 ? 0 : sample.dt};
    ++tally.steps;
    Response r;
    if (law.update(start, step, TangentKind::consistent, q, r) != Outcome::ok)
    {
      ++tally.refused; // keeps its state
      q = start_q;
      continue;
    }
    const bool sound = finite(r.s) and std::isfinite(r.p)
                       and std::isfinite(r.flow) and finite(r.ds_de.reshaped())
                       and finite(r.ds_dtheta) and finite(r.dp_de)
                       and finite(r.dflow_de) and finite(q);
    tally.not_finite += not sound;
    tally.not_falling += not(r.dp_dtheta < 0);
    if (not sound)
      return;
    if (k == 7) // the pressure that the step has come to is found again
    {
      Driven d;
      std::vector<double> again = start_q;
      tally.lost += drive(law, start, step.de, r.p, step.dt, std::nan(""),
                          TangentKind::consistent, again, d)
                    != Outcome::ok;
    }
    s = r.s;
    p = r.p;
  }
}

void walk_all(long paths)
{
  const Sample sample = GENERATE(from_range(test::samples));
  INFO("law " << sample.law());
  Random random(71);
  Tally tally;
  std::visit(
      [&](const auto& law)
      {
        for (long k = 0; k < paths; ++k)
          walk(law, sample, random, tally);
      },
      make_law(sample.material));
  CAPTURE(tally.steps, tally.refused);
  CHECK(tally.not_finite == 0);
  CHECK(tally.not_falling == 0);
  CHECK(tally.lost == 0);
  CHECK(tally.refused < tally.steps);
}
} // namespace

// a million paths through all laws, and a hundredth of them
TEST_CASE("random paths towards no stress, tension and large strain have no "
          "NaN",
          "[conformance][material]")
{
  walk_all(10000 / static_cast<long>(test::samples.size()));
}

TEST_CASE("a million random paths have no NaN", "[conformance][material][slow]")
{
  walk_all(1000000 / static_cast<long>(test::samples.size()));
}
