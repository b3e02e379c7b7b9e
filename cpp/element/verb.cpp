// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/verb.h"

#include "element/compare.h"
#include "element/reader.h"
#include "element/run.h"
#include "output/pictures.h"
#include "scene/reader.h"
#include "scene/sweep.h"
#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>
#include <stdexcept>

namespace fs = std::filesystem;

namespace mmale::element
{
namespace
{
/// A test to be run, and what differs between members of a sweep.
struct Job
{
  scene::Member member;
  Test test;
};

scene::Libraries libraries()
{
  return {.laws = material::law_infos()};
}

/// Columns of the data that the test does not have; only a law knows all.
void check_data(const Test& test, std::vector<scene::Complaint>& out)
{
  if (not test.data)
    return;
  const auto names = columns(test, material::make_law(test.material));
  const fs::path file = fs::path(test.data->folder) / test.data->file;
  for (const std::string& what : strangers(read_data(*test.data), names))
    out.push_back({"", what, {file.string(), 0}});
}

/// Read the test of every member of the sweep; all complaints of all.
std::vector<Job> read_jobs(const Arguments& given,
                           std::vector<scene::Complaint>& complaints)
{
  const scene::FileText file = scene::load(given.scene, "test");
  complaints = file.complaints;
  const scene::Sweep sweep = scene::expand(given.overrides);
  std::ranges::copy(sweep.complaints, std::back_inserter(complaints));
  std::vector<Job> jobs;
  if (not complaints.empty())
    return jobs;
  for (const scene::Member& member : sweep.members)
  {
    Reading reading = element::read(file.text, given.scene.string(),
                                    member.overrides, libraries());
    if (reading.complaints.empty())
      check_data(reading.test, reading.complaints);
    std::ranges::copy(reading.complaints, std::back_inserter(complaints));
    jobs.push_back({member, std::move(reading.test)});
  }
  return jobs;
}

/// What the test is checked against: reference.toml beside it, if this is the
/// test as it is written.
fs::path reference_of(const Arguments& given, const Test& test)
{
  const fs::path beside = given.scene.parent_path() / "reference.toml";
  std::error_code error;
  if (not fs::exists(beside, error))
    return {};
  const Reading written = element::read(scene::load(given.scene, "test").text,
                                        given.scene.string(), {}, libraries());
  return describe(written.test) == describe(test) ? beside : fs::path();
}

Exit run_one(const Job& job, const Arguments& given, const fs::path& results,
             scene::Row& row)
{
  try
  {
    const Result result =
        run(job.test, {.results = results,
                       .reference = reference_of(given, job.test),
                       .test_as_understood = describe(job.test),
                       .quiet = given.quiet});
    row.outcome = result.outcome;
    row.last = result.last;
    return end_of(result.completed, result.checks_hold);
  }
  catch (const std::exception& error)
  {
    row.outcome = std::string("failed: ") + error.what();
    std::cerr << "mmale: " << error.what() << std::endl;
    return failure;
  }
}

Exit run_all(const std::vector<Job>& jobs, const Arguments& given,
             const fs::path& results)
{
  std::set<Exit> ends;
  std::vector<scene::Row> rows;
  std::vector<fs::path> members;
  for (const Job& job : jobs)
  {
    if (jobs.size() > 1 and not given.quiet)
      std::cout << "[" << rows.size() + 1 << "/" << jobs.size() << "] "
                << job.member.folder << std::endl;
    scene::Row row = {job.member.swept, "", {}};
    members.push_back(job.member.folder.empty() ? results
                                                : results / job.member.folder);
    ends.insert(run_one(job, given, members.back(), row));
    if (given.quiet and ends.contains(stopped))
      std::cerr << "mmale: " << row.outcome << std::endl;
    rows.push_back(std::move(row));
    if (jobs.size() > 1
        and not(std::ofstream(results / "sweep.csv")
                << scene::to_csv(rows) << std::flush))
      throw std::runtime_error("cannot write "
                               + (results / "sweep.csv").string());
  }
  if (jobs.size() > 1)
    if (const auto trouble = output::draw_sweep(results, members);
        not trouble.empty())
      std::cerr << "mmale: no pictures of the sweep: " << trouble << std::endl;
  return worst(ends);
}
} // namespace

Exit element_verb(const Arguments& given)
{
  if (given.keys)
  {
    std::cout << scene::to_string(element::key_reference(libraries()));
    if (given.scene.empty())
      return good;
  }
  std::vector<scene::Complaint> complaints;
  const std::vector<Job> jobs = read_jobs(given, complaints);
  const fs::path results = results_folder(given, "test.toml");
  std::error_code error;
  if (complaints.empty())
    fs::create_directories(results, error);
  if (error)
    complaints.push_back(
        {"", "cannot be made: " + error.message(), {results.string(), 0}});
  if (not complaints.empty())
  {
    print(complaints);
    return mistake;
  }
  return run_all(jobs, given, results);
}
} // namespace mmale::element
