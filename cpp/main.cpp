// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bridge/domains.h"
#include "bridge/paint.h"
#include "command_line.h"
#include "drainage.h"
#include "element/verb.h"
#include "environment.h"
#include "libraries.h"
#include "mesh/gmsh.h"
#include "output/pictures.h"
#include "run.h"
#include "scene/describe.h"
#include "scene/reader.h"
#include "scene/sweep.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <tuple>

namespace fs = std::filesystem;
using namespace mmale;

namespace
{
constexpr const char* exit_help =
    "Exit code: 0 all runs completed; 1 mistake in scene or command line;\n"
    "2 failure of the program; 3 a run stopped early, --resume goes on;\n4 "
    "completed, but a check of reference.toml does not hold.\n"
    "Words after -- go to PETSc.";

/// A run to be made: what differs between members, its scene, and its mesh if
/// that comes from a file (without cells but on rank 0).
struct Job
{
  scene::Member member;
  scene::Scene scene;
  std::string described = {}; ///< the scene as understood
  Resumption begin = {};
  std::shared_ptr<const mesh::Grid> grid = nullptr;
};

/// Meshes from files, each read once: members of a sweep may share them.
class Meshes
{
public:
  const mesh::Loaded& of(const scene::Scene& scene)
  {
    const Key key = {scene.mesh.file, scene.mesh.refine, scene.symmetry,
                     scene.motion.has_value()};
    auto at = _loaded.find(key);
    if (at == _loaded.end())
      at = _loaded.emplace(key, mesh::load_gmsh(scene)).first;
    return at->second;
  }

private:
  using Key = std::tuple<std::string, double, scene::Symmetry, bool>;
  std::map<Key, mesh::Loaded> _loaded;
};

/// What a run is checked against, and the scene that it is known of: changed
/// scenes have other results.
struct Reference
{
  std::string file;  ///< reference.toml; empty without one
  std::string scene; ///< as described
};

/// Text that only rank 0 knows, on all ranks.
std::string broadcast(MPI_Comm comm, std::string text)
{
  auto size = static_cast<unsigned long>(text.size());
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, comm);
  text.resize(size);
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, 0, comm);
  return text;
}

/// Read the scene of every member of the sweep; all complaints of all.
/// @param meshes null on ranks that leave files to rank 0
std::vector<Job> read_jobs(const scene::FileText& file, const Arguments& given,
                           Meshes* meshes,
                           std::vector<scene::Complaint>& complaints)
{
  scene::OutlineReader read_mesh;
  scene::DomainReader read_domain;
  scene::RegionReader read_region;
  if (meshes)
  {
    read_mesh = [meshes](const scene::Scene& scene)
    { return meshes->of(scene).outline; };
    read_domain = bridge::outline_of;
    read_region = bridge::region_outline;
  }
  complaints = file.complaints;
  const scene::Sweep sweep = scene::expand(given.overrides);
  std::ranges::copy(sweep.complaints, std::back_inserter(complaints));
  if (not complaints.empty())
    return {};
  std::vector<Job> jobs;
  for (const scene::Member& member : sweep.members)
  {
    scene::Reading reading =
        scene::read(file.text, given.scene.string(), member.overrides,
                    libraries(), read_mesh, read_domain, read_region);
    std::ranges::copy(reading.complaints, std::back_inserter(complaints));
    Job job = {.member = member, .scene = std::move(reading.scene)};
    job.described = scene::describe(job.scene);
    if (job.scene.mesh.shape == "gmsh" and complaints.empty())
      job.grid = meshes ? meshes->of(job.scene).grid
                        : std::make_shared<const mesh::Grid>();
    jobs.push_back(std::move(job));
  }
  return jobs;
}

/// What a throw of ours comes to: told and, with company, the end of all
/// processes, for the others may wait in a collective.
Exit fail(MPI_Comm comm, const std::exception& error)
{
  std::cerr << "mmale: " << error.what() << std::endl;
  int size = 1;
  MPI_Comm_size(comm, &size);
  if (size > 1)
    MPI_Abort(comm, failure);
  return failure;
}

/// One run, and its row of the sweep's table.
Exit run_one(MPI_Comm comm, const Job& job, const RunOptions& options,
             scene::Row& row)
{
  try
  {
    const Result result = job.begin.way == Resumption::Way::completed
                              ? job.begin.result
                              : run(comm, job.scene, options);
    row.interrupted = result.interrupted;
    row.outcome = result.outcome;
    row.last = result.last;
    return end_of(result.completed, result.checks_hold);
  }
  catch (const std::exception& error)
  {
    row.outcome = std::string("failed: ") + error.what();
    return fail(comm, error);
  }
}

