// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/run.h"

#include "element/compare.h"
#include "element/reader.h"
#include "element/schema.h"
#include "output/clock.h"
#include "output/curves.h"
#include "output/summary.h"
#include <algorithm>
#include <cmath>
#include <format>
#include <iostream>
#include <numeric>
#include <stdexcept>

namespace mmale::element
{
namespace
{
/// Does the driver follow the void ratio, for a law that has none of its own?
bool follows_void_ratio(const Test& test,
                        const std::vector<std::string>& history)
{
  return test.initial.void_ratio
         and std::ranges::find(history, "void_ratio") == history.end();
}

/// A row of curves.csv, in the order of `columns`.
std::vector<double> row(const Test& test, const material::AnyLaw& law,
                        const State& s, std::size_t path, double cycle,
                        const StepLog& log)
{
  const Voigt &t = s.stress, &e = s.strain;
  const double p = -t.head<3>().sum() / 3, eps_v = -e.head<3>().sum();
  const double q = -t[1] + (t[0] + t[2]) / 2;
  const double eps_q = 2.0 / 3 * (-e[1] + (e[0] + e[2]) / 2);
  const double mises =
      std::sqrt(1.5) * material::norm(t + p * Voigt(1, 1, 1, 0));
  std::vector<double> out = {s.time,
                             static_cast<double>(path),
                             cycle,
                             p,
                             q,
                             mises,
                             -t[1],
                             -t[0],
                             -t[2],
                             t[3],
                             -e[1],
                             -e[0],
                             -e[2],
                             e[3],
                             eps_v,
                             eps_q,
                             s.pore_pressure};
  if (follows_void_ratio(test, material::history_names(law)))
    out.push_back((1 + *test.initial.void_ratio) * std::exp(-eps_v) - 1);
  out.insert(out.end(), s.history.begin(), s.history.end());
  for (double x :
       {static_cast<double>(log.iterations), static_cast<double>(log.rejected),
        static_cast<double>(log.effort.substeps),
        static_cast<double>(log.effort.apex),
        static_cast<double>(log.effort.clipped)})
    out.push_back(x);
  for (double& x : out)
    x += 0.0; // -0 is no number that people write
  return out;
}

output::References references_of(const Options& options,
                                 const std::vector<std::string>& columns)
{
  output::References out;
  if (not options.reference.empty())
    out = output::read_references(options.reference, columns, {});
  std::string all;
  for (const auto& c : out.complaints)
    all += (all.empty() ? "" : "\n") + c;
  if (not all.empty())
    throw std::runtime_error(all);
  return out;
}

/// All paths in turn; what stopped them, or "completed".
std::string follow(const Test& test, const material::AnyLaw& law, State& state,
                   output::Curves& curves, output::Summary& summary)
{
  double cycles = 0;
  for (std::size_t i = 0; i < test.path.size(); ++i)
  {
    Driver driver(law, test.path[i], test.solver, state);
    for (int step = 1; step <= driver.steps(); ++step)
    {
      StepLog log;
      const auto outcome = driver.advance(log);
      summary.iterations += log.iterations;
      summary.rejected += log.rejected;
      if (outcome != material::Outcome::ok)
      {
        const double p = -state.stress.head<3>().sum() / 3;
        return std::format("stopped in step {} of {} of {}: {}; p = {:.6g} Pa, "
                           "eps_a = {:.6g}",
                           step, driver.steps(), label(test.path, i), log.cause,
                           p, 0.0 - state.strain[1]);
      }
      ++summary.steps;
      curves.add(
          row(test, law, state, i, cycles + driver.progress(step).cycle, log));
    }
    cycles += test.path[i].cycles;
  }
  return "completed";
}

/// Hold the test against measured points; a clean copy goes beside the curves.
std::vector<output::Deviation> compare(const Test& test, const Options& options,
                                       const output::Curves& curves)
{
  const std::filesystem::path copy = options.results / "data.csv";
  std::filesystem::remove(copy);
  if (not test.data)
    return {};
  const DataTable table = read_data(*test.data);
  output::Curves file(
      copy, {table.curves->names().begin(), table.curves->names().end()});
  std::vector<double> line(file.names().size());
  for (std::size_t r = 0; r < table.curves->rows(); ++r)
  {
    for (std::size_t c = 0; c < line.size(); ++c)
      line[c] = table.curves->column(file.names()[c])[r];
    file.add(line);
  }
  return deviations(table, curves);
}

/// What the law had to put right, if anything.
void tell_effort(const output::Curves& curves)
{
  const auto sum = [&](const char* name)
  {
    const auto column = curves.column(name);
    return std::accumulate(column.begin(), column.end(), 0.0);
  };
  const double apex = sum("apex"), clipped = sum("clipped");
  if (apex > 0 or clipped > 0)
    std::cout << std::format("the law met its zero-stress floor in {} updates "
                             "and clipped its state in {}\n",
                             apex, clipped);
}

void tell(const output::Summary& summary, const Options& options)
{
  std::cout << output::table(summary.checks);
  for (const output::Deviation& d : summary.data)
    std::cout << std::format(
        "{:<6} {:<28} {:>12.6g}  RMS of test less data over "
        "{}, {} points{}\n",
        "data", d.column, d.rms, d.abscissa, d.points,
        d.outside > 0 ? std::format(", {} not reached", d.outside) : "");
  std::cout << summary.outcome << ", "
            << std::format("{} steps, {:.3g} s; results in {}", summary.steps,
                           summary.wall_seconds, options.results.string())
            << std::endl;
}
} // namespace

std::vector<std::string> columns(const Test& test, const material::AnyLaw& law)
{
  const std::vector<std::string> history = material::history_names(law);
  std::vector<std::string> names = {
      "time",      "path",         "cycle",   "p",       "q",
      "von_mises", "sigma_a",      "sigma_r", "sigma_t", "tau",
      "eps_a",     "eps_r",        "eps_t",   "gamma",   "eps_v",
      "eps_q",     "pore_pressure"};
  if (follows_void_ratio(test, history))
    names.emplace_back("void_ratio");
  names.insert(names.end(), history.begin(), history.end());
  for (const char* name :
       {"iterations", "rejected", "substeps", "apex", "clipped"})
    names.emplace_back(name);
  return names;
}

Result run(const Test& test, const Options& options)
{
  const output::Clock clock;
  const material::AnyLaw law = material::make_law(test.material);
  const std::vector<std::string> names = columns(test, law);
  const output::References known = references_of(options, names);
  std::filesystem::create_directories(options.results);
  output::Summary summary;
  summary.title = test.title;
  summary.scene = options.test_as_understood;
  write(options.results / "summary.json", summary);

  output::Curves curves(options.results / "curves.csv", names);
  State state = initial_state(test, law);
  curves.add(row(test, law, state, 0, 0, {}));
  summary.outcome = follow(test, law, state, curves, summary);
  summary.time = state.time;
  summary.checks = output::evaluate(known.entries, curves, {});
  summary.data = compare(test, options, curves);
  summary.wall_seconds = clock.wall();
  write(options.results / "summary.json", summary);
  if (not options.quiet)
  {
    tell_effort(curves);
    tell(summary, options);
  }

  output::Pictures pictures{.title = test.title};
  pictures.sheets = {sheet(test, names, known.entries)};
  const auto trouble = output::draw(options.results, pictures);
  if (not trouble.empty())
    std::cerr << "mmale: no pictures: " << trouble << std::endl;

  Result result{.outcome = summary.outcome,
                .completed = summary.outcome == "completed",
                .checks_hold = output::all_hold(summary.checks)};
  for (const auto& name : names)
    result.last[name] = curves.column(name).back();
  for (const output::Deviation& d : summary.data)
    result.last["rms_" + d.column] = d.rms;
  return result;
}

output::Sheet sheet(const Test& test, std::span<const std::string> columns,
                    std::span<const output::Reference> references)
{
  const Path& last = test.path.back();
  const bool undrained = last.drainage == drainages[1];
  const auto has = [&](const char* name)
  { return std::ranges::find(columns, name) != columns.end(); };
  const std::string volume = has("void_ratio") ? "void_ratio" : "eps_v";
  const std::string response = undrained ? "pore_pressure" : volume;
  using Panels = std::vector<output::Panel>;
  Panels panels;
  if (last.kind == kinds[isotropic])
    panels = {{.x = "p", .y = volume, .log_x = true}, {.x = "eps_v", .y = "p"}};
  else if (last.kind == kinds[oedometric])
    panels = {{.x = "sigma_a", .y = volume, .log_x = true},
              {.x = "eps_a", .y = "sigma_a"},
              {.x = "sigma_a", .y = "sigma_r"},
              {.x = "p", .y = "q"}};
  else if (last.kind == kinds[simple_shear])
    panels = {{.x = "sigma_a", .y = "tau"},
              {.x = "gamma", .y = "tau"},
              {.x = "gamma", .y = response},
              {.x = "p", .y = "von_mises"}};
  else if (last.kind == kinds[triaxial])
    panels = {{.x = "p", .y = "q"},
              {.x = "eps_a", .y = "q"},
              {.x = "eps_a", .y = response},
              {.x = last.cycles > 0 ? "cycle" : "p",
               .y = last.cycles > 0 ? "p" : volume,
               .log_x = not(last.cycles > 0)}};
  else
    panels = {{.x = "p", .y = "q"},
              {.x = "eps_q", .y = "q"},
              {.x = "gamma", .y = "tau"},
              {.x = "eps_q", .y = response}};
  return {.name = "test",
          .panels = panels,
          .points = output::known_points(references),
          .data = test.data ? "data.csv" : ""};
}
} // namespace mmale::element
