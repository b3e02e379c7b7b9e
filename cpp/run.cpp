// SPDX-License-Identifier: LGPL-3.0-or-later
#include "run.h"

#include "monitor.h"
#include "output/checks.h"
#include "output/curves.h"
#include "output/on_root.h"
#include "output/pictures.h"
#include "output/progress.h"
#include "output/state_file.h"
#include "output/summary.h"
#include "output/versions.h"
#include "simulation.h"
#include "step_control.h"
#include "stop_signal.h"
#include <algorithm>
#include <cmath>
#include <dolfinx/common/MPI.h>
#include <iostream>
#include <spdlog/spdlog.h>
#include <sstream>

namespace mmale
{
namespace
{
/// A run with its books open. Every method is collective.
class Run
{
public:
  Run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options);
  Result go();

private:
  bool stage(const scene::Stage& stage);
  void record(double step, const StepLog& log);
  void write_fields();
  std::vector<double> marks(double begin, double duration) const;
  std::string explain(const StepControl& control, const StepLog& log) const;
  void save_state();
  void finish();

  MPI_Comm _comm;
  const scene::Scene& _scene;
  const RunOptions& _options;
  bool _root;
  double _end = 0;
  Simulation _sim;
  Monitor _monitor;
  output::Curves _curves;
  output::References _references;
  output::Fields _fields;
  output::Probe _probe;
  output::Progress _progress;
  output::Summary _summary;
  double _fields_due = 0;
  int _outputs = 0;
  bool _interrupted = false;
  StopSignal _stop;
};

double total_duration(const scene::Scene& scene)
{
  double sum = 0;
  for (const auto& stage : scene.stage)
    sum += stage.duration;
  return sum;
}

output::Curves make_curves(bool root, const RunOptions& options,
                           const std::vector<std::string>& names)
{
  return root ? output::Curves(options.results / "curves.csv", names)
              : output::Curves(names);
}

std::vector<std::string> names(const output::Ledger& ledger)
{
  std::vector<std::string> out;
  for (const auto& entry : ledger)
    out.push_back(entry.name);
  return out;
}

Run::Run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options)
    : _comm(comm), _scene(scene), _options(options),
      _root(dolfinx::MPI::rank(comm) == 0), _end(total_duration(scene)),
      _sim(comm, scene, options.grid.get()), _monitor(_sim),
      _curves(make_curves(_root, options, _monitor.names())),
      _fields(_sim.domain.mesh, options.results), _probe(_sim.domain.mesh),
      _progress(0, _end, output::Progress::style(options.quiet or not _root))
{
  if (not options.reference.empty())
    _references = output::read_references(options.reference, _monitor.names(),
                                          names(_monitor.ledger()));
  if (not _references.complaints.empty())
  {
    std::string all;
    for (const auto& c : _references.complaints)
      all += (all.empty() ? "" : "\n") + c;
    throw std::runtime_error(all);
  }
  _summary.title = scene.title;
  _summary.ranks = dolfinx::MPI::size(comm);
  _summary.versions = output::versions();
  _summary.scene = options.scene_as_understood;
  _summary.cells = _sim.domain.cell_map().size_global();
  _summary.nodes = _sim.domain.nodes().size_global();
  output::on_root(comm,
                  [&] { write(options.results / "summary.json", _summary); });
}

/// Times of a stage at which fields are written, from its start [s].
std::vector<double> Run::marks(double begin, double duration) const
{
  std::vector<double> out;
  for (const auto& [name, picture] : _scene.output.picture)
    out.push_back(picture.at - begin);
  if (const double every = _scene.output.fields_every; every > 0)
    for (double t = every * (std::floor(begin / every) + 1);
         t < begin + duration; t += every)
      out.push_back(t - begin);
  std::erase_if(out,
                [duration](double t) { return not(t > 0 and t < duration); });
  return out;
}

void Run::write_fields()
{
  const auto scope = _sim.clock.scope("5 output");
  _sim.domain.put_geometry(_sim.state.x);
  const auto fields = _monitor.fields();
  _fields.write(_sim.state.time, fields);
  if (not _scene.output.line.empty())
    output::write_lines(_probe, _comm, _options.results, _outputs,
                        _scene.output.line, fields);
  ++_outputs;
}