/// Pictures with all runs of a sweep; without them the sweep is no failure.
void draw_sweep(const std::vector<Job>& jobs, const fs::path& results)
{
  std::vector<fs::path> members;
  for (const Job& job : jobs)
    members.push_back(results / job.member.folder);
  if (const auto trouble = output::draw_sweep(results, members);
      not trouble.empty())
    std::cerr << "mmale: no pictures of the sweep: " << trouble << std::endl;
}

/// All runs in turn; the table grows with each, so an end midway loses none.
Exit run_all(MPI_Comm comm, const std::vector<Job>& jobs,
             const Arguments& given, const fs::path& results,
             const Reference& reference)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::set<Exit> ends;
  std::vector<scene::Row> rows;
  for (const Job& job : jobs)
  {
    if (rank == 0 and jobs.size() > 1 and not given.quiet)
      std::cout << "[" << rows.size() + 1 << "/" << jobs.size() << "] "
                << job.member.folder << std::endl;
    scene::Row row = {job.member.swept, "", {}};
    const fs::path folder = job.member.folder;
    if (rank == 0 and job.begin.way == Resumption::Way::completed)
      std::cout << "mmale: " << (results / folder).string()
                << ": this run is completed, nothing is left to do"
                << std::endl;
    ends.insert(run_one(comm, job,
                        {folder.empty() ? results : results / folder,
                         job.described == reference.scene ? reference.file : "",
                         job.described, given.quiet,
                         job.begin.way == Resumption::Way::resume, job.grid},
                        row));
    const bool interrupted = row.interrupted;
    rows.push_back(std::move(row));
    if (rank == 0 and jobs.size() > 1
        and not(std::ofstream(results / "sweep.csv")
                << scene::to_csv(rows) << std::flush))
      throw std::runtime_error("cannot write "
                               + (results / "sweep.csv").string());
    if (interrupted)
      break;
  }
  if (rank == 0 and jobs.size() > 1)
    draw_sweep(jobs, results);
  return worst(ends);
}

/// What --resume finds for each run; on rank 0.
void look_for_checkpoints(std::vector<Job>& jobs, const fs::path& results,
                          std::vector<scene::Complaint>& complaints)
{
  bool any = false;
  for (Job& job : jobs)
  {
    const fs::path folder = job.member.folder;
    job.begin = look_for_checkpoint(folder.empty() ? results : results / folder,
                                    job.scene, job.described);
    any = any or job.begin.way != Resumption::Way::start;
    for (const auto& line : job.begin.complaints)
      complaints.push_back({"", line, {}});
  }
  // Of a sweep's runs some may not have begun; with none there is a mistake.
  if (not any)
    complaints.push_back(
        {"", results.string() + ": there is no checkpoint to resume from", {}});
}

/// What rank 0 has found, on all ranks.
void agree_on_beginnings(MPI_Comm comm, std::vector<Job>& jobs)
{
  for (Job& job : jobs)
  {
    int way[2] = {static_cast<int>(job.begin.way),
                  job.begin.result.checks_hold};
    MPI_Bcast(way, 2, MPI_INT, 0, comm);
    job.begin.way = static_cast<Resumption::Way>(way[0]);
    job.begin.result.completed = true;
    job.begin.result.checks_hold = way[1] != 0;
  }
}

/// `mmale run`: rank 0 reads, all ranks agree before anything starts.
Exit run_verb(MPI_Comm comm, const Arguments& given)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const fs::path results = results_folder(given, "scene.toml");
  scene::FileText file;
  std::vector<scene::Complaint> complaints;
  std::vector<Job> jobs;
  std::string reference;
  if (rank == 0)
  {
    file = scene::load(given.scene);
    Meshes meshes;
    jobs = read_jobs(file, given, &meshes, complaints);
    std::error_code error;
    if (complaints.empty())
      fs::create_directories(results, error);
    if (error)
      complaints.push_back(
          {"", "cannot be made: " + error.message(), {results.string(), 0}});
    const fs::path beside = given.scene.parent_path() / "reference.toml";
    if (fs::exists(beside, error))
      reference = beside.string();
    if (given.resume and complaints.empty())
      look_for_checkpoints(jobs, results, complaints);
    if (not complaints.empty())
      print(complaints);
  }
  int bad = not complaints.empty();
  MPI_Bcast(&bad, 1, MPI_INT, 0, comm);
  if (bad)
    return mistake;
  // The same text gives the same scenes on every rank.
  file.text = broadcast(comm, file.text);
  if (rank > 0)
    jobs = read_jobs(file, given, nullptr, complaints);
  agree_on_beginnings(comm, jobs);
  // A scene that only its changes make good has no results to compare with.
  const scene::Reading as_written =
      scene::read(file.text, given.scene.string(), {}, libraries());
  return run_all(
      comm, jobs, given, results,
      {broadcast(comm, reference),
       as_written.complaints.empty() ? scene::describe(as_written.scene) : ""});
}

