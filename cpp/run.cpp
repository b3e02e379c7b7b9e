// SPDX-License-Identifier: LGPL-3.0-or-later
#include "run.h"

#include "drainage.h"
#include "initial.h"
#include "lay.h"
#include "mixture.h"
#include "monitor.h"
#include "output/archive.h"
#include "output/checkpoint.h"
#include "output/checks.h"
#include "output/curves.h"
#include "output/keep.h"
#include "output/on_root.h"
#include "output/pictures.h"
#include "output/progress.h"
#include "output/summary.h"
#include "output/versions.h"
#include "simulation.h"
#include "step_control.h"
#include "stop_signal.h"
#include <algorithm>
#include <cmath>
#include <dolfinx/common/MPI.h>
#include <format>
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
  void settle();
  void count(const material::Effort& effort);
  void enter_stage();
  bool stage();
  bool attempt();
  void record(double step, const StepLog& log);
  void write_fields();
  std::vector<double> marks(double begin, double duration) const;
  std::string explain(const StepLog& log) const;
  bool checkpoint_due() const;
  void save();
  void resume();
  void keep(output::Archive& archive);
  void keep_books(output::Archive& archive);
  std::vector<output::Timing> timings() const;
  void check();
  void finish();

  MPI_Comm _comm;
  const scene::Scene& _scene;
  const RunOptions& _options;
  bool _root;
  double _end = 0;
  Simulation _sim;
  Monitor _monitor;
  std::optional<output::Archive> _loaded; ///< what is resumed; until it is
  output::Curves _curves;
  output::References _references;
  output::Fields _fields;
  output::Probe _probe;
  output::Progress _progress;
  output::Summary _summary;
  output::CheckpointHeader _header;
  int _stage = 0;             ///< the present one
  double _begin = 0;          ///< of the present stage [s]
  std::vector<double> _marks; ///< of the present stage
  std::optional<StepControl> _control;
  double _checkpoint_due = 0; ///< wall time [s]
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

std::optional<output::Archive> load(const mesh::Domain& domain,
                                    const RunOptions& options)
{
  if (not options.resume)
    return std::nullopt;
  return std::optional<output::Archive>(
      std::in_place, domain, options.results / output::checkpoint_name);
}