void Run::record(double step, const StepLog& log)
{
  const auto scope = _sim.clock.scope("5 output");
  const auto row = _monitor.row(step, log);
  output::on_root(_comm, [&] { _curves.add(row); });
  if (not _root)
    _curves.add(row);
}

void Run::save_state()
{
  output::write_state(_options.results / "state.h5", _sim.domain, _sim.state);
}

std::string Run::explain(const StepControl& control, const StepLog& log) const
{
  const auto& why = log.newton.failure;
  std::ostringstream out;
  out << "stopped at the step floor: t = " << _sim.state.time << " s, step "
      << control.step() << " s is below " << control.floor() << " s; "
      << why.cause << ", cell " << why.cell << " at (" << why.place[0] << ", "
      << why.place[1] << ") m, material '" << _scene.material.begin()->first
      << "'";
  return out.str();
}

/// Steps of one stage; false when the run has to end.
bool Run::stage(const scene::Stage& stage)
{
  const double begin = _sim.state.time;
  const auto outputs = marks(begin, stage.duration);
  StepControl control(stage, outputs);
  if (_sim.problem)
  {
    _sim.problem->set_stage(stage);
    _sim.problem->begin_stage(_sim.state);
  }
  while (not control.finished())
  {
    StepLog log;
    const double t0 = control.time(), t1 = control.next();
    const int number = static_cast<int>(_summary.steps) + 1;
    const bool taken = step(_sim, stage, t0, t1, number, log);
    _summary.iterations += log.newton.iterations;
    if (not taken)
    {
      ++_summary.rejected;
      if (control.failed())
        continue;
      _summary.outcome = explain(control, log);
      return false;
    }
    if (not log.remap.trouble.empty())
    {
      _progress.note("remap left out: " + log.remap.trouble);
      ++_summary.remaps_left_out;
      _summary.remap_trouble = log.remap.trouble;
    }
    _summary.remaps += log.remap.done;
    ++_summary.steps;
    control.accepted(static_cast<int>(log.newton.residuals.size()) - 1);
    _sim.state.time = begin + control.time();
    _monitor.after_step(t1 - t0);
    record(t1 - t0, log);
    _progress.show(
        {_sim.state.time, t1 - t0, _summary.steps, log.newton.iterations});
    if (std::ranges::find(outputs, control.time()) != outputs.end())
      write_fields();
    if (_stop.requested(_comm))
    {
      _summary.outcome = "stopped by a signal";
      _interrupted = true;
      return false;
    }
  }
  return true;
}

void Run::finish()
{
  _summary.ledger = _monitor.ledger();
  _summary.time = _sim.state.time;
  _summary.checks =
      output::evaluate(_references.entries, _curves, _summary.ledger);
  _summary.timers = _sim.clock.timings(
      _summary.cells,
      [this](std::span<double> v)
      {
        MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()),
                      MPI_DOUBLE, MPI_MAX, _comm);
      });
  _summary.wall_seconds = _sim.clock.wall();
  output::on_root(_comm,
                  [&] { write(_options.results / "summary.json", _summary); });
  _progress.finish(_summary.outcome);
  if (not _root)
    return;
  if (not _options.quiet)
    std::cout << output::table(_summary.timers, _summary.wall_seconds)
              << output::table(_summary.checks) << std::flush;
  const auto trouble = output::draw(
      _options.results, output::pictures(_scene, _monitor.names(),
                                         _references.entries, _fields.info()));
  if (not trouble.empty())
    spdlog::warn("no pictures: {}", trouble);
}

Result Run::go()
{
  record(0, {});
  write_fields();
  bool completed = true;
  for (const auto& s : _scene.stage)
    if (completed = stage(s); not completed)
      break;
  if (completed)
    _summary.outcome = "completed";
  else
    save_state();
  write_fields();
  finish();
  Result result;
  result.outcome = _summary.outcome;
  result.completed = completed;
  result.interrupted = _interrupted;
  result.checks_hold = output::all_hold(_summary.checks);
  for (const auto& name : _curves.names())
    result.last[name] = _curves.column(name).back();
  return result;
}
} // namespace

Result run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options)
{
  output::on_root(comm, [&]
                  { std::filesystem::create_directories(options.results); });
  return Run(comm, scene, options).go();
}
} // namespace mmale