/// `mmale check`: the scene as understood, or the complaints.
Exit check_verb(const Arguments& given)
{
  if (given.keys)
  {
    std::cout << to_string(scene::key_reference(libraries()));
    if (given.scene.empty())
      return good;
  }
  Meshes meshes;
  std::vector<scene::Complaint> complaints;
  const std::vector<Job> jobs =
      read_jobs(scene::load(given.scene), given, &meshes, complaints);
  if (not complaints.empty())
  {
    print(complaints);
    return mistake;
  }
  for (const Job& job : jobs)
  {
    if (jobs.size() > 1)
      std::cout << "# " << job.member.folder << "\n";
    if (const auto water = drainage(job.scene))
      std::cout << "# " << water->words() << "\n";
    std::cout << scene::describe(job.scene) << "\n";
  }
  return good;
}

/// The verb `element`.
void define_element(CLI::App& app, Arguments& given,
                    const std::function<void(CLI::App*)>& overrides)
{
  CLI::App* verb = app.add_subcommand(
      "element", "One material point along the paths of an element test");
  CLI::Option* test =
      verb->add_option("test", given.scene, "the test")->type_name("TEST.toml");
  overrides(verb);
  verb->add_option("--results", given.results,
                   "where to write; default results/<name of the test>")
      ->type_name("DIR");
  verb->add_flag("--quiet", given.quiet, "Nothing on the screen");
  CLI::Option* keys =
      verb->add_flag("--keys", given.keys, "List every key of a test");
  verb->footer(
      "Exit code: 0 all tests completed; 1 mistake in test or command line;\n"
      "2 failure of the program; 3 a test stopped early: what is prescribed\n"
      "cannot be met; 4 completed, but a check of reference.toml beside the\n"
      "test does not hold.");
  verb->final_callback(
      [keys, test]
      {
        if (not*keys and not*test)
          throw CLI::RequiredError("TEST.toml");
      });
}

/// The options of all verbs.
void define(CLI::App& app, Arguments& given)
{
  const auto overrides = [&](CLI::App* verb)
  {
    verb->add_option("changes", given.overrides,
                     "keys of the file, mesh.size=0.025; several values, "
                     "mesh.size=0.1,0.05, make a sweep")
        ->type_name("key=value");
  };
  app.name("mmale");
  app.set_version_flag("--version", "mmale " MMALE_VERSION);
  app.require_subcommand(1);
  app.footer(exit_help);
  CLI::App* run = app.add_subcommand("run", "Run a scene");
  run->add_option("scene", given.scene, "the scene")
      ->type_name("SCENE.toml")
      ->required();
  overrides(run);
  run->add_option("--results", given.results,
                  "where to write; default results/<name of the scene>")
      ->type_name("DIR");
  run->add_flag("--resume", given.resume,
                "Go on from the checkpoint in the folder of the results");
  run->add_flag("--quiet", given.quiet, "No progress on the screen");
  run->footer(exit_help);
  CLI::App* check = app.add_subcommand(
      "check", "Say how a scene is understood, or all complaints about it");
  CLI::Option* keys =
      check->add_flag("--keys", given.keys, "List every key of a scene");
  CLI::Option* scene = check->add_option("scene", given.scene, "the scene")
                           ->type_name("SCENE.toml");
  overrides(check);
  check->final_callback(
      [keys, scene]
      {
        if (not*keys and not*scene)
          throw CLI::RequiredError("SCENE.toml");
      });
  define_element(app, given, overrides);
}
} // namespace

int main(int argc, char* argv[])
{
  // Ours are the words before --, PETSc's those behind.
  const auto dashes = std::find(argv, argv + argc, std::string_view("--"));
  const int ours = static_cast<int>(dashes - argv);
  const std::vector<std::string> petsc(std::min(dashes + 1, argv + argc),
                                       argv + argc);
  try
  {
    // Only runs need MPI; with it a usage mistake too is told once.
    std::optional<Environment> environment;
    int rank = 0;
    if (argc > 1 and std::string_view(argv[1]) == "run")
    {
      environment.emplace(argv[0], petsc);
      MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    }
    Arguments given;
    CLI::App app("MMALE: multi-material arbitrary Lagrangian-Eulerian solver");
    define(app, given);
    try
    {
      app.parse(ours, argv);
    }
    catch (const CLI::ParseError& error)
    {
      if (rank > 0)
        return error.get_exit_code() == 0 ? good : mistake;
      return app.exit(error) == 0 ? good : mistake;
    }
    if (app.got_subcommand("element"))
      return element::element_verb(given);
    if (not environment)
      return check_verb(given);
    try
    {
      return run_verb(MPI_COMM_WORLD, given);
    }
    catch (const std::exception& error)
    {
      return fail(MPI_COMM_WORLD, error);
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << "mmale: " << error.what() << std::endl;
    return failure;
  }
}