std::vector<output::FieldOutput>
earlier_fields(std::optional<output::Archive>& loaded)
{
  std::vector<output::FieldOutput> out;
  if (loaded)
    keep(*loaded, out);
  return out;
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
      _loaded(load(_sim.domain, options)),
      _curves(make_curves(_root, options, _monitor.names())),
      _fields(_sim.domain.mesh, options.results, earlier_fields(_loaded)),
      _probe(_sim.domain.mesh),
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
  _header.version = output::versions().at("mmale");
  _header.scene = options.scene_as_understood;
  _summary.title = scene.title;
  _summary.ranks = dolfinx::MPI::size(comm);
  _summary.versions = output::versions();
  _summary.scene = options.scene_as_understood;
  if (const auto water = drainage(scene))
  {
    _summary.water = {{"T_v", water->T_v},
                      {"c_v", water->c_v},
                      {"frequency", water->frequency},
                      {"drainage_length", water->length}};
    _summary.water_recommended = water->recommended;
    _progress.note(water->words());
  }
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

/// All that steers the run to come. `enter_stage` has been called.
void Run::keep(output::Archive& archive)
{
  archive("run/stage_begin", _begin);
  _control->keep(archive);
  archive("state/time", _sim.state.time);
  Work& work = _sim.state.work;
  archive("state/internal_work", work.internal);
  archive("state/external_work", work.external);
  archive("state/remap_work", work.remap);
  const bool several = _sim.state.materials.has_value();
  if (several)
    mixture::keep(archive, _sim.domain, _sim.state);
  for_each_field(_sim.state,
                 [&](const std::string& name, Entity entity, auto& values)
                 {
                   if (entity != Entity::slot or not several)
                     archive("state/" + name, entity, values);
                 });
  if (_sim.problem)
    _sim.problem->keep(archive);
  if (_sim.remap)
    _sim.remap->keep(archive);
  _monitor.keep(archive);
  keep_books(archive);
}

/// What the run has told so far.
void Run::keep_books(output::Archive& archive)
{
  archive("run/outputs", _outputs);
  archive("summary/steps", _summary.steps);
  archive("summary/rejected", _summary.rejected);
  archive("summary/iterations", _summary.iterations);
  archive("summary/remaps", _summary.remaps);
  archive("summary/remaps_left_out", _summary.remaps_left_out);
  archive("summary/remap_trouble", _summary.remap_trouble);
  archive("summary/initial_imbalance", _summary.initial_imbalance);
  for (const char* what : {"substeps", "rejected", "apex", "clipped"})
    archive(std::string("summary/law_") + what, _summary.law[what]);
  archive("summary/resumed", _summary.resumed);
  output::keep(archive, _curves);
  output::keep(archive, _sim.clock, timings());
}

bool Run::checkpoint_due() const
{
  int due = _sim.clock.wall() >= _checkpoint_due;
  MPI_Bcast(&due, 1, MPI_INT, 0, _comm);
  return due != 0 and _scene.output.checkpoint_every > 0;
}

void Run::save()
{
  const auto outer = _sim.clock.scope("5 output");
  const auto scope = _sim.clock.scope("5a checkpoint");
  const double t0 = _sim.clock.wall();
  output::Archive archive(_sim.domain);
  _header.standing.stage = _stage;
  _header.time = _sim.state.time;
  _header.keep(archive);
  auto outputs = _fields.outputs();
  output::keep(archive, outputs);
  keep(archive);
  archive.write(_options.results / output::checkpoint_name);
  const double t1 = _sim.clock.wall();
  _checkpoint_due =
      t1 + output::checkpoint_wait(_scene.output.checkpoint_every, t1 - t0);
}

/// Take everything from the checkpoint.
void Run::resume()
{
  (*_loaded)("run/stage", _stage);
  (*_loaded)("run/stage_begin", _begin);
  enter_stage();
  keep(*_loaded);
  _loaded.reset();
  ++_summary.resumed;
  _progress.resume({.time = _sim.state.time, .number = _summary.steps});
  std::ostringstream words;
  words << "resumed at t " << _sim.state.time << " s";
  _progress.note(words.str());
}

std::string Run::explain(const StepLog& log) const
{
  const auto& why = log.newton.failure;
  std::ostringstream out;
  out << "stopped at the step floor: t = " << _sim.state.time << " s, step "
      << _control->step() << " s is below " << _control->floor() << " s; "
      << why.cause << ", cell " << why.cell << " at (" << why.place[0] << ", "
      << why.place[1] << ") m, material '" << _scene.material.begin()->first
      << "'";
  return out.str();
}

/// The present stage, from its start or from where it is resumed.
void Run::enter_stage()
{
  const scene::Stage& stage = _scene.stage.at(_stage);
  _marks = marks(_begin, stage.duration);
  _control.emplace(stage, _marks, _sim.scene.solver.max_iterations);
  if (_sim.problem)
    _sim.problem->set_stage(stage, _sim.state);
}

/// What the laws took in a step, into the summary.
void Run::count(const material::Effort& effort)
{
  _summary.law["substeps"] += effort.substeps;
  _summary.law["rejected"] += effort.rejected;
  _summary.law["apex"] += effort.apex;
  _summary.law["clipped"] += effort.clipped;
}

/// One step; false when it fails at the floor.
bool Run::attempt()
{
  StepLog log;
  const double t0 = _control->time(), t1 = _control->next();
  const int number = static_cast<int>(_summary.steps) + 1;
  const bool taken = step(_sim, _scene.stage[_stage], t0, t1, number, log);
  _summary.iterations += log.newton.iterations;
  if (not taken)
  {
    ++_summary.rejected;
    if (_control->failed())
      return true;
    _summary.outcome = explain(log);
    return false;
  }
  if (not log.remap.trouble.empty())
  {
    _progress.note("remap left out: " + log.remap.trouble);
    ++_summary.remaps_left_out;
    _summary.remap_trouble = log.remap.trouble;
  }
  if (_sim.problem)
    count(_sim.problem->effort());
  _summary.remaps += log.remap.done;
  ++_summary.steps;
  _control->accepted(static_cast<int>(log.newton.residuals.size()) - 1);
  _sim.state.time = _begin + _control->time();
  _monitor.after_step(t1 - t0);
  record(t1 - t0, log);
  _progress.show(
      {_sim.state.time, t1 - t0, _summary.steps, log.newton.iterations});
  if (std::ranges::find(_marks, _control->time()) != _marks.end())
    write_fields();
  return true;
}

/// Steps of the present stage; false when the run has to end.
bool Run::stage()
{
  if (_control->time() == 0 and _sim.problem)
    _sim.problem->begin_stage(_sim.state);
  while (not _control->finished())
  {
    const auto steps = _summary.steps;
    if (not attempt())
      return false;
    if (_summary.steps == steps)
      continue;
    if (_stop.requested(_comm))
    {
      _summary.outcome = "stopped by a signal";
      _interrupted = true;
      return false;
    }
    if (checkpoint_due())
      save();
  }
  return true;
}

std::vector<output::Timing> Run::timings() const
{
  return _sim.clock.timings(_summary.cells,
                            [this](std::span<double> v)
                            {
                              MPI_Allreduce(MPI_IN_PLACE, v.data(),
                                            static_cast<int>(v.size()),
                                            MPI_DOUBLE, MPI_MAX, _comm);
                            });
}

void Run::finish()
{
  _summary.timers = timings();
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

/// Hold the run against what is known of it.
void Run::check()
{
  _summary.ledger = _monitor.ledger();
  _summary.time = _sim.state.time;
  _summary.checks =
      output::evaluate(_references.entries, _curves, _summary.ledger);
}

/// Ground begins at rest.
void Run::settle()
{
  if (not _scene.initial.K0)
    return;
  const Balance balance = mmale::settle(_sim);
  _summary.initial_imbalance = balance.settled;
  _progress.note(std::format("initial stress: {:.1e} of the weight out of "
                             "balance as laid, {:.1e} when settled",
                             balance.as_laid, balance.settled));
}

Result Run::go()
{
  if (_loaded)
    resume();
  else
  {
    settle();
    record(0, {});
    write_fields();
    enter_stage();
    if (_scene.initial.K0)
      _sim.problem->rest_under_gravity();
  }
  _checkpoint_due = _sim.clock.wall() + _scene.output.checkpoint_every;
  bool completed = stage();
  while (completed and _stage + 1 < static_cast<int>(_scene.stage.size()))
  {
    ++_stage;
    _begin = _sim.state.time;
    enter_stage();
    completed = stage();
  }
  if (completed)
    _summary.outcome = "completed";
  // Fields of the end belong to a run that is completed, and are no part of
  // one that goes on.
  if (completed)
    write_fields();
  check();
  _header.completed = completed;
  _header.checks_hold = output::all_hold(_summary.checks);
  save();
  if (not completed)
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
/// A run that starts leaves nothing of an earlier one that it could be mixed
/// up with.
void clear(const RunOptions& options)
{
  const auto found = output::find_checkpoint(options.results);
  if (found.there and not found.header.completed and found.trouble.empty())
    std::cerr << "mmale: " << options.results.string()
              << " holds a run that stopped at t = " << found.header.time
              << " s; it starts afresh (--resume would have gone on)"
              << std::endl;
  const auto checkpoint = options.results / output::checkpoint_name;
  std::filesystem::remove(checkpoint);
  std::filesystem::remove(checkpoint.string() + ".part");
  std::filesystem::remove_all(options.results / "lines");
}
} // namespace

Result run(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options)
{
  output::on_root(comm,
                  [&]
                  {
                    std::filesystem::create_directories(options.results);
                    if (not options.resume)
                      clear(options);
                  });
  if (scene.stage.empty())
    return lay(comm, scene, options);
  return Run(comm, scene, options).go();
}
} // namespace mmale
