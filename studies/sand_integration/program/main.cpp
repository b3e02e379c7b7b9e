// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Paths of Hochstetten sand at a point: error and time of each integrator and
// tolerance, and of forward Euler in equal steps. Prints a table. The error is
// the largest along the path, over the stress there, against dp54 at 1e-12.

#include "material/hypoplastic.h"
#include "material/library.h"
#include "material/runge_kutta.h"

#include <cstdio>
#include <ctime>
#include <limits>

using namespace mmale::material;

namespace
{
const Voigt one(1, 1, 1, 0);

struct Path
{
  const char* name;
  bool grains;
  std::vector<Voigt> steps; ///< of strain; each is a call of the law
};

std::vector<Path> paths()
{
  const auto times = [](int n, const Voigt& step, std::vector<Voigt>& out)
  { out.insert(out.end(), n, step); };
  Path basic{"oedometer, basic law", false, {}};
  times(20, {0, -1e-3, 0, 0}, basic.steps);
  times(5, {0, 1e-4, 0, 0}, basic.steps);
  Path grains = basic;
  grains.name = "oedometer, intergranular strain";
  grains.grains = true;
  Path cycles{"undrained cycles, intergranular strain", true, {}};
  const Voigt shear(0.5, -1, 0.5, 0);
  times(5, 1e-4 * shear, cycles.steps);
  for (int i = 0; i < 5; ++i)
  {
    times(10, -1e-4 * shear, cycles.steps);
    times(10, 1e-4 * shear, cycles.steps);
  }
  return {basic, grains, cycles};
}

Hypoplastic sand(const Path& path, std::string_view scheme, double tolerance)
{
  return std::get<Hypoplastic>(make_law(
      {.law = "hypoplastic",
       .parameters = {{"grain_density", 2650},
                      {"void_ratio", 0.70},
                      {"tolerance", tolerance},
                      {"max_substeps", 1e6}},
       .texts = {{"sand", "hochstetten"},
                 {"integrator", std::string(scheme)},
                 {"intergranular_strain", path.grains ? "on" : "off"}}}));
}

/// Stresses after each step.
using Curve = std::vector<Voigt>;

struct Count
{
  long substeps = 0, rejected = 0;
};

Curve walk(const Path& path, const Hypoplastic& law, TangentKind kind,
           Count& count)
{
  Voigt s = Voigt::Zero();
  double p = 100e3;
  std::vector<double> q(path.grains ? 5 : 1), next;
  law.begin({.p = p}, q);
  Curve out;
  count = {};
  for (const Voigt& step : path.steps)
  {
    const double theta = step.head<3>().sum();
    next = q;
    Response a;
    if (law.update({s, p, q}, {step - theta / 3 * one, theta, 1}, kind, next, a)
        != Outcome::ok)
      return {};
    s = a.s;
    p = a.p;
    q = next;
    count.substeps += a.effort.substeps;
    count.rejected += a.effort.rejected;
    out.push_back(s - p * one);
  }
  return out;
}

/// Forward Euler, `n` equal steps a call. Paths have no shear components.
Curve euler(const Path& path, const Hypoplastic& law, int n)
{
  const auto c = law.constants();
  Voigt T = -100e3 * one, h = Voigt::Zero();
  double e = law.void_ratio;
  Curve out;
  for (const Voigt& step : path.steps)
  {
    const Voigt D = step / n;
    for (int i = 0; i < n; ++i)
    {
      if (path.grains)
      {
        hypoplasticity::Rate<4, true> r;
        r.evaluate(c, T, e, h, D, D.norm(), h.dot(D) > 0);
        T += r.stress;
        h += r.grains.rate;
      }
      else
      {
        hypoplasticity::Rate<4, false> r;
        r.evaluate(c, T, e, h, D, D.norm(), true);
        T += r.stress;
      }
      e += (1 + e) * D.head<3>().sum();
    }
    out.push_back(T);
  }
  return out;
}

double worst(const Curve& curve, const Curve& exact)
{
  if (curve.size() != exact.size())
    return std::nan("");
  double out = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const double miss = (curve[i] - exact[i]).norm() / exact[i].norm();
    if (not(miss <= out)) // NaN too
      out = miss;
  }
  return out;
}

/// Processor time of a path, the least of five rounds of some milliseconds
/// [us].
template <class F>
double microseconds(F&& f)
{
  double best = std::numeric_limits<double>::infinity();
  int repeats = 1;
  for (int round = 0; round < 5;)
  {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < repeats; ++i)
      f();
    const double spent =
        1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (spent < 4e3)
    {
      repeats *= 2;
      continue;
    }
    best = std::min(best, spent / repeats);
    ++round;
  }
  return best;
}

void row(const Path& path, std::string_view scheme, double tolerance,
         double error, double us, double us_tangent, const Count& count)
{
  std::printf("\"%s\",%s,%g,%.4e,%.4e,%.4e,%ld,%ld,%zu\n", path.name,
              std::string(scheme).c_str(), tolerance, error, us, us_tangent,
              count.substeps, count.rejected, path.steps.size());
}
} // namespace

int main()
{
  std::printf("path,integrator,tolerance,error,us,us_tangent,substeps,rejected,"
              "calls\n");
  for (const Path& path : paths())
  {
    Count count;
    const Curve exact =
        walk(path, sand(path, "dp54", 1e-12), TangentKind::robust, count);
    for (const auto scheme : runge_kutta::names)
      for (double tolerance = 1e-2; tolerance > 0.9e-8; tolerance /= 10)
      {
        const Hypoplastic law = sand(path, scheme, tolerance);
        const auto time = [&](TangentKind kind)
        { return microseconds([&] { walk(path, law, kind, count); }); };
        const double us = time(TangentKind::robust);
        const double with = time(TangentKind::consistent);
        row(path, scheme, tolerance,
            worst(walk(path, law, TangentKind::robust, count), exact), us, with,
            count);
      }
    const Hypoplastic law = sand(path, "bs32", 1e-4);
    for (int n = 1; n <= 1024; n *= 4)
    {
      count.substeps = n * static_cast<long>(path.steps.size());
      count.rejected = 0;
      row(path, "euler", n, worst(euler(path, law, n), exact),
          microseconds([&] { euler(path, law, n); }), std::nan(""), count);
    }
  }
}
